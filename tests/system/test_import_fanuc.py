"""`rmac import`, `rmac simulate` and `rmac run` of programs for Fanuc-type controls, as posts write them."""

import json
import math
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance

# A slot, an arc, a full circle and a row of holes by a macro, in the shape of what posts of CAM systems write.
PLATE = """%
O1001 (PLATE)
(T1 D=10. CR=0. - ZMIN=-2. - FLAT END MILL)
N10 G90 G94 G17 G49 G40 G80
N15 G21
N20 G05.1 Q1
(CONTOUR1)
N25 S800 M03
N30 G43
N35 G00 X10. Y0. Z10.
N40 G01 Z-2. F1200.
N45 G03 X0. Y10. R10.
N50 G03 I0. J-10.
N55 G00 Z5.
N60 G65 P9010 X-10. Y10. I10. K3 R1. Z-4. F300.
N65 G05.1 Q0
N70 M05
N75 M30
O9010 (ROW OF HOLES: X, Y, PITCH I, COUNT K)
#33=0
WHILE [#33 LT #6] DO1
G98 G81 X[#24+#33*#4] Y#25 Z#26 R#18 F#9
#33=#33+1
END1
G80
M99
%
"""


class ImportFanuc(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.source = self.folder / "O1001.nc"
        self.source.write_text(PLATE.replace("K3 ", "K3. "))

    def rmac(self, *words):
        return subprocess.run([BUILD / "bin" / "rmac", *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
                              check=False)

    def test_a_post_s_program_is_simulated_and_machined(self):
        done = self.rmac("simulate", self.source, "--dialect", "fanuc", "--machine", "BenchXYZ", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # From rest at 0, 0, 0 to 10, 0, 10; 12 down; five quarters of radius 10; 7 up; across, and three holes of 9 down and up.
        expected = math.hypot(10, 10) + 12 + 25 * math.pi + 7 + 10 + 3 * 18 + 2 * 10
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], expected, delta=0.01)
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", "--dialect", "fanuc", self.source)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            x, y, z = json.loads(appliance.rmac("--json", "status").stdout)["pose"][:3]
        self.assertLess(math.dist((x, y, z), (10, 10, 5)), 0.01)

    def test_an_option_says_what_whole_numbers_count(self):
        self.source.write_text(PLATE)
        done = self.rmac("simulate", self.source, "--dialect", "fanuc", "--machine", "BenchXYZ")
        self.assertEqual(done.returncode, 1)
        self.assertIn("O1001.nc:15:31: no decimal point", done.stderr)
        done = self.rmac("simulate", self.source, "--dialect", "fanuc", "--machine", "BenchXYZ", "--whole-numbers", "units")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_a_haas_has_its_own_language(self):
        self.source.write_text("%\nO1 (POCKET)\nG21 G90 G54 M31\nS800 M3 M88\nG0 X0 Y0 Z10.\nG13 I5. K9. Q4. Z-1. D1 F600.\n"
                               "G0 Z10. M89\nM97 P100 L2\nM30\nN100 G0 X5.\nX0\nM99\n%\n")  # fmt: skip
        given = ("--machine", "BenchXYZ", "--approach", "0,0,10", "--tool-diameter", "1=4")
        done = self.rmac("simulate", self.source, "--dialect", "fanuc", *given)
        self.assertEqual(done.returncode, 1)
        self.assertIn("O1001.nc:3:13: M31 is a code of the machine's builder", done.stderr)
        self.assertIn("of a Haas' program --dialect haas knows it", done.stderr)
        done = self.rmac("simulate", self.source, "--dialect", "haas", *given)
        self.assertIn("give --output 88=NAME", done.stderr)
        done = self.rmac("simulate", self.source, "--dialect", "haas", *given, "--pass-over", "M88", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # From rest at 0, 0, 0: 10 up, 11 down; half turns of diameter 3, 10 and 7, circles of radius 3 and 7; 11 up; twice to and fro.
        expected = 10 + 11 + 10 * math.pi + 20 * math.pi + 11 + 20
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], expected, delta=0.01)

    def test_an_option_that_would_do_nothing_is_refused(self):
        self.source.write_text("%\nO1\nG21 G90\nT1 M16\nG43 H1\nG0 X0 Y0 Z10.\nM30\n%\n")
        for option, value in (("--output", "99=Air"), ("--output", "89=Coolant"), ("--pass-over", "M97"), ("--pass-over", "M16"), ("--pass-over", "M6")):
            done = self.rmac("import", self.source, "--dialect", "haas", option, value)
            self.assertEqual(done.returncode, 2, value)
            self.assertIn(f"{option} {value}: ", done.stderr)
        self.assertEqual(self.rmac("import", self.source, "--dialect", "fanuc", "--pass-over", "M98").returncode, 2)
        done = self.rmac("import", self.source, "--dialect", "haas", "--output", "88=Coolant", "--pass-over", "M21", "--pass-over", "M88")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_it_is_no_program_of_linuxcnc(self):
        """The ending is the same, and the language is not."""
        done = self.rmac("import", self.source)
        self.assertEqual(done.returncode, 1)
        self.assertIn("if it is one, give --dialect fanuc or --dialect haas)", done.stderr)
        self.source.write_text("%\no100 sub\no100 endsub\nG65\n%\n")
        self.assertIn("there is no G65\n", self.rmac("import", self.source).stderr, "and this is one of LinuxCNC")
        done = self.rmac("import", self.source, "--whole-numbers", "units")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--whole-numbers is not of rs274", done.stderr)

    def test_an_error_leaves_no_file(self):
        self.source.write_text("%\nO1\nG21 G90\nG84 X1. Z-5. R2.\nM30\n%\n")
        done = self.rmac("import", self.source, "--dialect", "fanuc")
        self.assertEqual(done.returncode, 1)
        self.assertIn("O1001.nc:4:1: G84: ", done.stderr)
        self.assertEqual(list(self.folder.iterdir()), [self.source])


if __name__ == "__main__":
    unittest.main()

"""`rmac import`, `rmac simulate` and `rmac run` of CL files in APT, as CATIA and NX write them."""

import json
import math
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance

PLATE = """$$ a plate: slot, arc, full circle and two holes, in the shape of CATIA's files
PARTNO a plate
UNITS/MM
CUTCOM/OFF
PPRINT OPERATION NAME : Contour.1
CUTTER/ 10.000000,  2.000000,  3.000000,  2.000000,  0.000000,$
         0.000000, 50.000000
FEDRAT/ 1200.0000,MMPM
SPINDL/ 800.0000,RPM,CLW
RAPID
GOTO  /   10.00000,    0.00000,   10.00000
GOTO  /   10.00000,    0.00000,   -2.00000
AUTOPS
INDIRV/    0.00000,    1.00000,    0.00000
TLON,GOFWD/ (CIRCLE/    0.00000,    0.00000,   -2.00000,$
   10.00000),ON,(LINE/    0.00000,    0.00000,   -2.00000,$
    0.00000,   10.00000,   -2.00000)
INDIRV/    1.00000,    0.00000,    0.00000
TLON,GOFWD/ (CIRCLE/    0.00000,    0.00000,   -2.00000,10.00000),$
ON,2,INTOF,(LINE/ 0.00000,0.00000,-2.00000,0.00000,10.00000,-2.00000)
RAPID
GOTO/0,10,5
CYCLE/DRILL,DEPTH,4,MMPM,300,CLEAR,1
GOTO/-10,10,0
GOTO/-10,-10,0
CYCLE/OFF
DELAY/.5
SPINDL/OFF
END
FINI
"""

IMPELLER = """TOOL PATH/VARIABLE_CONTOUR,TOOL,BALL_6
TLDATA/MILL,6.0000,3.0000,75.0000,0.0000,0.0000
MSYS/0.0000,0.0000,0.0000,1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
$$ centerline data
PAINT/PATH
RAPID
GOTO/10.0000,20.0000,50.0000,0.0000000,0.0000000,1.0000000
FEDRAT/MMPM,1000.0000
GOTO/10.0000,20.0000,30.0000,0.0871557,0.0000000,0.9961947
GOTO/60.0000,20.0000,30.0000
CIRCLE/60.0000,40.0000,30.0000,0.0000000,0.0000000,-1.0000000,20.0000,0.0600,0.5000,6.0000,3.0000
GOTO/80.0000,40.0000,30.0000,0.0000000,0.0871557,0.9961947
END-OF-PATH
"""


class ImportApt(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def rmac(self, *words):
        return subprocess.run([BUILD / "bin" / "rmac", *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
                              check=False)

    def source(self, name, text):
        file = self.folder / name
        file.write_text(text)
        return file

    def test_a_program_of_catia_s_shape_is_simulated_and_machined(self):
        plate = self.source("plate.aptsource", PLATE)
        done = self.rmac("simulate", plate, "--machine", "BenchXYZ", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # 10, 0, 10 from rest at 0, 0, 0; 12 down; a quarter and a whole of radius 10; 7 up; across and down to the first hole, 5 in and
        # out, and the same 20 away.
        expected = math.hypot(10, 10) + 12 + 1.25 * 20 * math.pi + 7 + 10 + 4 + 10 + 20 + 10
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], expected, delta=0.01)
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", plate)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            x, y, z = json.loads(appliance.rmac("--json", "status").stdout)["pose"][:3]
        self.assertLess(math.dist((x, y, z), (-10, -10, 1)), 0.01)

    def test_five_axes_of_nx_s_shape_are_simulated_where_a_machine_has_them(self):
        impeller = self.source("impeller.cls", IMPELLER)
        words = ["simulate", impeller, "--unit", "mm", "--multax"]
        done = self.rmac(*words, "--machine", "TarusXYZCA", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout)["moves"], 4)
        done = self.rmac(*words, "--machine", "BenchXYZ")
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith(f"rmac: {impeller}:9: RMAC_CAM.MoveAlongLine: "), done.stderr)
        done = self.rmac("simulate", impeller, "--unit", "mm", "--machine", "TarusXYZCA")
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith(f"rmac: {impeller}:9:1: the tool axis 0.0871557,0,0.996195 is not Z"), done.stderr)

    def test_the_language_is_told_by_the_ending_or_the_dialect(self):
        program = "UNITS/MM\nRAPID\nGOTO/1,0,0\nFINI\n"
        for name, words, ending in (("P.APT", [], 0), ("p.Cls", [], 0), ("p.aptsource", [], 0), ("p.txt", [], 1),
                                    ("p.txt", ["--dialect", "apt"], 0), ("p.ngc", ["--dialect", "apt"], 0), ("p.ngc", [], 1)):
            done = self.rmac("simulate", self.source(name, program), "--machine", "BenchXYZ", *words)
            self.assertEqual(done.returncode, ending, (name, done.stderr))
        done = self.rmac("import", self.source("p.apt", program), "-o", "-")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("MoveToPathTarget", done.stdout)

    def test_an_option_of_the_other_language_is_refused(self):
        program = self.source("p.apt", "UNITS/MM\nFINI\n")
        done = self.rmac("import", program, "--assume-g43")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--assume-g43 is not of apt", done.stderr)
        done = self.rmac("import", self.source("p.ngc", "M2\n"), "--multax")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--multax is not of rs274", done.stderr)

    def test_what_is_refused_leaves_no_file(self):
        program = self.source("p.apt", "UNITS/MM\nRAPID\nGOTO/1,0,0\n  CUTCOM/LEFT\nFINI\n")
        done = self.rmac("import", program)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith(f"rmac-import: {program}:4:10: CUTCOM/LEFT: compensation"), done.stderr)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["p.apt"])


if __name__ == "__main__":
    unittest.main()

"""`rmac import`: a program of another control becomes one that `rmac simulate` plans, or none at all; `rmac run` and `rmac simulate` take
it as it is."""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance

PART = """%
(a plate: slot, arc, helix and holes)
g21 g90 g17 g40 g80 g94
G0 X0 Y0 Z10
#1 = 12 #<depth> = -2
M3 S800
F1200 G1 Z#<depth>
X#1
G3 X[#1 + 8] Y8 I0 J8
G2 X20 Y8 I-5 J0 Z[#<depth> - 1] P2
G0 Z5
G98 G83 X-10 Y-10 Z-4 R1 Q2
G80
G4 P0.5
M5
M30
%
"""


# The same slot thrice, by a sub, a loop and a numbered program.
LOOPS = """%
O1
g21 g90 g17 G0 X0 Y0 Z10
F1200
o<slot> sub (x, length)
  G0 X#1 Y0
  G1 Z-1
  Y#2
  G0 Z10
o<slot> endsub [#1 + 5]
o10 repeat [2]
  o<slot> call [#<_value>] [12]
o10 endrepeat
M98 P7
M30
O7
o<slot> call [#<_value>] [12]
M99
%
"""


class Import(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.source = self.folder / "part.ngc"

    def rmac(self, *words):
        return subprocess.run([BUILD / "bin" / "rmac", *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120,
                              check=False)

    def test_an_imported_program_is_simulated(self):
        self.source.write_text(PART)
        done = self.rmac("import", self.source)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        target = self.folder / "part.rmac"
        self.assertIn(f"{target}: ", done.stdout)
        done = self.rmac("simulate", target, "--machine", "BenchXYZ", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # 10 to the start, 12 down, 12, a quarter of radius 8, two full turns of radius 5 with 1 mm of rise, 8 up, then the hole:
        # across to -10, -10 at 5, to R1, pecks to -1, -3 and -4, and back to 5.
        helix = 2 * math.hypot(2 * math.pi * 5, 0.5)
        hole = 4 + 2 + 2 + 1.746 + 2.254 + 4 + 3.746 + 1.254 + 9
        expected = 10 + 12 + 12 + 4 * math.pi + helix + 8 + math.hypot(30, 18) + hole
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], expected, delta=0.01)

    def test_a_program_of_subs_and_loops_is_simulated(self):
        self.source.write_text(LOOPS)
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # To the start, 10 from where the machine stands; then three slots of 11 down, 12 along, 11 up, and the ways between them.
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], 10 + 3 * (11 + 12 + 11) + 2 * math.hypot(5, 12), delta=0.01)

    def test_a_program_of_subs_and_loops_is_machined(self):
        self.source.write_text(LOOPS)
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", self.source)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            x, y, z = json.loads(appliance.rmac("--json", "status").stdout)["pose"][:3]
        self.assertLess(math.dist((x, y, z), (10, 12, 10)), 0.01)  # where the third slot was left, as measured

    def test_the_tool_s_centre_is_simulated_beside_the_contour(self):
        self.source.write_text("g21 f600\nG0 X0 Y0 Z10\nG42 D3\nG1 X10\nY10\nG40\nG0 X20\nM2\n")
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ", "--tool-diameter", "3=4", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        # To (10, -2), a quarter of radius 2 around the corner, 10 up at X 12, and to (20, 10).
        self.assertAlmostEqual(json.loads(done.stdout)["length_mm"], 10 + math.hypot(10, 2) + math.pi + 10 + 8, delta=0.01)
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ")
        self.assertIn(f"{self.source}:3:5: the diameter of tool 3 is not known here; give --tool-diameter 3=MM", done.stderr)

    def test_a_file_that_is_no_program_is_told_as_what_it_is(self):
        for content, what in ((b"", "is empty"), (b"\r\n \n", "is empty"), ("G21\n".encode("utf-16"), "is text in UTF-16; save it as plain text"),
                              (b"PK\x03\x04\0\0", "is no text")):
            self.source.write_bytes(content)
            done = self.rmac("import", self.source)
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (1, "", 1))
            self.assertIn(f"{self.source}: {what}", done.stderr)
        for file, what in ((self.folder, "is a folder"), (self.folder / "none.ngc", "cannot be read: No such file or directory")):
            self.assertIn(f"{file}: {what}", self.rmac("import", file).stderr)
        self.assertEqual(list(self.folder.glob("*.rmac")), [])

    def test_a_program_that_does_not_end_is_refused(self):
        self.source.write_text("g21 f600\nG0 X0 Y0 Z10\no1 while [1]\nG1 X1\nX0\no1 endwhile\nM2\n")
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ", "--output-limit", "1")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(f"{self.source}:6:1: the program became more than 1 MB", done.stderr)

    def test_a_fault_in_a_sub_is_told_at_its_line(self):
        self.source.write_text(LOOPS.replace("Y#2", "Y#2 M19"))
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(f"{self.source}:8:7: M19: ", done.stderr)

    def test_subs_are_read_from_files_beside_the_program_and_in_folders(self):
        (self.folder / "library").mkdir()
        (self.folder / "library" / "slot.ngc").write_text("o<slot> sub\nG1 X#1\no<deep> call\no<slot> endsub\n")
        (self.folder / "deep.ngc").write_text("o<deep> sub\nG1 Z-1\nG1 Z1 M19\no<deep> endsub\n")
        self.source.write_text("g21 f600\nG0 X0 Y0 Z10\no<Slot> call [5]\nM2\n")
        words = ["simulate", self.source, "--machine", "BenchXYZ"]
        done = self.rmac(*words)
        self.assertIn(f"{self.source}:3:1: o<slot> is not in this file, and there is no slot.ngc beside the program", done.stderr)
        done = self.rmac(*words, "--subroutines", self.folder / "library")
        self.assertIn(f"{self.folder / 'deep.ngc'}:3:7: M19: ", done.stderr)
        (self.folder / "deep.ngc").write_text("o<deep> sub\nG1 Z-1\no<deep> endsub\n")
        done = self.rmac(*words, "--subroutines", self.folder / "library", "--json")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["moves"], 3)

    def test_an_imported_program_is_machined(self):
        self.source.write_text(PART)
        self.assertEqual(self.rmac("import", self.source).returncode, 0)
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", self.folder / "part.rmac")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            x, y, z = json.loads(appliance.rmac("--json", "status").stdout)["pose"][:3]
        self.assertLess(math.dist((x, y, z), (-10, -10, 5)), 0.01)  # where the hole was left, as measured

    def test_such_a_program_is_simulated_and_machined_as_it_is(self):
        self.source.write_text(PART)
        imported = self.folder / "part.rmac"
        self.assertEqual(self.rmac("import", self.source).returncode, 0)
        of_import = json.loads(self.rmac("simulate", imported, "--machine", "BenchXYZ", "--json").stdout)
        imported.unlink()
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ", "--json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for what in ("length_mm", "moves", "cycle_time_s"):
            self.assertEqual(json.loads(done.stdout)[what], of_import[what])
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", self.source)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertEqual(json.loads(done.stdout)["moves"], of_import["moves"])
        self.assertEqual([p.name for p in self.folder.iterdir()], ["part.ngc"])

    def test_what_is_wrong_is_told_by_the_source_s_line(self):
        self.source.write_text("(far)\nG21 G90 G0 X0 Y0 Z0\n\nF600 G1 X5\nG1 X9000\nM2\n")
        for words in (["simulate", self.source, "--machine", "BenchXYZ"], ["simulate", "--machine", "BenchXYZ", self.source, "--rapid", "900"]):
            done = self.rmac(*words)
            self.assertEqual(done.returncode, 1)
            self.assertTrue(done.stderr.startswith(f"rmac: {self.source}:5: "), done.stderr)
        self.source.write_text("G21\nG0 X0 Y0 Z0\n\nG1 X1 F900000\nM2\n")  # the feed is no move
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ")
        self.assertTrue(done.stderr.startswith(f"rmac: {self.source}:4: RMAC_CAM.SetFeedrate: "), done.stderr)
        self.source.write_text("G21 G0 X0 Y0 Z0\n  G12 X2\nM2\n")
        done = self.rmac("simulate", self.source, "--machine", "BenchXYZ")
        self.assertEqual((done.returncode, done.stderr), (1, f"rmac: {self.source}:2:3: there is no G12\n"))

    def test_the_language_is_told_by_the_ending_or_the_dialect(self):
        for name, words, ending in (("P.NC", [], 0), ("p.tap", [], 0), ("p.gcode", [], 1), ("p.gcode", ["--dialect", "rs274"], 0),
                                    ("p.rmac", ["--dialect", "rs274"], 0), ("p.rmac", ["--rapid", "100"], 1)):
            file = self.folder / name
            file.write_text("G0 X1 Y0 Z0\nG0 X2\nM2\n" if ending == 0 else "{}")
            done = self.rmac("simulate", "--offset", "G54=0,0,0", file, "--machine", "BenchXYZ", "--unit", "mm", *words)
            self.assertEqual(done.returncode, ending, (name, done.stderr))
        self.assertIn("--dialect", done.stderr)
        self.assertEqual(self.rmac("simulate", "-", "--dialect", "rs274", "--machine", "BenchXYZ").returncode, 1)

    def test_options_and_help_are_the_program_s_own(self):
        self.source.write_text("G0 X1\nM2\n")
        done = self.rmac("import", "--unit", "mm", "--approach", "0,0,5", self.source, "-o", "-")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([json.loads(line)["params"]["TargetFrame"]["p"] for line in done.stdout.splitlines()[1:]],
                         [[0, 0, 5], [1, 0, 5]])
        done = self.rmac("import", "--help")
        self.assertEqual(done.returncode, 0)
        self.assertIn("--approach", done.stdout)
        self.assertEqual(self.rmac("import", self.source, "--dialect", "klingon").returncode, 2)

    def test_what_is_refused_leaves_no_file_and_the_old_one(self):
        target = self.folder / "part.rmac"
        target.write_text("the old one\n")
        self.source.write_text("G21 G0 X0 Y0 Z0\nG1 X1 F100\n  G76 X2\nM2\n")
        done = self.rmac("import", self.source)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith(f"rmac-import: {self.source}:3:3: G76: "), done.stderr)
        self.assertEqual(target.read_text(), "the old one\n")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["part.ngc", "part.rmac"])

    def test_what_is_no_file_stays_what_it_is(self):
        """A link leads to its file; a pipe and a device get the program. A mark of byte order is none of it."""
        self.source.write_bytes(b"\xef\xbb\xbfG21 G0 X0 Y0 Z0\nM2\n")
        target, link, pipe = (self.folder / name for name in ("elsewhere.rmac", "link.rmac", "pipe"))
        target.write_text("the old one\n")
        link.symlink_to(target)
        done = self.rmac("import", self.source, "-o", link)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertTrue(link.is_symlink())
        whole = target.read_text()
        self.assertIn("MoveToPathTarget", whole)
        os.mkfifo(pipe)
        with subprocess.Popen([BUILD / "bin" / "rmac", "import", self.source, "-o", pipe], stdout=subprocess.DEVNULL) as importer:
            self.assertEqual(pipe.read_text(), whole)
        self.assertEqual(importer.returncode, 0)
        self.assertTrue(pipe.is_fifo())
        full = self.folder / "full"
        full.symlink_to("/dev/full")
        done = self.rmac("import", self.source, "-o", full)
        self.assertEqual((done.returncode, done.stderr), (1, f"rmac-import: {full}: cannot be written\n"))
        self.assertTrue(pathlib.Path("/dev/full").is_char_device())

    def test_no_file_but_the_output_is_written(self):
        program = "G21 G0 X0 Y0 Z0\nM2\n"
        self.source.write_text(program)
        part = self.folder / "part.rmac.part"
        part.write_text("the user's\n")
        (self.folder / "part.rmac.0.part").write_text("the user's too\n")
        (self.folder / "link.ngc").symlink_to(self.source)
        for same in (self.source, f"{self.folder}/./part.ngc", self.folder / "link.ngc"):
            done = self.rmac("import", self.source, "-o", same)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("would replace its source", done.stderr)
        self.assertEqual(self.source.read_text(), program)
        self.assertEqual(self.rmac("import", self.source).returncode, 0)
        self.assertEqual(part.read_text(), "the user's\n")
        self.assertEqual((self.folder / "part.rmac.0.part").read_text(), "the user's too\n")
        self.assertEqual(len(list(self.folder.iterdir())), 5)


if __name__ == "__main__":
    unittest.main()

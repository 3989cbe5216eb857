"""Files of other controls without a window: opened, saved with the document, simulated and cut by a real daemon; and what is refused."""

import json
import math
import os
import pathlib
import sys
import unittest
from unittest import mock

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
from appliance import BUILD, Appliance
from legacy_file import AWAY, LINE_OF_ARC, REFUSED_IN_ITS_MIDST, SLOT, file_of, folder_of
from rmac_freecad.legacy import CodeRefused, Options, codes, open_code, read_code
from rmac_freecad.legacy import source as sources
from rmac_freecad.path import strokes_of
from rmac_freecad.running import CutEnded, cut
from rmac_freecad.simulation import NoProgram, SimulationRefused, simulate

import rmac  # isort: skip

RMAC = str(BUILD / "bin/rmac")
MACHINE = "DMACXYZ"
RAPID_MM_MIN = 2000
# One of every kind of step that rmac import writes.
EVERYTHING = """G21 G17 M6 T1 G43
G0 X0 Y0 Z20
M3 S800 M8
G64 P0.01
G1 X10 F600
G3 X10 Y0 I-5 J0 P2
G5.2 X5 Y5 P1 L3
X0 Y10 P2
X-5 Y0 P1
G5.3
G4 P0.25
M62 P1
M66 P2 L3 Q5
M0 (Turn it over)
M1
G10 L2 P2 X1 Y2 Z3
G55
G0 X0 Y0 Z20
M2
"""
GIVEN = "--output 1=Clamp --input 2=Door --offset G54=0,0,0"
APT = "UNITS/MM\nRAPID\nGOTO/0,0,20\nFEDRAT/600,MMPM\nGOTO/10,0,20\nFINI\n"


def in_full(params):
    """With what may be left out where it is empty."""
    calls = [{"params": {}, **call} for call in params.get("Calls", ())]
    return {"Message": "", **params, "Calls": calls}


class CodeTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("codes")
        self.addCleanup(lambda: FreeCAD.closeDocument(self.document.Name))

    def opened(self, content, name="Träger 1 (neu).ngc", **options):
        self.file = file_of(self, content, name)
        return open_code(self.document, self.file, Options(**options), rmac=RMAC)

    def program(self, content, name="Träger 1 (neu).ngc", **options):
        return read_code(self.opened(content, name, **options), rapid_mm_min=RAPID_MM_MIN, rmac=RMAC)

    def refused(self, *words, content="", name="Träger 1 (neu).ngc", **options):
        with self.assertRaises(CodeRefused) as refused:
            self.opened(content, name, **options)
        for word in words:
            self.assertIn(word, str(refused.exception))
        self.assertEqual(self.document.Objects, [])
        return refused.exception


class OpeningTest(CodeTest):
    def test_each_step_is_a_move_that_says_what_the_text_says(self):
        program = self.program(EVERYTHING, further=GIVEN)
        written = [json.loads(line) for line in program.text().splitlines()]
        methods = {request["method"].split(".")[1] for request in written}
        self.assertEqual(methods, {"SetFeedrate", "MoveToPathTarget", "MoveAlongLine", "MoveAlongArc", "MoveAlongNurbs", "InTurn", "DoToolChange", "Dwell",
                                   "ProgramStop", "AwaitInput", "SetPathTolerance", "SetPartFrame"})  # fmt: skip
        for number, (request, move) in enumerate(zip(written, program.moves, strict=True), 1):
            made = move.request(number)
            self.assertEqual(request["id"], number)
            self.assertEqual(made["method"], request["method"])
            self.assertEqual(in_full(made["params"]), in_full(request["params"]))
            self.assertEqual(program.index_of(move), number - 1)

    def test_moves_know_their_line(self):
        program = self.program(SLOT)
        arc = next(index for index, move in enumerate(program.moves) if isinstance(move, rmac.Arc))
        self.assertEqual(str(program.place_of(arc)), f"Träger 1 (neu).ngc, line {LINE_OF_ARC}")
        lines = [program.place_of(index).line for index in range(len(program))]
        self.assertEqual(lines, sorted(lines))

    def test_what_is_shown_is_where_the_moves_lead(self):
        program = self.program(EVERYTHING, further=GIVEN)
        ends = {index: move.end for index, move in enumerate(program.moves) if move.end is not None}
        strokes = strokes_of(program)
        self.assertEqual([stroke.index for stroke in strokes], list(ends)[1:])
        for number, stroke in enumerate(strokes):
            self.assertLess(math.dist(stroke.points[0], list(ends.values())[number]), 1e-9)
            self.assertLess(math.dist(stroke.points[-1], ends[stroke.index]), 1e-9)

    def test_a_spline_is_shown_as_a_curve(self):
        program = self.program(EVERYTHING, further=GIVEN)
        index = next(index for index, move in enumerate(program.moves) if isinstance(move, rmac.Nurbs))
        points = next(stroke.points for stroke in strokes_of(program) if stroke.index == index)
        curve = program.moves[index].curve
        self.assertEqual((curve.degree, len(curve.points), len(points)), (2, 4, 2 * 16 + 1))
        # At the knot between its two spans a quadratic is halfway between its inner points, by their weights.
        (_, a, b, _), (_, u, v, _) = curve.points, curve.weights
        self.assertNotEqual(u, v)
        for shown, x, y in zip(points[16], a, b):
            self.assertAlmostEqual(shown, (u * x + v * y) / (u + v), 9)

    def test_a_file_of_windows_with_a_mark_at_its_begin_is_the_same(self):
        plain = self.program(SLOT).text()
        self.assertEqual(self.program(b"\xef\xbb\xbf" + SLOT.replace("\n", "\r\n").encode()).text(), plain)

    def test_inches_are_read_as_inches(self):
        metric = [stroke.points[-1] for stroke in self.program(SLOT).strokes]
        inches = [stroke.points[-1] for stroke in self.program(SLOT.replace("G21", "G20").replace("F100", "F10").replace("F600", "F60")).strokes]
        for a, b in zip(metric, inches, strict=True):
            for x, y in zip(a, b):
                self.assertAlmostEqual(25.4 * x, y, 5)

    def test_old_letters_in_a_comment_do_no_harm(self):
        self.assertEqual(self.program(SLOT.replace("(a slot", "(Träger").encode("latin-1")).text(), self.program(SLOT).text())
        program = self.program("G21\nG0 X0 Y0 Z1\nM0 (Träger wenden)\nM2\n".encode("latin-1"))
        self.assertEqual(len([move for move in program.moves if isinstance(move, rmac.ProgramStop)]), 1)

    def test_apt_is_read_by_its_ending_of_any_case(self):
        self.assertEqual([stroke.points[-1] for stroke in self.program(APT, "PART.CLS").strokes], [(10, 0, 20)])

    def test_rapids_are_as_fast_as_the_machine_at_most(self):
        code = self.opened(SLOT, rapid_mm_min=1500)
        for fastest, wanted in ((2000, 1500), (900, 900)):
            moves = read_code(code, rapid_mm_min=fastest, rmac=RMAC).moves
            feeds = [json.loads(move.params(0))["Feedrate"] for move in moves if move.method == "RMAC_CAM.SetFeedrate"]
            self.assertEqual(feeds[0], wanted)


class KeepingTest(CodeTest):
    def saved_and_opened_elsewhere(self):
        saved = folder_of(self) / "Teil ü.FCStd"
        self.document.saveAs(str(saved))
        FreeCAD.closeDocument(self.document.Name)
        self.document = FreeCAD.openDocument(str(saved.rename(folder_of(self) / "elsewhere.FCStd")))
        return codes(self.document)[0]

    def test_a_document_has_the_file_with_it(self):
        before = self.program(EVERYTHING.encode("latin-1"), further=GIVEN, block_delete=True)
        self.file.unlink()
        code = self.saved_and_opened_elsewhere()
        self.assertEqual(code.FileName, "Träger 1 (neu).ngc")
        self.assertEqual(read_code(code, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC).text(), before.text())

    def test_the_same_file_again_is_the_same_object(self):
        self.document.UndoMode = 1  # as in the window
        code = self.opened(SLOT)
        self.file.write_text(AWAY)
        self.assertEqual(open_code(self.document, self.file, rmac=RMAC), code)
        self.assertEqual(len(codes(self.document)), 1)
        self.document.undo()
        self.file.write_text(SLOT)
        self.assertIn("MoveAlongArc", read_code(code, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC).text())

    def test_a_copy_stands_on_its_own(self):
        code = self.opened(SLOT)
        copied = self.document.copyObject(code)
        self.document.removeObject(code.Name)
        self.assertGreater(len(read_code(copied, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC)), 10)

    def test_a_file_that_was_changed_since_is_not_machined(self):
        code = self.opened(SLOT)
        self.file.write_text(AWAY)
        with self.assertRaisesRegex(CodeRefused, "changed since it was opened"):
            read_code(code, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC)
        code.File = ""
        self.assertIn("MoveAlongArc", read_code(code, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC).text())

    def test_a_document_that_lost_part_of_it_says_so(self):
        code = self.opened(SLOT)
        whole = code.Source
        for damaged in (whole[: len(whole) // 2 // 4 * 4], "", "?" + whole[1:], "AAAA" + whole[4:]):
            code.Source = damaged
            with self.assertRaisesRegex(CodeRefused, "damaged"):
                read_code(code, rapid_mm_min=RAPID_MM_MIN, rmac=RMAC)


class RefusedTest(CodeTest):
    def test_what_is_not_understood_is_told_with_line_and_column(self):
        refused = self.refused("Träger 1 (neu).ngc, line 4, column 3: ", "G76", content=REFUSED_IN_ITS_MIDST)
        self.assertEqual((refused.line, refused.column), (4, 3))

    def test_an_empty_file_is_told_as_that(self):
        for content in (b"", b"\r\n  \n", b"\xef\xbb\xbf\n"):
            self.refused("Träger 1 (neu).ngc: it is empty", content=content)

    def test_a_file_that_moves_nothing_is_no_path(self):
        self.refused("nothing in it moves the tool", content="G21\nM2\n")

    def test_a_file_that_is_not_there_and_a_folder_are_told(self):
        for path in (folder_of(self) / "gone.ngc", folder_of(self), pathlib.Path("/dev/zero")):
            with self.assertRaisesRegex(CodeRefused, f"{path.name}: there is no file"):
                open_code(self.document, path, rmac=RMAC)

    def test_a_file_that_is_too_long_is_told(self):
        with mock.patch.object(sources, "MOST_BYTES", 100):
            self.refused("more than", content=SLOT)

    def test_an_unknown_ending_asks_for_the_language(self):
        self.refused("choose RS274/NGC, Fanuc, Haas or APT", content=SLOT, name="slot.txt")
        self.assertEqual(self.program(SLOT, "slot.txt", dialect="rs274").text(), self.program(SLOT).text())

    def test_no_option_of_a_document_writes_a_file(self):
        """A document comes from somebody else, and its options with it."""
        target = folder_of(self) / "written.rmac"
        for further in (f"-o {target}", f"--tolerance 0.1 -o {target}", f"-o{target}", f"--o={target}", f"{target}", "--config=/etc/passwd", "--ids-are-lines",
                        '--offset "'):  # fmt: skip
            self.refused("further options", content=SLOT, further=further)
        self.assertFalse(target.exists())

    def test_an_option_that_the_import_does_not_take_is_told_in_its_words(self):
        self.refused("Träger 1 (neu).ngc: --approach is three numbers", content=SLOT, approach="here")
        self.refused("multax", content=SLOT, further="--multax")

    def test_without_the_command_line_client_it_says_what_to_do(self):
        with self.assertRaisesRegex(NoProgram, "give its path"):
            open_code(self.document, file_of(self, SLOT), rmac="/nowhere/rmac")


class MachinedTest(CodeTest):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())

    def setUp(self):
        super().setUp()
        self.client = self.enterContext(rmac.connect(f"127.0.0.1:{self.appliance.port}", "cam"))
        self.enterContext(self.client.authority())
        self.client.load(MACHINE)
        self.client.cam.SetTool(1, 0.0, 2.5)

    def test_it_is_simulated_with_the_limit_of_each_move(self):
        program = self.program(SLOT)
        found = simulate(program, MACHINE, self.client.cam.GetTools(), rmac=RMAC)
        moving = {index for index, move in enumerate(program.moves) if move.end is not None}
        self.assertEqual(set(found.move_limits), moving)
        self.assertGreater(found.limited_by_s["feed"], 0)

    def test_simulation_and_machine_refuse_the_same_line(self):
        program = self.program(AWAY)
        with self.assertRaises(SimulationRefused) as simulated:
            simulate(program, MACHINE, self.client.cam.GetTools(), rmac=RMAC)
        with self.assertRaises(CutEnded) as machined:
            list(cut(self.client, program))
        for refused in (simulated.exception, machined.exception):
            self.assertEqual(str(refused.place), "Träger 1 (neu).ngc, line 4")
            self.assertIn("beyond its limit", refused.why)

    def test_it_is_cut_to_its_end_line_by_line(self):
        program = self.program(SLOT.replace("M6 T1 G43\n", ""))
        places = list(cut(self.client, program))
        self.assertEqual(places, [program.place_of(index) for index in range(len(program))])
        for joint, wanted in zip(self.client.state()["joints"], (5, 5, 20)):
            self.assertAlmostEqual(joint, wanted, 2)


if __name__ == "__main__":
    unittest.main()

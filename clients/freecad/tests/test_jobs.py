"""Jobs become programs for the appliance: what is in them, and what is refused."""

import json
import math
import random
import unittest

import FreeCAD
import PathScripts.PathDrilling as PathDrilling
import PathScripts.PathHelix as PathHelix
import PathScripts.PathProfile as PathProfile
import PathScripts.PathToolBit as PathToolBit
import PathScripts.PathToolController as PathToolController
from path_job import hole_of, operation_of, plate_job, remove_operations, set_path, written

from rmac_freecad import jobs  # it finds rmac
from rmac_freecad.jobs import JobRefused

import rmac  # isort: skip

ABOVE = "G0 X0 Y0 Z5"
RAPID_MM_MIN = 3000


def read_job(job):
    return jobs.read_job(job, rapid_mm_min=RAPID_MM_MIN)


def methods(program):
    return [move.method.split(".")[1] for move in program.moves]


def feeds(program):
    return [json.loads(move.params(0))["Feedrate"] for move in program.moves if move.method == "RMAC_CAM.SetFeedrate"]


class OperationsOfFreeCADTest(unittest.TestCase):
    def test_a_profile_is_cut_with_its_arcs_at_its_feeds(self):
        job = plate_job(self)
        profile = operation_of(job, PathProfile, "Profile")
        program = read_job(job)
        codes = [command.Name for command in profile.Path.Commands]
        self.assertEqual(sum(isinstance(move, rmac.Arc) for move in program.moves), codes.count("G2") + codes.count("G3"))
        self.assertGreater(codes.count("G2"), 0)
        self.assertEqual(set(feeds(program)), {3000.0, 600.0, 100.0})
        self.assertEqual(methods(program)[:2], ["DoToolChange", "InTurn"])

    def test_rapids_of_the_tool_controller_hold_up_to_the_machine_s(self):
        job = plate_job(self)
        operation_of(job, PathProfile, "Profile")
        job.SetupSheet.HorizRapid, job.SetupSheet.VertRapid = "90000 mm/min", "1200 mm/min"
        job.Document.recompute()
        self.assertEqual(set(feeds(read_job(job))), {3000.0, 1200.0, 600.0, 100.0})

    def test_moves_follow_each_other_and_end_where_the_path_does(self):
        job = plate_job(self)
        operation_of(job, PathProfile, "Profile")
        helix = operation_of(job, PathHelix, "Helix", Base=hole_of(job))
        at = None
        program = read_job(job)
        for move in program.moves:
            if move.start is not None:
                self.assertLess(math.dist(at, move.start), 1e-9)
            at = move.end or at
        self.assertEqual(at[2], [c.Parameters["Z"] for c in helix.Path.Commands if "Z" in c.Parameters][-1])
        self.assertTrue(any(isinstance(move, rmac.Arc) and move.begin.p[2] > move.target.p[2] for move in program.moves))

    def test_a_hole_is_pecked_to_its_bottom(self):
        job = plate_job(self)
        drilling = operation_of(job, PathDrilling, "Drilling", Base=hole_of(job), PeckEnabled=True)
        cycle = next(command for command in drilling.Path.Commands if command.Name == "G83").Parameters
        lines = [move for move in read_job(job).moves if isinstance(move, rmac.Line)]
        self.assertEqual(len(lines), math.ceil((cycle["R"] - cycle["Z"]) / cycle["Q"]))
        self.assertEqual(lines[-1].end, (cycle["X"], cycle["Y"], cycle["Z"]))

    def test_what_is_switched_off_is_not_cut(self):
        job = plate_job(self)
        operation_of(job, PathProfile, "Profile")
        alone = read_job(job).text()
        operation_of(job, PathDrilling, "Drilling", Base=hole_of(job)).Active = False
        job.Document.recompute()
        self.assertEqual(read_job(job).text(), alone)

    def test_a_document_in_inches_gives_the_same_program(self):
        job = plate_job(self)
        operation_of(job, PathProfile, "Profile")
        before = read_job(job).text()
        general = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units")
        schema = general.GetInt("UserSchema", 0)
        self.addCleanup(FreeCAD.Units.setSchema, schema)
        FreeCAD.Units.setSchema(3)
        job.Document.recompute()
        self.assertEqual(read_job(job).text(), before)


class WrittenPathsTest(unittest.TestCase):
    def setUp(self):
        self.job = plate_job(self)

    def program(self, *lines):
        written(self.job, lines)
        return read_job(self.job)

    def refused(self, why, *lines, command):
        written(self.job, lines)
        with self.assertRaises(JobRefused) as refusal:
            read_job(self.job)
        self.assertIn(why, str(refusal.exception))
        self.assertTrue(str(refusal.exception).startswith(f"Custom, command {command} ("), refusal.exception)

    def test_the_first_rapids_are_one_once_they_say_where(self):
        program = self.program("G0 Z16", "G0 X3 Y4", "G0 Z5", "G1 Z-1 F2")
        self.assertEqual([move.end for move in program.moves if isinstance(move, rmac.MoveTo)], [(3, 4, 16), (3, 4, 5)])

    def test_every_move_knows_its_command(self):
        program = self.program(ABOVE, "(down)", "G1 Z-1 F2", "G1 X5")
        lines = [index for index, move in enumerate(program.moves) if isinstance(move, rmac.Line)]
        self.assertEqual([str(program.place_of(index)) for index in lines], ["Custom, command 3 (G1)", "Custom, command 4 (G1)"])
        self.assertEqual(len(program.text().splitlines()), len(program))

    def test_arcs_lie_on_the_circle_that_was_written_in_every_plane_either_way(self):
        seeded = random.Random(18)
        for plane, first, second, names in (("G17", 0, 1, "IJ"), ("G18", 2, 0, "KI"), ("G19", 1, 2, "JK")):
            for code in ("G2", "G3"):
                radius, a, sweep = seeded.uniform(1, 20), seeded.uniform(0, 6), seeded.uniform(0.2, 6)
                way = -sweep if code == "G2" else sweep
                start, end = [0.0] * 3, [0.0] * 3
                start[first], start[second] = radius * math.cos(a), radius * math.sin(a)
                end[first], end[second] = (round(radius * f(a + way), 4) for f in (math.cos, math.sin))
                begin = "G0 " + " ".join(f"{axis}{value:.12f}" for axis, value in zip("XYZ", start))
                cut = f"{code} F5 " + " ".join(f"{axis}{value:.12f}" for axis, value in zip("XYZ", end))
                cut += f" {names[0]}{-start[first]:.4f} {names[1]}{-start[second]:.4f}"
                remove_operations(self.job)
                (arc,) = (move for move in self.program(begin, plane, cut).moves if isinstance(move, rmac.Arc))
                self.assertLess(math.dist(arc.center.p, (0, 0, 0)), 5e-4)
                self.assertAlmostEqual(math.dist(arc.begin.p, arc.center.p), math.dist(arc.target.p, arc.center.p), 6)
                half = arc.rest(radius * sweep / 2).begin.p
                middle = [0.0] * 3
                middle[first], middle[second] = radius * math.cos(a + way / 2), radius * math.sin(a + way / 2)
                self.assertLess(math.dist(half, middle), 1e-3, f"{plane} {code}")

    def test_a_full_turn_with_one_word_of_its_centre(self):
        (arc,) = (move for move in self.program(ABOVE, "G2 I-5 Z3 F5").moves if isinstance(move, rmac.Arc))
        self.assertTrue(arc.closed and arc.clockwise)
        self.assertEqual((arc.center.p[:2], arc.target.p), ((-5, 0), (0, 0, 3)))

    def test_coolant_goes_on_with_the_operation_and_off_behind_it(self):
        for mode, on in (("Flood", "TurnCoolantOn"), ("Mist", "Mist")):
            remove_operations(self.job)
            written(self.job, [ABOVE, "G1 Z1 F1"]).CoolantMode = mode
            self.job.Operations.Group[0].purgeTouched()
            turns = [move.params(0) for move in read_job(self.job).moves if move.method == "RMAC_CAM.InTurn"]
            self.assertIn(on, turns[1])
            self.assertIn("TurnCoolantOff" if mode == "Flood" else '"On":false', turns[2])

    def test_chips_are_broken_and_bottoms_dwelt_at(self):
        program = self.program(ABOVE, "G99", "G73 X1 Y1 Z-3 R2 Q2 F2", "G82 X2 Y1 Z-1 R2 P0.5 F2")
        self.assertEqual([move.end[2] for move in program.moves if isinstance(move, rmac.Line)], [0, -2, -3, -1])
        self.assertEqual(methods(program).count("Dwell"), 1)
        self.assertEqual([move.end for move in program.moves if move.end][-1], (2, 1, 2))

    def test_broken_chips_stay_in_the_hole_and_pecks_leave_it(self):
        for code, highest in (("G73", -2 + 0.254), ("G83", 2)):
            remove_operations(self.job)
            moves = self.program(ABOVE, "G99", f"{code} X1 Y1 Z-5 R2 Q2 F2").moves
            lines = [index for index, move in enumerate(moves) if isinstance(move, rmac.Line)]
            between = [move.end[2] for move in moves[lines[1] : lines[2]] if isinstance(move, rmac.MoveTo)]
            self.assertAlmostEqual(max(between), highest)

    def test_g98_at_the_end_of_a_row_of_holes_retracts_to_where_the_row_began(self):
        program = self.program("G0 X0 Y0 Z20", "G99", "G81 X1 Y1 Z-1 R2 F2", "G98", "G81 X5 Y1 Z-1 R2 F2")
        self.assertEqual([move.end for move in program.moves if move.end][-1], (5, 1, 20))

    def test_what_is_not_understood_is_refused_with_its_place(self):
        for why, line in (("G91", "G91"), ("G20", "G20"), ("A is not", "G1 X5 A20 F1"), ("G38.2", "G38.2 Z-5"), ("feed is 0", "G1 X5 F0"),
                          ("feed is 0", "G1 X5"), ("centre", "G2 X5 Y5 F1"), ("from its end", "G2 X5 Y5 I1 F1"), ("R is not", "G2 X5 R9 F1"),
                          ("peck of 0", "G83 X1 Y1 Z-3 R2 Q0 F2"), ("needs P", "G82 X1 Y1 Z-3 R2 F2"), ("above", "G81 X1 Y1 Z3 R2 F2"),
                          ("spindle speed is 0", "M3 S0"), ("tool 7", "G43 H7"), ("1 or more", "M6 T0")):
            remove_operations(self.job)
            with self.subTest(line=line):
                self.refused(why, ABOVE, line, command=2)

    def test_a_cut_from_nowhere_is_refused(self):
        self.refused("nobody knows X, Y", "G0 Z16", "G1 Z0 F2", command=2)


class JobsThatAreRefusedTest(unittest.TestCase):
    def setUp(self):
        self.job = plate_job(self)
        self.operation = written(self.job, [ABOVE, "G1 Z1 F1"])
        self.controller = self.job.Tools.Group[0]

    def assert_refused(self, why):
        with self.assertRaises(JobRefused) as refusal:
            read_job(self.job)
        self.assertIn(why, str(refusal.exception))

    def test_several_fixtures(self):
        self.job.Fixtures = ["G54", "G55"]
        self.assert_refused("G54, G55")

    def test_a_spindle_that_stands_unless_it_is_meant_to(self):
        self.controller.SpindleSpeed = 0
        self.assert_refused("spindle speed 0")
        self.controller.SpindleDir = "None"
        self.job.Document.recompute()
        set_path(self.operation, [ABOVE, "G1 Z1 F1"])
        self.assertIn('"RPM":0', read_job(self.job).moves[1].params(0))

    def test_an_operation_with_a_placement_of_its_own(self):
        self.operation.Placement.Base = FreeCAD.Vector(1, 0, 0)
        self.assert_refused("a placement of its own")

    def test_a_path_that_is_older_than_its_operation_s_values(self):
        self.controller.SpindleSpeed = 500
        self.assert_refused("recompute the document")

    def test_no_operation(self):
        self.operation.Active = False
        self.assert_refused("no operation")

    def test_an_operation_without_a_path(self):
        written(self.job, ["(nothing)"], "Empty")
        self.assert_refused("Empty has no path")

    def test_an_operation_of_freecad_s_that_found_nothing_to_cut(self):
        operation = operation_of(self.job, PathProfile, "Profile")
        set_path(operation, [ABOVE])
        self.assert_refused("Profile has no path that cuts")

    def test_two_tools_with_one_number(self):
        self.add_thin_tool(1, ABOVE, "G1 Z1 F1")
        self.assert_refused("different tools with one number, 1")

    def test_two_tools_of_one_diameter_with_one_number(self):
        self.add_thin_tool(1, ABOVE, "G1 Z1 F1")
        second = self.job.Operations.Group[-1].ToolController.Tool
        second.Diameter = self.job.Operations.Group[0].ToolController.Tool.Diameter
        second.CuttingEdgeHeight = "3 mm"
        self.job.Document.recompute()
        self.assert_refused("different tools with one number, 1")

    def test_a_cut_of_another_operation_without_its_own_feed(self):
        self.add_thin_tool(2, ABOVE, "G1 Z1")
        self.assert_refused("the feed is 0")

    def test_a_cut_behind_a_tool_change_before_its_place_is_known(self):
        self.add_thin_tool(2, "G1 Z1 F1")
        self.assert_refused("Second, command 1 (G1): nobody knows X, Y, Z")

    def add_thin_tool(self, number, *lines):
        bit = PathToolBit.Factory.Create("Thin")
        bit.Diameter = "2 mm"
        controller = PathToolController.Create("TC: Thin", bit, number)
        controller.SpindleSpeed = 1000
        self.job.Proxy.addToolController(controller)
        written(self.job, lines, "Second").ToolController = controller
        self.job.Document.recompute()
        set_path(self.job.Operations.Group[-1], lines)


if __name__ == "__main__":
    unittest.main()

"""Edges and sketches cut along: on the curve exactly, beside lines and arcs at exactly the tool's radius, and what is refused."""

import json
import math
import os
import random
import sys
import tempfile
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import Part
import Sketcher  # noqa: F401  its type of objects
from appliance import BUILD
from rmac_freecad.path import strokes_of
from rmac_freecad.profiles import Profile, ProfileRefused, beside, contour_of, edges_of, profile_of, profiles, program_of, read_profile
from rmac_freecad.simulation import simulate

import rmac  # isort: skip

RAPID_MM_MIN = 2000
GIVEN = {"tool": 1, "diameter_mm": 4.0, "side": "on", "top_mm": 0.0, "bottom_mm": -3.0, "step_mm": 1.5, "safe_mm": 5.0, "feed_mm_min": 600.0,
         "plunge_mm_min": 100.0, "spindle_rpm": 800.0}  # fmt: skip
SEEDS = range(40)


def at(x, y, z=0.0):
    return FreeCAD.Vector(x, y, z)


def line(a, b):
    return Part.makeLine(at(*a), at(*b))


def arc(a, via, b):
    return Part.Arc(at(*a), at(*via), at(*b)).toShape()


def named(edges):
    return [(f"Edge{number}", edge) for number, edge in enumerate(edges, 1)]


def polygon(*corners):
    return [line(a, b) for a, b in zip(corners, (*corners[1:], corners[0]))]


def outline(seed):
    """Convex corners, joined by lines and by arcs that bulge out, in any order and direction."""
    chance = random.Random(seed)
    count = chance.randint(3, 8)
    turns = [(number + chance.uniform(-0.3, 0.3)) * 2 * math.pi / count for number in range(count)]
    corners = [(25 * math.cos(turn), 25 * math.sin(turn)) for turn in turns]
    edges = []
    for a, b in zip(corners, [*corners[1:], corners[0]]):
        chord, middle = math.dist(a, b), ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
        out = ((b[1] - a[1]) / chord, (a[0] - b[0]) / chord)
        bulge = chance.uniform(0.05, 0.45) * chord
        via = middle[0] + bulge * out[0], middle[1] + bulge * out[1]
        ends = (a, b) if chance.random() < 0.5 else (b, a)
        edges.append(line(*ends) if chance.random() < 0.5 else arc(ends[0], via, ends[1]))
    chance.shuffle(edges)
    return edges


class ProfileTest(unittest.TestCase):
    def program(self, edges, **given):
        return read_profile("Profile", named(edges), Profile(**{**GIVEN, **given}), rapid_mm_min=RAPID_MM_MIN)

    def cutting(self, program):
        return [move for move in program.moves if isinstance(move, (rmac.Line, rmac.Arc, rmac.Nurbs))]

    def refused(self, edges, *words, **given):
        with self.assertRaises(ProfileRefused) as refused:
            self.program(edges, **given)
        for word in words:
            self.assertIn(word, str(refused.exception))

    def joined(self, program):
        """Each move begins exactly where the one before it ends: the appliance takes no other."""
        place = None
        for move in program.moves:
            if move.start is not None:
                self.assertEqual(tuple(move.start), tuple(place))
            place = move.end if move.end is not None else place


class BesideTest(ProfileTest):
    def test_the_centre_is_as_far_from_the_contour_as_the_radius_everywhere(self):
        """Held against FreeCAD's distances, which know nothing of how the way was made."""
        for seed in SEEDS:
            edges = outline(seed)
            wall = Part.Compound(edges)
            for side in ("outside", "inside"):
                with self.subTest(seed=seed, side=side):
                    program = self.program(edges, side=side, step_mm=3.0)
                    self.joined(program)
                    flat = [stroke for stroke in strokes_of(program) if stroke.points[0][2] == stroke.points[-1][2] == -3]
                    self.assertGreaterEqual(len(flat), len(edges))
                    for stroke in flat:
                        for x, y, _ in self.along(stroke.points):
                            self.assertAlmostEqual(Part.Vertex(x, y, 0).distToShape(wall)[0], 2.0, 6)

    def along(self, points):
        """Those of the stroke, which lie on it, and halfway along a line."""
        middle = [tuple((a + b) / 2 for a, b in zip(*points))] if len(points) == 2 else []
        return [*points, *middle]

    def test_outside_is_as_long_as_freecad_s_own_offset(self):
        for seed in SEEDS:
            wire = Part.Wire(Part.__sortEdges__(outline(seed)))
            made = beside(contour_of(named(outline(seed))), -2.0)
            self.assertAlmostEqual(made.length, wire.makeOffset2D(2.0, join=0).Length, 5, f"seed {seed}")

    def test_outside_and_inside_are_where_they_say_however_it_goes(self):
        square = polygon((0, 0), (20, 0), (20, 20), (0, 20))
        for edges in (square, square[::-1], [edge.reversed() for edge in square]):
            for turned in (False, True):
                for side, wanted in (("outside", -2), ("inside", 2)):
                    xs = [move.end[0] for move in self.cutting(self.program(edges, side=side, turned=turned))]
                    self.assertAlmostEqual(min(xs), wanted, 9)

    def test_outside_goes_counter_clockwise_unless_turned(self):
        square = polygon((0, 0), (20, 0), (20, 20), (0, 20))
        for turned in (False, True):
            arcs = [move for move in self.program(square, side="outside", turned=turned).moves if isinstance(move, rmac.Arc)]
            self.assertEqual({move.clockwise for move in arcs}, {turned})

    def test_left_and_right_of_an_open_contour(self):
        bend = [line((0, 0), (20, 0)), line((20, 0), (20, 20))]
        left = [move.end for move in self.cutting(self.program(bend, side="left", step_mm=3.0))][1:]
        self.assertEqual([tuple(round(x, 9) for x in end[:2]) for end in left], [(18, 2), (18, 20)])
        right = self.cutting(self.program(bend, side="right", step_mm=3.0))[1:]
        self.assertEqual([type(move).__mro__[0] for move in right], [rmac.Line, rmac.Arc, rmac.Line])
        self.assertEqual(right[1].center.p[:2], (20, 0))

    def test_a_full_circle_stays_one(self):
        circle = [Part.Circle(at(5, 5), FreeCAD.Vector(0, 0, 1), 10).toShape()]
        for side, radius in (("on", 10), ("outside", 12), ("inside", 8)):
            arcs = [move for move in self.program(circle, side=side, step_mm=3.0).moves if isinstance(move, rmac.Arc)]
            self.assertEqual([move.closed for move in arcs], [True])
            self.assertAlmostEqual(math.dist(arcs[0].start, arcs[0].center.p), radius, 9)


class LeadTest(ProfileTest):
    def cut_level(self, program):
        return [move for move in self.cutting(program) if abs(move.start[2] - move.end[2]) < 1e-9]

    def directions(self, stroke):
        points = stroke.points
        return [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in (points[:2], points[-2:])]

    def test_both_leads_are_quarter_circles_tangent_to_the_way_and_off_the_wall(self):
        for seed in SEEDS:
            edges = outline(seed)
            wall = Part.Compound(edges)
            for side in ("outside", "inside"):
                for turned in (False, True):
                    with self.subTest(seed=seed, side=side, turned=turned):
                        plain = self.program(edges, side=side, turned=turned, step_mm=3.0)
                        program = self.program(edges, side=side, turned=turned, step_mm=3.0, lead_mm=1.5)
                        self.joined(program)
                        into, *way, out = self.cut_level(program)
                        for lead, end, after in ((into, into.start, way[0]), (out, out.end, way[-1])):
                            self.assertEqual(type(lead).__mro__[0], rmac.Arc)
                            self.assertAlmostEqual(math.dist(lead.start, lead.center.p), 1.5, 6)
                            self.assertAlmostEqual(math.dist(lead.start, lead.end), 1.5 * math.sqrt(2), 6)
                            self.assertGreater(Part.Vertex(*end[:2], 0).distToShape(wall)[0], 2.5)  # the tool is off the wall
                        by_move = {stroke.index: stroke for stroke in strokes_of(program)}
                        order = [by_move[program.index_of(move)] for move in (into, way[0], way[-1], out)]
                        for one, other in (order[:2], order[2:]):
                            turn = self.directions(one)[1] - self.directions(other)[0]
                            self.assertLess(abs(math.remainder(turn, 2 * math.pi)), math.radians(6))  # chords of 5 degrees
                        for stroke in order:
                            for x, y, _ in stroke.points:
                                self.assertGreater(Part.Vertex(x, y, 0).distToShape(wall)[0], 2 - 1e-6)
                        lengths = [sum(math.dist(*pair) for s in strokes_of(p) if s.points[0][2] == s.points[-1][2] == -3 for pair in zip(s.points, s.points[1:]))
                                   for p in (plain, program)]  # fmt: skip
                        self.assertAlmostEqual(lengths[1] - lengths[0], 2 * 1.5 * math.pi / 2, delta=0.02)

    def test_each_pass_is_led_in_and_out(self):
        program = self.program(polygon((0, 0), (20, 0), (20, 20), (0, 20)), side="inside", lead_mm=3.0)
        arcs = [move for move in self.cutting(program) if isinstance(move, rmac.Arc)]
        self.assertEqual([round(move.end[2], 9) for move in arcs], [-1.5, -1.5, -3, -3])

    def test_a_lead_that_has_no_room_or_no_sense_is_refused(self):
        slot = polygon((0, 0), (40, 0), (40, 6), (0, 6))
        self.refused(slot, "a lead of 3 mm has no room", "smaller lead", side="inside", lead_mm=3.0)
        self.program(slot, side="inside", lead_mm=1.0)
        self.refused(slot, "a lead is for ways beside", side="on", lead_mm=1.0)
        self.refused(slot, "a lead is for ways beside", side="outside", lead_mm=1.0, ramp_deg=3.0)
        self.refused(slot, "the lead is", side="outside", lead_mm=-1.0)


class OnTest(ProfileTest):
    def test_a_spline_is_cut_as_it_is(self):
        spline = Part.BSplineCurve()
        spline.interpolate([at(0, 0), at(10, 5), at(20, -3), at(30, 0)])
        edge = spline.toShape()
        ellipse = Part.Edge(Part.Ellipse(at(0, 0), 20, 10), 0.3, 2.0)
        closed = Part.BSplineCurve()
        closed.interpolate([at(0, 0), at(20, 5), at(10, 20)], PeriodicFlag=True)
        for one in (edge, edge.reversed(), ellipse, closed.toShape()):
            for ramp_deg in (0.0, 20.0):
                program = self.program([one], ramp_deg=ramp_deg)
                self.joined(program)
                splines = [stroke for stroke in strokes_of(program) if len(stroke.points) > 2]
                self.assertEqual(len(splines), sum(isinstance(move, rmac.Nurbs) for move in program.moves))
                self.assertGreaterEqual(len(splines), 2)
                for stroke in splines:
                    for x, y, _ in stroke.points:
                        self.assertLess(Part.Vertex(x, y, 0).distToShape(one)[0], 1e-7)

    def test_lines_and_arcs_stay_what_they_are(self):
        edges = [line((0, 0), (10, 0)), arc((10, 0), (15, 5), (10, 10))]
        kinds = [type(move) for move in self.cutting(self.program(edges, step_mm=3.0))]
        self.assertEqual(kinds, [rmac.Line, rmac.Line, rmac.Arc])

    def test_a_sketch_is_cut_where_it_stands(self):
        document = FreeCAD.newDocument("sketch")
        self.addCleanup(FreeCAD.closeDocument, document.Name)
        sketch = document.addObject("Sketcher::SketchObject", "Sketch")
        sketch.addGeometry(Part.LineSegment(at(0, 0), at(10, 0)), False)
        sketch.addGeometry(Part.LineSegment(at(0, 5), at(10, 5)), True)  # for construction
        sketch.Placement.Base = at(3, 4, 2)
        document.recompute()
        program = read_profile("Profile", edges_of(sketch), Profile(**{**GIVEN, "top_mm": 2.0, "bottom_mm": 1.0}), rapid_mm_min=RAPID_MM_MIN)
        self.assertEqual(self.cutting(program)[-1].start[:2], (3, 4))
        self.assertEqual(self.cutting(program)[-1].end, (13, 4, 1))


class DepthTest(ProfileTest):
    def levels(self, program):
        return sorted({round(move.end[2], 9) for move in self.cutting(program)})

    def test_passes_are_even_and_no_deeper_than_the_step(self):
        for step, wanted in ((3, [-3]), (1.5, [-3, -1.5]), (1.4, [-3, -2, -1]), (0.1 * 10, [-3, -2, -1])):
            self.assertEqual(self.levels(self.program(polygon((0, 0), (20, 0), (20, 20)), step_mm=step)), wanted)

    def test_a_ramp_goes_down_along_the_contour_and_ends_flat(self):
        for seed in SEEDS:
            edges = outline(seed)
            for contour in (edges, [line((0, 0), (60, 0)), arc((60, 0), (70, 10), (60, 20))]):
                program = self.program(contour, ramp_deg=3.0)
                self.joined(program)
                cut = self.cutting(program)[1:]  # the first one goes down to the top
                self.assertEqual(self.cutting(program)[0].end[2], 0)
                for move in cut:
                    self.assertLessEqual(move.end[2], move.start[2])
                    down = move.start[2] - move.end[2]
                    self.assertLessEqual(math.degrees(math.atan2(down, math.dist(move.start[:2], move.end[:2]) or 1e9)), 5)
                flat = [move for move in cut if move.start[2] == move.end[2] == -3]
                self.assertGreaterEqual(len(flat), len(contour))

    def test_an_open_contour_is_cut_the_same_way_in_each_pass(self):
        starts = [move.start[:2] for move in self.cutting(self.program([line((0, 0), (20, 0))])) if move.start[2] == move.end[2]]
        self.assertEqual(starts, [(0, 0), (0, 0)])

    def test_the_feed_down_is_not_that_along(self):
        feed, feeds = None, {}
        for move in self.program([line((0, 0), (20, 0))]).moves:
            if move.method == "RMAC_CAM.SetFeedrate":
                feed = json.loads(move.params(0))["Feedrate"]
            elif move.end is not None:
                feeds.setdefault((type(move), isinstance(move, rmac.Line) and move.start[2] > move.end[2]), set()).add(feed)
        self.assertEqual(feeds, {(rmac.MoveTo, False): {2000}, (rmac.Line, True): {100}, (rmac.Line, False): {600}})


class RefusedTest(ProfileTest):
    def test_a_gap_is_told_with_its_place(self):
        self.refused([line((0, 0), (10, 0)), line((10, 0.01), (10, 10))], "Edge1 at X 10 Y 0", "gap of 0.01 mm to Edge2")

    def test_a_branch_and_a_second_contour_are_told(self):
        self.refused([line((0, 0), (10, 0)), line((10, 0), (10, 10)), line((10, 0), (20, 0))], "at X 10 Y 0", "Edge2 and Edge3")
        self.refused([*polygon((0, 0), (9, 0), (9, 9)), line((20, 0), (30, 0))], "Edge4 at X 20 Y 0", "of each contour")

    def test_what_is_not_level_is_told(self):
        self.refused([Part.makeLine(at(0, 0, 0), at(10, 0, 1))], "Edge1", "plane")

    def test_an_arc_that_the_tool_does_not_get_into_is_told(self):
        edges = [line((0, 0), (10, 0)), arc((10, 0), (11.5, 1.5), (10, 3)), line((10, 3), (0, 3))]
        self.refused(edges, "Edge2 at X 11.5 Y 1.5", "radius of 2 mm", "1.5 mm", side="left")
        self.program(edges, side="right")

    def test_a_pocket_that_is_narrower_than_the_tool_is_refused(self):
        self.refused(polygon((0, 0), (20, 0), (20, 3.9), (0, 3.9)), "smaller", side="inside")
        self.program(polygon((0, 0), (20, 0), (20, 4.1), (0, 4.1)), side="inside")

    def test_a_slot_in_an_outline_that_is_narrower_than_the_tool_is_refused(self):
        """No two of its walls that follow each other are the reason."""
        for width, fits in ((3.9, False), (4.1, True)):
            edges = polygon((0, 0), (10, 0), (10, 10), (10 + width, 10), (10 + width, 0), (30, 0), (30, 20), (0, 20))
            if fits:
                self.program(edges, side="outside")
            else:
                self.refused(edges, "smaller", side="outside")

    def test_two_walls_far_along_the_contour_are_held_against_each_other(self):
        hook = [line((0, 0), (30, 0)), arc((30, 0), (35, 5), (30, 10)), line((30, 10), (10, 10)), line((10, 10), (10, 3))]
        self.refused(hook, "Edge1 at X 10 Y 2", "the tool would cut into Edge4", side="left")

    def test_beside_a_spline_is_not_built_and_says_so(self):
        spline = Part.BSplineCurve()
        spline.interpolate([at(0, 0), at(10, 5), at(20, 0)])
        self.refused([spline.toShape()], "Edge1", "not built", side="left")

    def test_a_ramp_that_would_be_too_steep_says_what_to_do(self):
        self.refused([line((0, 0), (10, 0))], "smaller step", ramp_deg=5.0)

    def test_numbers_that_mean_nothing_are_refused(self):
        edges = [line((0, 0), (10, 0))]
        for given in ({"step_mm": 0.0}, {"feed_mm_min": 0.0}, {"plunge_mm_min": math.inf}, {"spindle_rpm": math.nan}, {"tool": 0}, {"bottom_mm": 1.0},
                      {"safe_mm": -1.0}, {"side": "above"}, {"side": "left", "diameter_mm": 0.0}, {"side": "inside"}, {"ramp_deg": 90.0}, {"top_mm": None}, {"feed_mm_min": "600"}, {"side": "left", "diameter_mm": math.inf}, {"lead_mm": math.nan}, {"step_mm": 1e-9}):  # fmt: skip
            self.refused(edges, **given)
        self.refused([], "select edges")


class ObjectTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("profiles")
        self.addCleanup(lambda: FreeCAD.closeDocument(self.document.Name))
        self.box = self.document.addObject("Part::Box", "Box")
        self.box.Length, self.box.Width, self.box.Height = 30, 20, 10
        self.document.recompute()
        top = [f"Edge{number}" for number, edge in enumerate(self.box.Shape.Edges, 1) if edge.BoundBox.ZMin == edge.BoundBox.ZMax == 10]
        self.profile = profile_of(self.document, [(self.box, top)])
        self.profile.Side = "outside"
        self.document.recompute()

    def reach(self, profile):
        return max(move.end[0] for move in program_of(profile, RAPID_MM_MIN).moves if isinstance(move, (rmac.Line, rmac.Arc)))

    def test_it_begins_at_the_height_of_its_edges_and_follows_them(self):
        self.assertEqual((self.profile.Top.Value, self.profile.Bottom.Value, self.profile.Safe.Value), (10, 9, 15))
        self.assertAlmostEqual(self.reach(self.profile), 30 + 2.5, 9)
        self.box.Length = 40
        self.document.recompute()
        self.assertAlmostEqual(self.reach(self.profile), 40 + 2.5, 9)

    def test_its_speeds_are_a_minute_s_in_the_program(self):
        feeds = {json.loads(move.params(0))["Feedrate"] for move in program_of(self.profile, RAPID_MM_MIN).moves if move.method == "RMAC_CAM.SetFeedrate"}
        self.assertEqual(feeds, {2000, 600, 100})

    def test_it_is_saved_with_its_document(self):
        before = program_of(self.profile, RAPID_MM_MIN).text()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "Teil ü.FCStd")
            self.document.saveAs(file)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(file)
        self.assertEqual(program_of(profiles(self.document)[0], RAPID_MM_MIN).text(), before)

    def test_an_edge_that_went_is_told(self):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        sketch.addGeometry([Part.LineSegment(at(0, 0), at(10, 0)), Part.LineSegment(at(10, 0), at(10, 10))], False)
        self.document.recompute()
        profile = profile_of(self.document, [(sketch, ("Edge1", "Edge2"))])
        sketch.delGeometry(1)
        self.document.recompute()
        with self.assertRaisesRegex(ProfileRefused, "has no Edge2|hardly|no edge"):
            program_of(profile, RAPID_MM_MIN)

    def test_what_is_no_contour_leaves_the_document_as_it_is(self):
        before = len(self.document.Objects)
        with self.assertRaises(ProfileRefused):
            profile_of(self.document, [(self.box, ())])
        self.assertEqual(len(self.document.Objects), before)


class SimulatedTest(ProfileTest):
    def test_a_machine_takes_each_of_them(self):
        tools = {"Mounted": 1, "Tools": [{"ToolNumber": 1, "Length": 0, "Radius": 2}]}
        spline = Part.BSplineCurve()
        spline.interpolate([at(0, 0), at(10, 5), at(20, -3), at(30, 0)])
        circle = Part.Circle(at(0, 0), FreeCAD.Vector(0, 0, 1), 10).toShape()
        for edges, given in ((outline(1), {"side": "outside"}), (outline(2), {"side": "inside", "ramp_deg": 3.0}), ([spline.toShape()], {"ramp_deg": 5.0}),
                             ([Part.Ellipse(at(0, 0), 20, 10).toShape()], {"ramp_deg": 5.0}),
                             ([circle], {"side": "outside", "ramp_deg": 3.0})):  # fmt: skip
            found = simulate(self.program(edges, **given), "DMACXYZ", tools, rmac=str(BUILD / "bin/rmac"))
            self.assertGreater(found.cycle_time_s, 0)


if __name__ == "__main__":
    unittest.main()

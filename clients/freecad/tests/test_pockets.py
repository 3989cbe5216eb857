"""Pockets: what is cut is told by code that shares nothing with what made the way (pocket_check.py), and what is refused."""

import json
import math
import os
import random
import sys
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import numpy as np
import Part
import Sketcher  # noqa: F401  its type of objects
from appliance import BUILD
from pocket_check import Cut, Flat, at, blob, nearest_of, rounded, seeded_face, whole_face
from rmac_freecad.pockets import Pocket, PocketRefused, outline_of, read_pocket
from rmac_freecad.profiles import ProfileRefused
from rmac_freecad.simulation import simulate

import rmac  # isort: skip

GIVEN = {"tool": 1, "radius_mm": 2.0, "top_mm": 0.0, "depth_mm": 2.5, "step_down_mm": 1.0, "step_over_mm": 1.6, "safe_mm": 5.0, "feed_mm_min": 600.0,
         "plunge_mm_min": 200.0, "spindle_rpm": 800.0}  # fmt: skip
WAYS = ({}, {"order": "outside in"}, {"entry": "ramp", "ramp_deg": 5.0}, {"climb": False, "step_over_mm": 3.6}, {"step_over_mm": 2.9, "order": "outside in"})
GOUGE_MM = 0.001
LEFT_MM = 0.001
SEEDS = range(16)
PLACES, APART_MM = 1500, 0.2  # at random; of a grid


class PocketTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("pockets")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def outline(self, shape, face="Face1"):
        feature = self.document.addObject("Part::Feature", "Cut")
        feature.Shape = shape
        return outline_of(feature, face)

    def cleared(self, shape, **given):
        return read_pocket("Pocket", self.outline(shape), Pocket(**{**GIVEN, **given}), rapid_mm_min=2000)

    def refused(self, shape, *words, **given):
        with self.assertRaises(PocketRefused) as refused:
            self.cleared(shape, **given)
        for word in words:
            self.assertIn(word, str(refused.exception))

    def check(self, face, seed=0, **given):
        """All that is promised of any pocket."""
        pocket = Pocket(**{**GIVEN, **given})
        made = self.cleared(face, **given)
        cut, flat = Cut(made.program, pocket.top_mm), Flat(face)
        gouge = cut.gouge(flat, pocket.radius_mm)
        self.assertLess(gouge, GOUGE_MM)
        places = flat.places(PLACES, seed)
        centres = flat.centres(pocket.radius_mm, APART_MM)
        off = nearest_of(centres, places) - pocket.radius_mm
        self.check_depths(cut, pocket)
        self.assertLess(cut.uncut(places[off <= 0], pocket.radius_mm, cut.floors()[-1]), LEFT_MM)
        self.assertEqual(made.missed, ())
        self.check_area(made, face, (off > APART_MM).mean(), (off > 0).mean())
        return made, gouge

    def check_depths(self, cut, pocket):
        floors = cut.floors()
        self.assertAlmostEqual(floors[-1], pocket.top_mm - pocket.depth_mm, 9)
        above = dict(zip(floors, [pocket.top_mm, *floors]))
        for z, before in above.items():
            self.assertLessEqual(before - z, pocket.step_down_mm + 1e-9)
        slopes = cut.slopes()
        self.assertLessEqual(slopes.max(), pocket.ramp_deg)
        helices = any(isinstance(move, rmac.Arc) and move.closed and move.end[2] < move.start[2] for move in cut.feeds)  # whole turns are gentler
        self.assertGreater(slopes.max(), pocket.ramp_deg * (0.4 if helices else 0.99))
        self.assertGreater(slopes.min(), -1e-9)
        self.check_rapids(cut, pocket, floors)
        ways = [sorted((type(move).__name__, *np.round((*move.start[:2], *move.end[:2]), 6)) for move in cut.level(z)) for z in floors]
        self.assertEqual(ways, [ways[0]] * len(floors))

    def check_rapids(self, cut, pocket, floors):
        """Sideways at the safe height alone; down no deeper than where a whole level was cleared, and so are plunges at feed."""
        lowest, ahead = pocket.top_mm, [(z, len(cut.level(z))) for z in floors]
        for before, move in zip(cut.moves, cut.moves[1:]):
            straight_down = math.dist(before.end[:2], move.end[:2]) < 1e-9 and not isinstance(move, rmac.Arc)
            if move.start is not None:
                self.assertEqual(tuple(move.start), tuple(before.end))  # the appliance takes no other
            if isinstance(move, rmac.MoveTo):
                self.assertTrue(straight_down or before.end[2] == move.end[2] == pocket.safe_mm)
            if straight_down and move.end[2] < before.end[2]:
                self.assertGreater(move.end[2], lowest - 1e-9)
            elif move.start is not None and ahead and abs(move.start[2] - ahead[0][0]) < 1e-9 and abs(move.end[2] - ahead[0][0]) < 1e-9:
                z, more = ahead[0]
                ahead[0] = z, more - 1
                if more == 1:
                    lowest = z
                    ahead.pop(0)
        self.assertEqual(ahead, [])

    def check_area(self, made, face, least, most):
        """What the tool does not get into, between shares of places as chance would have them."""
        told = sum(spot.area_mm2 for spot in made.unreached) / face.Area
        chance = 4 * math.sqrt(max(most, 1e-3) / PLACES)
        self.assertAlmostEqual(made.area_mm2, face.Area, delta=5e-5 * face.Area)
        self.assertTrue(least - chance < told < most + chance, (least, told, most))


class SeededTest(PocketTest):
    def test_no_wall_is_cut_into_and_all_that_can_be_reached_is_cut_at_the_step_and_the_angle(self):
        worst, kinds = -math.inf, set()
        for seed in SEEDS:
            kind, face = seeded_face(seed)
            given = WAYS[(seed + seed // 8) % len(WAYS)]
            with self.subTest(seed=seed, kind=kind, given=given):
                _, gouge = self.check(face, seed, **given)
                worst = max(worst, gouge)
                kinds.add(kind)
        print(f"{len(SEEDS)} pockets of {len(kinds)} kinds: cut into by {1e3 * worst:.3f} um at most")


class CoincidencesTest(PocketTest):
    def test_corners_and_necks_that_fall_together_are_cleared_like_others(self):
        """Whole millimetres: loops that shrink to lines, crossings in one place, cusps where a circle touches a wall."""
        refused = 0
        for seed in range(20):
            face, radius, given = whole_face(seed)
            with self.subTest(seed=seed, given=given):
                try:
                    made = self.cleared(face, **given)
                except PocketRefused as error:
                    self.assertRegex(str(error), "do not cross or touch|no room to go down|does not get into it anywhere")
                    refused += 1
                    continue
                cut, flat = Cut(made.program, 0.0), Flat(face)
                self.assertLess(cut.gouge(flat, radius), GOUGE_MM)
                places = flat.places(300, seed)
                off = nearest_of(flat.centres(radius, 0.25), places) - radius
                self.assertLess(cut.uncut(places[off <= 0], radius, -1.0), LEFT_MM)
        self.assertLess(refused, 6)

    def test_a_circle_that_touches_a_wall_leaves_a_cusp_of_the_pocket_or_of_what_stands_in_it(self):
        circle = Part.Face(Part.Wire(Part.Circle(at(30, 4), at(0, 0, 1), 4).toShape()))
        pocket = Part.makePlane(30, 20).cut(circle).Faces[0]
        stands = Part.makePlane(30, 10, at(0, -10)).fuse(circle).fuse(Part.makePlane(10, 18, at(30, -10))).removeSplitter().Faces[0]
        for face in (pocket, stands):
            for angle in (0, 31):
                face.rotate(at(0, 0), at(0, 0, 1), angle)
                tip = face.Vertexes[min(range(len(face.Vertexes)), key=lambda i: face.Vertexes[i].Point.distanceToPoint(self.turned(30, angle)))]
                self.assertLess(tip.Point.distanceToPoint(self.turned(30, angle)), 1e-6)
                self.check(face)

    def turned(self, x, angle):
        return at(x * math.cos(math.radians(angle)), x * math.sin(math.radians(angle)))


class WaysTest(PocketTest):
    def kinds(self, program):
        return {type(move) for move in program.moves if isinstance(move, (rmac.Line, rmac.Arc, rmac.Nurbs))}

    def test_lines_stay_lines_arcs_arcs_and_beside_splines_there_are_nurbs(self):
        self.assertEqual(self.kinds(self.cleared(rounded(30, 20, 5)).program), {rmac.Line, rmac.Arc})
        made, gouge = self.check(blob(random.Random(1), 14), entry="ramp", ramp_deg=5.0)
        self.assertEqual(self.kinds(made.program), {rmac.Line, rmac.Nurbs})  # lines from loop to loop
        ellipse = Part.Face(Part.Wire(Part.Ellipse(at(0, 0), 20, 10).toShape()))
        self.check(ellipse)

    def test_a_slot_as_wide_as_the_tool_is_cut_along_its_middle(self):
        for face, angle in ((Part.makePlane(30, 4), 0), (rounded(30, 4, 1.9), 0), (Part.makePlane(30, 4), 33)):
            face.rotate(at(0, 0), at(0, 0, 1), angle)
            made = self.cleared(face)
            cut, flat = Cut(made.program, 0.0), Flat(face)
            self.assertLess(cut.gouge(flat, 2.0), GOUGE_MM)
            ends = [np.array((x, 2.0)) for x in (2.0, 28.0)]
            turn = np.array([[math.cos(math.radians(angle)), math.sin(math.radians(angle))], [-math.sin(math.radians(angle)), math.cos(math.radians(angle))]])
            self.assertLess(cut.uncut(np.array([end @ turn for end in ends]), 0.0, -2.5), 1e-6)

    def test_a_helix_is_as_wide_as_there_is_room(self):
        for order in ("inside out", "outside in"):
            made, _ = self.check(Part.makePlane(30, 6), order=order)
            circles = {round(math.dist(move.start[:2], move.center.p[:2]), 3) for move in made.program.moves if isinstance(move, rmac.Arc)}
            self.assertEqual(len(circles), 1)
            self.assertTrue(0.9 < circles.pop() <= 1.0)  # between walls 6 mm apart, with a tool of 4 mm

    def test_a_pocket_with_a_slot_as_wide_as_the_tool_is_cleared_to_the_slot_s_end(self):
        face = Part.makePlane(30, 20).fuse(Part.makePlane(20, 4, at(30, 7))).removeSplitter().Faces[0]
        made, _ = self.check(face)
        self.assertLess(Cut(made.program, 0.0).uncut(np.array([[48.0, 9.0]]), 0.0, -2.5), 1e-6)

    def test_the_corners_of_a_rectangle_are_told_as_area(self):
        made = self.cleared(Part.makePlane(30, 20))
        self.assertEqual(len(made.unreached), 4)
        for spot in made.unreached:
            self.assertAlmostEqual(spot.area_mm2, (1 - math.pi / 4) * 2**2, delta=0.03)
        self.assertAlmostEqual(min(math.dist(spot.place, (0, 0)) for spot in made.unreached), 0.447 * math.sqrt(2), delta=0.02)

    def test_wide_steps_get_loops_between_where_they_would_leave_something(self):
        """Of a square of 13.6 mm two loops with 3.8 mm between them leave its middle."""
        square = Part.makePlane(13.6, 13.6)
        loops = {place.what for place in self.places(self.cleared(square, step_over_mm=3.8).program)}
        self.assertTrue(any("3.9 mm from the walls" in what for what in loops), loops)
        self.check(square, step_over_mm=3.8)

    def places(self, program):
        return [program.place_of(index) for index in range(len(program))]

    def test_inside_out_ends_at_the_walls_and_outside_in_begins_there(self):
        for order, number in (("inside out", -1), ("outside in", 0)):
            places = [place for place in self.places(self.cleared(Part.makePlane(30, 20), order=order).program) if "loop" in place.what]
            self.assertIn("loop 2 mm from the walls", places[number].what)

    def test_climbing_has_walls_to_the_right_and_islands_too(self):
        face = Part.makePlane(30, 20).cut(rounded(6, 6, 1, 12, 7))
        for climb in (True, False):
            for move in Cut(self.cleared(face, climb=climb).program, 0.0).level(-2.5):
                begin, end = np.array(move.start[:2]), np.array(move.end[:2])
                if isinstance(move, rmac.Line) and math.dist(begin, end) > 2:
                    across = np.array([end[1] - begin[1], begin[0] - end[0]]) / math.dist(begin, end)
                    away = Flat(face).away(np.array([(begin + end) / 2 + 0.1 * across, (begin + end) / 2 - 0.1 * across]))
                    self.assertEqual(away[0] < away[1], climb, (begin, end))

    def test_a_sketch_with_an_island_is_cleared_where_it_stands(self):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        corners = [at(0, 0), at(30, 0), at(30, 20), at(0, 20)]
        sketch.addGeometry([Part.LineSegment(a, b) for a, b in zip(corners, [*corners[1:], corners[0]])], False)
        sketch.addGeometry(Part.Circle(at(15, 10), at(0, 0, 1), 3), False)
        sketch.addGeometry(Part.LineSegment(at(0, 5), at(10, 5)), True)  # for construction
        sketch.Placement.Base = at(3, 4, 2)
        self.document.recompute()
        outline = outline_of(sketch)
        made = read_pocket("Pocket", outline, Pocket(**{**GIVEN, "top_mm": 2.0}), rapid_mm_min=2000)
        face = Part.makePlane(30, 20, at(3, 4)).cut(Part.Face(Part.Wire(Part.Circle(at(18, 14), at(0, 0, 1), 3).toShape()))).Faces[0]
        self.assertEqual(outline.z, 2)
        self.assertAlmostEqual(made.area_mm2, face.Area, 6)
        self.assertLess(Cut(made.program, 2.0).gouge(Flat(face), 2.0), GOUGE_MM)

    def test_a_machine_takes_it(self):
        tools = {"Mounted": 1, "Tools": [{"ToolNumber": 1, "Length": 0, "Radius": 2}]}
        for seed in (1, 2, 4):
            program = self.cleared(seeded_face(seed)[1], entry="ramp" if seed == 4 else "helix").program
            self.assertGreater(simulate(program, "DMACXYZ", tools, rmac=str(BUILD / "bin/rmac")).cycle_time_s, 0)

    def test_the_feed_down_is_that_of_slopes(self):
        feed, feeds = None, {}
        for move in self.cleared(Part.makePlane(30, 20)).program.moves:
            if move.method == "RMAC_CAM.SetFeedrate":
                feed = json.loads(move.params(0))["Feedrate"]
            elif move.end is not None:
                feeds.setdefault("rapid" if isinstance(move, rmac.MoveTo) else "down" if move.end[2] < move.start[2] else "level", set()).add(feed)
        self.assertEqual(feeds, {"rapid": {2000}, "down": {200}, "level": {600}})


class RefusedTest(PocketTest):
    def test_a_pocket_that_is_narrower_than_the_tool_is_refused(self):
        self.refused(Part.makePlane(30, 3.99), "radius of 2 mm", "does not get into it anywhere", "smaller")
        self.refused(Part.Face(Part.Wire(Part.Circle(at(0, 0), at(0, 0, 1), 2).toShape())), "smaller")

    def test_a_place_where_nothing_can_go_down_is_told(self):
        self.refused(Part.makePlane(4.01, 4.01), "no room to go down", "at X 2.005 Y 2:")

    def test_faces_that_are_not_flat_or_not_level_are_told(self):
        ball = Part.makeSphere(5)
        self.refused(ball, "Face1", "not planar")
        slope = Part.makePlane(30, 20)
        slope.rotate(at(0, 0), at(1, 0, 0), 1)
        self.refused(slope, "Face1", "not level")
        box = Part.makeBox(9, 9, 9)
        below = next(f"Face{number}" for number, face in enumerate(box.Faces, 1) if face.BoundBox.ZMax < 1e-6)
        with self.assertRaisesRegex(PocketRefused, "looks down"):
            self.outline(box, below)
        with self.assertRaisesRegex(PocketRefused, "has no Face7; select a face, or a sketch"):
            self.outline(Part.makeBox(9, 9, 9), "Face7")

    def wires(self, *edges):
        with self.assertRaises(ProfileRefused) as refused:
            self.outline(Part.Compound(list(edges)), "")
        return str(refused.exception)

    def test_an_open_outline_is_told_with_its_place(self):
        corners = [at(0, 0), at(10, 0), at(10, 10), at(0, 10)]
        text = self.wires(*(Part.makeLine(a, b) for a, b in zip(corners, corners[1:])))
        self.assertIn("Edge3 at X 0 Y 10: the outline is open there", text)

    def test_outlines_that_cross_touch_or_lie_apart_are_told(self):
        square = Part.makePlane(10, 10).Edges
        self.assertIn("do not cross or touch", self.wires(*square, *Part.makePlane(10, 10, at(5, 5)).Edges))
        self.assertIn("do not cross or touch", self.wires(*square, *Part.makePlane(3, 3, at(7, 2)).Edges))
        self.assertIn("a pocket of each", self.wires(*square, *Part.makePlane(9, 9, at(20, 0)).Edges))
        self.assertIn("at X 10 Y 10", self.wires(*square, *Part.makePlane(3, 3, at(10, 10)).Edges))
        island = Part.makePlane(6, 6, at(2, 2)).Edges
        self.assertIn("within an island", self.wires(*square, *island, *Part.makePlane(2, 2, at(4, 4)).Edges))
        self.assertIn("begin in one plane", self.wires(*square, *Part.makePlane(2, 2, at(4, 4, 1)).Edges))
        self.assertIn("no edge", self.wires())

    def test_what_is_no_number_is_refused_by_its_name(self):
        face = Part.makePlane(30, 20)
        for name in ("radius_mm", "depth_mm", "step_down_mm", "step_over_mm", "feed_mm_min", "plunge_mm_min", "spindle_rpm", "ramp_deg"):
            for value in (None, 0, -1, math.nan, math.inf, True, "3 mm"):
                with self.subTest(name=name, value=value):
                    self.refused(face, f"({name})", "not given" if value is None else "more than 0", **{name: value})
        for name in ("top_mm", "safe_mm"):
            self.refused(face, f"({name})", **{name: None})

    def test_other_values_that_make_no_sense_are_refused(self):
        face = Part.makePlane(30, 20)
        self.refused(face, "tool's number", tool=0)
        self.refused(face, "helix, ramp", entry="drill")
        self.refused(face, "inside out, outside in", order="anyhow")
        self.refused(face, "at most 3.8 mm", step_over_mm=3.9)
        self.refused(face, "height to cross at", safe_mm=0.0)
        self.refused(face, "at most 45", ramp_deg=60)


if __name__ == "__main__":
    unittest.main()

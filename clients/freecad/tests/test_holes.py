"""Holes of a part and a sketch: found, told why not, and drilled as deep, as far and as high as they are."""

import math
import unittest

import FreeCAD
import numpy as np
import Part
import rmac_freecad  # noqa: F401
import Sketcher  # noqa: F401  its type of objects
from drilled_part import block_without, bore, box_with_holes, halves, leaning
from FreeCAD import Vector
from rmac_freecad.holes import Drilling, HoleRefused, Room, drilling_of, drillings, holes_in, read_holes, short_order, tip_of
from rmac_freecad.jobs.refusal import JobRefused

DRILL = Drilling(tool=3, diameter_mm=5, feed_mm_min=100, spindle_rpm=800, safe_mm=20)
POINT_MM = 2.5 / math.tan(math.radians(59))


def drill(**changes):
    return Drilling(**{**DRILL.__dict__, **changes})


def ends(program):
    return [tuple(move.end) for move in program.moves if move.end is not None]


class FindingTest(unittest.TestCase):
    def test_holes_that_lean_or_open_below_are_found_and_told(self):
        told = {(round(hole.diameter_mm, 6), hole.obstacle, hole.through, tuple(round(float(a), 6) + 0.0 for a in hole.axis)) for hole in holes_in(box_with_holes())}
        self.assertEqual(told, {
            (5, "", True, (0, 0, 1)), (8, "", False, (0, 0, 1)), (9, "", False, (0, 0, 1)),
            (4, "its axis leans by 90° from Z; turn the part until it stands upright", True, (0, 1, 0)),
            (6, "it opens below; turn the part over", False, (0, 0, -1)),
        })  # fmt: skip

    def test_a_tilted_hole_has_its_axis_and_its_depth_along_it(self):
        axis = (math.sin(math.radians(30)), 0, math.cos(math.radians(30)))
        (hole,) = holes_in(block_without(leaning(4, axis)))
        np.testing.assert_allclose(hole.axis, axis, atol=1e-9)
        self.assertAlmostEqual(hole.lean_deg, 30, 9)
        self.assertAlmostEqual(hole.depth_mm, 12 / axis[2] + 4 * math.tan(math.radians(30)), 2)

    def test_what_leans_by_a_hundredth_of_a_degree_leans(self):
        for degrees, told in ((1e-5, ""), (0.01, "its axis leans by 0.01°")):
            (hole,) = holes_in(block_without(bore(5, -4)).rotated(Vector(20, 15, 0), Vector(1, 0, 0), degrees))
            self.assertEqual(hole.obstacle[:23], told)

    def test_a_mirrored_part_has_the_same_holes_and_its_boss_is_none(self):
        part = box_with_holes().fuse(Part.makeCylinder(4, 8, Vector(30, 5, 10)))
        mirrored = part.mirror(Vector(0, 0, 0), Vector(1, 0, 0))
        for shape, sign in ((part, 1), (mirrored, -1)):
            upright = sorted((round(sign * hole.x, 6), round(hole.y, 6), round(hole.diameter_mm, 6), round(hole.bottom, 6)) for hole in holes_in(shape) if not hole.obstacle)
            self.assertEqual(upright, [(8, 8, 5, 0), (8, 22, 5, 0), (8, 22, 9, 7), (30, 20, 8, 5), (50, 8, 5, 0)])

    def test_a_keyway_is_told_and_the_end_of_a_slot_is_no_hole(self):
        (keyed,) = holes_in(block_without(bore(10, -4), Part.makeBox(3, 7, 20, Vector(18.5, 15, -4))))
        self.assertAlmostEqual(keyed.around_deg, 360 - 2 * math.degrees(math.asin(1.5 / 5)), 6)
        self.assertEqual((keyed.obstacle, keyed.through), ("", True))
        self.assertEqual(holes_in(block_without(bore(6, -4), Part.makeBox(10, 6, 20, Vector(20, 12, -4)))), ())

    def test_of_hundreds_each_is_found(self):
        places = [(3 + 4 * i, 3 + 4 * j) for i in range(20) for j in range(10)]
        part = block_without(Part.makeCompound([bore(2, -4, x=x, y=y) for x, y in places]), size=(90, 50, 8))
        self.assertEqual(len({(round(hole.x, 6), round(hole.y, 6)) for hole in holes_in(part) if hole.through}), len(places))


class DepthTest(unittest.TestCase):
    def tip(self, *tools, of=5, **changes):
        part = block_without(*tools)
        hole = next(hole for hole in holes_in(part) if abs(hole.diameter_mm - of) < 1e-6)
        tip, told = tip_of(hole, drill(diameter_mm=of, point_deg=118, **changes), Room(part.Faces))
        return round(tip, 6), "; ".join(told)

    def test_the_shoulder_goes_through_and_into_a_drawn_point_and_the_tip_stops_at_a_floor(self):
        cone = Part.makeCone(0, 2.5, POINT_MM, Vector(20, 15, 4 - POINT_MM))
        self.assertEqual(self.tip(bore(5, -4), beyond_mm=0.5), (round(-0.5 - POINT_MM, 6), ""))
        self.assertEqual(self.tip(bore(5, 4), cone), (round(4 - POINT_MM, 6), ""))
        self.assertEqual(self.tip(bore(5, 4)), (4, "the point has no room below, so its tip stops there"))
        self.assertEqual(self.tip(bore(5, -4), bore(9, 7), of=9)[0], 7, "not into the ledge of a counterbore")

    def test_tip_and_shoulder_are_taken_at_their_word(self):
        self.assertEqual(self.tip(bore(5, 4), end="shoulder"), (round(4 - POINT_MM, 6), f"the point goes {POINT_MM:.4g} mm into what is below"))
        self.assertEqual(self.tip(bore(5, -4), end="tip"), (0, "the point does not come out"))

    def test_a_second_wall_below_a_through_hole_is_left_alone(self):
        gap = Part.makeBox(60, 30, 1, Vector(0, 0, 6))
        self.assertEqual(self.tip(bore(5, 6), gap)[0], 7)
        self.assertEqual(self.tip(bore(5, 6), Part.makeBox(60, 30, 3, Vector(0, 0, 4)))[0], round(7 - POINT_MM, 6))

    def test_a_depth_spots_a_hole_with_as_much_of_the_point_as_fits(self):
        part = block_without(bore(5, -4))
        (hole,) = holes_in(part)
        spot = drill(diameter_mm=10, point_deg=90, depth_mm=2)
        self.assertEqual(tip_of(hole, spot, Room(part.Faces)), (10, []))
        with self.assertRaisesRegex(HoleRefused, "it is 5 mm wide, and the drill 10 mm, 6 mm of it at the top"):
            tip_of(hole, drill(diameter_mm=10, point_deg=90, depth_mm=3), Room(part.Faces))
        with self.assertRaisesRegex(HoleRefused, "it is 7 mm deep, and the tip would go 8 mm below its top"):
            self.tip(bore(5, 5), depth_mm=8)

    def test_what_does_not_fit_or_reach_is_told(self):
        with self.assertRaisesRegex(HoleRefused, "goes 14 mm below its top, and the drill reaches 10 mm"):
            self.tip(bore(5, -4), reach_mm=10, beyond_mm=2 - POINT_MM)
        for diameter, changes, word in ((6, {}, "take a drill that is"), (4, {}, "predrill it"), (4, {"predrills": True}, None)):
            (hole,) = holes_in(block_without(bore(5, -4)))
            if word is None:
                self.assertEqual(tip_of(hole, drill(diameter_mm=diameter, **changes)), (0, ["1 mm narrower than it"]))
            else:
                with self.assertRaisesRegex(HoleRefused, word):
                    tip_of(hole, drill(diameter_mm=diameter, **changes))


class WayTest(unittest.TestCase):
    def heights(self, *places, wall=None, safe=14.0):
        """At which the tool crosses to each hole but the first."""
        part = block_without(*(bore(5, -4, x=x, y=15.0) for x in places))
        part = part if wall is None else part.fuse(wall)
        holes = [hole for hole in holes_in(part) if hole.through]
        came = ends(read_holes("Holes", sorted(holes, key=lambda hole: hole.x), drill(safe_mm=safe), rapid_mm_min=2000, room=Room(part.Faces)))
        return came[0][2], [b[2] for a, b in zip(came, came[1:]) if math.dist(a[:2], b[:2]) > 1e-6 and self.assertEqual(a[2], b[2]) is None], came[-1][2]

    def test_the_tool_goes_over_what_stands_in_its_way_and_comes_and_goes_over_all(self):
        rib = Part.makeBox(2, 30, 30, Vector(29, 0, 0))
        self.assertEqual(self.heights(10, 20, 40, 50, wall=rib), (31, [14, 31, 14], 31))
        self.assertEqual(self.heights(10, 20, 40, 50), (14, [14, 14, 14], 14))
        for y, height in ((17.4, 31), (17.6, 14)):  # the middle of the drill passes both, its side one
            self.assertEqual(self.heights(10, 50, wall=Part.makeBox(28, 2, 30, Vector(16, y, 0))), (31, [height], 31))

    def test_pecks_chips_and_dwells(self):
        hole = holes_in(block_without(bore(5, 4)))
        self.assertEqual([end[2] for end in ends(read_holes("Holes", hole, DRILL, rapid_mm_min=2000))], [20, 13, 4, 20])
        pecked = ends(read_holes("Holes", hole, drill(peck_mm=5), rapid_mm_min=2000))
        self.assertEqual([round(end[2], 3) for end in pecked], [20, 13, 8, 13, 8.254, 4, 20])
        broken = read_holes("Holes", hole, drill(peck_mm=5, breaks_chips=True, dwell_s=0.5), rapid_mm_min=2000)
        self.assertEqual([round(end[2], 3) for end in ends(broken)], [20, 13, 8, 8.254, 4, 20])
        self.assertIn('"Time":0.5', broken.text().replace(" ", ""))

    def test_the_order_is_short(self):
        grid = [(10 * i, 10 * j) for i in range(6) for j in range(5)]
        mixed = np.random.default_rng(7).permutation(grid)
        order = short_order(mixed)
        self.assertEqual(sorted(order), list(range(30)))
        self.assertEqual(tuple(mixed[order[0]]), (0, 0))
        self.assertLessEqual(np.hypot(*np.diff(mixed[order], axis=0).T).sum(), 1.05 * 290)
        self.assertEqual(short_order([(3, 3)]), [0])


class DocumentTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("holes")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def part(self, shape):
        one = self.document.addObject("Part::Feature", "Part")
        one.Shape = shape
        return one

    def drilled(self, *chosen, **values):
        feature = drilling_of(self.document, [(one, list(names)) for one, *names in chosen])
        for name, value in values.items():
            setattr(feature, name, value)
        self.document.recompute()
        return feature, feature.Proxy.planning(feature)()

    def name(self, part, found):
        return next(f"Face{number}" for number, face in enumerate(part.Shape.Faces, 1) if found(face))

    def test_a_whole_part_drills_what_most_are_as_wide_as_and_tells_the_others(self):
        feature, plan = self.drilled((self.part(box_with_holes()),))
        self.assertEqual((list(feature.Diameters), feature.Diameter.Value, feature.Safe.Value), ([5], 5, 17))
        self.assertEqual(plan.told, "3 holes are drilled.")
        feature.Diameters = [4.0, 5.0, 6.0, 8.0]
        plan = feature.Proxy.planning(feature)()
        self.assertRegex(plan.told, "3 holes are drilled; 3 chosen ones are not: Ø 4 mm at X 20 Y 30: its axis leans by 90° .*; Ø 6 mm .*: it opens below; .*; Ø 8 mm .* predrill it")
        self.assertEqual({tuple(round(value) for value in end[:2]) for end in ends(plan.program("Holes", 2000))}, {(8, 8), (50, 8), (8, 22)})

    def test_faces_and_edges_mean_their_hole_and_what_is_none_is_told(self):
        sunk = self.part(block_without(bore(5, -4), Part.makeCone(2.5, 4.5, 2, Vector(20, 15, 10))).fuse(Part.makeCylinder(3, 20, Vector(45, 15, 0))))
        rims = [f"Edge{number}" for number, edge in enumerate(sunk.Shape.Edges, 1) if isinstance(edge.Curve, Part.Circle) and edge.CenterOfMass.x < 30]
        top = self.name(sunk, lambda face: isinstance(face.Surface, Part.Plane) and abs(face.CenterOfMass.z) < 1e-6)
        for name in (*rims, top, self.name(sunk, lambda face: isinstance(face.Surface, Part.Cone)), self.name(sunk, lambda face: isinstance(face.Surface, Part.Cylinder) and face.CenterOfMass.x < 30)):
            _, plan = self.drilled((sunk, name))
            self.assertEqual([(row.hole.x, row.hole.top, row.tip is None) for row in plan.rows], [(20, 12, False)], name)
        boss = self.name(sunk, lambda face: isinstance(face.Surface, Part.Cylinder) and face.CenterOfMass.x > 30)
        line = next(f"Edge{number}" for number, edge in enumerate(sunk.Shape.Edges, 1) if isinstance(edge.Curve, Part.Line))
        ring = next(f"Edge{number}" for number, edge in enumerate(sunk.Shape.Edges, 1) if isinstance(edge.Curve, Part.Circle) and edge.CenterOfMass.x > 30)
        before = len(self.document.Objects)
        for name, word in ((boss, "round outside"), (line, "no circle"), (ring, "goes round no hole"), ("Vertex1", "is no hole"), ("Face99", "is no hole")):
            with self.assertRaisesRegex(JobRefused, word):
                self.drilled((sunk, name))
        for shape, word in ((Part.makeBox(9, 9, 9), "no hole"), (Part.makeShell(Part.makeBox(9, 9, 9).Faces), "a shell and no solid"), (Part.makeLine(Vector(), Vector(9, 0, 0)), "neither circles nor points")):
            with self.assertRaisesRegex(JobRefused, word):
                self.drilled((self.part(shape),))
        self.assertEqual(len(self.document.Objects), before + 3, "nothing is made of what is refused")

    def test_a_sketch_gives_circles_and_points_and_needs_a_depth(self):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        sketch.addGeometry(Part.Circle(Vector(10, 5, 0), Vector(0, 0, 1), 2.5))
        sketch.addGeometry(Part.Point(Vector(20, 5, 0)))
        sketch.addGeometry(Part.LineSegment(Vector(0, 0, 0), Vector(30, 0, 0)))
        sketch.Placement.Base.z = 3
        self.document.recompute()
        feature, plan = self.drilled((sketch,), Depth=4)
        feature.Diameters = [0.0, 5.0]
        self.assertEqual(sorted((row.hole.x, row.tip) for row in feature.Proxy.planning(feature)().rows), [(10, -1), (20, -1)])
        feature.Depth = 0
        self.assertIn("give the depth", feature.Proxy.planning(feature)().told)
        feature.Depth = -1
        with self.assertRaisesRegex(JobRefused, r"the depth \(depth_mm\) is -1"):
            feature.Proxy.planning(feature)
        feature.Depth = 4
        sketch.Placement = FreeCAD.Placement(Vector(0, 0, 3), FreeCAD.Rotation(Vector(1, 0, 0), 20))
        self.document.recompute()
        self.assertIn("leans by 20°", feature.Proxy.planning(feature)().told)

    def test_a_circle_under_the_part_is_not_drilled(self):
        circle = self.part(Part.makeCircle(2, Vector(20, 15, 0)))
        _, plan = self.drilled((self.part(block_without(bore(5, -4, x=50.0))),), (circle,))
        self.assertEqual({row.told for row in plan.rows if row.hole.diameter_mm == 4}, {""}, "it is not chosen")
        feature = drillings(self.document)[0]
        feature.Diameters, feature.Diameter, feature.Depth = [4.0], 4, 3
        self.assertIn("something of the part is above it", feature.Proxy.planning(feature)().told)

    def test_a_link_and_a_part_in_a_container_are_where_they_stand(self):
        part = self.part(block_without(bore(5, -4)))
        link, container = self.document.addObject("App::Link", "Link"), self.document.addObject("App::Part", "Container")
        link.LinkedObject, link.Placement.Base.z = part, 30
        container.addObject(part)
        container.Placement.Base.y = 50
        self.document.recompute()
        for one, place in ((part, (20, 65, 12)), (link, (20, 15, 42)), (container, (20, 65, 12))):
            (hole,) = (hole for hole, _ in self.drilled((one,))[1].tipped)
            np.testing.assert_allclose((hole.x, hole.y, hole.top), place, atol=1e-9)

    def test_it_follows_its_part_and_finds_anew(self):
        part = self.part(block_without(bore(5, -4)))
        feature, plan = self.drilled((part,))
        first = feature.Proxy.planning(feature)()
        self.assertIs(feature.Proxy.planning(feature)(), first, "nothing changed")
        part.Shape = block_without(bore(5, -4, x=30.0))
        self.document.recompute()
        self.assertEqual([hole.x for hole, _ in feature.Proxy.planning(feature)().tipped], [30])
        part.Placement.Base.x = 7
        self.document.recompute()
        self.assertEqual([hole.x for hole, _ in feature.Proxy.planning(feature)().tipped], [37])
        part.Shape = block_without(bore(6, -4))
        with self.assertRaisesRegex(JobRefused, "none is as wide as"):
            feature.Proxy.planning(feature)().program("Holes", 2000)

    def test_halves_are_drilled_once_whichever_is_selected(self):
        part = self.part(block_without(*halves(5, 20, 15)))
        names = [f"Face{number}" for number, face in enumerate(part.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder)]
        self.assertEqual(len(names), 2)
        for chosen in (names, names[:1]):
            self.assertEqual(len(self.drilled((part, *chosen))[1].tipped), 1)


if __name__ == "__main__":
    unittest.main()

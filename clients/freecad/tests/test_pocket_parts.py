"""Floors of parts that have more above them than their outline tells: nothing of the part is cut, or it is refused. Told by OpenCASCADE's own solids of the tool."""

import math
import os
import sys
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import numpy as np
import Part
import PartDesign  # noqa: F401  its types of objects
import Sketcher  # noqa: F401
from pocket_check import at, points_of
from rmac_freecad.pockets import Pocket, PocketRefused, outline_of, pocket_of, read_pocket
from rmac_freecad.profiles import ProfileRefused, profile_of, program_of
from rmac_freecad.surfaces import sweep_of

GIVEN = {"tool": 1, "radius_mm": 2.0, "step_down_mm": 5.0, "step_over_mm": 1.6, "feed_mm_min": 600.0, "plunge_mm_min": 200.0, "spindle_rpm": 800.0}
BLOCK = Part.makeBox(40, 30, 20)
ROOM = Part.makeBox(24, 18, 10, at(8, 6, 10))
MILLED = BLOCK.cut(ROOM)
GOUGE_MM = 0.002
EVERY = 80  # of places along moves, 4 mm


LEDGE = BLOCK.cut(Part.makeBox(40, 14, 10, at(0, 0, 10)))
OPEN_TO_ONE_SIDE = BLOCK.cut(Part.makeBox(30, 18, 10, at(0, 6, 10)))
SLOT = BLOCK.cut(Part.makeBox(40, 14, 10, at(0, 8, 10)))
AROUND_A_BOSS = Part.makeBox(40, 30, 10).fuse(Part.makeCylinder(4, 10, at(20, 15, 10))).removeSplitter()
APART_FROM_WALLS = BLOCK.cut(Part.makeBox(20, 30, 10, at(20, 0, 10))).cut(Part.makeBox(4, 30, 15, at(20, 0, 5)))  # with a channel between


def trapezoid(at_floor, at_top):
    """A loft of rectangles, half as long and wide as that."""
    outlines = [Part.makePolygon([at(20 + x * i, 15 + y * j, z) for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]) for (x, y), z in ((at_floor, 10), (at_top, 20))]
    return Part.makeLoft(outlines, True, True)


class PocketPartsTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("parts")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def feature(self, shape):
        feature = self.document.addObject("Part::Feature", "Block")
        feature.Shape = shape
        return feature

    def floor(self, shape, z=10):
        level = [(face.Area, number) for number, face in enumerate(shape.Faces, 1) if isinstance(face.Surface, Part.Plane) and face.BoundBox.ZLength < 1e-6
                 and abs(face.BoundBox.ZMin - z) < 1e-6 and face.normalAt(0, 0).z > 0]  # fmt: skip
        return f"Face{max(level)[1]}"

    def cleared(self, shape, **given):
        wanted = {"top_mm": 20.0, "depth_mm": 10.0, "safe_mm": 25.0, **GIVEN, **given}
        return read_pocket("Pocket", outline_of(self.feature(shape), self.floor(shape)), Pocket(**wanted), rapid_mm_min=2000)

    def refused(self, shape, *words, **given):
        with self.assertRaises(PocketRefused) as refused:
            self.cleared(shape, **given)
        for word in words:
            self.assertIn(word, str(refused.exception))

    def check_clear(self, shape, program):
        for move in program.moves:
            if getattr(move, "start", None) is not None:
                places = points_of(move)
                for x, y, z in [*places[::EVERY], places[-1]]:
                    mill = Part.makeCylinder(GIVEN["radius_mm"] - GOUGE_MM, 60, at(x, y, z + GOUGE_MM))
                    self.assertGreater(shape.distToShape(mill)[0], 0, (x, y, z))

    def test_walls_that_lean_in_over_the_floor_are_refused_with_face_and_place(self):
        self.refused(BLOCK.cut(trapezoid((12, 9), (10, 7))), "Face", "at Z 20", "cut 2 mm into it", "turn the part")

    def test_so_is_a_slope_of_a_hundredth_of_a_millimetre(self):
        self.refused(BLOCK.cut(trapezoid((12, 9), (11.99, 9))), "cut 0.01 mm into it")

    def test_a_bridge_over_the_floor_is_refused(self):
        self.refused(MILLED.fuse(Part.makeBox(4, 18, 3, at(18, 6, 15))).removeSplitter(), "above what is cleared")

    def test_islands_that_are_wider_above_are_refused(self):
        heads = (Part.makeCylinder(5, 3, at(20, 15, 14)), Part.makeSphere(3.5, at(20, 15, 14)), Part.makeTorus(3, 1, at(20, 15, 15)))
        for head in heads:
            with self.subTest(head=head.Faces[0].Surface):
                self.refused(MILLED.fuse(Part.makeCylinder(2, 5, at(20, 15, 10))).fuse(head).removeSplitter(), "above what is cleared")

    def test_a_floor_without_a_way_in_from_above_is_refused(self):
        self.refused(BLOCK.cut(Part.makeBox(24, 18, 6, at(8, 6, 10))), "covers it")

    def test_what_is_deeper_than_the_part_s_own_floor_is_refused(self):
        self.refused(MILLED, "4 mm into this floor", "depth of 10 mm", depth_mm=14.0)

    def test_so_are_ledges_slots_and_whatever_else_has_the_part_above_it(self):
        for number, shape in enumerate((LEDGE, OPEN_TO_ONE_SIDE, SLOT, AROUND_A_BOSS, APART_FROM_WALLS)):
            with self.subTest(shape=number):
                self.refused(shape, "4 mm into this floor", "depth of 10 mm", depth_mm=14.0)
                self.check_clear(shape, self.cleared(shape).program)

    def test_seeded_stairs_are_cut_deeper_from_their_top_alone(self):
        for seed in range(8):
            chance = np.random.default_rng(seed)
            shape = BLOCK
            for low in map(int, chance.choice(range(6, 18), 3, replace=False)):
                x, y = (round(float(place), 3) for place in chance.uniform((0, 0), (30, 20)))
                shape = shape.cut(Part.makeBox(*map(float, chance.uniform(8, 30, 2)), 20, at(x, y, low)))
            for number, face in enumerate(shape.Faces, 1):
                z = face.CenterOfMass.z
                if z < 1 or face.BoundBox.ZLength > 1e-6:
                    continue
                with self.subTest(seed=seed, z=z):
                    around = outline_of(self.feature(shape), f"Face{number}").around
                    self.assertEqual(around.is_floor, z < max(vertex.Point.z for vertex in shape.Vertexes) - 1e-6)

    def test_a_top_between_bent_walls_is_no_floor_though_their_boxes_are_higher(self):
        ring = Part.makeTorus(10, 4).cut(Part.makeBox(60, 60, 9, at(-30, -30, 2)))
        hump = Part.BSplineCurve()
        hump.interpolate([at(0, 0, 0), at(0, 5, 8), at(0, 10, 3), at(0, 15, 9), at(0, 20, 0)])
        humps = Part.Face(Part.Wire([hump.toShape(), Part.makeLine(at(0, 20, 0), at(0, 0, 0))])).extrude(at(30, 0, 0)).cut(Part.makeBox(60, 60, 9, at(-1, -1, 7)))
        for shape, z in ((ring, 2), (humps, 7)):
            with self.subTest(z=z):
                self.assertGreater(shape.BoundBox.ZMax, z + 0.1)
                self.assertFalse(outline_of(self.feature(shape), self.floor(shape, z)).around.is_floor)

    def test_a_hole_in_a_ledge_is_no_island_of_it(self):
        shape = LEDGE.cut(Part.makeCylinder(3, 30, at(20, 7, -1)))
        self.assertAlmostEqual(self.cleared(shape).area_mm2, 40 * 14, 6)

    def test_a_top_face_is_cut_as_deep_as_is_wanted(self):
        top = self.feature(BLOCK)
        self.assertGreater(len(read_pocket("Top", outline_of(top, self.floor(BLOCK, 20)), Pocket(top_mm=20.0, depth_mm=4.0, safe_mm=25.0, **GIVEN), rapid_mm_min=2000).program), 5)

    def test_the_tool_does_not_cross_through_the_part(self):
        self.refused(MILLED, "below the top of the part, Z 20", top_mm=12.0, depth_mm=2.0, safe_mm=15.0)

    def test_an_object_whose_part_has_changed_says_so(self):
        block = self.feature(MILLED)
        pocket = pocket_of(self.document, block, self.floor(MILLED))
        self.assertGreater(len(pocket.Proxy.planning(pocket)().chains), 0)
        block.Shape = BLOCK.cut(Part.makeBox(24, 18, 7, at(8, 6, 13)))
        self.document.recompute()
        with self.assertRaisesRegex(PocketRefused, "3 mm into this floor"):
            pocket.Proxy.planning(pocket)()

    def test_an_object_whose_part_was_moved_with_what_it_is_in_is_planned_anew(self):
        holder, block = self.document.addObject("App::Part", "Holder"), self.feature(MILLED)
        holder.addObject(block)
        self.document.recompute()
        pocket, sweep = pocket_of(self.document, block, self.floor(MILLED)), sweep_of(self.document, block, [self.floor(MILLED)])
        pocket.Safe = sweep.Safe = 40
        sweep.Mill, sweep.Diameter, sweep.Scallop = "flat end", 6, 0.05
        before = [np.array([move.end for move in one.Proxy.planning(one)().program("One", 2000).moves if move.end is not None]) for one in (pocket, sweep)]
        holder.Placement.Base = at(100, 50)
        for one, was in zip((pocket, sweep), before):
            now = np.array([move.end for move in one.Proxy.planning(one)().program("One", 2000).moves if move.end is not None])
            np.testing.assert_allclose(now.min(0)[:2] - was.min(0)[:2], (100, 50), atol=1e-5)

    def test_sketches_and_edges_are_crossed_to_above_the_part_that_they_belong_to(self):
        block = self.feature(BLOCK)
        bottom = tuple(f"Edge{number}" for number, edge in enumerate(BLOCK.Edges, 1) if edge.BoundBox.ZMax < 1e-6)
        profile = profile_of(self.document, [(block, bottom)])
        self.assertEqual(profile.Safe.Value, 25)
        profile.Safe = 15
        with self.assertRaisesRegex(ProfileRefused, "Z 15, is below the top of Block, Z 20"):
            program_of(profile, 2000)
        body = self.document.addObject("PartDesign::Body", "Body")
        base = body.newObject("PartDesign::AdditiveBox", "Box")
        base.Length, base.Width, base.Height = 40, 30, 20
        sketch = body.newObject("Sketcher::SketchObject", "Sketch")
        sketch.addGeometry(Part.Circle(at(20, 15), at(0, 0, 1), 8))
        self.document.recompute()
        pocket = pocket_of(self.document, sketch)
        self.assertEqual(pocket.Safe.Value, 25)
        pocket.Safe = 8
        with self.assertRaisesRegex(PocketRefused, "below the top of Sketch, Z 20"):
            pocket.Proxy.planning(pocket)

    def test_what_is_open_above_is_cut_and_nothing_else(self):
        inner = [edge for edge in MILLED.Edges if abs(edge.CenterOfMass.z - 10) < 1e-6]
        boss = Part.makeCylinder(3, 8, at(20, 15, 10))
        shapes = (MILLED, MILLED.makeFillet(2, inner), BLOCK.cut(trapezoid((10, 7), (12, 9))), MILLED.fuse(boss).cut(Part.makeCylinder(1, 30, at(20, 15, -1))).removeSplitter(),
                  MILLED.cut(Part.makeCylinder(4, 30, at(8, 15, -1))), MILLED.mirror(at(20, 0, 0), at(1, 0, 0)))  # fmt: skip
        for number, shape in enumerate(shapes):
            with self.subTest(shape=number):
                self.check_clear(shape, self.cleared(shape).program)

    def test_seeded_blocks_with_heads_anywhere_are_cut_right_or_refused(self):
        refused = 0
        for seed in range(10):
            chance = np.random.default_rng(seed)
            shape = MILLED
            for _ in range(1 + seed % 2):
                x, y, low = chance.uniform(2, 38), chance.uniform(2, 28), chance.uniform(7, 17)
                body = Part.makeBox(*map(float, chance.uniform(1, 6, 2)), 4, at(x, y, low)) if chance.random() < 0.5 else Part.makeCylinder(float(chance.uniform(1, 3)), 4, at(x, y, low))
                body.rotate(at(x, y), at(0, 0, 1), math.degrees(chance.uniform(0, 3)))
                shape = shape.fuse(body).removeSplitter()
            with self.subTest(seed=seed):
                try:
                    made = self.cleared(shape)
                except ProfileRefused:
                    refused += 1
                else:
                    self.check_clear(shape, made.program)
        self.assertGreater(refused, 0)
        self.assertLess(refused, 10)


if __name__ == "__main__":
    unittest.main()

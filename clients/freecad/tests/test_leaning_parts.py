"""Parts that are swept with five axes: nothing of them is cut into, and no more than the scallop is left."""

import math
import unittest

import FreeCAD
import numpy as np
import Part
from leaning_case import GOUGE_MM, SIDE_MM, LeaningTest, Vector, looks, passage, prism, wavy
from leaning_part import Poses, cloud, outward_points

from rmac_freecad.surfaces import ball_end


class PartsTest(LeaningTest):
    def test_random_faces_keep_the_scallop_and_are_not_gouged(self):
        for seed, along in ((1, "u"), (2, 35), (3, "v")):
            with self.subTest(seed=seed, along=along):
                shape = wavy(seed)
                top = looks(shape, 0, 0, 1)
                program, left = self.swept(shape, [top], ball_end(2), along=along, lead_deg=5, tilt_deg=20)
                self.assertEqual(left, [])
                self.check(shape, [top], 2, program, least=0.9)

    def test_upright_and_undercut_walls_are_swept(self):
        box = Part.makeBox(10, 8, 6)
        undercut = prism([(0, 0), (8, 0), (10, 8), (0, 8)], 6)  # its right side looks down by 14 degrees
        for name, shape, way, more in (
            ("upright, level passes", box, (1, 0, 0), {"along": "level", "tilt_deg": 40}),
            ("upright, passes up", box, (1, 0, 0), {"along": 0, "lead_deg": 30}),
            ("undercut", undercut, (1, 0, -0.2), {"along": "level", "tilt_deg": 40}),
            ("undercut, and the axis asked for would point down", undercut, (1, 0, -0.2), {"along": "level", "tilt_deg": 0}),
        ):
            with self.subTest(name):
                wall = looks(shape, *way)
                program, left = self.swept(shape, [wall], ball_end(2), **more)
                self.assertEqual(left, [])
                poses = self.check(shape, [wall], 2, program, least=0.9)
                self.assertGreater(poses.axis[:, 2].min(), -1e-5)

    def test_a_standing_cylinder_is_swept_all_around_over_its_seam(self):
        shape = Part.makeCylinder(5, 6)
        side = looks(shape, -1, 0, 0)  # its middle is there
        for along in ("level", "v"):
            with self.subTest(along=along):
                program, left = self.swept(shape, [side], ball_end(3), along=along, tilt_deg=45)
                self.assertEqual(left, [])
                self.check(shape, [side], 3, program, least=0.9)

    def test_a_cone_to_its_apex_and_the_wall_of_a_hole_are_swept(self):
        cone, hole = Part.makeCone(6, 0, 8), Part.makeBox(12, 10, 6).cut(Part.makeCylinder(3, 20, Vector(6, 5, -5)))
        for shape, kind, radius, tilt in ((cone, Part.Cone, 2, 30), (hole, Part.Cylinder, 1.5, 80)):
            with self.subTest(kind=kind):
                side = next(i for i, face in enumerate(shape.Faces) if isinstance(face.Surface, kind))
                program, left = self.swept(shape, [side], ball_end(radius), along="level", tilt_deg=tilt, scallop_mm=0.1)
                self.assertEqual(left, [])
                self.check(shape, [side], radius, program, scallop_mm=0.1, least=0.9)

    def test_a_sphere_is_swept_to_below_its_equator_and_what_the_spindle_bars_is_told(self):
        shape = Part.makeSphere(5)
        program, left = self.swept(shape, [0], ball_end(3), along="u", tilt_deg=20, scallop_mm=0.1)
        self.assertRegex(" ".join(left), "^Face1: [0-9.]+ % is out of reach")
        poses = Poses(program, 3)
        self.assertLess(poses.ball_gouge(shape, 6), GOUGE_MM)
        self.assertLess(poses.side_gouge(cloud(shape, 3000, 3), 6), SIDE_MM)
        points, normals = outward_points(shape, shape.Faces[0], 2000, 1)
        above = poses.left_over(points, normals)
        self.assertLess(above[normals[:, 2] > -0.9].max(), 1.05 * 0.1)

    def test_in_a_passage_the_axis_gives_way_and_nothing_is_touched(self):
        shape, walls, floor = passage()
        for name, face, more in (("wall", walls[0], {"along": "level", "tilt_deg": 40}), ("other wall", walls[1], {"along": "u", "tilt_deg": 20}),
                                 ("floor", floor, {"along": 90, "tilt_deg": 0})):  # fmt: skip
            with self.subTest(name):
                program, left = self.swept(shape, [face], ball_end(1.5), **more)
                self.assertRegex(" ".join(left), "^Face[0-9]+: [0-9.]+ % is beside other places of the part, or too narrow for the mill$")
                poses = self.check(shape, [face], 1.5, program, least=0.9)
                self.assertLess(poses.most_turn(), 20)

    def test_a_wall_is_swept_down_to_the_floor_that_is_not_touched(self):
        shape = prism([(0, 0), (12, 0), (12, 3), (4, 3), (4, 12), (0, 12)], 6)
        wall = next(i for i, face in enumerate(shape.Faces) if abs(face.CenterOfMass.x - 4) < 1e-6)
        for along in ("level", 0):
            with self.subTest(along=along):
                program, left = self.swept(shape, [wall], ball_end(2), along=along, tilt_deg=0)  # level, it would be in the floor
                self.assertEqual(len(left), 1)
                self.check(shape, [wall], 2, program)

    def test_an_axis_that_never_turns_is_kept(self):
        shape = prism([(0, 0), (8, 0), (4, 8), (0, 8)], 6)
        slope = looks(shape, 2, 0, 1)
        program, left = self.swept(shape, [slope], ball_end(2), along="level", axis=(1, 0, 2))
        self.assertEqual(left, [])
        poses = self.check(shape, [slope], 2, program, least=0.9)
        np.testing.assert_allclose(poses.axis, np.broadcast_to(np.array((1, 0, 2)) / math.sqrt(5), poses.axis.shape), atol=1e-9)

    def test_trimmed_reversed_and_placed_faces_are_swept_on_their_outer_side(self):
        holed = wavy(4).cut(Part.makeCylinder(1, 20, Vector(3, 2, -5)))
        backward = wavy(1).copy()
        backward.reverse()
        moved = wavy(1).copy()
        moved.Placement = FreeCAD.Placement(Vector(50, 20, 10), FreeCAD.Rotation(Vector(1, 0, 0), 70))
        for name, shape, way in (("trimmed", holed, (0, 0, 1)), ("reversed", backward, (0, 0, 1)), ("placed", moved, (0, -1, 0.4))):
            with self.subTest(name):
                top = looks(Part.makeSolid(Part.Shell(shape.Faces)), *way)
                program, _ = self.swept(shape, [top], ball_end(2), along="u", tilt_deg=20)
                self.check(Part.makeSolid(Part.Shell(shape.Faces)), [top], 2, program)


if __name__ == "__main__":
    unittest.main()

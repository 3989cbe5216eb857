"""Faces that are swept with five axes: what is left of the part is told by code that shares nothing with the sweep (leaning_part.py)."""

import math
import os
import pathlib
import unittest

import FreeCAD
import numpy as np
import Part
from leaning_part import Poses, cloud, outward_points
from swept_part import reachable

from rmac_freecad.jobs import JobRefused
from rmac_freecad.simulation import simulate
from rmac_freecad.surfaces import ball_end, bull_nose, flat_end, read_faces

Vector = FreeCAD.Vector
GOUGE_MM = 0.001
SIDE_MM = 0.001
FEEDS = {"feed_mm_min": 600, "rapid_mm_min": 2000}


def wavy(seed, length=6.0, width=4.0, height=0.025):
    """A solid with a random bicubic face on top."""
    chance = np.random.default_rng(seed)
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(length * i / 4, width * j / 4, 6 + chance.uniform(-height, height)) for j in range(5)] for i in range(5)])
    return surface.toShape().extrude(Vector(0, 0, -8))


def prism(outline, depth):
    """Of an outline in X and Z, along Y."""
    places = [Vector(x, 0, z) for x, z in outline]
    return Part.Face(Part.makePolygon([*places, places[0]])).extrude(Vector(0, depth, 0))


def passage(gap=6.0):
    """Between two bent blades on a hub; the faces that look into it, and its floor."""

    def blade(x, bend, thick):
        surface = Part.BSplineSurface()
        heights = [1.5 + 2.5 * j for j in range(5)]
        surface.interpolate([[Vector(x + bend * math.sin(math.pi * j / 4) + 0.1 * i, 2 * i, heights[j]) for j in range(5)] for i in range(5)])
        return surface.toShape().extrude(Vector(thick, 0, 0))

    shape = Part.makeBox(20, 8, 2, Vector(-6, 0, 0)).fuse([blade(0, 0.8, -2.5), blade(gap, 0.6, 2.5)])
    middle = [face.CenterOfMass for face in shape.Faces]
    bent = [i for i, face in enumerate(shape.Faces) if isinstance(face.Surface, Part.BSplineSurface)]
    walls = [next(i for i in bent if low < middle[i].x < high) for low, high in ((0, 2), (gap, gap + 1.5))]
    floor = next(i for i, at in enumerate(middle) if abs(at.z - 2) < 1e-6 and 1 < at.x < 5)
    return shape, walls, floor


def looks(shape, *way):
    """Number of the face that looks that way most."""
    way = Vector(*way)

    def toward(face):
        u, v = (sum(face.ParameterRange[k : k + 2]) / 2 for k in (0, 2))
        normal, point = face.normalAt(u, v), face.valueAt(u, v)
        return (-normal if shape.isInside(point + normal * 1e-3, 1e-7, False) else normal).dot(way)

    return max(range(len(shape.Faces)), key=lambda i: toward(shape.Faces[i]))


class LeaningTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("leaning")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def swept(self, shape, faces, mill, scallop_mm=0.05, **more):
        feature = self.document.addObject("Part::Feature", "Cut")
        feature.Shape = shape
        return read_faces(feature, [f"Face{face + 1}" for face in faces], mill, scallop_mm=scallop_mm, **{**FEEDS, **more})

    def check(self, shape, faces, radius, program, scallop_mm=0.05, every=6, least=-1.0):
        """No gouge, with the ball or its side, on passes, links and rapids; the scallop wherever the ball gets to."""
        poses = Poses(program, radius)
        deepest = poses.ball_gouge(shape, every)
        side = poses.side_gouge(cloud(shape, 3000, 3), every)
        worst = 0.0
        for face in faces:
            points, normals = outward_points(shape, shape.Faces[face], 2000, 1)
            above = poses.left_over(points, normals)
            high = above > 0.9 * scallop_mm
            free = reachable(shape, points[high], normals[high], radius)
            worst = max(worst, above[high][free].max(initial=0))
        print(f"ball {1e3 * max(deepest, 0):.2f} um, side {1e3 * max(side, 0):.2f} um in the part, left {1e3 * worst:.1f} um of {1e3 * scallop_mm:g}")
        self.assertLess(deepest, GOUGE_MM)
        self.assertLess(side, SIDE_MM)
        self.assertLess(worst, 1.05 * scallop_mm)
        self.assertGreater(worst, least * scallop_mm)
        return poses

    def angles(self, shape, face, poses):
        """Lead and tilt in degrees, as a stranger would measure them on the first pass."""
        surface = shape.Faces[face]
        inner = np.flatnonzero(poses.cut)[5:60:5]
        found = []
        for i in inner:
            centre = Vector(*poses.centre[i])
            near = surface.distToShape(Part.Vertex(centre))[1][0][0]
            normal = np.array(centre - near) / (centre - near).Length
            feed = poses.centre[i + 1] - poses.centre[i - 1]
            feed /= np.linalg.norm(feed)
            axis = poses.axis[i]
            lead = math.degrees(math.asin(axis @ feed))
            found.append((lead, math.degrees(math.atan2(axis @ np.cross(normal, feed), axis @ normal))))
        return np.array(found)


class AnglesTest(LeaningTest):
    def test_lead_is_toward_the_feed_and_tilt_to_its_left(self):
        shape = wavy(1)
        top = looks(shape, 0, 0, 1)
        for lead, tilt in ((15, 0), (0, 25), (-10, -30)):
            with self.subTest(lead=lead, tilt=tilt):
                program, left = self.swept(shape, [top], ball_end(2), along="u", lead_deg=lead, tilt_deg=tilt)
                self.assertEqual(left, [])
                found = self.angles(shape, top, Poses(program, 2))
                np.testing.assert_allclose(found, np.broadcast_to((lead, tilt), found.shape), atol=0.5)


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


class PassesTest(LeaningTest):
    def test_a_pass_is_one_curve_that_is_smooth_in_tip_and_axis(self):
        shape = wavy(1)
        program, _ = self.swept(shape, [looks(shape, 0, 0, 1)], ball_end(2), along="v", tilt_deg=15)
        curves = [move.curve for move in program.moves if hasattr(move, "curve") and move.curve.degree == 5]
        self.assertGreater(len(curves), 3)
        for curve in curves:
            inner = curve.knots[6:-6]
            self.assertEqual(len(set(inner)), len(inner))  # quintic with single knots: four derivatives are continuous
            self.assertEqual(len(curve.points[0]), 6)
            self.assertGreater(np.diff(np.unique(curve.knots)).min(), 0.02)  # mm, or it would hide a bend

    def test_passes_are_linked_along_the_part_and_go_to_and_fro_unless_there_is_a_lead(self):
        shape = wavy(1)
        for lead, lifted in ((0, False), (10, True)):
            program, _ = self.swept(shape, [looks(shape, 0, 0, 1)], ball_end(2), along="v", lead_deg=lead, tilt_deg=10)
            curves = [move.curve for move in program.moves if hasattr(move, "curve")]
            ways = [np.sign(curve.points[-1][1] - curve.points[0][1]) for curve in curves if curve.degree == 5]
            self.assertEqual(set(ways), {1.0} if lifted else {1.0, -1.0})
            links = [curve for curve in curves if curve.degree == 3]
            self.assertEqual(len(links), 0 if lifted else len(ways) - 1)

    def test_moves_follow_each_other_in_place_and_axis(self):
        shape = Part.makeCylinder(5, 6)
        program, _ = self.swept(shape, [looks(shape, -1, 0, 0)], ball_end(3), along="level", tilt_deg=45)
        at = None
        for move in program.moves:
            pose = getattr(getattr(move, "curve", None), "points", [None])[0]
            if pose is not None and at is not None:
                np.testing.assert_allclose(pose, at, atol=1e-7)
            if move.end is not None:
                at = move.curve.points[-1] if pose is not None else (*move.target.p, *move.target.axis)


class RefusalsTest(LeaningTest):
    def refused(self, text, mill=None, face=5, shape=None, **more):
        with self.assertRaisesRegex(JobRefused, text):
            self.swept(shape or Part.makeBox(8, 6, 3), [face], mill or ball_end(2), **{"scallop_mm": 0.1, **more})

    def test_angles_at_which_the_side_would_cut_are_refused_by_their_names(self):
        for name in ("lead_deg", "tilt_deg"):
            for value in (math.nan, math.inf, True, "10"):
                with self.subTest(name=name, value=value):
                    self.refused(name, **{name: value})
            self.refused("at most 80 are possible", **{name: 85})
        self.refused("at most 80 are possible", lead_deg=75, tilt_deg=75)
        self.refused("at most 80 are possible", tilt_deg=360)

    def test_other_mills_are_refused(self):
        self.refused("ball end", flat_end(2), tilt_deg=10)
        self.refused("ball end", bull_nose(2, 1), lead_deg=0)

    def test_axes_that_make_no_sense_are_refused(self):
        self.refused("not both", axis=(0, 0, 1), tilt_deg=10)
        self.refused("axis is", axis=(0, 0, 0))
        self.refused("axis is", axis=(0, 1))
        self.refused("axis is", axis=(math.nan, 0, 1))
        self.refused("below the tip", axis=(0, 0, -1))

    def test_what_cannot_be_reached_is_refused(self):
        self.refused("nothing of the faces can be cut.*does not point down", face=4, tilt_deg=0)  # its underside
        self.refused("stand along the planes", face=0, along=90, tilt_deg=30)
        pocket = Part.makeBox(10, 10, 10).cut(Part.makeBox(3, 3, 8, Vector(3, 3, 4)))
        floor = next(i for i, one in enumerate(pocket.Faces) if abs(one.CenterOfMass.z - 4) < 1e-6)
        self.refused("nothing of the faces can be cut.*too narrow", face=floor, shape=pocket, tilt_deg=0)

    def test_level_passes_and_a_low_crossing_are_refused_with_the_reason(self):
        self.refused("with five axes", along="level")
        self.refused("below its tip where it leans", tilt_deg=10, clearance_mm=4.5)
        self.refused("along", tilt_deg=10, along="w")


class ProgramTest(LeaningTest):
    def test_five_axis_machines_take_the_program(self):
        shape = Part.makeCylinder(15, 20)
        program, _ = self.swept(shape, [looks(shape, -1, 0, 0)], ball_end(5), scallop_mm=0.2, along="level", tilt_deg=60, tool=1, rpm=800)
        tools = {"Mounted": 1, "Tools": [{"ToolNumber": 1, "Length": 50, "Radius": 5}]}
        found = simulate(program, "TarusXYZCA", tools, rmac=str(pathlib.Path(os.environ["RMAC_BUILD"]) / "bin/rmac"))
        print(f"on TarusXYZCA {found.cycle_time_s:.1f} s for {found.length_mm:.0f} mm")
        self.assertGreater(found.length_mm, 5 * 2 * math.pi * 15)


if __name__ == "__main__":
    unittest.main()

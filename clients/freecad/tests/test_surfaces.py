"""Faces that are swept: what is left of the part is told by code that shares nothing with the sweep (swept_part.py)."""

import json
import math
import os
import pathlib
import unittest

import FreeCAD
import numpy as np
import Part
from swept_part import ball_gouge, face_points, left_over, mill_gouge, mill_left_over, reachable, tips

from rmac_freecad.jobs import JobRefused
from rmac_freecad.simulation import simulate
from rmac_freecad.surfaces import ball_end, bull_nose, flat_end, read_faces

import rmac  # isort: skip

Vector = FreeCAD.Vector
GOUGE_MM = 0.001
FEEDS = {"feed_mm_min": 600, "rapid_mm_min": 2000}


def wavy(seed, length=8.0, width=6.0, height=0.08):
    """A solid with a random bicubic face on top."""
    chance = np.random.default_rng(seed)
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(length * i / 4, width * j / 4, 6 + chance.uniform(-height, height)) for j in range(5)] for i in range(5)])
    return surface.toShape().extrude(Vector(0, 0, -8))


def facing_up(shape):
    """The face with the highest middle."""
    return max(range(len(shape.Faces)), key=lambda i: shape.Faces[i].CenterOfMass.z)


class SweptTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("swept")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def feature(self, shape):
        found = self.document.addObject("Part::Feature", "Cut")
        found.Shape = shape
        return found

    def swept(self, shape, faces, mill, scallop_mm=0.05, **more):
        return read_faces(self.feature(shape), [f"Face{face + 1}" for face in faces], mill, scallop_mm=scallop_mm, **{**FEEDS, **more})

    def check_ball(self, shape, faces, radius, scallop_mm, program, steepest_deg=80.0, every=12):
        places = tips(program)
        deepest = ball_gouge(shape, radius, places[::every])
        self.assertLess(deepest, GOUGE_MM)
        worst = 0
        for face in faces:
            points, normals = face_points(shape.Faces[face], 2000, 1, steepest_deg)
            above = left_over(points, normals, places, radius)
            high = above > 0.9 * scallop_mm
            free = reachable(shape, points[high], normals[high], radius)
            worst = max(worst, above[high][free].max(initial=0))
        print(f"cut into by {1e3 * max(deepest, 0):.2f} um, left {1e3 * worst:.1f} um of {1e3 * scallop_mm:g}")
        self.assertLess(worst, 1.05 * scallop_mm)
        return worst


class HeightsTest(SweptTest):
    def test_random_faces_keep_the_scallop_and_are_not_gouged(self):
        for seed, along in ((1, 0), (2, 35)):
            with self.subTest(seed=seed, along=along):
                shape = wavy(seed, 4, 3, 0.02)
                face = facing_up(shape)
                program, left = self.swept(shape, [face], ball_end(2), along=along)
                self.assertEqual(left, [])
                worst = self.check_ball(shape, [face], 2, 0.05, program)
                self.assertGreater(worst, 0.95 * 0.05)

    def test_faces_bent_as_much_as_the_mill_keep_the_scallop(self):
        shape = wavy(5, 3, 2, 0.06)
        face = facing_up(shape)
        program, left = self.swept(shape, [face], ball_end(1))
        self.assertRegex(" ".join(left), "^Face5: .* too narrow for the mill$")  # and no place that is left too high
        self.check_ball(shape, [face], 1, 0.05, program)

    def test_isolines_do_as_planes_do(self):
        shape = wavy(3, 6, 4, 0.05)
        face = facing_up(shape)
        program, _ = self.swept(shape, [face], ball_end(2), along="v")
        self.assertGreater(self.check_ball(shape, [face], 2, 0.05, program), 0.95 * 0.05)

    def test_a_bull_nose_does_not_gouge_where_it_bridges(self):
        shape = wavy(4, 3, 2, 0.04)
        face = facing_up(shape)
        program, left = self.swept(shape, [face], bull_nose(1, 0.3), scallop_mm=0.15)
        self.assertIn("too narrow", " ".join(left))
        self.assertLess(mill_gouge(1, 0.3, tips(program)[::4], face_points(shape.Faces[face], 5000, 1)[0]), GOUGE_MM)

    def test_bull_noses_and_flat_ends_keep_the_scallop_on_slopes(self):
        shape = Part.makeCylinder(4, 2, Vector(0, 0, 0), Vector(1, 0, 0)).common(Part.makeBox(9, 4, 9, Vector(-1, 0.5, 0)))
        face = next(i for i, f in enumerate(shape.Faces) if isinstance(f.Surface, Part.Cylinder))
        points, normals = face_points(shape.Faces[face], 600, 1, 45)
        cloud = face_points(shape.Faces[face], 5000, 2)[0]
        for mill, along in ((bull_nose(1.5, 0.5), 90), (flat_end(1.5), 0)):
            with self.subTest(mill=mill):
                program, _ = self.swept(shape, [face], mill, scallop_mm=0.1, along=along, steepest_deg=45)
                places = tips(program)
                up = mill_left_over(mill.radius_mm, mill.corner_mm, points, normals, places, 0.1 * np.arange(0, 1.5, 0.025))
                self.assertLess(up.max(), 1.05 * 0.1)
                self.assertGreater(up.max(), 0.7 * 0.1)
                self.assertLess(mill_gouge(mill.radius_mm, mill.corner_mm, places[::4], cloud), GOUGE_MM)

    def test_a_flat_end_cuts_a_plane_with_steps_below_its_diameter(self):
        shape = Part.makeBox(12, 15, 5)
        program, left = self.swept(shape, [facing_up(shape)], flat_end(3), scallop_mm=0.01)
        curves = [move.curve for move in program.moves if hasattr(move, "curve")]
        across = sorted({round(curve.points[0][1], 3) for curve in curves})
        self.assertEqual(left, [])
        self.assertLess(max(np.diff(across)), 6)
        self.assertLess(len(curves), 6)
        self.assertLess(across[0] - 3, 0)
        self.assertGreater(across[-1] + 3, 15)
        for curve in curves:
            for point in curve.points:
                self.assertTrue(0 <= point[2] - 5 <= 0.001, point)

    def test_a_pass_is_one_curve_without_a_bend_in_it(self):
        shape = wavy(1)
        program, _ = self.swept(shape, [facing_up(shape)], ball_end(2), along=90, scallop_mm=0.1)
        curves = [move.curve for move in program.moves if hasattr(move, "curve") and move.curve.degree == 5]
        for curve in curves:
            inner = curve.knots[6:-6]
            self.assertEqual(len(set(inner)), len(inner))  # quintic with single knots: four derivatives are continuous
        across = {round(curve.points[0][0], 3) for curve in curves}
        self.assertEqual(len(across), len(curves))  # none is in two
        self.assertGreater(len(curves), 3)
        at = None
        for move in program.moves:  # and moves follow each other
            if at and move.start:
                self.assertLess(math.dist(at, move.start), 1e-6)
            at = move.end or at


class PartsTest(SweptTest):
    def test_a_pit_narrower_than_the_mill_is_bridged_and_told(self):
        shape = Part.makeBox(8, 6, 6).cut(Part.makeSphere(1.5, Vector(4, 3, 6.3)))
        program, left = self.swept(shape, [i for i, f in enumerate(shape.Faces) if isinstance(f.Surface, Part.Sphere)] + [facing_up(shape)], ball_end(2))
        self.assertIn("too narrow", " ".join(left))
        self.assertLess(ball_gouge(shape, 2, tips(program)[::8]), GOUGE_MM)

    def test_a_neighbour_at_a_sharp_concave_edge_is_not_gouged(self):
        groove = Part.Face(Part.makePolygon([Vector(*p) for p in ((0, 0, 0), (0, 0, 4), (5, 0, 2), (10, 0, 6), (10, 0, 0), (0, 0, 0))]))
        shape = groove.extrude(Vector(0, 3, 0))
        faces = [i for i, f in enumerate(shape.Faces) if f.normalAt(0, 0).z > 0.5]
        self.assertEqual(len(faces), 2)
        for chosen, along in ((faces, 0), (faces[:1], 0), (faces[:1], 90)):
            with self.subTest(faces=chosen, along=along):
                program, _ = self.swept(shape, chosen, ball_end(1), scallop_mm=0.1, along=along)
                self.assertLess(ball_gouge(shape, 1, tips(program)[::8]), GOUGE_MM)

    def test_curves_meet_in_a_shallow_concave_edge_and_none_bends_through_it(self):
        for degrees in (5, 20, 35):  # by which the faces are bent
            up = math.tan(math.radians(degrees / 2))
            outline = [Vector(x, 0, z) for x, z in ((-6, 6 * up), (0, 0), (6.3, 6.3 * up), (6.3, -3), (-6, -3), (-6, 6 * up))]
            shape = Part.Face(Part.makePolygon(outline)).extrude(Vector(0, 1, 0))
            faces = [i for i, f in enumerate(shape.Faces) if f.normalAt(0, 0).z > 0.5]
            with self.subTest(degrees=degrees):
                program, _ = self.swept(shape, faces, ball_end(2), scallop_mm=0.05)
                curves = [move.curve for move in program.moves if hasattr(move, "curve") and move.curve.degree == 5]
                inner = [[point for point in (curve.points[0], curve.points[-1]) if abs(point[0]) < 1] for curve in curves]
                for ends in inner:  # a curve may go round a bend of 5 degrees within what the scallop allows
                    self.assertTrue((len(ends) == 1 and abs(ends[0][0]) < 0.001) or (not ends and degrees == 5), inner)
                self.assertGreater(len(curves), 1)
                for curve in curves:  # a bend would need spans of micrometres
                    long = math.dist(curve.points[0], curve.points[-1]) / (curve.knots[-1] - curve.knots[0])
                    self.assertGreater(np.diff(np.unique(curve.knots)).min() * long, 0.02)
                self.assertLess(ball_gouge(shape, 2, tips(program)[::8]), GOUGE_MM)

    def test_what_is_swept_leads_up_to_a_wall_where_it_is_upright_and_ends_there(self):
        torus = Part.makeBox(9, 5, 5, Vector(3, -2, -5)).cut(Part.makeTorus(6, 2.5))  # a groove whose walls stand upright at its rim
        pocket = Part.makeBox(9, 7, 6).cut(Part.makeBox(6, 4, 4, Vector(1.5, 1.5, 2)))
        pocket = pocket.makeFillet(1.3, [edge for edge in pocket.Edges if abs(edge.CenterOfMass.z - 2) < 1e-6])
        for shape, radius in ((torus, 1.2), (pocket, 1.1)):
            faces = [i for i, face in enumerate(shape.Faces) if isinstance(face.Surface, (Part.Toroid, Part.Cylinder, Part.Sphere))]
            with self.subTest(radius=radius):
                program, _ = self.swept(shape, faces, ball_end(radius), scallop_mm=0.08, steepest_deg=70)
                self.check_ball(shape, faces, radius, 0.08, program, 70)

    def test_a_face_with_a_hole_and_a_boss_is_swept_round_them(self):
        shape = Part.makeBox(10, 6, 4).cut(Part.makeCylinder(1.8, 10, Vector(3, 3, -1))).fuse(Part.makeCylinder(1, 7, Vector(7, 3, 0)))
        face = next(i for i, f in enumerate(shape.Faces) if isinstance(f.Surface, Part.Plane) and abs(f.CenterOfMass.z - 4) < 1e-6)
        program, _ = self.swept(shape, [face], ball_end(1.5), scallop_mm=0.1)
        self.assertLess(ball_gouge(shape, 1.5, tips(program)[::8]), GOUGE_MM)

    def test_spheres_and_cylinders_are_cut_where_they_look_up(self):
        ball = Part.makeSphere(5)
        program, left = self.swept(ball, [0], ball_end(2), scallop_mm=0.15, along="u", steepest_deg=60)
        self.assertRegex(left[0], "steeper")
        self.check_ball(ball, [0], 2, 0.15, program, 60)
        lying = Part.makeCylinder(4, 3, Vector(0, 0, 0), Vector(1, 0, 0))
        face = next(i for i, f in enumerate(lying.Faces) if isinstance(f.Surface, Part.Cylinder))
        program, left = self.swept(lying, [face], ball_end(2), scallop_mm=0.1, steepest_deg=60)
        self.check_ball(lying, [face], 2, 0.1, program, 60)

    def test_placed_reversed_and_compounded_faces_are_cut_where_they_stand(self):
        plain = Part.makeBox(8, 6, 3)
        face = facing_up(plain)
        expected, _ = self.swept(plain, [face], ball_end(2), scallop_mm=0.2)
        backward = plain.copy()
        backward.reverse()
        for shape in (backward, Part.makeCompound([plain]), plain.mirror(Vector(4, 3, 0), Vector(1, 0, 0))):
            program, _ = self.swept(shape, [facing_up(shape)], ball_end(2), scallop_mm=0.2)
            self.assertEqual(len(program), len(expected))
            np.testing.assert_allclose(tips(program)[:, 2].min(), tips(expected)[:, 2].min(), atol=1e-6)
        holder = self.document.addObject("App::Part", "Holder")
        feature = self.feature(plain)
        holder.addObject(feature)
        holder.Placement.Base, feature.Placement.Base = Vector(100, 0, 7), Vector(0, 50, 0)
        self.document.recompute()
        program, _ = read_faces(feature, [f"Face{face + 1}"], ball_end(2), scallop_mm=0.2, **FEEDS)
        np.testing.assert_allclose(tips(program).min(0) - tips(expected).min(0), (100, 50, 7), atol=1e-5)


class RefusalsTest(SweptTest):
    def refused(self, text, mill=None, names=("Face6",), **more):
        with self.assertRaisesRegex(JobRefused, text):
            feature = self.feature(Part.makeBox(8, 6, 3))
            read_faces(feature, names, mill or ball_end(2), **{"scallop_mm": 0.1, **FEEDS, **more})

    def test_what_is_no_number_is_refused_by_its_name(self):
        for name in ("scallop_mm", "tolerance_mm", "steepest_deg", "feed_mm_min", "rapid_mm_min", "plunge_mm_min", "rpm"):
            for value in (0, -1, math.nan, math.inf, True):
                with self.subTest(name=name, value=value):
                    self.refused(name, **{name: value})

    def test_mills_that_nobody_makes_are_refused(self):
        for make in (lambda: ball_end(-1), lambda: ball_end(math.nan), lambda: bull_nose(2, 3), lambda: flat_end(0), lambda: bull_nose(2, -1)):
            with self.assertRaises(JobRefused):
                make()

    def test_faces_that_are_not_there_or_cannot_be_reached_are_refused(self):
        self.refused("no face 'Face7'", names=["Face7"])
        self.refused("no face 'Edge1'", names=["Edge1"])
        self.refused("no face of", names=[])
        self.refused("no place that is less steep", names=["Face1"])
        self.refused("nothing of the faces can be cut.*below other places", names=["Face5"])

    def test_other_values_that_make_no_sense_are_refused(self):
        self.refused("quarter of the mill", scallop_mm=1)
        self.refused("clearance_mm", clearance_mm=2)
        self.refused("along", along="w")
        for value in (0, -1, 1.5, math.nan, math.inf, True, "1"):
            self.refused("tool is", tool=value)
        self.refused("at most 85", steepest_deg=90)

    def test_a_tolerance_above_the_scallop_does_no_harm(self):
        shape = Part.makeBox(8, 6, 3)
        program, _ = self.swept(shape, [facing_up(shape)], ball_end(2), scallop_mm=0.1, tolerance_mm=1)
        self.check_ball(shape, [facing_up(shape)], 2, 0.1, program)


class ProgramTest(SweptTest):
    def test_a_sweep_is_simulated_on_a_machine(self):
        shape = Part.makeBox(8, 6, 3)
        program, _ = self.swept(shape, [facing_up(shape)], ball_end(2), scallop_mm=0.1, tool=1, rpm=800)
        tools = {"Mounted": 1, "Tools": [{"ToolNumber": 1, "Length": 0, "Radius": 2}]}
        found = simulate(program, "DMACXYZ", tools, rmac=str(pathlib.Path(os.environ["RMAC_BUILD"]) / "bin/rmac"))
        self.assertGreater(found.length_mm, 8 * 5)
        feeds = [json.loads(move.params(0))["Feedrate"] for move in program.moves if move.method == "RMAC_CAM.SetFeedrate"]
        self.assertEqual(set(feeds), {600, 2000})
        self.assertEqual(str(program.place_of(len(program) - 1)), "Cut, command 1 (end)")
        self.assertTrue(any(isinstance(move, rmac.Nurbs) for move in program.moves))


if __name__ == "__main__":
    unittest.main()

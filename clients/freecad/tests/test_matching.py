"""Faces swept with a bull nose or a flat end whose lead goes with their curvature: nothing is cut into, no more than the scallop is left,
and it takes fewer passes than a ball end."""

import math
import os
import pathlib
import unittest
from types import SimpleNamespace

import numpy as np
import Part
from disc_part import DiscPoses, Skin
from leaning_case import FEEDS, GOUGE_MM, LeaningTest, Vector, looks
from leaning_part import outward_points

from rmac_freecad.jobs import JobRefused
from rmac_freecad.simulation import simulate
from rmac_freecad.surfaces import ball_end, bull_nose, flat_end, mill_of, plan_faces


def bowl(radius, seed=None, waves=0.0, size=(18.0, 14.0)):
    """A solid with a face on top that is bent so, upward or downward, and wavy."""
    chance = np.random.default_rng(seed)
    surface = Part.BSplineSurface()
    x, y = (np.linspace(-side / 2, side / 2, 7) for side in size)
    surface.interpolate([[Vector(a, b, 10 + (a * a + b * b) / (2 * radius) + chance.uniform(-waves, waves)) for b in y] for a in x])
    return surface.toShape().extrude(Vector(0, 0, -8))


def hollow(tool):
    """Of a block; and which of its faces is bent."""
    shape = Part.makeBox(16, 12, 8).cut(tool)
    return shape, next(i for i, face in enumerate(shape.Faces) if not isinstance(face.Surface, Part.Plane))


def dish(radius=30):
    return hollow(Part.makeSphere(radius, Vector(8, 6, radius + 5)))


def trough(radius=25):
    """Along Y."""
    return hollow(Part.makeCylinder(radius, 40, Vector(8, -10, radius + 5), Vector(0, 1, 0)))


class MatchingTest(LeaningTest):
    def matched(self, shape, faces, mill, scallop_mm=0.05, **more):
        names = [f"Face{face + 1}" for face in faces]
        return plan_faces("Part", shape, names, mill, scallop_mm=scallop_mm, feed_mm_min=FEEDS["feed_mm_min"], axis="matched", **more)

    def held(self, shape, faces, mill, plan, scallop_mm=0.05):
        """Against the part, on passes, links and rapids, at places that the sweep does not know."""
        poses = DiscPoses(plan.program("Part", FEEDS["rapid_mm_min"]), mill.radius_mm, mill.corner_mm)
        deepest = poses.gouge(Skin(shape, 6000, 3), 50, 5)
        left = [poses.left_over(*outward_points(shape, shape.Faces[face], 400, 1), 3 * scallop_mm) for face in faces]
        worst = max(one.max() for one in left)
        print(f"{len(plan.swept.passes)} passes, ball end {plan.swept.ball_passes}; {1e3 * max(deepest, 0):.2f} um in the part, left {1e3 * worst:.1f} um of {1e3 * scallop_mm:g}")
        self.assertLess(deepest, GOUGE_MM)
        self.assertLess(worst, 1.05 * scallop_mm)
        return deepest


class PartsTest(MatchingTest):
    def test_smooth_faces_take_fewer_passes_than_with_a_ball_end(self):
        for name, radius, mill, along, share in (
            ("bowl", 40, bull_nose(5, 1), "u", 0.5),
            ("bowl, small corner, aslant", 30, bull_nose(4, 0.5), 30, 0.6),
            ("hill", -30, bull_nose(5, 1), "v", 0.7),
            ("bowl, hardly a corner", 40, bull_nose(5, 0.01), "u", 0.5),
        ):
            with self.subTest(name):
                shape = bowl(radius)
                top = looks(shape, 0, 0, 1)
                plan = self.matched(shape, [top], mill, along=along)
                self.assertEqual(plan.left_out, [])
                self.held(shape, [top], mill, plan)
                self.assertLess(len(plan.swept.passes), share * plan.swept.ball_passes)

    def test_a_flat_end_keeps_off_by_the_width_of_its_curves_and_half_of_it(self):
        """Held as one that is a fortieth of the scallop larger, and lifted by half of that, of which curves may be off by 0.35."""
        for name, radius, along, share in (("bowl", 40, "u", 0.5), ("dome", -30, "v", 0.7)):
            with self.subTest(name):
                shape = bowl(radius)
                top = looks(shape, 0, 0, 1)
                plan = self.matched(shape, [top], flat_end(5), along=along)
                self.assertEqual(plan.left_out, [])
                self.assertAlmostEqual(self.held(shape, [top], flat_end(5), plan), -1.5 * 0.05 / 40, delta=0.4 * 0.05 / 40)
                self.assertLess(len(plan.swept.passes), share * plan.swept.ball_passes)

    def test_wavy_faces_keep_the_scallop_and_are_not_gouged(self):
        for seed, along in ((1, "u"), (2, 20)):
            with self.subTest(seed=seed):
                shape, mill = bowl(60, seed, 0.03), bull_nose(4, 1)
                top = looks(shape, 0, 0, 1)
                plan = self.matched(shape, [top], mill, along=along)
                self.assertEqual(plan.left_out, [])
                self.held(shape, [top], mill, plan)

    def test_troughs_are_swept_along_and_across(self):
        shape, face = trough()
        for along in (0, 90):
            with self.subTest(along=along):
                plan = self.matched(shape, [face], bull_nose(5, 1), along=along)
                self.assertEqual(plan.left_out, [])
                self.held(shape, [face], bull_nose(5, 1), plan)

    def test_beside_a_wall_the_part_is_not_touched_and_what_is_left_is_told(self):
        shape = dish()[0].fuse(Part.makeBox(4, 12, 25, Vector(16, 0, 0))).removeSplitter()
        face = next(i for i, one in enumerate(shape.Faces) if isinstance(one.Surface, Part.Sphere))
        plan = self.matched(shape, [face], bull_nose(4, 1), along=90)
        self.assertRegex(" ".join(plan.left_out), "^Face[0-9]+: [0-9.]+ % is (bent|beside)")
        poses = DiscPoses(plan.program("Part", 2000), 4, 1)
        self.assertLess(poses.gouge(Skin(shape, 6000, 3), 50, 5), GOUGE_MM)
        points, normals = outward_points(shape, shape.Faces[face], 400, 1)
        self.assertLess(poses.left_over(points[points[:, 0] < 7], normals[points[:, 0] < 7], 0.2).max(), 1.05 * 0.05)

    def test_a_face_bent_more_than_the_disc_is_told(self):
        shape, face = trough(6)
        for mill in (bull_nose(8, 1), flat_end(8)):
            with self.assertRaisesRegex(JobRefused, "nothing of the faces can be cut.*give a smaller mill"):
                self.matched(shape, [face], mill, along=90)

    def test_a_closed_pass_overlaps_itself_so_that_its_seam_needs_no_other(self):
        shape = Part.makeCylinder(12, 6)
        face = next(i for i, one in enumerate(shape.Faces) if isinstance(one.Surface, Part.Cylinder))
        plan = self.matched(shape, [face], flat_end(4), along="level")
        self.assertEqual(plan.left_out, [])
        self.assertLess(len(plan.swept.passes), plan.swept.ball_passes)
        self.held(shape, [face], flat_end(4), plan)


class LeadTest(MatchingTest):
    def test_in_a_dish_the_disc_lies_in_a_circle_of_the_sphere(self):
        """The middle of the disc is a leg, its corner's centre the hypotenuse, both from the sphere's centre."""
        shape, face = dish(30)
        for corner in (0, 2):
            plan = self.matched(shape, [face], bull_nose(5, corner), along=0)
            poses = DiscPoses(plan.program("Part", 2000), 5, corner)
            within = poses.cut & (poses.middle[:, 0] > 3) & (poses.middle[:, 0] < 10)  # beyond the face passes go on straight
            way = np.array((8, 6, 35)) - poses.middle[within]
            off = np.degrees(np.arccos((way * poses.axis[within]).sum(1) / np.linalg.norm(way, axis=1)))
            self.assertLess(off.max(), 0.5)  # the axis goes through the middle of the sphere: all of the disc's rim is as near
            np.testing.assert_allclose(np.linalg.norm(way, axis=1), math.sqrt((30 - corner) ** 2 - (5 - corner) ** 2), atol=0.02)

    def test_on_a_plane_the_lead_is_the_least(self):
        shape = Part.makeBox(12, 9, 4)
        top = looks(shape, 0, 0, 1)
        endmill = mill_of(SimpleNamespace(Label="Mill", Tool=SimpleNamespace(ShapeName="endmill", Diameter=8)))
        for mill, least in ((bull_nose(4, 1), 3.0), (endmill, 8.0)):
            plan = self.matched(shape, [top], mill, along=0, lead_deg=least)
            poses = DiscPoses(plan.program("Part", 2000), mill.radius_mm, mill.corner_mm)
            angles = np.degrees(np.arcsin(poses.axis[poses.cut] @ (1, 0, 0)))
            np.testing.assert_allclose(angles, np.broadcast_to(least, angles.shape), atol=0.05)


class RefusalsTest(MatchingTest):
    def refused(self, text, mill=None, **more):
        with self.assertRaisesRegex(JobRefused, text):
            self.matched(Part.makeBox(8, 6, 3), [5], mill or bull_nose(2, 0.5), **more)

    def test_a_mill_that_has_no_disc_is_refused(self):
        self.refused("a ball end has no disc.*give flat_end", ball_end(2))

    def test_leads_and_tilts_that_make_no_sense_are_refused(self):
        for least in (0, -3, 46, math.nan, True, "3"):
            self.refused("lead_deg is", lead_deg=least)
        self.refused("not both", tilt_deg=10)

    def test_other_words_for_an_axis_are_refused(self):
        with self.assertRaisesRegex(JobRefused, "axis is 'match'"):
            self.swept(Part.makeBox(8, 6, 3), [5], bull_nose(2, 0.5), axis="match")


class ProgramTest(MatchingTest):
    def test_five_axis_machines_take_the_program_and_the_passes_saved_are_told(self):
        shape, face = dish()
        plan = self.matched(shape, [face], bull_nose(5, 1), along=0, tool=1, rpm=800)
        self.assertEqual(plan.told, f"{len(plan.swept.passes)} passes instead of {plan.swept.ball_passes} with a ball end of the same radius and scallop, and nothing is left out.")
        tools = {"Mounted": 1, "Tools": [{"ToolNumber": 1, "Length": 50, "Radius": 5}]}
        found = simulate(plan.program("Part", 2000), "TarusXYZCA", tools, rmac=str(pathlib.Path(os.environ["RMAC_BUILD"]) / "bin/rmac"))
        print(f"on TarusXYZCA {found.cycle_time_s:.1f} s")
        self.assertGreater(found.length_mm, len(plan.swept.passes) * 16)


if __name__ == "__main__":
    unittest.main()

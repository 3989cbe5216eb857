"""The passes that sweep a face with five axes: their angles, curves and links, and what is refused."""

import math
import os
import pathlib
import unittest

import numpy as np
import Part
from leaning_case import LeaningTest, Vector, looks, wavy
from leaning_part import Poses

from rmac_freecad.jobs import JobRefused
from rmac_freecad.simulation import simulate
from rmac_freecad.surfaces import ball_end, bull_nose, flat_end, plan_faces


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
        self.refused("lead_deg is 1000000000.0", lead_deg=1e9)
        self.refused("steepest_deg is 200", tilt_deg=10, steepest_deg=200)
        self.refused("along is 1e\\+300", tilt_deg=10, along=1e300)

    def test_other_mills_are_refused(self):
        self.refused("ball end", flat_end(2), tilt_deg=10)
        self.refused("ball end", bull_nose(2, 1), lead_deg=0)
        for radius in (1e9, math.inf, 0, -1, True, "2"):
            with self.assertRaisesRegex(JobRefused, "radius_mm is"):
                ball_end(radius)

    def test_faces_that_are_no_list_of_names_are_refused(self):
        for names in (None, "Face1", 6):
            with self.assertRaisesRegex(JobRefused, "give a list of names"):
                plan_faces("Box", Part.makeBox(8, 6, 3), names, ball_end(2), scallop_mm=0.1, feed_mm_min=600)

    def test_axes_that_make_no_sense_are_refused(self):
        self.refused("not both", axis=(0, 0, 1), tilt_deg=10)
        self.refused("axis is", axis=(0, 0, 0))
        self.refused("axis is", axis=(0, 1))
        self.refused("axis is", axis=(math.nan, 0, 1))
        self.refused("axis is", axis=(True, 0, 1))
        self.refused("axis is", axis="up")
        self.refused("axis is", axis=5)
        self.refused("below the tip", axis=(0, 0, -1))

    def test_what_cannot_be_reached_is_refused(self):
        self.refused("nothing of the faces can be cut.*does not point down", face=4, tilt_deg=0)  # its underside
        self.refused("stand along the planes", face=0, along=90, tilt_deg=30)
        pocket = Part.makeBox(10, 10, 10).cut(Part.makeBox(3, 3, 8, Vector(3, 3, 4)))
        floor = next(i for i, one in enumerate(pocket.Faces) if abs(one.CenterOfMass.z - 4) < 1e-6)
        self.refused("nothing of the faces can be cut.*too narrow", face=floor, shape=pocket, tilt_deg=0)

    def test_a_slot_that_is_hardly_wider_than_the_mill_tells_how_near_its_side_may_pass(self):
        slot = Part.makeBox(30, 10, 20).cut(Part.makeBox(30, 4.3, 15, Vector(0, 3, 5)))  # 0.15 mm to each side of the mill
        floor = next(i for i, one in enumerate(slot.Faces) if abs(one.CenterOfMass.z - 5) < 1e-6)
        self.refused("pass it by less than 0.16 mm, with any axis that does not point down. Passes are up to 1.26 mm apart", face=floor, shape=slot, tilt_deg=30, mill=ball_end(2), scallop_mm=0.1)
        self.refused("pass it by less than 0.1 mm, with the axis that was given", face=floor, shape=slot, axis=(0, 0, 1), mill=ball_end(2), scallop_mm=0.1)

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

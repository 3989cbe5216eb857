"""A motion that was recorded becomes a program that goes through it."""

import pathlib
import sys
import unittest

import numpy as np
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1])]

import chain  # noqa: E402
import replay  # noqa: E402
import sweeps  # noqa: E402
import verdict  # noqa: E402


def measured():
    """MoveIDs and joints: from above, down, over the block with a bump of 5 µm as a joint that turns round makes it, a rest, and up."""
    spline = sweeps.sweep(2.0, 1, -1)
    over = spline(np.linspace(spline.t[0], spline.t[-1], 3000))
    down = over[:1] + np.linspace(30, 0, 400)[:, None] * np.concatenate([over[0, 3:], np.zeros(3)])
    joints = np.array([chain.joints(pose) for pose in np.concatenate([down, over, np.repeat(over[-1:], 200, axis=0), down[::-1]])])
    joints[1500:1560, 1] += 5e-3 * np.sin(np.linspace(0, np.pi, 60))
    return np.repeat([2, sweeps.DOWN, sweeps.FIRST_SWEEP, sweeps.FIRST_SWEEP + 2], [200, 200, 3200, 400]), joints


class Replay(unittest.TestCase):
    def setUp(self):
        self.moves, self.joints = measured()
        self.requests = replay.program(self.moves, self.joints)
        self.curves = [r["params"]["NurbsND"] for r in self.requests if r["method"].endswith("NurbsND")]

    def test_its_curves_go_through_all_that_was_recorded_between_down_and_up(self):
        way = np.concatenate([BSpline(np.array(c["knots"]), np.array(c["points"]), c["degree"])(np.linspace(0, c["knots"][-1], 40000)) for c in self.curves])
        cut = (self.moves >= sweeps.DOWN) & (self.moves < self.moves.max())
        tips = chain.places(self.joints[cut], 0)
        apart, near = cKDTree(way[:, :3]).query(tips)
        self.assertLess(1000 * apart.max(), 1.5, "half of the way between two of the 40000 places")
        axes = chain.places(self.joints[cut], 1) - tips
        self.assertLess(np.abs(way[near, 3:] - axes).max(), 2e-4)

    def test_each_curve_begins_where_the_one_before_ends_and_the_first_where_the_joints_are_put(self):
        (target,) = (r["params"]["JointTargetFrame"]["joints"] for r in self.requests if r["method"].endswith("MoveToJointTarget"))
        np.testing.assert_allclose(chain.places(np.array([target]), 0)[0], self.curves[0]["points"][0][:3], atol=1e-9)
        for before, behind in zip(self.curves, self.curves[1:]):
            np.testing.assert_allclose(before["points"][-1], behind["points"][0], atol=1e-9)


class Rays(unittest.TestCase):
    RESOLUTION = 0.5

    def surface(self, higher):
        """Corners on rays along z, and others that are on none of them, as marching cubes have them."""
        x, y = np.meshgrid(np.arange(-29.75, 30, 0.5), np.arange(-19.75, 20, 0.5))
        on = verdict.dome.surface(x.ravel(), y.ravel())[0] + [0, 0, higher]
        off = on[: len(on) // 2] + [0.13, 0, 0.7]
        return np.random.default_rng(5).permutation(np.concatenate([on, off]).astype(np.float32).astype(float))

    def test_a_surface_that_is_higher_is_told_so_along_its_normal(self):
        off = verdict.between_rays_um(self.surface(0), self.surface(3e-3), self.RESOLUTION)
        self.assertEqual(len(off), 120 * 80)
        normals = verdict.dome.surface(*np.meshgrid(np.arange(-29.75, 30, 0.5), np.arange(-19.75, 20, 0.5)))[1]
        np.testing.assert_allclose(np.sort(off), np.sort(3 * normals[..., 2].ravel()), atol=0.01)

    def test_rays_that_one_surface_lacks_are_not_compared(self):
        some = self.surface(0)
        self.assertEqual(len(verdict.between_rays_um(some, some[some[:, 0] < 0], self.RESOLUTION)), 60 * 80)


if __name__ == "__main__":
    unittest.main()

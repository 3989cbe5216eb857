"""The verdict: each thing that can be wrong with a run is seen."""

import pathlib
import sys
import types
import unittest

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1])]

import chain  # noqa: E402
import clamping  # noqa: E402
import sweeps  # noqa: E402
import verdict  # noqa: E402

MOVE = sweeps.FIRST_SWEEP
FINDING = {"bodies": verdict.BODIES, "certain": True, "move_id": MOVE}


def joints_of_sweep(y):
    return np.array([chain.joints(pose) for pose in sweeps.poses(np.linspace(-25, 25, 2501), y, -1)])


def problems(finding=FINDING, held_in=MOVE, state="Holding", warning=""):
    found = [finding] if finding else []
    first = types.SimpleNamespace(told={"collisions": found}, finding=lambda: found[0])
    held = types.SimpleNamespace(move_id=held_in, state=state)
    return list(verdict.problems(first, held, types.SimpleNamespace(warning=warning)))


class Figures(unittest.TestCase):
    def test_a_figure_is_fine_within_its_bounds_alone(self):
        for value, fine in ((1, True), (0.4, False), (2.1, False), (float("nan"), False), (float("inf"), False)):
            self.assertEqual(verdict.Figure("", value, "mm", 0.5, 2).ok(), fine, value)

    def test_time_in_motion_leaves_out_rests_at_both_ends(self):
        joints = np.concatenate([np.zeros(50), np.arange(1, 101), np.full(70, 100.0)])[:, None]
        self.assertAlmostEqual(verdict.in_motion_s(joints), 0.1)

    def test_joints_that_are_off_leave_a_part_that_is_off(self):
        joints = joints_of_sweep(4.0)
        x = np.linspace(-20, 20, 300)
        cut = verdict.dome.surface(x, 0 * x + 4)[0]
        face = np.array([[0, 4, 0.0]])
        exact, faces = verdict.off_um(cut, face, joints)
        self.assertLess(np.abs(exact).max(), 0.01)
        self.assertEqual(faces[0], 0, "material that nothing cut is not off")
        for joint, by in ((2, 3e-3), (3, 2e-2), (4, 2e-2)):
            moved = joints.copy()
            moved[:, joint] += by
            expected = np.einsum("ij,ij->i", verdict.swept.motion(moved).middle - verdict.swept.motion(joints).middle,
                                 verdict.dome.surface(np.linspace(-25, 25, 2501), 4.0)[1])  # fmt: skip
            off, _ = verdict.off_um(cut, face, moved)
            self.assertAlmostEqual(verdict.rms(off), 1000 * np.sqrt((np.interp(x, np.linspace(-25, 25, 2501), expected) ** 2).mean()), delta=0.05)
            self.assertGreater(verdict.rms(off), 0.1)

    def test_a_tool_that_went_through_the_block_is_seen_on_its_faces(self):
        through = np.array([chain.joints(np.array([0, y, 5, 0, 0, 1.0])) for y in np.linspace(-30, 30, 601)])
        _, faces = verdict.off_um(np.array([[20.0, 0, 18]]), np.array([[0, -20, 10.0]]), through)
        self.assertAlmostEqual(faces[0], -1000 * clamping.BALL_RADIUS, delta=1)


class Problems(unittest.TestCase):
    def test_a_good_run_has_none(self):
        self.assertEqual(problems(), [])

    def test_each_thing_that_is_wrong_is_said(self):
        for changes, words in (
                ({"finding": None}, "was planted"),
                ({"finding": FINDING | {"bodies": ["jaw", verdict.BODIES[1]]}}, "was planted"),
                ({"finding": FINDING | {"certain": False}}, "was planted"),
                ({"held_in": MOVE + 2}, f"in move {MOVE + 2}"),
                ({"state": "Running"}, "is Running"),
                ({"finding": FINDING | {"move_id": 3}, "held_in": 3}, "before it cuts"),
                ({"warning": "tool 1 has no shape"}, "no shape")):  # fmt: skip
            with self.subTest(words):
                self.assertIn(words, " ".join(problems(**changes)))


if __name__ == "__main__":
    unittest.main()

"""Frames, and what is told for an animation; no sockets."""

import math
import random
import unittest

from rmac.animation import read_animation, read_geometry
from rmac.geometry.frame import Frame

TOLD = {
    "geometry": 3, "machine": "Mill", "missing": "", "virtual": True, "tool": None,
    "part_frame": {"p": [1, 2, 3], "q": [1, 0, 0, 0]}, "tool_frame": {"p": [0, 0, -80], "q": [1, 0, 0, 0]},
    "samples": [{
        "cycle": 7, "t_s": 0.007, "moving": True, "move_id": 4, "pose": [1, 2, 3, 0, 0, 1], "joints": [10, 20],
        "links": {
            "base": {"p": [0, 0, 0], "q": [1, 0, 0, 0]},
            "spindle": {"p": [0, 0, 20], "q": [0, 1, 0, 0]},
            "table": {"p": [-10, 0, 0], "q": [1, 0, 0, 0]},
        },
    }],
}  # fmt: skip


def some_frame(draw):
    q = [draw.gauss(0, 1) for _ in range(4)]
    size = math.hypot(*q)
    return Frame(tuple(draw.uniform(-100, 100) for _ in range(3)), tuple(part / size for part in q))


class FrameTest(unittest.TestCase):
    def near(self, one, other, seed):
        for a, b in zip(one, other):
            self.assertAlmostEqual(a, b, places=9, msg=f"seed {seed}")

    def test_a_quarter_turn_about_z_takes_x_to_y(self):
        turn = Frame((5, 0, 0), (math.sqrt(0.5), 0, 0, math.sqrt(0.5)))
        self.near(turn.point((1, 0, 0)), (5, 1, 0), "none")

    def test_frames_in_frames_are_their_points_in_each(self):
        for seed in range(100):
            draw = random.Random(seed)
            outer, inner = some_frame(draw), some_frame(draw)
            point = tuple(draw.uniform(-9, 9) for _ in range(3))
            self.near(outer.times(inner).point(point), outer.point(inner.point(point)), seed)
            self.near(outer.inverse().point(outer.point(point)), point, seed)
            self.near(outer.inverse().times(outer).p, (0, 0, 0), seed)


class AnimationTest(unittest.TestCase):
    def test_the_tip_is_below_the_spindle_that_carries_it(self):
        geometry = read_geometry({
            "geometry": 3, "machine": "Mill", "missing": "", "joints": ["X", "Z"], "links": ["base", "spindle", "table"],
            "interface": {"p": [0, 0, 100], "q": [1, 0, 0, 0]}, "bodies": [],
        })  # fmt: skip
        told = read_animation(TOLD)
        tip = told.tip(told.samples[0], geometry)
        # The spindle is turned upside down: its interface is 100 below its place, and the tool points up from there.
        self.assertEqual(tip.p, (0, 0, 20 - 100 + 80))
        self.assertEqual(told.part(told.samples[0]).p, (-9, 2, 3))

    def test_a_machine_of_which_nothing_is_known_has_no_samples_and_says_why(self):
        told = read_animation(TOLD | {"machine": None, "missing": "no machine is loaded", "samples": []})
        self.assertEqual((told.machine, told.samples, told.missing), (None, (), "no machine is loaded"))
        geometry = read_geometry({"geometry": 1, "machine": None, "missing": "no machine is loaded", "joints": [],
                                  "links": [], "interface": None, "bodies": []})  # fmt: skip
        self.assertIsNone(geometry.interface)

    def test_bodies_have_what_a_device_json_says_of_them(self):
        body = {"Name": "nose", "Link": "Z", "Shape": {"Sphere": {"Radius": 4}}, "Pose": {"p": [0, 0, 5], "q": [1, 0, 0, 0]}}
        told = {"geometry": 1, "machine": "Mill", "missing": "", "joints": [], "links": [], "interface": None}
        plain, coloured = read_geometry(told | {"bodies": [body, body | {"Colour": "#102030"}]}).bodies
        self.assertEqual((plain.name, plain.link, plain.shape, plain.pose.p), ("nose", "Z", {"Sphere": {"Radius": 4}}, (0, 0, 5)))
        self.assertEqual((plain.colour, coloured.colour), ("", "#102030"))


if __name__ == "__main__":
    unittest.main()

"""The simulated part is the one that was cut: each test moves a cutter, and the part must show by how much."""

import json
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import numpy as np  # noqa: E402

import world  # noqa: E402

UP, RIGHT = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


def line(start, end, count=4001):
    return np.linspace(start, end, count)


class AsCut(unittest.TestCase):
    def off(self, point, normal, *cuts):
        return float(world.as_cut(np.array([point], float), np.array([normal], float), cuts)[0])

    def test_a_ball_that_passes_a_place_leaves_it_as_high_as_its_tip(self):
        for height in (-0.02, 0.0, 0.03):
            cut = world.Cut(line((-5, 0, height), (5, 0, height)), 4.0, True)
            self.assertAlmostEqual(self.off((0, 0, 0), UP, cut), height, delta=1e-6)

    def test_between_two_passes_of_a_ball_the_scallop_stands(self):
        cuts = [world.Cut(line((-5, y, 0), (5, y, 0)), 4.0, True) for y in (-0.5, 0.5)]
        self.assertAlmostEqual(self.off((0, 0, 0), UP, *cuts), 4 - np.sqrt(16 - 0.25), delta=1e-6)

    def test_a_ball_on_a_slope_is_seen_along_its_normal(self):
        normal = np.array([-0.6, 0.0, 0.8])
        centre = (4.0 + 0.01) * normal
        cut = world.Cut(line(centre - (0, 1, 4), centre + (0, 1, -4)), 4.0, True)
        self.assertAlmostEqual(self.off((0, 0, 0), normal, cut), 0.01, delta=1e-6)

    def test_a_wall_is_where_the_side_of_an_end_mill_was_and_its_floor_where_the_tip_was(self):
        cut = world.Cut(line((2.02, -5, -3.04), (2.02, 5, -3.04)), 2.0, False)
        self.assertAlmostEqual(self.off((0, 0, -1), RIGHT, cut), 0.02, delta=1e-5)
        self.assertAlmostEqual(self.off((2, 0, -3), UP, cut), -0.04, delta=1e-9)

    def test_a_cutter_above_a_place_of_a_wall_does_not_cut_it(self):
        self.assertEqual(self.off((0, 0, -1), RIGHT, world.Cut(line((2, -5, 0), (2, 5, 0)), 2.0, False)), np.inf)

    def test_a_cutter_on_the_other_side_of_an_island_is_none_of_its(self):
        self.assertEqual(self.off((0, 0, -1), RIGHT, world.Cut(line((-8, -5, -3), (-8, 5, -3)), 2.0, False)), np.inf)

    def test_what_no_cutter_came_to_is_as_the_blank_was(self):
        np.testing.assert_array_equal(world.finished(np.array([np.inf, 5.0, 0.02, -0.1])), [0, 0, 0.02, -0.1])

    def test_flat_faces_are_flat_and_bent_ones_are_not(self):
        slope = [0.6, 0, 0.8]
        off = world.flattened(["a", "a", "b", "b"], np.array([UP, UP, slope, slope]), [0.01, 0.03, 0.01, 0.03])
        np.testing.assert_allclose(off, [0.02, 0.02, 0.01, 0.03])


class Clamped(unittest.TestCase):
    POINTS = np.array([[10.0, 0, -2], [0, 0, 0], [-5, 1, -1]])
    NORMALS = np.array([RIGHT, UP, [0.0, 0.6, 0.8]])

    def clamped(self, off, place=(0, 0, -30, 0), body=((-10, -10, -12, 10, 10, 0),), bores=()):
        with tempfile.TemporaryDirectory() as tree:
            file = pathlib.Path(tree) / "cmm/3-axis/CMM/device.json"
            file.parent.mkdir(parents=True)
            file.write_text(json.dumps({"DigitalIOInterface": {"Inputs": {"Probe": 0}}}))
            world.clamp(tree, place, self.POINTS, self.NORMALS, np.array(off), bores, body, 1.0)
            return json.loads(file.read_text())["DigitalIOInterface"]["Parameters"]

    def test_sides_of_blocks_are_where_the_cutter_left_them(self):
        part = self.clamped([0.05, -0.02, 0.0])
        np.testing.assert_allclose(part["part_block_mm"], [-10, -10, -12, 10.05, 10, -0.02])

    def test_a_ball_touches_a_bent_face_where_it_was_cut_and_the_part_lies(self):
        place = (0.3, -0.2, -30, 90)
        part = self.clamped([0, 0, 0.01], place)
        *centre, radius = part["sphere_mm"]
        surface = world.placed(place, self.POINTS[2] + 0.01 * self.NORMALS[2])
        self.assertAlmostEqual(np.linalg.norm(surface - centre), radius, delta=1e-9)
        np.testing.assert_allclose(surface, [0.3 - 1.006, -0.2 - 5, -30.992], atol=1e-9)
        self.assertEqual(part["part_place"], [0.3, -0.2, -30, 0, 0, 90])

    def test_more_than_a_description_holds_is_refused_and_not_left_out(self):
        with self.assertRaisesRegex(ValueError, "66 numbers of blocks"):
            self.clamped([0, 0, 0], body=((-10, -10, -12, 10, 10, 0),) * 11)


if __name__ == "__main__":
    unittest.main()

"""The figures of `./demo.sh measure` see what is wrong with a cut."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))

import numpy as np  # noqa: E402

import groove  # noqa: E402
from record import Record  # noqa: E402


def path_of(requests):
    """Points of a loop's lines and arcs, with their moves, as the requests say it."""
    moves, points = [], []
    for function, parameters in requests:
        start, end = (np.array(parameters[key]["p"]) for key in ("StartPoint", "EndPoint"))
        t = np.linspace(0, 1, 50)[:, None]
        if function == "MoveAlongLine":
            along = start + t * (end - start)
        else:
            centre = np.array(parameters["CenterPoint"]["p"])
            first, last = (np.arctan2(*(point - centre)[[1, 0]]) for point in (start, end))
            angle = first + t * ((last - first) % (2 * np.pi))
            along = centre + np.hypot(*(start - centre)[:2]) * np.hstack([np.cos(angle), np.sin(angle), 0 * angle])
        points.append(along)
        moves += [parameters["MoveID"]] * len(along)
    return np.array(moves), np.vstack(points)


def record_of(tips_in_part):
    """Joints that put the tip there in the part as it is clamped."""
    moves, points = tips_in_part
    turn = np.radians(groove.TURN_DEG)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    joints = points @ rotation.T + groove.PLACE_MM + [0, 0, groove.CUTTER_LENGTH]
    n = len(moves)
    return Record(np.arange(n), moves, np.zeros(n), np.zeros(n), np.zeros((n, 6)), *[joints] * 5)


class Groove(unittest.TestCase):
    def cut(self, name, shift=(0, 0, 0)):
        first_id, z, offset = groove.PASSES[name]
        moves, points = path_of(groove.loop(offset, z, first_id))
        return groove.off_pass(record_of((moves, points + np.array(shift))), name, record_of((moves, points + shift)).q)

    def test_cut_where_it_belongs_is_off_by_nothing(self):
        for name in groove.PASSES:
            _, wall, floor, points = self.cut(name)
            self.assertEqual(len(points), 9 * 50)
            self.assertLess(np.abs(wall).max(), 1e-9)
            self.assertLess(np.abs(floor).max(), 1e-9)

    def test_cut_beside_is_off_by_as_much(self):
        _, wall, floor, _ = self.cut("outer wall", (0.1, 0, -0.02))
        self.assertAlmostEqual(wall.max(), 0.1, delta=1e-9)
        self.assertAlmostEqual(wall.min(), -0.1, delta=1e-9)
        np.testing.assert_allclose(floor, -0.02, atol=1e-9)

    def test_roughing_leaves_more_than_the_part_can_be_off(self):
        corner = np.hypot(groove.HALF[0], groove.HALF[1])
        self.assertLess(np.linalg.norm(groove.PLACE_MM) + corner * np.radians(groove.TURN_DEG), groove.ALLOWANCE)


if __name__ == "__main__":
    unittest.main()

"""What rmac measure-following's program makes of a flight record, held against the circle that the joints went."""

import os
import pathlib
import random
import sys
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(os.environ["RMAC_SOURCE"], "gateway/rmac/plots")))
import measure_following  # noqa: E402

RADIUS, MOVE, CYCLES = 20.0, 3, 2000


def record_of(delays, centre, off):
    """Head and columns of a turn with a quarter of one on either side. Joints answer `delays` cycles late; `off(angle)`: how far they are off it."""
    angle = np.arange(-CYCLES // 4, CYCLES + CYCLES // 4) * 2 * np.pi / CYCLES
    wanted = RADIUS * np.array([np.cos(angle), np.sin(angle)]).T + centre
    error = off(angle)
    columns = {"move_id": np.where(angle < 0, MOVE - 1, np.where(angle < 2 * np.pi, MOVE, MOVE + 1)), "x": wanted[:, 0], "y": wanted[:, 1]}
    for joint, delay in enumerate(delays):
        columns[f"q{joint + 1}"] = wanted[:, joint]
        columns[f"a{joint + 1}"] = np.roll(wanted[:, joint] - error[:, joint], delay)
        columns[f"error{joint + 1}"] = np.roll(error[:, joint], delay)
    return {"joints": [{"unit": "mm", "answer_delay": delay} for delay in delays]}, columns


class Turns(unittest.TestCase):
    def test_a_turn_is_where_the_joints_were_however_late_they_tell_it(self):
        for seed in range(1, 31):
            dice = random.Random(seed)
            delays, centre = (dice.randint(0, 8), dice.randint(0, 8)), [dice.uniform(-50, 50), dice.uniform(-50, 50)]
            x, y = dice.uniform(-0.02, 0.02), dice.uniform(-0.02, 0.02)

            def off(angle, x=x, y=y):
                return np.array([x * np.sin(3 * angle), y * np.sign(np.cos(angle))]).T

            wanted, measured = measure_following.turn_of(*record_of(delays, centre, off), MOVE)
            with self.subTest(seed=seed, delays=delays):
                angle = np.arange(CYCLES) * 2 * np.pi / CYCLES
                truth = RADIUS * np.array([np.cos(angle), np.sin(angle)]).T
                self.assertLess(np.abs(wanted - truth).max(), 1e-3)
                self.assertLess(np.abs(wanted - measured - off(angle)).max(), 1e-9)


if __name__ == "__main__":
    unittest.main()

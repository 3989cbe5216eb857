"""What the recorder keeps of the samples that come."""

import pathlib
import sys
import unittest

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent)]

from recorder import STILL_ROWS, Recorder  # noqa: E402


def sample(cycle, q, moving=True):
    return {
        "cycle": cycle, "t_s": cycle * 1e-3, "moving": moving, "move_id": 7, "s_mm": 1.5, "feed_mm_s": 2.0,
        "pose": [q, 0.0, 0.0, 0.0, 0.0, 1.0], "q": [q, 0.0], "qd": [1.0, 0.0], "qdd": [0.0, 0.0],
        "a": [q + 0.001, 0.0], "held": [-25.0],
    }  # fmt: skip


class Rows(unittest.TestCase):
    def test_rests_are_cut_short_and_motion_is_whole(self):
        recorder = Recorder()
        for cycle in range(3000):
            recorder.add(sample(cycle, 0.0 if cycle < 1000 else min(cycle - 1000, 500) * 0.01))
        record = recorder.record()
        self.assertEqual(recorder.lost, 0)
        self.assertEqual(len(record.t), STILL_ROWS + 501 - 1 + STILL_ROWS)
        self.assertAlmostEqual(record.t[0], (1001 - STILL_ROWS) * 1e-3)

    def test_a_lost_sample_is_counted(self):
        recorder = Recorder()
        for cycle in (0, 1, 2, 5, 6):
            recorder.add(sample(cycle, cycle * 0.1))
        self.assertEqual(recorder.lost, 1)

    def test_a_record_of_nothing_is_an_error(self):
        recorder = Recorder()
        recorder.add(sample(0, 0.0))
        self.assertRaises(RuntimeError, recorder.record)


if __name__ == "__main__":
    unittest.main()

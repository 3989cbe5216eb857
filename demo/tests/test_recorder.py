"""What the recorder keeps of the samples that come."""

import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent)]

import numpy as np  # noqa: E402

from record import Record  # noqa: E402
from recorder import STILL_ROWS, Recorder  # noqa: E402


def sample(cycle, q, moving=True):
    return {
        "cycle": cycle, "t_s": cycle * 1e-3, "moving": moving, "move_id": 7, "s_mm": 1.5, "feed_mm_s": 2.0,
        "pose": [q, 0.0, 0.0, 0.0, 0.0, 1.0], "q": [q, 0.0], "qd": [1.0, 0.0], "qdd": [0.0, 0.0],
        "a": [q + 0.001, 0.0], "held": [-25.0], "truth": [q + 0.003, 0.01], "held_truth": [-25.02],
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

    def test_what_encoders_measured_and_the_truth_are_kept_apart_on_file_too(self):
        recorder = Recorder()
        for cycle in range(200):
            recorder.add(sample(cycle, 0.01 * cycle))
        kept = recorder.record()
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "record.csv"
            kept.write(file)
            self.assertIn(",a1,a2,a3,truth1,truth2,truth3", file.read_text().splitlines()[0])
            for record in (kept, Record.read(file)):
                np.testing.assert_allclose(record.a - record.q[:, [0, 1, 1]], [[0.001, 0, -25.0]] * 200, atol=1e-12)
                np.testing.assert_array_equal(record.truth[:, 1:], [[0.01, -25.02]] * 200)
                np.testing.assert_allclose(record.truth[:, 0] - record.q[:, 0], 0.003, atol=1e-12)

    def test_a_machine_that_does_not_tell_where_its_loads_are_is_not_taken_for_one_that_cuts_there(self):
        recorder = Recorder()
        for cycle in range(10):
            told = sample(cycle, 0.01 * cycle)
            del told["truth"], told["held_truth"]
            recorder.add(told)
        with self.assertRaisesRegex(RuntimeError, "does not tell where its loads truly are"):
            recorder.record()

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

"""Samples become arrays; what only some machines tell is there, or is None."""

import unittest

import numpy

from rmac.errors import RmacError
from rmac.records import Samples


def sample(cycle, **more):
    scalars = {"t_s": cycle / 1000, "move_id": 1, "moving": True, "s_mm": 0.5 * cycle, "feed_mm_s": 5.0, "feed_actual_mm_s": 5.1}
    joints = {name: [10.0 * k + cycle, 20.0 * k + cycle] for k, name in enumerate(("q", "qd", "qdd", "a", "ad", "effort", "error"))}
    return {"cycle": cycle, "pose": [1.0, 2.0, 3.0, 0.0, 0.0, 1.0], **scalars, **joints, **more}


def recorded(samples):
    taken = Samples(1000, 1000)
    taken.take(samples)
    return taken.record()


class Records(unittest.TestCase):
    def test_have_the_truth_where_it_is_told(self):
        record = recorded([sample(cycle, truth=[cycle + 0.25, -cycle]) for cycle in range(5)])
        numpy.testing.assert_array_equal(record.truth, [[cycle + 0.25, -cycle] for cycle in range(5)])
        numpy.testing.assert_array_equal(record.error[:, 0], [60.0 + cycle for cycle in range(5)])

    def test_have_none_where_nobody_tells_it(self):
        record = recorded([sample(cycle) for cycle in range(5)])
        self.assertIsNone(record.truth)
        numpy.testing.assert_array_equal(record.error[:, 1], [120.0 + cycle for cycle in range(5)])

    def test_are_of_one_machine(self):
        with self.assertRaisesRegex(RmacError, "another machine was loaded"):
            recorded([sample(0), sample(1, truth=[0.0, 0.0])])

    def test_count_what_did_not_come(self):
        self.assertEqual(recorded([sample(cycle) for cycle in (0, 1, 4, 5, 9)]).lost, 2)


if __name__ == "__main__":
    unittest.main()

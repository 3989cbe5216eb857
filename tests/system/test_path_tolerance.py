"""SetPathTolerance acts on the path: a corner is rounded within it, and met exactly without."""

import math
import unittest

from appliance import Appliance, line, wait_for_rest

CORNER = (5.0, 0.0)


class PathTolerance(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.operator = self.appliance.operator()
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["state"], rate_hz=1000)

    def nearest_to_corner(self, tolerance_mm):
        """How near the measured path of two lines comes to where they meet."""
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=2000)
        self.operator.call("RMAC_CAM.SetPathTolerance", Tolerance=tolerance_mm)
        self.assertEqual(self.operator.call("RMAC_CAM.GetPathTolerance"), tolerance_mm)
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (*CORNER, 0), move_id=1))
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((*CORNER, 0), (5, 5, 0), move_id=2))
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        nearest = math.inf
        while True:
            state = self.watcher.wait_note("state")
            nearest = min(nearest, math.dist(state["pose"][:2], CORNER))
            if state["pose"][1] > 4.9 and not state["moving"]:
                break
        wait_for_rest(self.operator)
        return nearest

    def test_a_corner_is_met_without_tolerance(self):
        self.assertLess(self.nearest_to_corner(0), 0.02)

    def test_a_corner_is_rounded_within_the_tolerance(self):
        nearest = self.nearest_to_corner(0.2)
        self.assertGreater(nearest, 0.05)
        self.assertLess(nearest, 0.22)

    def test_a_negative_tolerance_is_refused(self):
        self.operator.call("RMAC_CAM.SetPathTolerance", Tolerance=0.1)
        self.operator.refusal("RMAC_CAM.SetPathTolerance", Tolerance=-0.1)
        self.assertEqual(self.operator.call("RMAC_CAM.GetPathTolerance"), 0.1)

    def test_the_axis_has_a_tolerance_of_its_own(self):
        self.assertEqual(self.operator.call("RMAC_CAM.GetOrientationTolerance"), 0.1)
        self.operator.call("RMAC_CAM.SetOrientationTolerance", Tolerance=0.5)
        self.operator.refusal("RMAC_CAM.SetOrientationTolerance", Tolerance=-0.1)
        self.operator.refusal("RMAC_CAM.SetOrientationTolerance", Tolerance=11)
        self.assertEqual(self.operator.call("RMAC_CAM.GetOrientationTolerance"), 0.5)
        self.assertEqual(self.operator.call("RMAC_CAM.GetPathTolerance"), 0)


if __name__ == "__main__":
    unittest.main()

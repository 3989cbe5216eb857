"""Two motors that move X of DMACXYZ side by side, with nothing between them but the appliance."""

import unittest

from appliance import Appliance, line
from bending_mill import device_of, on_two_motors

PLACES = [(x, 0, 0) for x in (0, 20, -20, 20, -20, 20, -20)]
FRICTION = [0.015] * 4 + [0.0195] + [0.015] * 3  # N·m: the second motor of X has 1.3 times that of the first


class GantryTest(unittest.TestCase):
    def mill(self, gantry):
        appliance = Appliance(own_tree=True)
        on_two_motors(appliance)
        with device_of(appliance) as device:
            device["DigitalControlInterface"]["Parameters"]["friction_nm"] = FRICTION
            joint = device["Joints"][0]
            if gantry:
                kp, _, kd = joint["Gains"]
                joint["Gantry"] = {"MaxSkew": 0.2, "Stiffness": kp / 2, "Damping": kd / 2}
        return self.enterContext(appliance)

    def test_they_are_held_together_and_told_apart(self):
        appliance = self.mill(gantry=True)
        operator = appliance.operator()
        watcher = appliance.client("watcher")
        watcher.call("subscribe", topics=["drives"], rate_hz=1000)
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=2000)
        for number, (start, end) in enumerate(zip(PLACES, PLACES[1:]), 1):
            operator.call("RMAC_CAM.MoveAlongLine", **line(start, end, number))
        operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        samples = []
        while (state := operator.state())["moves_in_buffer"] > 0 or state["moving"]:
            self.assertNotEqual(state["state"], "Faulted", state["last_stop"])
            samples += watcher.wait_note("drives")["samples"]
        while not samples or samples[-1]["cycle"] < state["cycle"]:
            samples += watcher.wait_note("drives")["samples"]
        ahead = [sample["ahead"] for sample in samples]
        self.assertAlmostEqual(state["joints"][0], PLACES[-1][0], delta=0.05)
        self.assertGreater(len(ahead), 1000)
        self.assertTrue(all(one[2:] == [0, 0] for one in ahead), "the others move their joints alone")
        apart = max(abs(one[0] - one[1]) for one in ahead)
        self.assertLess(apart, 0.1)
        self.assertGreater(apart, 0.001)

    def test_where_nothing_holds_them_the_machine_is_not_loaded_and_it_is_told_what_to_do(self):
        done = self.mill(gantry=False).rmac("load", "DMACXYZ")
        self.assertEqual(done.returncode, 1)
        self.assertRegex(done.stderr, r"actuator [01] \(bus sim0, axis [04]\): the motors of its joint stand 0\.5\d* apart, beyond the bound "
                         r"of 0\.5 .*give the joint a Gantry with Stiffness and Damping")


if __name__ == "__main__":
    unittest.main()

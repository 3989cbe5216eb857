"""A machine that needs compressed air, which a valve on the output Coolant switches here."""

import json
import unittest

from appliance import Appliance, line, run_to_rest, wait_for_rest

VALVE_S = 0.05


class Air(unittest.TestCase):
    def setUp(self):
        self.appliance = Appliance(own_tree=True)
        file = self.appliance.tree / "mill/3-axis/DMACXYZ/device.json"
        device = json.loads(file.read_text())
        device["DigitalIOInterface"] = {"Module": "SimulatedValves", "Parameters": {"air": [0, 1, 0, VALVE_S]},
                                        "Inputs": {"Air": 1}, "Outputs": {"Coolant": 0}}
        file.write_text(json.dumps(device))
        self.enterContext(self.appliance)
        self.client = self.appliance.client("operator")
        self.client.call("authority.acquire")
        self.client.call("Device.Load", Name="DMACXYZ")
        self.client.call("subscribe", topics=["events"])

    def switch_air(self, on):
        self.client.call("RMAC_CAM.TurnCoolantOn" if on else "RMAC_CAM.TurnCoolantOff")
        while bool(self.client.state()["inputs"] & 2) != on:
            pass

    def test_nothing_starts_without_air(self):
        for method, params in (("RMAC_CAM.CycleStart", {"Mode": "AUTOMATIC"}), ("RMAC_CAM.Home", {}),
                               ("RMAC_CAM.JogJoint", {"JntNum": 0, "Distance": 5})):
            refused = self.client.refusal(method, **params)
            self.assertEqual(refused.minor, "MACHINE_ERR_NO_AIR")
            self.assertIn("no compressed air", refused.message)
        self.assertEqual(self.client.state()["moves_in_buffer"], 0, "what was refused is not queued")
        self.assertEqual(self.client.call("RMAC_CAM.StatusMinorCode"), 3)
        self.switch_air(True)
        self.client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=5)
        self.assertAlmostEqual(wait_for_rest(self.client)["joints"][0], 5, delta=0.05)

    def test_air_that_goes_off_stops_motion_on_its_path_and_keeps_the_program(self):
        self.switch_air(True)
        self.client.call("RMAC_CAM.Home")
        wait_for_rest(self.client)
        while self.client.state()["state"] != "Idle":
            pass
        self.client.call("subscribe", topics=["events"])
        self.client.call("RMAC_CAM.SetFeedrate", Feedrate=6)
        self.client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (30, 0, 0)))
        self.client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.client.wait_note("events", lambda event: event["kind"] == "MoveStarted" and event["move_id"] == 1)
        self.client.call("RMAC_CAM.TurnCoolantOff")
        stopped = self.client.wait_note("events", lambda event: event["kind"] == "Stopped")
        self.assertIn("compressed air went off", stopped["message"])
        self.assertEqual(self.client.call("RMAC_CAM.StatusMinorCode"), 3)
        state = self.client.state()
        self.assertEqual((state["state"], state["moves_in_buffer"]), ("Idle", 1))
        self.assertLess(state["joints"][0], 29)
        self.switch_air(True)
        self.client.call("RMAC_CAM.SetFeedOverride", Percent=200)
        self.assertAlmostEqual(run_to_rest(self.client)["joints"][0], 30, delta=0.05)


if __name__ == "__main__":
    unittest.main()

"""A measuring client on the wire: the measuring machine alone, and over the mill that is loaded."""

import json
import math
import unittest

from appliance import Appliance, pose, wait_for_rest
from bending_mill import device_of, rigid
from client import Refused

# Of drivers/cmm/3-axis/CMM/device.json: the block's top, the tip's radius.
TOP, RADIUS = -20.0, 1.0
COUNT = 10 / 1048576  # mm


class Measuring(unittest.TestCase):
    def setUp(self):
        """Where the measuring machine's axes are rigid: a hit is as exact as its time."""
        self.appliance = Appliance(own_tree=True)
        for machine in ("CMM", "SuginoXYZAC"):
            with device_of(self.appliance, machine) as device:
                rigid(device)
        self.enterContext(self.appliance)

    def operator(self, machine):
        client = self.appliance.operator(machine)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        return client

    def test_cmm_measures_the_height_of_its_part(self):
        client = self.operator("CMM")
        self.assertTrue(client.call("RMAC_CAM.ProbeActive"))
        self.assertFalse(client.call("RMAC_CAM.NewHit"))
        client.call("RMAC_CAM.Parameter", ParamNumber="MACH_RETRACT_DISTANCE", newVal=2)
        self.assertEqual(client.call("RMAC_CAM.Parameter", ParamNumber="MACH_RETRACT_DISTANCE"), 2)
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, x=15, y=0, z=-10, Speed=20)
        wait_for_rest(client)
        client.call("subscribe", topics=["events"])
        client.call("RMAC_CAM.AutoMeasure", MoveID=2, x=15, y=0, z=TOP + RADIUS, Speed=20)
        hit = client.wait_note("events", lambda event: event["kind"] == "Hit")
        client.wait_note("events", lambda event: event["kind"] == "MoveDone" and event["move_id"] == 2)
        self.assertAlmostEqual(hit["pose"][2], TOP + RADIUS, delta=1e-4 + COUNT)
        self.assertTrue(client.call("RMAC_CAM.NewHit"))
        self.assertEqual(client.call("RMAC_CAM.LastHitPosition"), hit["joints"])
        self.assertFalse(client.call("RMAC_CAM.NewHit"))
        self.assertTrue(client.call("RMAC_CAM.Ok"))

    def test_part_that_is_not_there_is_told_and_kept_in_the_status(self):
        client = self.operator("CMM")
        client.call("subscribe", topics=["events"])
        client.call("RMAC_CAM.AutoMeasure", MoveID=3, x=0, y=0, z=8, Speed=20)
        stopped = client.wait_note("events", lambda event: event["kind"] == "Stopped")
        self.assertIn("not where it was looked for", stopped["message"])
        self.assertFalse(client.call("RMAC_CAM.Ok"))
        self.assertEqual(client.call("RMAC_CAM.StatusMinorCode"), 9)
        client.call("RMAC_CAM.StatusMajorCode", newVal="MACHINE_SUCCESS")
        self.assertTrue(client.call("RMAC_CAM.Ok"))

    def test_moves_wait_for_a_measurement_and_a_program_goes_on_behind_it(self):
        self.assertEqual(self.appliance.rmac("load", "CMM").returncode, 0)
        requests = [("MoveToXYZ", {"MoveID": 1, "x": 15, "y": 0, "z": -10, "Speed": 20})]
        for i, x in enumerate((15, 12, -12, -15)):
            requests.append(("MoveToXYZ", {"MoveID": 10 * i + 2, "x": x, "y": 0, "z": -12, "Speed": 20}))
            requests.append(("AutoMeasure", {"MoveID": 10 * i + 3, "x": x, "y": 0, "z": TOP + RADIUS, "Speed": 20}))
        program = self.appliance.folder / "four.rmac"
        program.write_text("".join(
            json.dumps({"jsonrpc": "2.0", "id": i, "method": "RMAC_CAM." + function, "params": params}) + "\n"
            for i, (function, params) in enumerate(requests)))
        watcher = self.appliance.client("watcher")
        watcher.call("subscribe", topics=["events"])
        done = self.appliance.rmac("run", str(program))
        self.assertEqual(done.returncode, 0, done.stderr)
        hits = []
        while len(hits) < 4:
            hits.append(watcher.wait_note("events", lambda event: event["kind"] == "Hit"))
        for hit, x in zip(hits, (15, 12, -12, -15)):
            self.assertAlmostEqual(hit["pose"][0], x, delta=0.02)
            self.assertAlmostEqual(hit["pose"][2], TOP + RADIUS, delta=1e-4 + COUNT)

    def test_measuring_is_a_role_of_the_mill_that_is_loaded(self):
        client = self.operator("SuginoXYZAC")
        client.call("Device.Load", Name="CMM")
        self.assertEqual(client.call("Device.Machine_GetMechanismName"), "CMM")
        self.assertEqual(client.call("Device.Machine_GetMechanismNumberOfJoints"), 5)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.call("RMAC_CAM.MoveRotaryAxis", MoveID=1, JointNum=4, JointPose=350, Direction="shortest", Speed=20)
        state = wait_for_rest(client)
        self.assertAlmostEqual(state["joints"][4], -10, delta=0.01)
        client.call("Device.Load", Name="SuginoXYZAC")
        self.assertEqual(client.call("Device.Machine_GetMechanismName"), "SuginoXYZAC")
        self.assertAlmostEqual(client.state()["joints"][4], -10, delta=0.01)

    def test_virtual_mode_takes_its_hits_from_the_client(self):
        appliance = self.enterContext(Appliance(pace="real-time"))
        client = appliance.client("operator")
        client.call("authority.acquire")
        client.call("Device.Load", Name="CMM", Virtual=True)
        client.call("RMAC_CAM.Parameter", ParamNumber="MACH_SCAN_SPEED", newVal=0.5)  # 16 s for the search
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.call("RMAC_CAM.AutoMeasure", MoveID=4, x=0, y=0, z=-20, Speed=20)
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.wait_note("state", lambda state: state["pose"][2] < -17)
        for touches in ("0x1", 0):
            client.call("RMAC_CAM.SendConditionChangedEvent", JointValues=[0, 0, -18], NumJoints=3, Mask=1,
                        Condition=touches)
        self.assertEqual(client.call("RMAC_CAM.LastHitPosition"), [0, 0, -18])
        wait_for_rest(client)
        with self.assertRaises(Refused):
            client.call("RMAC_CAM.SendConditionChangedEvent", JointValues=[0, 0], NumJoints=3, Mask=1, Condition=1)

    def test_line_after_a_measurement_begins_where_it_ended(self):
        client = self.operator("CMM")
        client.call("RMAC_CAM.SetFeedrate", Feedrate=600)
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, x=15, y=0, z=-12, Speed=20)
        wait_for_rest(client)
        client.call("RMAC_CAM.AutoMeasure", MoveID=2, x=15, y=0, z=TOP + RADIUS, Speed=20)
        wait_for_rest(client)
        client.call("RMAC_CAM.MoveToPathTarget", MoveID=3, TargetFrame=pose(15, 0, -10))
        state = wait_for_rest(client)
        self.assertAlmostEqual(state["pose"][2], -10, delta=0.01)


class MeasuringAsItComes(unittest.TestCase):
    def test_hits_are_off_by_what_friction_bends_and_no_more_than_the_machine_may_be(self):
        """Its encoders are the motors': what slides behind the springs is not where they say."""
        appliance = self.enterContext(Appliance())
        device = json.loads(next(appliance.tree.glob("*/*/CMM/device.json")).read_text())
        bus = device["DigitalControlInterface"]["Parameters"]
        sliding = 0.5 * bus["friction_nm"][2] / bus["stiffness_nm_rad"][2] * 10 / (2 * math.pi)  # mm, by the guides' half of Z's
        client = appliance.operator("CMM")
        client.call("subscribe", topics=["events"])
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        for move, x in enumerate((15, 12, -12, -15), 1):
            client.call("RMAC_CAM.MoveToXYZ", MoveID=2 * move, x=x, y=0, z=-12, Speed=20)
            wait_for_rest(client)
            client.call("RMAC_CAM.AutoMeasure", MoveID=2 * move + 1, x=x, y=0, z=TOP + RADIUS, Speed=20)
            hit = client.wait_note("events", lambda event: event["kind"] == "Hit")
            wait_for_rest(client)
            low = TOP + RADIUS - hit["pose"][2]
            self.assertLess(low, device["RepeatabilityTolerance"])
            self.assertAlmostEqual(low, sliding, delta=3e-4)


if __name__ == "__main__":
    unittest.main()

"""The dissertation's functions: what its getters tell, and those that no other test asks for on the wire."""

import json
import math
import unittest

from appliance import SOURCE, Appliance, line, pose, wait_for_rest
from bending_mill import device_of, rigid

FILES = sorted((SOURCE / "drivers").glob("*/*/*/device.json"))
JOINT_TYPES = {"Rotary": 0, "Linear": 1, "Screw": 2}


def described(path):
    return json.loads(path.read_text())


def volume(device):
    sides = device["WorkingVolume"]
    return "x".join(f"{sides[side]:g}" for side in ("Length", "Width", "Depth"))


def version(text):
    major, minor, patch = map(int, text.split("."))
    return 10000 * major + 100 * minor + patch


def of_both(device):
    """The values that the record set and the loaded machine's database have in common."""
    spindle = (device["Spindles"] or [{"HorsePower": 0, "MaxSpeed": 0, "MaxTorque": 0}])[0]
    return {
        "Machine_GetMechanismName": device["MechanismName"],
        "Machine_GetMechanismNumberOfJoints": len(device["Joints"]),
        "Machine_GetMechanismWorkingVolume": volume(device),
        "Machine_GetMechanismSpindleHorsePower": spindle["HorsePower"],
        "Machine_GetMechanismSpindleMaxSpeed": spindle["MaxSpeed"],
        "Machine_GetMechanismSpindleMaxTorque": spindle["MaxTorque"],
        "Machine_GetMechanismMaxFeedrate": device["MaxFeedrate"],
        "Machine_GetMechanismMaxPalletLoad": device["MaxPalletLoad"],
        "Machine_GetMechanismPositioningTolerance": device["PositioningTolerance"],
        "Machine_GetMechanismRepeatabilityTolerance": device["RepeatabilityTolerance"],
    }


def of_record(device):
    return of_both(device) | {
        "Machine_GetMechanismID": device["MechanismID"],
        "Machine_GetMechanismDeviceDriver": device["DeviceDriver"],
        "Machine_GetMechanismDeviceDriverVersion": version(device["DeviceDriverVersion"]),
        "Machine_GetMechanismType": device["Type"],
        "Machine_GetMechanismConfigurationType": device["ConfigurationType"],
    }


def of_machine(device):
    return of_both(device) | {
        "Machine_GetMechanismKinematics": device["Kinematics"]["Module"],
        "Machine_GetMechanismActuatorMap": device["ActuatorMap"]["Module"],
        "Machine_GetMechanismConfiguration": device["ConfigurationType"],
    }


def of_joint(joint):
    return {
        "Machine_GetMechanismJntTypes": JOINT_TYPES[joint["Type"]],
        **({"Machine_GetMechanismJntMaxLimit": joint["Max"],
            "Machine_GetMechanismJntMinLimit": joint["Min"]} if joint["LimitType"] == "Limited" else {}),
        "Machine_GetMechanismJntMaxSpeed": joint["MaxSpeed"],
        "Machine_GetMechanismJntMaxAccel": joint["MaxAcceleration"],
        "Machine_GetMechanismJntMaxJerk": joint["MaxJerk"],
        "Machine_GetMechanismJntServoControlLaw": joint["ServoControlLaw"]["Module"],
    }


class Getters(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())

    def tell(self, client, interface, expected, **params):
        for getter, value in expected.items():
            with self.subTest(getter=getter, **params):
                self.assertEqual(client.call(f"{interface}.{getter}", **params), value)

    def test_record_set_tells_every_machine_of_the_tree(self):
        client = self.appliance.client()
        client.call("DeviceDriverManager.OpenDeviceDriverDatabase")
        total = client.call("DeviceDriverManager.GetTotalNumberOfRecords")
        self.assertEqual(total, len(FILES))
        devices = {device["MechanismID"]: device for device in map(described, FILES)}
        told = []
        for row in range(total):
            client.call("DeviceDriverManager.GetDatabaseRecordSetColumns")
            number = client.call("DeviceDriverManager.Machine_GetMechanismID")
            self.tell(client, "DeviceDriverManager", of_record(devices[number]))
            told.append(number)
            if row + 1 < total:
                client.call("DeviceDriverManager.OnNextRecord")
        self.assertEqual(sorted(told), sorted(devices))
        for way, number in (("OnPreviousRecord", told[-2]), ("OnLastRecord", told[-1]), ("OnFirstRecord", told[0])):
            client.call(f"DeviceDriverManager.{way}")
            self.assertEqual(client.call("DeviceDriverManager.Machine_GetMechanismID"), number, way)
        self.assertIn("first record already", client.refusal("DeviceDriverManager.OnPreviousRecord").message)
        client.call("DeviceDriverManager.CloseDeviceDriverDatabase")
        client.refusal("DeviceDriverManager.Machine_GetMechanismID")

    def test_database_of_a_loaded_machine_tells_its_device_json(self):
        client = self.appliance.client("operator")
        client.call("authority.acquire")
        for path in FILES:
            device = described(path)
            if device.get("Overlay"):
                continue  # its joints are those of the machine below
            client.call("Device.Load", Name=device["MechanismName"], Virtual=True)
            self.assertTrue(client.call("Device.GetDatabaseRecordSetMechanismColumns"))
            self.tell(client, "Device", of_machine(device))
            joints = device["Joints"] + device.get("HeldJoints", [])
            for number, joint in enumerate(joints):
                self.assertTrue(client.call("Device.GetDatabaseRecordSetJointColumns", JntNum=number))
                self.tell(client, "Device", of_joint(joint), JntNum=number)
            self.assertIn(f"joints 0 to {len(joints) - 1}",
                          client.refusal("Device.GetDatabaseRecordSetJointColumns", JntNum=len(joints)).message)

    def test_settings_are_told_as_they_were_set(self):
        client = self.appliance.operator()
        for name, unset, value in (("MaxFeedrate", None, 1500), ("PathAccelRise", 0, 321), ("PathAccelFall", 0, 123),
                                   ("JointInterpSpeed", None, 40)):
            if unset is not None:
                self.assertEqual(client.call(f"RMAC_CAM.Get{name}"), unset)
            client.call(f"RMAC_CAM.Set{name}", **{"MaxFeedrate" if name == "MaxFeedrate" else "newVal": value})
            self.assertEqual(client.call(f"RMAC_CAM.Get{name}"), value)
        for name in ("JointAccelRise", "JointAccelFall"):
            before = client.call(f"RMAC_CAM.Get{name}", JointNum=1)
            client.call(f"RMAC_CAM.Set{name}", JointNum=0, newVal=77)
            self.assertEqual(client.call(f"RMAC_CAM.Get{name}", JointNum=0), 77)
            self.assertEqual(client.call(f"RMAC_CAM.Get{name}", JointNum=1), before)
        client.call("RMAC_CAM.SetSpindleMaxRPM", SpindleNumber=0, MaxRPM=900)
        self.assertEqual(client.call("RMAC_CAM.GetSpindleMaxRPM", SpindleNumber=0), 900)
        self.assertIn("900", client.refusal("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=901).message)

    def test_what_moves_is_told_while_it_moves(self):
        appliance = Appliance(pace="real-time", own_tree=True)
        with device_of(appliance) as device:
            rigid(device)
        self.enterContext(appliance)
        client = appliance.operator()
        client.call("RMAC_CAM.SetFeedrate", Feedrate=300)
        client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (40, 0, 0)))
        client.call("RMAC_CAM.MoveAlongLine", **line((40, 0, 0), (40, 1, 0), move_id=2))
        self.assertFalse(client.call("RMAC_CAM.GetCycleStartStatus"))
        self.assertTrue(client.call("RMAC_CAM.GetCycleStopStatus"))
        self.assertEqual(client.call("RMAC_CAM.NumMovesInBuffer"), 2)
        self.assertEqual(client.call("RMAC_CAM.GetFeedrate"), 0)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.wait_note("state", lambda state: state["pose"][0] > 2)
        self.assertTrue(client.call("RMAC_CAM.GetCycleStartStatus"))
        self.assertFalse(client.call("RMAC_CAM.GetCycleStopStatus"))
        self.assertAlmostEqual(client.call("RMAC_CAM.GetFeedrate"), 300, delta=15)
        first = client.call("RMAC_CAM.CurrentPosition")
        client.wait_note("state", lambda state: state["pose"][0] > first[0] + 1)
        self.assertGreater(client.call("RMAC_CAM.CurrentPosition")[0], first[0] + 0.5)
        client.call("RMAC_CAM.StopNow")
        wait_for_rest(client)
        self.assertEqual(client.call("RMAC_CAM.NumMovesInBuffer"), 0)
        client.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=600)
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.wait_note("state", lambda state: abs(state["spindle_rpm"][0] - 600) < 20)
        self.assertAlmostEqual(client.call("RMAC_CAM.GetSpindleRPM", SpindleNumber=0), 600, delta=20)

    def test_status_codes_tell_the_last_error_until_they_are_cleared(self):
        client = self.appliance.operator()
        self.assertEqual(client.call("RMAC_CAM.StatusMajorCode"), 0)
        self.assertTrue(client.call("RMAC_CAM.Ok"))
        client.call("RMAC_CAM.SetFeedrate", Feedrate=300)
        refusal = client.refusal("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(1000, 0, 0))
        self.assertEqual(refusal.minor, "MACHINE_ERR_TRAVEL_LIMIT")
        self.assertEqual(client.call("RMAC_CAM.StatusMajorCode"), 1)
        self.assertEqual(client.call("RMAC_CAM.StatusMinorCode"), 4)
        self.assertFalse(client.call("RMAC_CAM.Ok"))
        client.call("RMAC_CAM.StatusMinorCode", newVal="NONE")
        client.call("RMAC_CAM.StatusMajorCode", newVal="MACHINE_SUCCESS")
        self.assertTrue(client.call("RMAC_CAM.Ok"))


class Moves(unittest.TestCase):
    """The moves and configuring calls that no other test asks for on the wire."""

    def setUp(self):
        self.client = self.enterContext(Appliance()).operator()
        self.client.call("RMAC_CAM.SetFeedrate", Feedrate=1200)

    def way(self, until):
        """Where the tip is, sample by sample, from the cycle's start to its end."""
        client, seen = self.client, []
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.wait_note("state", lambda state: seen.append(state["pose"][:3]) or math.dist(seen[-1], until) < 0.01)
        self.assertGreater(len(seen), 20)
        return seen

    def test_arc_leads_through_its_point(self):
        self.client.call("RMAC_CAM.MoveAlongArc3", MoveID=1, StartPoint=pose(0, 0, 0), ViaPoint=[10, 10, 0],
                         EndPoint=pose(20, 0, 0))
        for x, y, z in self.way((20, 0, 0)):
            self.assertAlmostEqual(math.dist((x, y, z), (10, 0, 0)), 10, delta=0.03)
            self.assertGreater(y, -0.03)

    def test_nurbs_of_joints_is_followed_by_the_joints(self):
        # A parabola in X and Y, and Z evenly.
        curve = {"degree": 2, "knots": [0, 0, 0, 1, 1, 1], "points": [[0, 0, 0], [10, 10, 2], [20, 0, 4]],
                 "space": "joint"}
        self.client.call("RMAC_CAM.MoveAlongNurbsND", MoveID=1, NurbsND=curve)
        for x, y, z in self.way((20, 0, 4)):
            t = x / 20
            self.assertAlmostEqual(y, 20 * t * (1 - t), delta=0.03)
            self.assertAlmostEqual(z, 4 * t, delta=0.03)

    def gains_in_force(self):
        """Of joint 0, as a flight record tells them."""
        client = self.client
        client.call("subscribe", topics=["events"])
        client.call("FlightRecorder.Record")
        name = client.wait_note("events", lambda event: event["kind"] == "FlightRecord")["record"]
        return next(record["joints"][0]["gains"]
                    for record in client.call("FlightRecorder.List")["records"] if record["name"] == name)

    def test_driver_configures_servo_loops_and_interface_anew(self):
        client = self.client
        shipped = self.gains_in_force()
        client.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0,
                    ServoControlGains=[gain / 2 for gain in shipped])
        client.call("RMAC_Config.Apply")
        self.assertNotEqual(self.gains_in_force(), shipped)
        self.assertTrue(client.call("Device.Machine_ConfigureServoController"))
        self.assertEqual(self.gains_in_force(), shipped)
        self.assertTrue(client.call("Device.Machine_ConfigureDigitalControlInterface"))
        client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 0, 0)))
        self.way((5, 0, 0))

    def test_interfaces_are_made_before_they_are_put_in(self):
        client = self.client
        self.assertTrue(client.call("RMAC_Config.InitializeMechanismDigitalControlInterface"))
        self.assertTrue(client.call("RMAC_Config.InitializeMechanismDigitalIOInterface"))
        client.call("RMAC_Config.SetMechanismDigitalControlInterface", DigitalControlInterface="NoSuchInterface")
        self.assertIn("NoSuchInterface",
                      client.refusal("RMAC_Config.InitializeMechanismDigitalControlInterface").message)


class MeasuringMachine(unittest.TestCase):
    """The functions of chapter 5's measuring client that no other test asks for on the wire."""

    def setUp(self):
        self.client = self.enterContext(Appliance()).operator("CMM")
        self.client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def test_arc_leads_round_its_centre(self):
        client = self.client
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, x=30, y=0, z=0, Speed=30)
        wait_for_rest(client)
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.call("RMAC_CAM.MoveInArc", MoveID=2, x=0, y=30, z=0, CenterX=0, CenterY=0, CenterZ=0, i=0, j=0, k=1,
                    Speed=30)
        seen = []
        client.wait_note("state", lambda state: seen.append(state["pose"]) or state["pose"][1] > 29.99)
        for x, y, z, *_ in seen:
            self.assertAlmostEqual(math.hypot(x, y), 30, delta=0.03)
            self.assertAlmostEqual(z, 0, delta=0.01)
        self.assertGreater(len(seen), 20)

    def test_all_joints_end_where_they_were_sent(self):
        self.client.call("RMAC_CAM.MoveAllAxis", MoveID=1, Position=[12, -7, 3], LinearSpeed=30)
        for joint, wanted in zip(wait_for_rest(self.client)["joints"], (12, -7, 3)):
            self.assertAlmostEqual(joint, wanted, delta=0.01)

    def test_probe_spins_for_its_time(self):
        refusal = self.client.refusal("RMAC_CAM.SpinProbe", RPM=500, Seconds=1)
        self.assertIn("spindle", refusal.message)

    def test_a_jog_into_the_part_ends_at_a_hit_that_is_expected(self):
        client = self.client
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, x=15, y=0, z=-15, Speed=20)
        wait_for_rest(client)
        client.call("RMAC_CAM.ManualMeasure")
        self.assertEqual(client.call("RMAC_CAM.ControlMode"), 1)
        client.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        client.call("RMAC_CAM.SetJointInterpSpeed", newVal=10)
        client.call("RMAC_CAM.JogJoint", JntNum=2, Distance=-20)
        height = wait_for_rest(client)["pose"][2]
        self.assertLess(height, -19)
        self.assertGreater(height, -20.5, "from 10 mm/s it stops within its acceleration and jerk")
        self.assertTrue(client.call("RMAC_CAM.NewHit"))
        self.assertAlmostEqual(client.call("RMAC_CAM.LastHitPosition")[2], -19, delta=1e-3)
        self.assertTrue(client.call("RMAC_CAM.Ok"))


if __name__ == "__main__":
    unittest.main()

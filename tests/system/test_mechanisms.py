"""Loading and swapping mechanisms while the appliance runs, and what may be wrong with one."""

import json
import os
import re
import shutil
import unittest

from appliance import Appliance, line, pose, run_to_rest, wait_for_rest

XY_FOLDER = "mill/2-axis/DMACXY"
OPERATION_ENABLED_MASK, OPERATION_ENABLED = 0x6F, 0x27


class Swap(unittest.TestCase):
    def test_third_drive_holds_while_two_axes_mill(self):
        with Appliance() as appliance:
            operator = appliance.operator("DMACXYZ")
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
            operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 5, -10)))
            before = run_to_rest(operator)
            self.assertAlmostEqual(before["joints"][2], -10, delta=0.02)

            operator.call("Device.Load", Name="DMACXY")
            swapped = operator.state()
            self.assertEqual(swapped["mechanism"], "DMACXY")
            self.assertEqual(len(swapped["joints"]), 2)
            self.assertAlmostEqual(swapped["held_joints"][0], -10, delta=0.02)
            for index in range(2):
                self.assertAlmostEqual(swapped["joints"][index], 5, delta=0.02)

            refusal = operator.refusal("RMAC_CAM.MoveAlongLine", **line((5, 5, 0), (10, 5, 1)))
            self.assertTrue(refusal.message)
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
            operator.call("RMAC_CAM.MoveAlongLine", **line((5, 5, 0), (10, -5, 0)))
            after = run_to_rest(operator)
            for value, wanted in zip(after["joints"], (10, -5)):
                self.assertAlmostEqual(value, wanted, delta=0.02)
            self.assertAlmostEqual(after["held_joints"][0], -10, delta=0.02)

    def test_drives_that_both_mechanisms_share_stay_enabled(self):
        with Appliance(pace="real-time") as appliance:
            operator = appliance.operator("DMACXYZ")
            watcher = appliance.client("watcher")
            watcher.call("subscribe", topics=["drives"], rate_hz=1000)
            cycle = watcher.wait_note("drives")["samples"][-1]["cycle"]
            operator.call("Device.Load", Name="DMACXY")
            loaded_at = operator.state()["cycle"]
            while cycle < loaded_at + 50:
                for sample in watcher.wait_note("drives")["samples"]:
                    self.assertEqual(sample["cycle"], cycle + 1, "a cycle is missing")
                    cycle = sample["cycle"]
                    for word in sample["statusword"][:3]:
                        self.assertEqual(word & OPERATION_ENABLED_MASK, OPERATION_ENABLED, sample)

    def test_unload_leaves_nothing_to_move(self):
        with Appliance() as appliance:
            operator = appliance.operator("DMACXYZ")
            operator.call("Device.Unload")
            self.assertIsNone(operator.state()["mechanism"])
            self.assertTrue(operator.refusal("RMAC_CAM.JogJoint", JntNum=0, Distance=1).message)
            operator.call("Device.Load", Name="DMACXYZ")
            operator.call("RMAC_CAM.JogJoint", JntNum=0, Distance=1)
            self.assertAlmostEqual(wait_for_rest(operator)["joints"][0], 1, delta=0.02)

    def test_virtual_mode_moves_setpoints_and_leaves_drives_alone(self):
        with Appliance() as appliance:
            operator = appliance.client("operator")
            operator.call("authority.acquire")
            operator.call("Device.Load", Name="DMACXYZ", Virtual=True)
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
            operator.call("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(5, 0, 0))
            state = run_to_rest(operator)
            self.assertTrue(state["virtual"])
            self.assertAlmostEqual(state["joints"][0], 5, delta=1e-9)
            operator.call("Device.Load", Name="DMACXYZ", Virtual=False)
            self.assertAlmostEqual(operator.state()["joints"][0], 0, delta=0.02)


class BadMechanism(unittest.TestCase):
    """DMACXYZ is loaded; DMACXY is made bad in one way; loading it must fail and change nothing."""

    def setUp(self):
        self.appliance = self.enterContext(Appliance(own_tree=True))
        self.operator = self.appliance.operator("DMACXYZ")
        self.folder = self.appliance.tree / XY_FOLDER

    def assert_load_fails(self, *words):
        before = self.operator.state()
        refusal = self.operator.refusal("Device.Load", Name="DMACXY")
        for word in words:
            self.assertIn(word, refusal.message)
        after = self.operator.state()
        self.assertEqual(after["mechanism"], "DMACXYZ")
        self.assertEqual(len(after["joints"]), len(before["joints"]))
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (0, 0, 3)))
        self.assertAlmostEqual(run_to_rest(self.operator)["joints"][2], 3, delta=0.02)

    def change(self, change):
        file = self.folder / "device.json"
        device = json.loads(file.read_text())
        change(device)
        file.unlink()  # The copy may be read-only.
        file.write_text(json.dumps(device))

    def test_unknown_mechanism_lists_those_there_are(self):
        refusal = self.operator.refusal("Device.Load", Name="DMACQ")
        self.assertIn("DMACXYZ", refusal.message)
        self.assertEqual(self.operator.state()["mechanism"], "DMACXYZ")

    def test_missing_module_is_named_with_the_folders_searched(self):
        (self.folder / "DMACXYKinematics.so").unlink()
        self.assert_load_fails("DMACXYKinematics", XY_FOLDER, "modules")

    def test_module_of_another_abi_is_refused_with_both_versions(self):
        module = self.folder / "DMACXYKinematics.so"
        module.unlink()
        shutil.copy(os.environ["RMAC_WRONG_ABI_MODULE"], module)
        message = self.operator.refusal("Device.Load", Name="DMACXY").message
        its, ours = re.search(r"module ABI (\d+) and this controller has ABI (\d+)", message).groups()
        self.assertEqual(int(its), int(ours) + 1, message)
        self.assert_load_fails("DMACXYKinematics")

    def test_truncated_module_is_refused_at_every_length(self):
        module = self.folder / "DMACXYKinematics.so"
        whole = module.read_bytes()
        module.unlink()
        for parts in (1, 8, 50, 90, 99):
            module.write_bytes(whole[: len(whole) * parts // 100])
            self.assertIn("DMACXYKinematics", self.operator.refusal("Device.Load", Name="DMACXY").message)
        self.assert_load_fails("DMACXYKinematics")
        module.write_bytes(whole)
        self.operator.call("Device.Load", Name="DMACXY")

    def test_rescan_reports_every_bad_folder_and_keeps_the_good_ones(self):
        good = self.operator.call("DeviceDriverManager.Rescan")
        self.assertEqual(good["problems"], [])
        self.change(lambda device: device["Joints"][1].update(MaxSpeed=-1))
        copy = self.appliance.tree / "mill/3-axis/Copy"
        shutil.copytree(self.appliance.tree / "mill/3-axis/DMACXYZ", copy)
        torn = self.appliance.tree / "mill/5-axis/TarusXYZCA/device.json"
        text = torn.read_text()
        torn.unlink()
        torn.write_text(text[: len(text) // 2])
        binary = self.appliance.tree / "mill/3-axis/Noise"
        binary.mkdir()
        (binary / "device.json").write_bytes(bytes(range(256)))

        report = self.operator.call("DeviceDriverManager.Rescan")
        self.assertEqual(report["mechanisms"], good["mechanisms"] - 2)
        messages = {problem["file"].split("/")[-2]: problem["message"] for problem in report["problems"]}
        self.assertEqual(sorted(messages), ["Copy", "DMACXY", "Noise", "TarusXYZCA"])
        for mechanism, words in (("DMACXY", ("/Joints/1/MaxSpeed", "-1", "allowed")),
                                 ("Copy", ("/MechanismName", "DMACXYZ", "allowed")),
                                 ("TarusXYZCA", ("line", "is not JSON")), ("Noise", ("line 1", "is not JSON"))):
            for word in (f"{mechanism}/device.json", *words):
                self.assertIn(word, messages[mechanism])
        self.operator.call("Device.Load", Name="DMACXYZ")
        self.appliance.end()
        log = "".join(self.appliance.log)
        for message in messages.values():
            self.assertIn(message, log)

    def test_module_that_is_no_module_is_refused(self):
        module = self.folder / "DMACXYKinematics.so"
        module.unlink()
        module.write_bytes(b"not a shared object")
        self.assert_load_fails("DMACXYKinematics")

    def test_bad_value_is_named_with_key_and_range(self):
        self.change(lambda device: device["Joints"][1].update(MaxAcceleration=-1000))
        self.assert_load_fails("device.json", "/Joints/1/MaxAcceleration", "-1000", "0")

    def test_unknown_key_is_an_error(self):
        self.change(lambda device: device["Joints"][0].update(MaxSpeeed=200))
        self.assert_load_fails("device.json", "MaxSpeeed")

    def test_limits_that_make_no_sense_are_refused(self):
        self.change(lambda device: device["Joints"][0].update(Min=50, Max=-50))
        self.assert_load_fails("device.json", "/Joints/0")

    def test_json_error_names_line(self):
        file = self.folder / "device.json"
        file.unlink()
        file.write_text('{\n "MechanismName": \n}')
        self.assert_load_fails("device.json", "line")


if __name__ == "__main__":
    unittest.main()

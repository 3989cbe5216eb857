"""Verification before a mechanism goes live: what is bad is refused with its counter-example, and the old one works on."""

import json
import os
import shutil
import subprocess
import unittest

from appliance import BUILD, Appliance, line, run_to_rest
from bending_mill import device_of, rigid

FOLDER = "mill/3-axis/Bad"
# What each defect of BadKinematics is refused for.
REFUSALS = {
    "CrashesInFactory": ("crash", "SEGV", "create"),
    "CrashesInForward": ("crash", "SEGV", "forward", "joints"),
    "Hangs": ("hang", "computes", "forward", "joints"),
    "Sleeps": ("hang", "does not come back", "forward", "joints"),
    "Allocates": ("real time", "allocates", "forward", "joints"),
    "Leaks": ("leaks", "bytes behind"),
    "LiesAboutInverse": ("inverse", "off the pose", "joints", "seed"),
    "LiesAboutJacobian": ("Jacobian", "row 0, column 1", "joints"),
    "LiesAboutJoints": ("joint types", "joint 2"),
    "HasAnotherAbi": ("loading", "module ABI"),
    "StaysMapped": ("unloading", "stays mapped"),
    "EatsMemory": ("crash", "ABRT", "create"),
    "IsSlow": ("call time", "take more than 20 us", "in inverse", "pose"),
    "IsSlowInASlab": ("call time", "200 us are allowed at worst, in inverse", "pose"),
    "Remembers": ("state", "answers otherwise", "keeps something"),
    "SharesScratch": ("state", "answers otherwise", "another thread"),
    "Tires": ("state", "answers otherwise"),
    "Saturates": ("inverse", "beyond its reach"),
    "OverrunsJacobian": ("overrun", "outside of its output in jacobian", "joints"),
}


class Verify(unittest.TestCase):
    """DMACXYZ is loaded, and beside it in the tree there is Bad: the same machine with one module in place of its own."""

    def setUp(self):
        self.appliance = self.enterContext(Appliance(own_tree=True, own_verdicts=True))
        self.folder = self.appliance.tree / FOLDER
        shutil.copytree(self.appliance.tree / "mill/3-axis/DMACXYZ", self.folder)

    def choose(self, key, module, defect):
        """Has Bad use a module of tests/system/bad_modules."""
        shutil.copy(BUILD / "bad_modules" / defect / f"{module}.so", self.folder)
        file = self.folder / "device.json"
        device = json.loads((self.appliance.tree / "mill/3-axis/DMACXYZ/device.json").read_text())
        device["MechanismName"] = "Bad"
        device.pop("MechanismID", None)
        if key == "ServoControlLaw":
            for joint in device["Joints"]:
                joint[key] = {"Module": module}
        else:
            device[key] = {"Module": module}
        file.unlink()  # The copy may be read-only.
        file.write_text(json.dumps(device))

    def assert_refused(self, operator, *words):
        refusal = operator.refusal("Device.Load", Name="Bad").message
        for word in ("Bad is not loaded", "what is loaded stays loaded", *words):
            self.assertIn(word, refusal)
        self.assertEqual(operator.state()["mechanism"], "DMACXYZ")

    def test_each_defect_is_refused_and_the_old_machine_works_on(self):
        operator = self.appliance.operator("DMACXYZ")
        self.choose("Kinematics", "BadKinematics", "None")
        operator.call("DeviceDriverManager.Rescan")
        for defect, words in REFUSALS.items():
            with self.subTest(defect):
                self.choose("Kinematics", "BadKinematics", defect)
                self.assert_refused(operator, "BadKinematics", *words)
        for key, module, defect, words in (("ServoControlLaw", "BadLaw", "HidesNoNumber", ("no number in", "puts out 0")),
                                           ("ServoControlLaw", "BadLaw", "PushesAway", ("stability", "joint")),
                                           ("ActuatorMap", "BadMap", "LosesPower", ("power", "at the shafts"))):
            with self.subTest(defect):
                self.choose(key, module, defect)
                self.assert_refused(operator, *words)
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (2, 0, 3)))
        self.assertAlmostEqual(run_to_rest(operator)["joints"][2], 3, delta=0.02)
        # And the same source without a defect is a machine.
        self.choose("Kinematics", "BadKinematics", "None")
        operator.call("Device.Load", Name="Bad")
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        operator.call("RMAC_CAM.MoveAlongLine", **line((2, 0, 3), (0, 0, 0)))
        self.assertAlmostEqual(run_to_rest(operator)["joints"][2], 0, delta=0.02)

    def test_limits_stay_within_what_was_verified(self):
        operator = self.appliance.operator("DMACXYZ")

        def apply(limit):
            operator.call("RMAC_Config.SetMechanismJointMaximumLimit", JntNum=0, MaxJntLimit=limit)
            return operator.refusal("RMAC_Config.Apply") if limit > 50 else operator.call("RMAC_Config.Apply")
        apply(20)
        message = apply(250).message
        for word in ("joint X", "250", "verified", "Device.Verify"):
            self.assertIn(word, message)
        apply(50)

    def test_report_holds_the_counter_example_as_numbers(self):
        operator = self.appliance.operator("DMACXYZ")
        self.choose("Kinematics", "BadKinematics", "LiesAboutInverse")
        operator.call("DeviceDriverManager.Rescan")
        report = operator.call("Device.Verify", Name="Bad")
        self.assertFalse(report["ok"])
        refused = [module for module in report["modules"] if not module["ok"]]
        self.assertEqual([module["module"] for module in refused], ["BadKinematics"])
        values = refused[0]["counter_example"]["values"]
        self.assertGreater(values["joints"][0], 40)
        self.assertAlmostEqual(values["answer"][1], values["joints"][1] + 1e-6, delta=1e-9)
        good = operator.call("Device.Verify", Name="DMACXYZ")
        self.assertTrue(good["ok"], good)
        self.assertEqual(good["samples"], 100_000)
        self.assertEqual(operator.state()["mechanism"], "DMACXYZ")

    def test_what_passed_is_asked_again_only_once_its_files_change(self):
        operator = self.appliance.operator("DMACXYZ")
        folder = self.appliance.folder / "state/verified"
        first = {file: file.stat().st_ino for file in folder.glob("DMACXYZ@*.json")}
        self.assertEqual(len(first), 1)
        file, = first
        os.utime(file, (0, 0))
        operator.call("Device.Load", Name="DMACXYZ")
        self.assertEqual({file: file.stat().st_ino for file in folder.glob("DMACXYZ@*.json")}, first, "it is not written anew")
        self.assertGreater(file.stat().st_mtime, 0, "the one that was needed longest ago goes first")
        module = self.appliance.tree / "mill/3-axis/DMACXYZ/DMACXYZKinematics.so"
        built = module.read_bytes()
        module.unlink()
        module.write_bytes(built + b"\0")
        operator.call("Device.Load", Name="DMACXYZ")
        self.assertEqual(len(list(folder.glob("DMACXYZ@*.json"))), 2)

    def test_command_needs_no_appliance_for_a_folder(self):
        good = self.verify(self.appliance.tree / "mill/3-axis/DMACXYZ")
        self.assertEqual((good.returncode, good.stderr), (0, ""))
        self.assertIn("DMACXYZ may go live", good.stdout)
        self.choose("Kinematics", "BadKinematics", "Leaks")
        bad = self.verify(self.folder / "device.json")
        self.assertEqual(bad.returncode, 1)
        self.assertIn("REFUSED", bad.stdout)
        self.assertEqual(bad.stderr.count("\n"), 1)
        self.assertIn("bytes behind", bad.stderr)
        told = self.verify(self.folder, "--json")
        self.assertEqual(told.returncode, 1)
        self.assertEqual(json.loads(told.stdout)["ok"], False)

    def test_machine_on_can_is_checked_on_the_models_of_its_buses(self):
        file = self.appliance.tree / "mill/5-axis/TarusXYZCA/device.json"
        whole = file.read_text()
        as_it_comes = self.verify(file.parent)
        self.assertEqual((as_it_comes.returncode, as_it_comes.stderr), (0, ""))

        def verify(change=lambda device: None):
            """On rigid axes, whose loops are bounded by the bus' delay alone."""
            device = json.loads(whole)
            rigid(device)
            change(device)
            file.unlink()
            file.write_text(json.dumps(device))
            return self.verify(file.parent)

        good = verify()
        self.assertEqual((good.returncode, good.stderr), (0, ""))
        self.assertIn("on the axis models each joint goes there and back", good.stdout)
        self.assertIn("each spindle comes to its full speed", good.stdout)

        def gains_of_a_quicker_bus(device):
            for joint in device["Joints"]:
                joint["Gains"][:3] = [gain * factor for gain, factor in zip(joint["Gains"], (4, 8, 3))]

        def answer_a_cycle_later(device):
            gains_of_a_quicker_bus(device)
            device["DigitalControlInterface"]["Parameters"].update({"can0.model.late_answers": 2, "can1.model.late_answers": 2})
        self.assertIn("swings", verify(answer_a_cycle_later).stderr)
        self.assertEqual(verify(gains_of_a_quicker_bus).returncode, 0, "they would do on a quicker bus")
        self.assertIn("spindle 0 does not come to 5000 rpm",
                      verify(lambda device: device["Spindles"][0].update(SpeedTimeout=0.1)).stderr)
        without = verify(lambda device: device["DigitalControlInterface"]["Parameters"].pop("can1.model.interface"))
        self.assertEqual(without.returncode, 0, "what nobody has measured is no reason to refuse a machine")
        self.assertIn("not checked stability: bus can1", " ".join(without.stdout.split()))

    def test_links_that_do_not_carry_each_other_so_are_refused(self):
        file = self.appliance.tree / "mill/5-axis/SuginoXYZAC/device.json"
        device = json.loads(file.read_text())
        self.assertEqual(device["Chain"][:2], ["C", "A"])
        device["Chain"][:2] = ["A", "C"]
        file.unlink()
        file.write_text(json.dumps(device))
        bad = self.verify(file)
        self.assertEqual(bad.returncode, 1)
        self.assertIn("/Chain is A C base X Y Z, and the kinematics module moves the tool otherwise", bad.stdout)

    def test_command_asks_the_appliance_for_a_name(self):
        done = self.appliance.rmac("verify", "DMACXY")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("DMACXY may go live", done.stdout)
        self.assertEqual(self.appliance.rmac("verify", "Nowhere").returncode, 1)
        refused = self.appliance.rmac("verify", "DMACXY", "--period", "0.00025")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("an appliance verifies at its own cycle", refused.stderr)

    def test_loops_are_checked_at_the_cycle_that_they_are_to_run_in(self):
        """Loops quicker than a cycle of 1 ms bears, and right for one of 0.25 ms; a verdict on the one is none on the other."""
        with device_of(self.appliance) as device:
            rigid(device)
            for data in device["Joints"]:
                data["Gains"] = [gain * factor for gain, factor in zip(data["Gains"], (8, 16, 3))]
        folder = self.appliance.tree / "mill/3-axis/DMACXYZ"
        slow, quick = self.verify(folder), self.verify(folder, "--period", "0.00025")
        self.assertEqual((slow.returncode, quick.returncode, quick.stderr), (1, 0, ""))
        self.assertIn("swings", slow.stderr)
        verdicts = self.appliance.folder / "state/verified"
        verdicts.mkdir(exist_ok=True)
        at_4_khz = Appliance(own_verdicts=True, device_tree=str(self.appliance.tree), period_s=0.00025)
        (at_4_khz.folder / "state/verified").symlink_to(verdicts)
        with at_4_khz:
            at_4_khz.operator("DMACXYZ")
        self.assertEqual(len(list(verdicts.iterdir())), 1)
        operator = self.appliance.client("operator")
        operator.call("authority.acquire")
        self.assertIn("swings", operator.refusal("Device.Load", Name="DMACXYZ").message)

    def test_a_part_under_the_tool_is_in_nobodys_way(self):
        """The simulated bus may have one; the moves that are planned know nothing of it, and loops are what is looked at."""
        with device_of(self.appliance) as device:
            device["DigitalControlInterface"]["Parameters"].update(contact_surface_mm=-10, contact_stiffness_n_mm=20000)
        done = self.verify(self.appliance.tree / "mill/3-axis/DMACXYZ")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def verify(self, path, *words):
        return subprocess.run([BUILD / "bin/rmac", "verify", path, *words], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=120, check=False, env=os.environ)


if __name__ == "__main__":
    unittest.main()

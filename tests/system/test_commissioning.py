"""rmac tune and rmac measure-following: what they find, and that they change nothing unless told to."""

import csv
import json
import pathlib
import random
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance, line, wait_for_rest
from bending_mill import RAD_PER_MM, TuningTest, device_of, rigid

PNG = b"\x89PNG\r\n\x1a\n"
MARGIN = 40.0


class Commands(TuningTest):
    def test_tune_finds_the_simulated_axes_and_applies_when_told(self):
        for seed in (2, 3):  # the latter is of the joint that carries a load
            chance = random.Random(seed)
            inertia = [chance.uniform(1.5e-5, 4e-5) for _ in range(3)]
            friction = [chance.uniform(0.008, 0.03) for _ in range(3)]
            with self.subTest(inertia=inertia, friction=friction), Appliance(own_tree=True) as appliance, \
                    tempfile.TemporaryDirectory() as folder:
                file = next(appliance.tree.glob("*/*/DMACXYZ/device.json"))
                device = json.loads(file.read_text())
                rigid(device, inertia_kg_m2=inertia + [2.2e-5] * 5, friction_nm=friction + [0.015] * 5)
                file.write_text(json.dumps(device))
                self.rmac(appliance, "load", "DMACXYZ")
                joint = seed - 1
                picture = pathlib.Path(folder, "tune.png")
                words = ("--json", "tune", str(joint), "--travel", "-20", "-o", str(picture))
                found = json.loads(self.rmac(appliance, *words))
                plant = found["plant"]
                self.assertAlmostEqual(plant["mass"] / (inertia[joint] * RAD_PER_MM ** 2 * 1000), 1, delta=0.02)
                self.assertAlmostEqual(plant["friction"] / (friction[joint] * RAD_PER_MM * 1000), 1, delta=0.03)
                self.assertAlmostEqual(plant["load"], 117.7 if joint == 2 else 0, delta=1)
                self.assertAlmostEqual(plant["delay_s"], 0.0017, delta=0.0003)
                self.assertTrue(picture.read_bytes().startswith(PNG))
                self.assert_stays_within(appliance, joint, -20)
                self.assertEqual(json.loads(file.read_text()), device)

                again = json.loads(self.rmac(appliance, *words, "--apply"))
                self.assertEqual(again["before"]["gains"], device["Joints"][joint]["Gains"], "nothing was changed")
                third = json.loads(self.rmac(appliance, *words))
                for applied, proposed in zip(third["before"]["gains"], again["apply"], strict=True):
                    self.assertAlmostEqual(applied / proposed, 1, delta=1e-9)
                self.assertAlmostEqual(third["before"]["phase_margin_deg"], MARGIN, delta=4)

    def assert_stays_within(self, appliance, joint, travel):
        """What the newest record shows: setpoints between 0 and `travel`, and other joints where they were."""
        rows = list(csv.DictReader(self.rmac(appliance, "trace", "export", "-o", "-").splitlines()))
        for other in range(3):
            wanted = [float(row[f"q{other + 1}"]) for row in rows]
            low, high = sorted((0, travel if other == joint else 0))
            self.assertGreaterEqual(min(wanted), low - 0.01)
            self.assertLessEqual(max(wanted), high + 0.01)
            self.assertGreater(max(map(abs, wanted)), abs(travel) - 0.01 if other == joint else -1)

    def test_tune_makes_a_loop_for_an_axis_that_bends(self):
        """What it proposes is taken, with the filters it belongs to, and holds where the resonance is 15 % elsewhere."""
        soft = {"Gains": [120, 2000, 1.2], "MaxFollowingError": 1}
        with self.bending(274, soft) as appliance, tempfile.TemporaryDirectory() as folder:
            words = ("tune", "0", "--travel", "20", "-o", str(pathlib.Path(folder, "tune.png")))
            found = json.loads(self.rmac(appliance, "--json", *words))
            applied = json.loads(self.rmac(appliance, "--json", *words, "--apply"))
            again = self.rmac(appliance, "--json", "trace", "record")
            head = json.loads(appliance.client().call("FlightRecorder.Read", Name=json.loads(again)["name"],
                                                      Offset=0)["text"].splitlines()[0])
        self.assertAlmostEqual(found["resonances"][0]["frequency"], 274, delta=3)
        self.assertTrue(found["before"]["stable"] and found["elsewhere"]["stable"])
        joint, filters = head["joints"][0], applied["proposed"]["filters"]
        self.assertEqual(joint["law"], "DMACXYZPIDServoControlLaw", "the law is back")
        self.assertEqual((joint["gains"], joint["low_pass"], len(joint["resonances"])),
                         (applied["apply"], filters["LowPass"], len(filters["Resonances"])))
        self.assertEqual(head["joints"][1]["gains"], soft["Gains"])
        self.assertGreater(applied["proposed"]["bandwidth_hz"], 2 * applied["before"]["bandwidth_hz"])
        tuned = {"Gains": found["proposed"]["gains"], **found["proposed"]["filters"]}
        if not tuned["LowPass"]:
            del tuned["LowPass"]
        for hz in (233, 274, 315):
            with self.subTest(hz=hz), self.bending(hz, tuned) as appliance:
                client = appliance.client()
                client.call("authority.acquire")
                client.call("RMAC_CAM.Home")
                wait_for_rest(client)
                for way in (20, -20, 3, -3):
                    client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=way)
                    wait_for_rest(client)
                while client.state()["state"] == "Running":  # It follows the last motion by a cycle or two.
                    pass
                self.assertEqual(client.state()["state"], "Idle")

    def test_tune_goes_no_further_where_somebody_stops_the_joint(self):
        appliance = self.enterContext(Appliance(pace="real-time"))
        self.rmac(appliance, "load", "DMACXYZ")
        watcher = appliance.client()
        watcher.call("subscribe", topics=["state"], rate_hz=100)
        with tempfile.TemporaryDirectory() as folder, subprocess.Popen(
                [BUILD / "bin/rmac", "--port", str(appliance.port), "tune", "0", "--travel", "30", "-o",
                 pathlib.Path(folder, "tune.png")], stderr=subprocess.PIPE, text=True) as tune:
            watcher.wait_note("state", lambda state: state["joints"][0] > 2)
            watcher.call("RMAC_CAM.StopNow")
            _, said = tune.communicate(timeout=60)
        self.assertEqual((tune.returncode, said.count("\n")), (1, 1), said)
        self.assertIn("somebody stopped it", said)
        stands = watcher.state()["joints"][0]
        self.assertTrue(2 < stands < 30, stands)

    def test_laws_and_gains_change_in_motion_without_a_step(self):
        """As a client does it: the plan goes on, and no joint's effort jumps where its law changes."""
        appliance = self.enterContext(Appliance(pace="real-time", flight_recorder={"seconds": 30}))
        client = appliance.operator()
        client.call("subscribe", topics=["state"], rate_hz=100)
        client.call("RMAC_CAM.SetFeedrate", Feedrate=120)
        client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (40, 20, 0)))
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.wait_note("state", lambda state: state["pose"][0] > 1)
        changes = []
        for law, gains in (("DMAC_PID_CONTROL", [1000, 75000, 10]), ("DMAC_FUZZY_CONTROL", [0.16, 22, 120, 140000]),
                           ("DMAC_FEEDFORWARDFEEDBACK_CONTROL", [1550, 140000, 11.1, 0.16, 0.035, 19, 0])):
            client.call("RMAC_Config.SetMechanismJointServoControlLaw", JntNum=0, ControlLaw=law)
            client.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=gains)
            before = client.state()["cycle"]
            client.call("RMAC_Config.Apply")
            changes.append((before, client.state()["cycle"]))
            self.assertTrue(client.state()["moving"])
        # A record ends with the cycle in which it is asked for.
        client.wait_note("state", lambda state: state["cycle"] > changes[-1][1] + 5)
        name = json.loads(self.rmac(appliance, "--json", "trace", "record"))["name"]
        head = json.loads(client.call("FlightRecorder.Read", Name=name, Offset=0)["text"].splitlines()[0])
        self.assertEqual((head["joints"][0]["law"], head["joints"][0]["gains"]),
                         ("FeedforwardFeedbackServoControlLaw", gains))
        rows = list(csv.DictReader(self.rmac(appliance, "trace", "export", name, "-o", "-").splitlines()))
        efforts = {int(row["cycle"]): float(row["effort1"]) for row in rows}
        rated = 0.318 * RAD_PER_MM * 1000  # N
        for before, after in changes:
            for cycle in range(before, after + 5):
                self.assertLess(abs(efforts[cycle + 1] - efforts[cycle]), 0.02 * rated, cycle)

    def test_measure_following_draws_the_circle_and_its_reversals(self):
        appliance = self.enterContext(Appliance())
        self.rmac(appliance, "load", "DMACXYZ")
        client = appliance.client("operator")
        client.call("authority.acquire")
        client.call("RMAC_CAM.SetPathTolerance", Tolerance=0.01)
        client.call("authority.release")
        # An axis rests some micrometres beside its setpoint, which is where the path begins.
        self.rmac(appliance, "jog", "--joint", "0", "--distance", "3.3")
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder, "circle.png")
            words = ("measure-following", "--radius", "20", "-o", str(picture))
            result = json.loads(self.rmac(appliance, "--json", *words))
            self.assertTrue(picture.read_bytes().startswith(PNG))
        self.assertAlmostEqual(result["feed_mm_min"], 2000, delta=2)
        self.assertEqual(client.call("RMAC_CAM.GetPathTolerance"), 0.01)
        self.assertEqual(len(result["reversal_spikes_um"]), 4)
        spikes = [abs(spike) for spike in result["reversal_spikes_um"]]
        self.assertGreater(max(spikes), 0.5, "friction and cogging are known, but not to the last")
        self.assertLess(max(spikes), 15)
        self.assertLess(result["circular_deviation_um"], 20)
        # Another turn right behind it is in the same record.
        with tempfile.TemporaryDirectory() as folder:
            words = ("measure-following", "--radius", "3", "-o", str(pathlib.Path(folder, "circle.png")))
            again = json.loads(self.rmac(appliance, "--json", *words))
        self.assertEqual(again["radius_mm"], 3)
        self.assertLess(again["circular_deviation_um"], 20)
        self.assertLess(max(map(abs, again["radial_deviation_um"])), 20)

    def test_measure_following_takes_drives_that_answer_late_for_where_they_are(self):
        """Of the same axes, late by none and by three cycles: what is on the circle is on it. The way of three cycles at F2000 is 100 µm."""
        found = []
        for late in (0, 3):
            with Appliance(own_tree=True) as appliance, tempfile.TemporaryDirectory() as folder:
                with device_of(appliance) as device:
                    rigid(device, late_answers=[late], friction_nm=[0.001] * 8)
                    for joint in device["Joints"]:
                        joint["Gains"] = [gain / share for gain, share in zip(joint["Gains"], (9, 27, 3), strict=True)]
                        joint["MaxFollowingError"] = 1
                self.rmac(appliance, "load", "DMACXYZ")
                words = ("measure-following", "--radius", "20", "-o", str(pathlib.Path(folder, "circle.png")))
                found.append(json.loads(self.rmac(appliance, "--json", *words)))
        for of in ("following_error_um", "circular_deviation_um"):
            self.assertAlmostEqual(found[1][of], found[0][of], delta=0.3 * found[0][of] + 1, msg=found)
        self.assertLess(found[1]["following_error_um"], 30)

    def test_say_what_is_missing(self):
        appliance = self.enterContext(Appliance())
        refused = appliance.rmac("tune", "0", "--travel", "10")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("no machine is loaded", refused.stderr)
        self.rmac(appliance, "load", "DMACXYZ")
        beyond = appliance.rmac("tune", "7", "--travel", "10")
        self.assertEqual(beyond.returncode, 1)
        self.assertIn("there is no joint 7; the machine has 3", beyond.stderr)
        far = appliance.rmac("tune", "0", "--travel", "1000")
        self.assertEqual(far.returncode, 1)
        self.assertIn("limit", far.stderr)
        before = self.rmac(appliance, "--json", "status")
        for words, said in ((("tune", "0", "--travel", "0"), "give the way"),
                            (("tune", "0", "--travel", "5", "-o", "/nowhere/tune.png"), "cannot be written"),
                            (("tune", "0", "--travel", "5", "-o", "tune.bmp"), "ends in .png, .svg or .pdf"),
                            (("measure-following", "-o", "/nowhere/circle.png"), "cannot be written"),
                            (("measure-following", "--radius", "9999"), "limit"),
                            (("trace", "plot", "-o", "/nowhere/trace.png"), "no flight record yet")):
            with self.subTest(words=words):
                refused = appliance.rmac(*words)
                self.assertEqual((refused.returncode, refused.stderr.count("\n")), (1, 1), refused.stderr)
                self.assertIn(said, refused.stderr)
        for after, stood in zip(json.loads(self.rmac(appliance, "--json", "status"))["joints"], json.loads(before)["joints"], strict=True):
            self.assertAlmostEqual(after, stood, delta=0.02, msg="a joint at rest moves by micrometres")
        beyond = appliance.rmac("tune", "0", "--travel", "20", "--bandwidth", "500", "-o", "/tmp/tune.png")
        self.assertEqual((beyond.returncode, beyond.stderr.count("\n")), (1, 1), beyond.stderr)
        self.assertIn("out of reach for a delay of", beyond.stderr)


if __name__ == "__main__":
    unittest.main()

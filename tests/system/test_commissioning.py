"""rmac tune and rmac measure-following: what they find, and that they change nothing unless told to."""

import contextlib
import csv
import json
import pathlib
import random
import re
import subprocess
import tempfile
import unittest

import numpy as np

from appliance import BUILD, Appliance, line, wait_for_rest
from bending_mill import bend, on_two_motors, rigid

PNG = b"\x89PNG\r\n\x1a\n"
MARGIN = 40.0
ROTOR = 4.49e-6 + 4.8e-6  # kg·m², of the simulated axes beside their table
RAD_PER_MM = 2 * np.pi / 5


class Commands(unittest.TestCase):
    def rmac(self, appliance, *words):
        done = appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return done.stdout

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

    def test_tune_takes_a_joint_that_rests_beside_its_setpoint_for_what_it_is(self):
        """Friction holds a soft loop: it creeps under the gains that are proposed, and where nothing was measured that they hold by, tune says
        what is wrong."""
        soft = {"Gains": [120, 100, 1.2], "MaxFollowingError": 2}
        with self.bending(274, soft) as appliance, tempfile.TemporaryDirectory() as folder:
            words = ("tune", "0", "--travel", "20", "--creep", "-o", str(pathlib.Path(folder, "tune.png")))
            rigid = appliance.rmac(*words, "--sweep-effort", "0")
            found = json.loads(self.rmac(appliance, "--json", *words))
            again = json.loads(self.rmac(appliance, "--json", *words[:-3], *words[-2:]))
        self.assertEqual((rigid.returncode, rigid.stderr.count("\n")), (1, 1), rigid.stderr)
        self.assertIn("its gains are too soft for its friction", rigid.stderr)
        self.assertAlmostEqual(found["creep"]["friction"] / 18.85, 1, delta=0.1)
        self.assertEqual((again["law"], again["gains"], again["filters_in_force"]),
                         ("DMACXYZPIDServoControlLaw", soft["Gains"], {"Resonances": [], "LowPass": 0}), "nothing was changed")

    def test_tune_begins_softly_where_the_gains_do_not_fit(self):
        """With gains which were made for axes that are rigid, and of another mass."""
        for hz, heavier, joints in ((346, 3, (0, 2)), (274, 1, (0,)), (600, 1 / 3, (2,))):
            with self.subTest(hz=hz, heavier=heavier), tempfile.TemporaryDirectory() as folder, \
                    self.bending(hz, {}, heavier, load=False) as appliance:
                refused = appliance.rmac("load", "DMACXYZ")
                self.assertEqual(refused.returncode, 1)
                self.assertIn("stability: on the model of its axes, where encoders are sound", refused.stderr)
                self.assertIn("softer by 8, and their joints", self.rmac(appliance, "load", "DMACXYZ", "--soften", "8"))
                client = appliance.client()
                for joint in joints:
                    words = ("tune", str(joint), "--travel", "20", "-o", str(pathlib.Path(folder, "tune.png")))
                    found = json.loads(self.rmac(appliance, "--json", *words, "--apply"))
                    seen = min(hz, 1000 - hz)  # by samples at 1 kHz
                    self.assertAlmostEqual(found["resonances"][0]["frequency"] / seen, 1, delta=0.02)
                    self.assertTrue(found["elsewhere"]["stable"])
                    self.assertGreater(found["proposed"]["bandwidth_hz"], found["before"]["bandwidth_hz"])
                client.call("authority.acquire")
                for way in (20, -20, 3, -3):
                    for joint in (0, 2):
                        client.call("RMAC_CAM.JogJoint", JntNum=joint, Distance=way)
                        wait_for_rest(client)
                while client.state()["state"] == "Running":  # It follows the last motion by a cycle or two.
                    pass
                self.assertEqual(client.state()["state"], "Idle")

    def test_the_tree_has_what_tune_finds(self):
        """Gains, filters, friction and cogging of its machines are those that anybody finds on their axes."""
        with Appliance() as appliance, tempfile.TemporaryDirectory() as folder:
            self.rmac(appliance, "load", "DMACXYZ")
            words = ("tune", "0", "--travel", "20", "--creep", "-o", str(pathlib.Path(folder, "tune.png")))
            found = json.loads(self.rmac(appliance, "--json", *words))
            device = json.loads(next(appliance.tree.glob("*/*/DMACXYZ/device.json")).read_text())
        joint, creep = device["Joints"][0], found["creep"]
        for gain, own in zip(found["pid_gains"], joint["Gains"], strict=True):
            self.assertAlmostEqual(gain / own, 1, delta=0.06)
        (notch,), (own,) = found["proposed"]["filters"]["Resonances"], joint["Resonances"]
        self.assertAlmostEqual(notch["Frequency"], own["Frequency"], delta=3)
        self.assertEqual(found["proposed"]["filters"]["LowPass"], joint["LowPass"])
        parameters = joint["ServoControlLaw"]["Parameters"]
        self.assertAlmostEqual(found["plant"]["mass"] / parameters["mass"], 1, delta=0.02)
        self.assertAlmostEqual(creep["friction"] / parameters["friction"], 1, delta=0.05)
        self.assertAlmostEqual(creep["parameters"]["presliding"][0] / parameters["presliding"], 1, delta=0.15)
        (cogs,), (known,) = creep["motor"]["cogging"]["Harmonics"], device["Actuators"][0]["Cogging"]["Harmonics"]
        self.assertEqual(cogs["Order"], known["Order"])
        self.assertAlmostEqual(cogs["Sine"] / known["Sine"], 1, delta=0.1)

    def test_tune_creeps_a_turn_of_the_motor_at_least(self):
        with Appliance() as appliance, tempfile.TemporaryDirectory() as folder:
            self.rmac(appliance, "load", "DMACXYZ")
            short = appliance.rmac("tune", "0", "--travel", "4", "--creep", "-o", str(pathlib.Path(folder, "tune.png")))
        self.assertEqual((short.returncode, short.stderr.count("\n")), (1, 1), short.stderr)
        self.assertIn("--creep takes a turn of the motor at least, which is 5: give more --travel", short.stderr)

    def test_tune_finds_cogging_and_how_friction_builds_up(self):
        """And puts it in force: the law with feedforward, and the motor's map."""
        soft = {"Gains": [120, 2000, 1.2], "MaxFollowingError": 1}
        with self.bending(274, soft) as appliance, tempfile.TemporaryDirectory() as folder:
            words = ("tune", "1", "--creep", "-o", str(pathlib.Path(folder, "tune.png")))
            said = self.rmac(appliance, *words, "--travel", "20", "--apply")
            name = json.loads(self.rmac(appliance, "--json", "trace", "record"))["name"]
            head = json.loads(appliance.client().call("FlightRecorder.Read", Name=name, Offset=0)["text"].splitlines()[0])
        friction, way = re.search(r"friction slides at ([\d.]+) N, builds up over ([\d.]+) mm", said).groups()
        self.assertAlmostEqual(float(friction) / 18.85, 1, delta=0.1)
        self.assertAlmostEqual(float(way) / 0.01, 1, delta=0.3)
        (percent,) = re.search(r"cogging of 60 periods a turn: .* N·m, ([\d.]+) % of the rated torque", said).groups()
        self.assertAlmostEqual(float(percent) / 2, 1, delta=0.15)
        self.assertIn('into its actuator: "Cogging": {"Harmonics":[{', said)
        joint = head["joints"][1]
        self.assertEqual(joint["law"], "FeedforwardFeedbackServoControlLaw")
        self.assertEqual(set(joint["parameters"]), {"rest_band", "lead_s", "presliding", "breakaway", "stribeck_speed"})
        self.assertEqual(head["joints"][0]["law"], "DMACXYZPIDServoControlLaw")

    def test_tune_finds_a_joint_of_two_motors(self):
        """All but their cogging, which the joint shows as a sum: mass and friction of both."""
        with tempfile.TemporaryDirectory() as folder, Appliance(own_tree=True, flight_recorder={"seconds": 30}) as appliance:
            bend(appliance, 274, {"Gains": [120, 2000, 1.2], "MaxFollowingError": 1})
            on_two_motors(appliance)
            self.rmac(appliance, "load", "DMACXYZ")
            words = ("tune", "0", "--travel", "20", "--creep", "-o", str(pathlib.Path(folder, "tune.png")))
            found = json.loads(self.rmac(appliance, "--json", *words))
            said = self.rmac(appliance, *words, "--apply")
        both = 2 * 2.2e-5 * RAD_PER_MM ** 2 * 1000
        self.assertAlmostEqual(found["plant"]["mass"] / both, 1, delta=0.03)
        self.assertAlmostEqual(found["creep"]["friction"] / (2 * 18.85), 1, delta=0.1)
        self.assertAlmostEqual(found["creep"]["parameters"]["presliding"][0] / 0.01, 1, delta=0.3)
        self.assertIsNone(found["creep"]["motor"])
        self.assertIn("cogging is not told: its 2 motors turn alike", said)
        self.assertNotIn('"Cogging"', said)

    @contextlib.contextmanager
    def bending(self, hz, joint, heavier=1.0, load=True):
        """DMACXYZ, with axes of two masses that swing at `hz`, so many times heavier than it says, and `joint` in the
        data of its first three."""
        appliance = Appliance(own_tree=True, flight_recorder={"seconds": 30})
        bend(appliance, hz, joint, heavier)
        with appliance:
            if load:
                self.rmac(appliance, "load", "DMACXYZ")
            yield appliance

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

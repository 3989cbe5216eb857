"""rmac tune --creep: cogging, and friction before it slides."""

import json
import pathlib
import re
import tempfile
import unittest

from appliance import Appliance
from bending_mill import RAD_PER_MM, TuningTest, bend, on_two_motors


class TuneCreep(TuningTest):
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

    def test_the_tree_has_what_tune_finds(self):
        """Gains, filters, friction and cogging of its machines are those that anybody finds on their axes."""
        for machine, number, travel in (("DMACXYZ", 0, "20"), ("SuginoXYZ", 0, "40"), ("TarusXYZCATwin", 0, "40"), ("TarusXYZCATwin", 4, "40")):
            with self.subTest(machine, joint=number), Appliance() as appliance, tempfile.TemporaryDirectory() as folder:
                self.rmac(appliance, "load", machine)
                found = json.loads(self.rmac(appliance, "--json", "tune", str(number), "--travel", travel, "--creep", "-o",
                                             str(pathlib.Path(folder, "tune.png"))))
                device = json.loads(next(appliance.tree.glob(f"*/*/{machine}/device.json")).read_text())
                self.has(device, number, found)

    def has(self, device, number, found):
        joint, creep = device["Joints"][number], found["creep"]
        for gain, own in zip(found["pid_gains"], joint["Gains"][:3], strict=True):
            self.assertAlmostEqual(gain / own, 1, delta=0.06)
        (notch,), (own,) = found["proposed"]["filters"]["Resonances"], joint["Resonances"]
        self.assertAlmostEqual(notch["Frequency"], own["Frequency"], delta=3)
        self.assertEqual(found["proposed"]["filters"]["LowPass"], joint.get("LowPass", 0))
        parameters = joint["ServoControlLaw"]["Parameters"]
        mass, friction = joint["Gains"][4:6] or (parameters["mass"], parameters["friction"])
        self.assertAlmostEqual(found["plant"]["mass"] / mass, 1, delta=0.02)
        self.assertAlmostEqual(creep["friction"] / friction, 1, delta=0.05)
        self.assertAlmostEqual(creep["parameters"]["presliding"][0] / parameters["presliding"], 1, delta=0.15)
        (cogs,), (known,) = creep["motor"]["cogging"]["Harmonics"], device["Actuators"][number]["Cogging"]["Harmonics"]
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
        kp, _, kd = found["pid_gains"]
        together = found["side_by_side"]
        self.assertEqual(together["motors"], 2)
        self.assertAlmostEqual(together["Gantry"]["Stiffness"] / kp, 0.5, delta=1e-4)
        self.assertAlmostEqual(together["Gantry"]["Damping"] / kd, 0.5, delta=1e-4)
        self.assertLess(together["apart"], 0.2)
        self.assertRegex(said, r"2 motors move it, up to [\d.e-]+ mm out of step .*\"Stiffness\": [\d.]+, \"Damping\": [\d.]+")
        self.assertIn("cogging is not told: its 2 motors turn alike", said)
        self.assertNotIn('"Cogging"', said)


if __name__ == "__main__":
    unittest.main()

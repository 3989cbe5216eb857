"""rmac tune and rmac measure-following: what they find, and that they change nothing unless told to."""

import json
import os
import pathlib
import random
import sys
import tempfile
import unittest

import numpy as np

from appliance import Appliance
from simulated_joint import PERIOD, Joint, excitation

sys.path.insert(0, str(pathlib.Path(os.environ["RMAC_SOURCE"], "gateway/rmac/helpers")))
import servo_model  # noqa: E402

PNG = b"\x89PNG\r\n\x1a\n"
MARGIN = 40.0
ROTOR = 4.49e-6 + 4.8e-6  # kg·m², of the simulated axes beside their table
RAD_PER_MM = 2 * np.pi / 5


class Identification(unittest.TestCase):
    def recordings(self, count):
        for seed in range(1, count + 1):
            joint = Joint.of(seed)
            kg = 1000 * joint.mass
            setpoints = list(excitation(travel=20, max_speed=100, acceleration=1000, jerk=10000))
            positions, efforts = joint.follow(setpoints, (45 * kg, 45 * 90 * kg, 0.32 * kg))
            found = servo_model.identify(np.arange(len(positions)) * PERIOD, np.array(positions), np.array(efforts))
            yield seed, joint, found

    def test_finds_the_parameters_of_seeded_joints(self):
        """Mass and friction within 1 %, load within 0.5 N, delay within 0.3 ms, viscous friction within 5 % of all
        friction at the fastest speed."""
        for seed, joint, found in self.recordings(40):
            with self.subTest(seed=seed, joint=joint, found=found):
                self.assertAlmostEqual(found.mass / joint.mass, 1, delta=0.01)
                self.assertAlmostEqual(found.friction / joint.friction, 1, delta=0.01)
                self.assertAlmostEqual(found.load, joint.load, delta=0.5)
                self.assertAlmostEqual(found.delay_s, joint.delay_s, delta=0.0003)
                whole = joint.friction + 100 * joint.viscous
                self.assertAlmostEqual(100 * found.viscous, 100 * joint.viscous, delta=0.05 * whole)

    def test_proposed_gains_hold_the_phase_margin_on_the_true_joint(self):
        """Within 4 degrees: what 0.3 ms of delay are at the crossover."""
        for seed, joint, found in self.recordings(40):
            true = servo_model.Plant(joint.mass, joint.viscous, joint.friction, joint.load, joint.delay_s)
            for share in (0.5, 0.9):
                with self.subTest(seed=seed, joint=joint, share=share):
                    bandwidth = share * servo_model.largest_bandwidth_hz(found, MARGIN)
                    gains = servo_model.gains_for(found, bandwidth, MARGIN)
                    crossover, margin, _ = servo_model.margins(true, gains)
                    self.assertAlmostEqual(crossover, bandwidth, delta=0.02 * bandwidth)
                    self.assertGreater(margin, MARGIN - 4)

    def test_proposed_gains_keep_the_true_joint_calm(self):
        """In the time domain, with friction and the encoder: it follows a move and comes to rest."""
        for seed, joint, found in self.recordings(10):
            with self.subTest(seed=seed, joint=joint):
                gains = servo_model.gains_for(found, 0.9 * servo_model.largest_bandwidth_hz(found, MARGIN), MARGIN)
                setpoints = list(excitation(travel=5, max_speed=50, acceleration=500, jerk=5000))
                positions, _ = joint.follow(setpoints, gains)
                error = np.abs(np.array([wanted for wanted, _ in setpoints]) - positions)
                self.assertLess(error.max(), 0.1)
                self.assertLess(error[-20:].max(), 0.005)

    def test_refuses_what_cannot_be(self):
        plant = servo_model.Plant(0.02, 0.01, 10, 0, 0.0017)
        with self.assertRaisesRegex(ValueError, "out of reach for a delay of 1.70 ms; at most 57.19 Hz"):
            servo_model.gains_for(plant, 80, MARGIN)
        with self.assertRaisesRegex(servo_model.Unidentifiable, "did not move"):
            servo_model.identify(np.arange(1000) * PERIOD, np.zeros(1000), np.ones(1000))
        with self.assertRaisesRegex(servo_model.Unidentifiable, "too few"):
            servo_model.identify(np.arange(50) * PERIOD, np.arange(50.0), np.ones(50))


class Commands(unittest.TestCase):
    def rmac(self, appliance, *words):
        done = appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return done.stdout

    def test_tune_finds_the_simulated_axes_and_applies_when_told(self):
        for seed in (1, 2, 3):
            chance = random.Random(seed)
            inertia = [chance.uniform(1.5e-5, 4e-5) for _ in range(3)]
            friction = [chance.uniform(0.008, 0.03) for _ in range(3)]
            with self.subTest(inertia=inertia, friction=friction), Appliance(own_tree=True) as appliance, \
                    tempfile.TemporaryDirectory() as folder:
                file = next(appliance.tree.glob("*/*/DMACXYZ/device.json"))
                device = json.loads(file.read_text())
                rest = [2.2e-5] * 5
                device["DigitalControlInterface"]["Parameters"] = {
                    "inertia_kg_m2": inertia + rest, "friction_nm": friction + [0.015] * 5}
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

                again = json.loads(self.rmac(appliance, *words, "--apply"))
                self.assertEqual(again["before"]["gains"], device["Joints"][joint]["Gains"], "nothing was changed")
                third = json.loads(self.rmac(appliance, *words))
                for applied, proposed in zip(third["before"]["gains"], again["apply"], strict=True):
                    self.assertAlmostEqual(applied / proposed, 1, delta=1e-9)
                self.assertAlmostEqual(third["before"]["phase_margin_deg"], MARGIN, delta=4)

    def test_measure_following_draws_the_circle_and_its_reversals(self):
        appliance = self.enterContext(Appliance())
        self.rmac(appliance, "load", "DMACXYZ")
        with tempfile.TemporaryDirectory() as folder:
            picture = pathlib.Path(folder, "circle.png")
            words = ("measure-following", "--radius", "20", "-o", str(picture))
            result = json.loads(self.rmac(appliance, "--json", *words))
            self.assertTrue(picture.read_bytes().startswith(PNG))
        self.assertAlmostEqual(result["feed_mm_min"], 2000, delta=2)
        self.assertEqual(len(result["reversal_spikes_um"]), 4)
        for spike in result["reversal_spikes_um"]:
            self.assertGreater(abs(spike), 2, "PID meets friction where an axis turns round")
            self.assertLess(abs(spike), 40)
        self.assertLess(result["circular_deviation_um"], 60)

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


if __name__ == "__main__":
    unittest.main()

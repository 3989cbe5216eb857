"""What rmac tune's programs find of a rigid joint, and what they propose for it, held against the joint itself."""

import os
import pathlib
import random
import sys
import tracemalloc
import unittest

import numpy as np

from simulated_joint import PERIOD, Joint, excitation

sys.path.insert(0, str(pathlib.Path(os.environ["RMAC_SOURCE"], "gateway/rmac/plots")))
import loop_design  # noqa: E402
import servo_model  # noqa: E402
from frequency_response import Model  # noqa: E402

MARGIN = 40.0


class Identification(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.recordings = []
        setpoints = list(excitation(travel=20, max_speed=100, acceleration=1000, jerk=10000))
        for seed in range(1, 41):
            joint = Joint.of(seed)
            kg = 1000 * joint.mass
            positions, efforts = joint.follow(setpoints, (45 * kg, 45 * 90 * kg, 0.32 * kg))
            found = servo_model.identify(np.arange(len(positions)) * PERIOD, np.array(positions), np.array(efforts))
            cls.recordings.append((seed, joint, found))

    def test_finds_the_parameters_of_seeded_joints(self):
        """Mass and friction within 1 %, load within 0.5 N, delay within 0.3 ms, viscous friction within 5 % of all
        friction at the fastest speed."""
        for seed, joint, found in self.recordings:
            with self.subTest(seed=seed, joint=joint, found=found):
                self.assertAlmostEqual(found.mass / joint.mass, 1, delta=0.01)
                self.assertAlmostEqual(found.friction / joint.friction, 1, delta=0.01)
                self.assertAlmostEqual(found.load, joint.load, delta=0.5)
                self.assertAlmostEqual(found.delay_s, joint.delay_s, delta=0.0003)
                whole = joint.friction + 100 * joint.viscous
                self.assertAlmostEqual(100 * found.viscous, 100 * joint.viscous, delta=0.05 * whole)

    def test_proposed_gains_hold_the_phase_margin_on_the_true_joint(self):
        """Within 4 degrees: what 0.3 ms of delay are at the crossover."""
        for seed, joint, found in self.recordings:
            true = Model(PERIOD, joint.mass, joint.delay_s)
            thought = Model(PERIOD, found.mass, found.delay_s)
            quickest = loop_design.margins_of(loop_design.design(thought, MARGIN), thought).bandwidth_hz
            for share in (0.5, 0.9):
                with self.subTest(seed=seed, joint=joint, share=share):
                    loop = loop_design.design(thought, MARGIN, share * quickest)
                    kept = loop_design.margins_of(loop, true)
                    self.assertAlmostEqual(kept.bandwidth_hz, share * quickest, delta=0.02 * quickest)
                    self.assertGreater(kept.phase_margin_deg, MARGIN - 4)

    def test_proposed_gains_keep_the_true_joint_calm(self):
        """In the time domain, with friction and the encoder: it follows a move and comes to rest."""
        for seed, joint, found in self.recordings[:10]:
            with self.subTest(seed=seed, joint=joint):
                gains = loop_design.design(Model(PERIOD, found.mass, found.delay_s), MARGIN).gains
                setpoints = list(excitation(travel=5, max_speed=50, acceleration=500, jerk=5000))
                positions, _ = joint.follow(setpoints, gains)
                error = np.abs(np.array([wanted for wanted, _ in setpoints]) - positions)
                self.assertLess(error.max(), 0.1)
                self.assertLess(error[-20:].max(), 0.005)

    def test_gains_are_such_as_laws_take(self):
        chance = random.Random(5)
        for _ in range(40):
            joint = Model(PERIOD, 10 ** chance.uniform(-3, 0), chance.uniform(0.001, 0.004))
            margin = chance.uniform(32, 70)
            with self.subTest(joint=joint, margin=margin):
                gains = loop_design.design(joint, margin).gains
                self.assertTrue(gains[0] > 0 and min(gains) >= 0, gains)

    def test_a_joint_that_is_a_little_other_gets_a_loop_that_is_a_little_other(self):
        """As noise makes it: a hundredth more delay costs a hundredth of bandwidth or two, wherever on the way that is."""
        bandwidths = []
        for delay in np.geomspace(0.0015, 0.0032, 76):
            joint = Model(PERIOD, 0.02, delay)
            bandwidths.append(loop_design.margins_of(loop_design.design(joint, MARGIN), joint).bandwidth_hz)
        steps = np.array(bandwidths[:-1]) / bandwidths[1:]
        self.assertLess(steps.max(), 1.025)
        self.assertGreater(steps.min(), 0.99)

    def test_a_motor_that_cogs_is_told_from_mass_and_friction(self):
        """By as much as it takes to speed up, every 5 to 16 mm, as a linear motor does, under a soft loop, which goes along with it; half of
        them behind an encoder so coarse that the loop shakes."""
        setpoints = list(excitation(travel=20, max_speed=100, acceleration=1000, jerk=10000))
        for seed in range(1, 9):
            chance = random.Random(seed)
            joint = Joint.of(seed)
            kg, share = 1000 * joint.mass, chance.choice([0.0, 0.05, 0.4])
            joint.friction, joint.load = share * kg, 0.0
            joint.cogs, joint.pitch = chance.uniform(0.5, 2.0) * kg, chance.uniform(5, 16)
            if seed % 2 == 0:
                joint.count = 0.01
            positions, efforts = joint.follow(setpoints, (5.6 * kg, 63 * kg, 0.04 * kg))
            with self.subTest(seed=seed, joint=joint):
                found = servo_model.identify(np.arange(len(positions)) * PERIOD, np.array(positions), np.array(efforts),
                                             wanted=np.array([place for place, _ in setpoints]))
                self.assertAlmostEqual(found.mass / joint.mass, 1, delta=0.05)
                self.assertAlmostEqual(found.friction, joint.friction, delta=0.03 * kg)
                self.assertLess(abs(found.load), 0.5 * joint.cogs)  # of the part of a period that is left over
                fast = np.abs([speed for _, speed in setpoints]) > 5
                by_place = joint.cogs * np.sin(2 * np.pi * np.array(positions)[fast] / joint.pitch)
                share = np.var(by_place) / np.var(np.array(efforts)[fast])
                self.assertAlmostEqual(found.explained, 1 - share, delta=0.12)
                self.assertAlmostEqual(found.by_place, share, delta=0.12)

    def test_a_long_record_of_a_fast_cycle_is_no_burden(self):
        """20 s at 0.25 ms, with noise, of a joint that cogs: in 150 MB."""
        period, noise = 0.00025, np.random.default_rng(1)
        time = np.arange(0, 20, period)
        wanted = 20 * (1 - np.cos(np.pi * time)) + 3 * (1 - np.cos(2 * np.pi * time / 0.7))
        speed = np.gradient(wanted, period)
        needed = 0.05 * np.gradient(speed, period) + 0.02 * speed + 10 * np.sign(speed) + 15 * np.sin(2 * np.pi * wanted / 7)
        effort = np.interp(time + 0.0006, time, needed) + noise.standard_normal(len(time))
        position = wanted + 0.001 * noise.standard_normal(len(time))
        tracemalloc.start()
        found = servo_model.identify(time, position, effort, period, wanted=wanted)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        self.assertLess(most, 150e6)
        self.assertAlmostEqual(found.mass / 0.05, 1, delta=0.01)
        self.assertAlmostEqual(found.friction / 10, 1, delta=0.01)
        self.assertAlmostEqual(found.delay_s, 0.0006, delta=0.0001)

    def test_a_joint_that_rings_is_no_later_by_a_period_of_that(self):
        """Its acceleration and its effort swing together, and would so a period later: the first delay that explains them is right."""
        setpoints = np.array(list(excitation(travel=40, max_speed=90, acceleration=75, jerk=750)))
        time = np.arange(len(setpoints)) * PERIOD
        mass, friction, delay = 0.05, 13.5, 0.0023
        for seed in range(1, 13):
            noise, hz = np.random.default_rng(seed), random.Random(seed).uniform(125, 165)
            ring = 600 * np.sin(2 * np.pi * hz * time + np.cumsum(0.05 * noise.standard_normal(len(time))))
            position = setpoints[:, 0] - ring / (2 * np.pi * hz) ** 2
            needed = mass * (np.gradient(setpoints[:, 1], PERIOD) + 0.6 * ring) + friction * np.sign(setpoints[:, 1])
            effort = np.interp(time + delay, time, needed) + 0.1 * noise.standard_normal(len(time))
            with self.subTest(seed=seed, hz=hz):
                found = servo_model.identify(time, position, effort, PERIOD)
                self.assertAlmostEqual(found.delay_s, delay, delta=0.001)

    def test_refuses_what_cannot_be(self):
        joint = Model(PERIOD, 0.02, 0.0017)
        # A whole turn of delay later the same angle comes again; that is no lead that a law could give.
        for bandwidth in (60, 80, 150, 300, 450):
            with self.assertRaisesRegex(loop_design.Undesignable, "out of reach for a delay of 1.70 ms; at most about 4"):
                loop_design.design(joint, MARGIN, bandwidth)
        with self.assertRaisesRegex(servo_model.Unidentifiable, "did not move"):
            servo_model.identify(np.arange(1000) * PERIOD, np.zeros(1000), np.ones(1000))
        with self.assertRaisesRegex(servo_model.Unidentifiable, "too few"):
            servo_model.identify(np.arange(50) * PERIOD, np.arange(50.0), np.ones(50))


if __name__ == "__main__":
    unittest.main()

"""What rmac tune's programs find of a joint that bends, and what they propose for it, held against the joint itself."""

import dataclasses
import os
import pathlib
import sys
import types
import unittest

import numpy as np

from bending_joint import PERIOD, BendingJoint, ClosedLoop, strokes, swept_sine

sys.path.insert(0, str(pathlib.Path(os.environ["RMAC_SOURCE"], "gateway/rmac/plots")))
import frequency_response  # noqa: E402
import loop_design  # noqa: E402
import servo_model  # noqa: E402
import tune  # noqa: E402

SWEEP = dict(from_hz=20, to_hz=495, period_s=0.5, sweeps=7)
FIRST_SEED, SEEDS = int(os.environ.get("RMAC_SEED", "1")), int(os.environ.get("RMAC_SEEDS", "12"))


def soft_gains(joint):
    """Gains with which it holds, as somebody would find them who has only the joint."""
    kg, softer = 1000 * joint.mass, 1.0
    while True:
        gains = (3.5 * kg * softer**2, 30 * kg * softer**3, 0.035 * kg * softer)
        loop = ClosedLoop(joint, gains, {"Resonances": [], "LowPass": 0})
        if loop.stable() and loop.stable(1.4) and loop.stable(0.7):
            return gains
        softer *= 0.7


def measured(joint, effort_per_mass=1000.0, cogging=lambda places: 0 * places):
    """The response of `joint` under soft gains, as the record of its strokes shows it; `cogging`: N at these places, which act and are
    no effort."""
    setpoints = list(strokes(20, 5))
    steady = [abs(speed) > 1e-6 and abs(change) * PERIOD <= 1e-3 * abs(speed) for _, speed, change in setpoints]
    sine = swept_sine(effort_per_mass * joint.mass, full_hz=70, **SWEEP)
    added = np.zeros(len(setpoints))
    for begin in np.flatnonzero(np.diff([0, *steady]) == 1):
        added[begin:begin + len(sine)] = sine
    wanted = np.array(setpoints)
    unseen = cogging(wanted[:, 0])
    positions, efforts = joint.run([(where, speed) for where, speed, _ in setpoints], soft_gains(joint), added + unseen)
    efforts = efforts - unseen
    columns = {"t_s": np.arange(len(wanted)) * PERIOD, "q1": wanted[:, 0], "qd1": wanted[:, 1], "qdd1": wanted[:, 2],
               "a1": positions, "effort1": efforts}
    return frequency_response.measure([columns], 1, SWEEP["period_s"], SWEEP["sweeps"], (20, 495))


def filters_of(loop):
    return {"Resonances": [{"Frequency": notch.frequency, "Damping": notch.damping, "Width": notch.width}
                           for notch in loop.filters.notches], "LowPass": loop.filters.low_pass}


def as_samples_show_it(frequency):
    """Below half the sampling rate: what is beyond it folds back."""
    return min(frequency, 1 / PERIOD - frequency)


class JointsThatBend(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.joints = [(seed, BendingJoint.of(seed)) for seed in range(FIRST_SEED, FIRST_SEED + SEEDS)]
        cls.found = {seed: frequency_response.fit(measured(joint), PERIOD) for seed, joint in cls.joints}

    def test_resonances_are_found_where_they_are(self):
        for seed, joint in self.joints:
            with self.subTest(seed=seed, joint=joint):
                found = self.found[seed]
                wanted = as_samples_show_it(joint.resonance_hz)
                if wanted > 470:
                    continue
                nearest = min(found.resonances(), key=lambda mode: abs(mode[0] - wanted))
                self.assertAlmostEqual(nearest[0] / wanted, 1, delta=0.01)

    def test_proposed_loops_keep_their_margins_on_the_joint_itself(self):
        """6 dB and 30 degrees; and stable with 3 dB where its resonance is 15 % elsewhere."""
        for seed, joint in self.joints:
            with self.subTest(seed=seed, joint=joint):
                loop = loop_design.design(self.found[seed], 40)
                closed = ClosedLoop(joint, loop.gains, filters_of(loop))
                for gain in (0.7, 1, 1.4, 2):
                    self.assertTrue(closed.stable(gain), (gain, loop))
                self.assertGreater(closed.phase_margin(), 30)
                for factor in (0.85, 0.92, 1.08, 1.15):
                    moved = ClosedLoop(joint.elsewhere(factor), loop.gains, filters_of(loop))
                    self.assertTrue(moved.stable() and moved.stable(1.41), (factor, loop))

    def test_a_rigid_joint_gets_no_notch(self):
        for seed, joint in self.joints[:4]:
            stiff = joint.elsewhere(5000 / joint.resonance_hz)
            with self.subTest(seed=seed, joint=stiff):
                found = frequency_response.fit(measured(stiff), PERIOD)
                self.assertAlmostEqual(found.mass / stiff.mass, 1, delta=0.05)
                self.assertEqual(loop_design.design(found, 40).filters.notches, [])

    def test_sines_that_move_a_motor_within_its_play_are_told_from_the_joint(self):
        """The motor alone: the loop that suits it is not proposed for the joint. Nor that for a joint which is heavier than what swung."""
        sweep = types.SimpleNamespace(sweep_effort=20.0, from_hz=20.0)
        for seed, joint in self.joints[:4]:
            with self.subTest(seed=seed, joint=joint):
                alone = joint.elsewhere(5000 / joint.resonance_hz)
                alone.motor, alone.load = 0.6 * joint.motor, 0.01 * joint.motor
                plant = servo_model.Plant(joint.mass, joint.viscous, 40.0, 0.0, 0.0017)
                for motor in (0.6 * joint.motor, 0.78 * joint.mass):
                    alone.motor = motor
                    with self.assertRaisesRegex(frequency_response.Unheard, "play.*near 20 Hz or below.*--sweep-effort 10$"):
                        tune.check_mass(plant, frequency_response.fit(measured(alone), PERIOD), "mm", sweep)
                for friction in (0.0, 400.0):  # sines of a quarter of it were none, or more than those that were
                    other = dataclasses.replace(plant, friction=friction)
                    with self.assertRaisesRegex(frequency_response.Unheard, "nothing is proposed$"):
                        tune.check_mass(other, frequency_response.fit(measured(alone), PERIOD), "mm", sweep)
                heavier = dataclasses.replace(plant, mass=joint.mass / 1.8)
                with self.assertRaisesRegex(frequency_response.Unheard, "more --travel$"):
                    tune.check_mass(heavier, self.found[seed], "mm", sweep)
                tune.check_mass(plant, self.found[seed], "mm", sweep)

    def test_a_motor_that_cogs_hides_no_resonance(self):
        """Twice as much as the sines have, every 8 mm of a stroke of 20, as a linear motor's magnets do: the loop, which is soft, lets the
        joint drift by far more than the sines do."""
        for seed, joint in self.joints[:6]:
            wanted = as_samples_show_it(joint.resonance_hz)
            if wanted > 470:
                continue
            with self.subTest(seed=seed, joint=joint):
                size = 2000 * joint.mass
                found = frequency_response.fit(
                    measured(joint, cogging=lambda places, size=size: size * np.sin(2 * np.pi * places / 8.0)), PERIOD)
                self.assertLess(found.misfit, 0.1)
                nearest = min(found.resonances(), key=lambda mode: abs(mode[0] - wanted))
                self.assertAlmostEqual(nearest[0] / wanted, 1, delta=0.01)


class LinesOfOneMode(unittest.TestCase):
    """Where a model of one mode is all that the lines show."""

    def test_what_lines_are_not_sure_of_is_no_further_mode(self):
        """As cogging leaves it: something narrow, within what the lines may be off by."""
        frequency = np.arange(21, 495, 2.0)
        for seed in range(1, 9):
            chance = np.random.default_rng(seed)
            hz = chance.uniform(80, 140)
            place = 2 * np.pi * PERIOD * hz
            mode = frequency_response.Mode(place, 0.02)
            mode.over = tuple(0.3 * (1 - np.cos(place)) * PERIOD**2 / 3 * share for share in (0.5, 1, 0.5))
            true = frequency_response.Model(PERIOD, 3.0, 0.0027, 0.0, [mode])
            noise = chance.standard_normal(len(frequency)) + 1j * chance.standard_normal(len(frequency))
            narrow = frequency_response.Mode(0.8 * place, 0.006, (0.0, 1.0, 0.0)).response(2 * np.pi * frequency * PERIOD)
            answer = true.response(frequency)
            narrow *= 0.7 / np.abs(narrow / answer).max()
            value = answer * (1 + 0.01 * noise) + narrow
            with self.subTest(seed=seed):
                found = frequency_response.fit(frequency_response.Response(frequency, value, np.full(len(frequency), 0.4)), PERIOD)
                (seen,) = found.resonances()
                self.assertAlmostEqual(seen[0] / hz, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()

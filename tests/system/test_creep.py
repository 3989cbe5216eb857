"""What `rmac tune --creep` finds, held to a joint that is simulated here, apart from the appliance and its simulated axes."""

import math
import os
import random
import sys
import unittest

import numpy as np
from appliance import SOURCE

sys.path.insert(0, str(SOURCE / "gateway/rmac/plots"))
import creep  # noqa: E402
import frequency_response  # noqa: E402
import servo_model as model  # noqa: E402

PERIOD, STEPS = 0.001, 4
TURN, COUNTS = 5.0, 131072
FIRST, SEEDS = int(os.environ.get("RMAC_SEED", "1")), int(os.environ.get("RMAC_SEEDS", "3"))


class CreepingJoint:
    """A mass on a screw with LuGre's friction (Canudas de Wit et al., 1995) and a motor that cogs, under a PID that holds it."""

    def __init__(self, seed):
        chance = random.Random(seed)
        self.mass = 10 ** chance.uniform(-2, -1)  # N·s²/mm
        self.viscous = self.mass * chance.uniform(1, 4)
        self.coulomb = chance.uniform(10, 40)
        self.presliding = chance.uniform(0.003, 0.02)
        self.breakaway = chance.uniform(1.0, 1.4)
        self.stribeck = chance.uniform(0.5, 2)
        self.load = chance.uniform(-30, 30)
        self.rated = self.mass * 10
        self.direction = chance.choice([1, -1])
        self.cogging = {order: (self.rated * chance.uniform(0.004, 0.02), chance.uniform(0, 2 * math.pi))
                        for order in chance.sample([12, 24, 36, 60, 72, 84], 2)}
        self.noise = np.random.default_rng(seed)

    def force_of_motor(self, place):
        """mm to N."""
        angle = self.direction * 2 * math.pi * place / TURN
        torque = sum(size * math.cos(order * angle + phase) for order, (size, phase) in self.cogging.items())
        return self.direction * torque * 2 * math.pi * 1000 / TURN

    def run(self, wanted):
        """Columns of a record, of this way that it is to go."""
        place = speed = bristle = integral = before = 0.0
        sigma, effort, delayed = self.coulomb / self.presliding, self.load, self.load
        damping = 0.6 * math.sqrt(sigma * self.mass)
        rows, dt = [], PERIOD / STEPS
        for target in wanted:
            seen = round(self.direction * (place / TURN * COUNTS) + self.noise.normal(0, 1))
            shown = self.direction * seen * TURN / COUNTS
            error = target - shown
            integral += error * PERIOD
            rate, before = (error - before) / PERIOD, error
            delayed, effort = effort, self.load + self.mass * (9000 * error + 160 * rate + 200_000 * integral)
            rows.append((shown, effort, seen))
            for _ in range(STEPS):
                bound = self.coulomb * (1 + (self.breakaway - 1) * math.exp(-(speed / self.stribeck) ** 2))
                bend = speed - sigma * abs(speed) / bound * bristle
                near = math.exp(-(speed / self.stribeck) ** 2)
                friction = sigma * bristle + near * damping * bend + self.viscous * speed
                bristle += bend * dt
                speed += (delayed - friction - self.load + self.force_of_motor(place)) / self.mass * dt
                place += speed * dt
        table = np.array(rows)
        return {"t_s": np.arange(len(rows)) * PERIOD, "a1": table[:, 0], "effort1": table[:, 1], "counts1": table[:, 2],
                "qd1": np.gradient(wanted, PERIOD)}


def strokes(way, seconds, count):
    """To and fro at a steady speed, with rests, and smooth between them."""
    there = np.linspace(0, way, int(seconds / PERIOD))
    rest = np.full(200, way)
    wanted = np.concatenate([np.zeros(200), *([there, rest, there[::-1], np.zeros(200)] * count)])
    smooth = np.hanning(63)[1:-1]
    return np.convolve(np.pad(wanted, 30, mode="edge"), smooth / smooth.sum(), mode="valid")


class Creep(unittest.TestCase):
    def find(self, joint, known=()):
        records = [joint.run(strokes(2 * TURN, 3.5, 1)), joint.run(strokes(0.06 * TURN, 0.75, 4))]
        return self.found_in(records, joint, [self.scale(joint, known)])

    @staticmethod
    def scale(joint, known=()):
        return {"counts_per_revolution": COUNTS, "rated_torque": joint.rated, "direction": joint.direction,
                "cogging": {"lead": 0, "harmonics": known}}

    @staticmethod
    def found_in(records, joint, actuators):
        head = {"joints": [{"unit": "mm"}], "actuators": actuators}
        plant = model.Plant(joint.mass, joint.viscous, joint.coulomb, joint.load, 1.5 * PERIOD)
        return creep.find(head, records, 0, plant, frequency_response.Model(PERIOD, plant.mass, plant.delay_s))

    def test_finds_the_harmonics_and_the_friction_of_seeded_joints(self):
        for seed in range(FIRST, FIRST + SEEDS):
            with self.subTest(seed=seed):
                joint = CreepingJoint(seed)
                motor, found = self.find(joint)
                self.assertAlmostEqual(motor.turn, joint.direction * TURN, delta=1e-3 * TURN)
                self.assertEqual(sorted(order for order, _, _ in found.harmonics), sorted(joint.cogging))
                for order, cosine, sine in found.harmonics:
                    size, phase = joint.cogging[order]
                    left = math.hypot(cosine - size * math.cos(phase), sine + size * math.sin(phase))
                    self.assertLess(left, 0.2 * size + 0.001 * joint.rated, f"order {order}")
                self.assertAlmostEqual(found.friction.sliding / joint.coulomb, 1, delta=0.06)
                # Its bristles are those of another model, which begin to slide at once.
                self.assertAlmostEqual(found.friction.presliding / joint.presliding, 1, delta=0.4)
                self.assertAlmostEqual(found.friction.breakaway, joint.breakaway, delta=0.25)
                self.assertGreater(found.explained, 0.99)

    def test_what_is_taken_away_already_is_added_to_what_is_left(self):
        joint = CreepingJoint(FIRST)
        known = [{"order": order, "cosine": 0.3 * size * math.cos(phase), "sine": -0.3 * size * math.sin(phase)}
                 for order, (size, phase) in joint.cogging.items()]
        alone = {order: complex(cosine, sine) for order, cosine, sine in self.find(joint)[1].harmonics}
        added = {order: complex(cosine, sine) for order, cosine, sine in self.find(joint, known)[1].harmonics}
        self.assertEqual(set(added), set(alone))
        for one in known:
            self.assertAlmostEqual(abs(added[one["order"]] - alone[one["order"]] - complex(one["cosine"], one["sine"])), 0,
                                   delta=2e-4 * joint.rated)

    def test_finds_no_cogging_where_there_is_none(self):
        for seed in range(FIRST, FIRST + (SEEDS + 2) // 3):
            with self.subTest(seed=seed):
                joint = CreepingJoint(seed)
                joint.cogging = {}
                self.assertEqual(self.find(joint)[1].harmonics, [])

    def test_finds_what_comes_again_with_each_magnet_of_a_joint_without_friction(self):
        """A linear motor on air: what it has twice for each pair of magnets is its cogging, and no guide's."""
        for seed in range(FIRST, FIRST + SEEDS):
            with self.subTest(seed=seed):
                joint = CreepingJoint(seed)
                joint.coulomb *= 1e-6
                joint.cogging = {2: (0.08 * joint.rated, 1.0 + seed), 4: (0.02 * joint.rated, 2.0)}
                _, found = self.find(joint)
                told = {order: complex(cosine, -sine) for order, cosine, sine in found.harmonics}
                for order, (size, phase) in joint.cogging.items():
                    self.assertLess(abs(told.pop(order) - size * np.exp(1j * phase)), 0.1 * size, order)
                self.assertLess(sum(map(abs, told.values())), 0.01 * joint.rated, told)
                # What the laws with feedforward take: none of a Stribeck speed that nobody saw.
                self.assertEqual(found.friction, creep.NO_FRICTION)

    def test_takes_no_pull_that_differs_from_turn_to_turn_for_cogging(self):
        """A cable that hangs on the table pulls by where it is, not by the motor's angle."""
        joint = CreepingJoint(FIRST)
        joint.cogging = {}
        joint.force_of_motor = lambda place: 0.3 * joint.coulomb * math.sin(2 * math.pi * place / (3.3 * TURN))
        self.assertEqual([order for order, _, _ in self.find(joint)[1].harmonics if order < creep.LOWEST_ORDER], [])

    def test_refuses_what_it_does_not_understand(self):
        """A turn alone does not tell what comes again in each; and swings that took friction for something else, or strokes."""
        joint = CreepingJoint(FIRST)
        joint.coulomb *= 1e-6
        joint.cogging = {2: (0.08 * joint.rated, 1.0), 4: (0.02 * joint.rated, 2.0)}
        records = [joint.run(strokes(TURN, 1.75, 1)), joint.run(strokes(0.06 * TURN, 0.75, 4))]
        with self.assertRaisesRegex(model.Unidentifiable, "explains .* more --travel, of two turns of the motor or more"):
            self.found_in(records, joint, [self.scale(joint)])
        records[0] = joint.run(strokes(2 * TURN, 3.5, 1))
        self.found_in(records, joint, [self.scale(joint)])
        joint.coulomb = 0.3 * joint.rated * 2 * math.pi * 1000 / TURN
        with self.assertRaisesRegex(model.Unidentifiable, "the strokes show no friction, and the swings"):
            self.found_in(records, joint, [self.scale(joint)])

    def test_tells_no_cogging_where_the_joint_gives_way(self):
        """By what it answers, three and a half times as much effort would be needed for the same motion as of a rigid one: so near to where
        the load swings alone, what is seen says nothing of the motor. What was taken away already stays."""
        joint = CreepingJoint(FIRST)
        order, (size, phase) = next(iter(joint.cogging.items()))
        joint.cogging = {order: (size, phase)}
        plant = model.Plant(joint.mass, joint.viscous, joint.coulomb, joint.load, 1.5 * PERIOD)
        rigid = frequency_response.Model(PERIOD, plant.mass, plant.delay_s)
        soft = frequency_response.Model(PERIOD, plant.mass, plant.delay_s)
        soft.response = lambda frequency: rigid.response(frequency) / 3.5
        records = [joint.run(strokes(2 * TURN, 3.5, 1)), joint.run(strokes(0.06 * TURN, 0.75, 4))]
        for known in ([], [{"order": order, "cosine": 0.5 * size, "sine": 0.0}]):
            head = {"joints": [{"unit": "mm"}], "actuators": [self.scale(joint, known)]}
            _, found = creep.find(head, records, 0, plant, soft)
            self.assertEqual(found.harmonics, [(order, 0.5 * size, 0.0)] if known else [])
            self.assertEqual([each for each, _ in found.hidden], [order])

    def test_finds_friction_of_two_motors_that_turn_alike_and_tells_no_cogging(self):
        """A gantry: what the joint shows is the sum of what both motors do."""
        joint = CreepingJoint(FIRST)
        records = [self.gantry(joint.run(strokes(2 * TURN, 3.5, 1))), self.gantry(joint.run(strokes(0.06 * TURN, 0.75, 4)))]
        motor, found = self.found_in(records, joint, [self.scale(joint), {**self.scale(joint), "direction": -joint.direction}])
        self.assertEqual((motor.actuators, found.harmonics), ([0, 1], []))
        self.assertIn("the sum of their cogging", creep.no_cogging(motor))
        self.assertAlmostEqual(found.friction.sliding / joint.coulomb, 1, delta=0.06)
        self.assertAlmostEqual(found.friction.presliding / joint.presliding, 1, delta=0.4)
        self.assertAlmostEqual(found.friction.breakaway, joint.breakaway, delta=0.25)

    def test_refuses_a_joint_of_motors_that_do_not_turn_alike(self):
        columns = self.gantry(CreepingJoint(1).run(strokes(TURN, 1, 1)), ratio=2)
        scale = {"counts_per_revolution": COUNTS, "rated_torque": 1}
        with self.assertRaisesRegex(model.Unidentifiable, "2 motors do not turn alike"):
            creep.motor_of({"actuators": [scale, scale]}, columns, 0)

    def test_tells_how_far_motors_of_a_joint_went_out_of_step(self):
        """Whichever way each turns, and wherever it stood: three thousandths of a turn of the second one."""
        columns = self.gantry(CreepingJoint(1).run(strokes(TURN, 1, 1)))
        scale = {"counts_per_revolution": COUNTS, "rated_torque": 1}
        head = {"actuators": [scale, scale]}
        self.assertLess(creep.apart(creep.motor_of(head, columns, 0), head, columns), 1e-9)
        columns["counts2"][1000:1300] += 0.003 * COUNTS
        self.assertAlmostEqual(creep.apart(creep.motor_of(head, columns, 0), head, columns), 0.003 * TURN, delta=1e-4 * TURN)

    @staticmethod
    def gantry(columns, ratio=1):
        """With a second motor, on the other side and the other way round."""
        columns["counts2"] = 5000 - ratio * columns["counts1"]
        return columns

    def test_goes_by_counts_that_wrap(self):
        counts = np.array([2.0 ** 31 - 2, 2.0 ** 31 - 1, -2.0 ** 31, -2.0 ** 31 + 5])
        self.assertEqual(list(np.diff(creep.unwrapped(counts))), [1, 1, 5])


if __name__ == "__main__":
    unittest.main()

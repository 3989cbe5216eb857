"""The stream against a model of a machine: whatever comes when, the program is taken once and in order."""

import random
import unittest

from machine_model import MachineModel
from rmac.errors import ConnectionLost, InvalidValue
from rmac.geometry.nurbs import NurbsCurve
from rmac.moves import Line, MoveTo, Nurbs
from rmac.streaming.gaps import OpenEnds
from rmac.streaming.part import Part
from rmac.streaming.progress import Interrupted, MachineStopped, MoveRefused
from rmac.streaming.stream import Stream


def walk(draw, count, reach=3):
    """Lines on a small grid, which come back to the same places all the time, and a few positioning moves."""
    here = (0.0, 0.0, 0.0)
    for _ in range(count):
        there = (float(draw.randint(0, reach)), float(draw.randint(0, reach)), 0.0)
        if draw.random() < 0.1:
            yield MoveTo(there)
        else:
            yield Line(here, there)
        here = there


def drive(stream, machine, draw, stop_after=None):
    """Until the stream ends: everything happens by chance, and states may be older than the answers around them. The machine is
    stopped once `stop_after` moves are done."""
    finished = []
    for _ in range(200000):
        if stream.ended:
            return finished
        if stop_after is not None and len(machine.done) >= stop_after and not machine.stopping and machine.stopped is None:
            machine.stop()
        event = draw.choice(("send", "carry", "work", "state", "late", "confirm"))
        if event == "send" and (batch := stream.next_batch()):
            machine.send(batch)
        elif event == "carry" and machine.waiting:
            stream.answered(machine.carry_out())
        elif event == "work":
            machine.work()
        elif event == "state":
            stream.heard(machine.state())
        elif event == "late" and machine.waiting:
            state = machine.state()
            stream.answered(machine.carry_out())
            stream.heard(state)
        elif event == "confirm" and stream.asks_state and not machine.waiting:
            stream.confirm(machine.state())
        finished += stream.ledger.finished
        stream.ledger.finished.clear()
        known = {part.move_id for part in finished}
        assert known <= set(machine.done), "told as done before it is"
    raise AssertionError("the stream does not end")


class StreamTest(unittest.TestCase):
    def test_what_a_stop_drops_is_not_told_as_done_and_no_program_ends_by_it(self):
        stopped_in_mid_program = 0
        for seed in range(60):
            draw = random.Random(seed)
            machine = MachineModel(draw, capacity=draw.randint(2, 200))
            stream = Stream(list(walk(draw, 100)), machine.state(), machine.capacity)
            finished = drive(stream, machine, draw, stop_after=draw.randint(0, 60))
            if len(machine.done) < 100:
                stopped_in_mid_program += 1
                self.assertIsInstance(stream.failure, MachineStopped, f"seed {seed}")
                self.assertLessEqual(len(finished), len(machine.done), f"seed {seed}")
        self.assertGreater(stopped_in_mid_program, 40)

    def test_a_program_is_taken_once_and_in_order_whatever_comes_when(self):
        for seed in range(60):
            draw = random.Random(seed)
            machine = MachineModel(draw, capacity=draw.randint(1, 200))
            announced = machine.capacity if draw.random() < 0.7 else 3 * machine.capacity  # so that it has to refuse
            stream = Stream(walk(draw, 500), machine.state(), announced)
            finished = drive(stream, machine, draw)
            with self.subTest(seed=seed):
                self.assertIsNone(stream.failure)
                self.assertEqual(machine.taken, list(range(1, 501)))
                self.assertEqual([part.index for part in finished], list(range(500)))

    def test_the_queue_is_never_asked_for_more_than_it_has(self):
        for seed in range(20):
            draw = random.Random(seed)
            machine = MachineModel(draw, capacity=50)
            machine.carry_out_full = 0
            stream = Stream(walk(draw, 400), machine.state(), machine.capacity)
            drive(stream, machine, draw)
            self.assertLessEqual(machine.most, 50, f"seed {seed}")
            self.assertEqual(machine.refusing, 0)

    def test_no_move_is_taken_behind_a_refused_one(self):
        for seed in range(200):
            draw = random.Random(seed)
            machine = MachineModel(draw, capacity=300, beyond=lambda place: place[0] > 2.5)
            program = list(walk(draw, 300, reach=2))
            wrong = draw.randrange(len(program))
            before = program[wrong - 1].end if wrong else (0, 0, 0)
            program[wrong:wrong] = [Line(before, (9, 0, 0)), Line((9, 0, 0), before)]
            stream = Stream(program, machine.state(), machine.capacity)
            drive(stream, machine, draw)
            with self.subTest(seed=seed):
                self.assertIsInstance(stream.failure, MoveRefused)
                self.assertEqual(stream.failure.index, wrong)
                self.assertEqual(machine.taken, list(range(1, wrong + 1)))

    def test_what_is_left_of_an_interrupted_program_is_what_is_not_done(self):
        for seed in range(60):
            draw = random.Random(seed)
            machine = MachineModel(draw, capacity=40)
            stream = Stream(walk(draw, 200), machine.state(), machine.capacity)
            finished = []
            for _ in range(draw.randint(1, 60)):
                if batch := stream.next_batch():
                    machine.send(batch)
                if machine.waiting and draw.random() < 0.7:
                    stream.answered(machine.carry_out())
                machine.work()
                stream.heard(machine.state())
                finished += stream.ledger.finished
                stream.ledger.finished.clear()
            stream.lost(ConnectionLost("cut"))
            with self.subTest(seed=seed):
                if stream.failure is None:
                    continue
                self.assertIsInstance(stream.failure, Interrupted)
                left = list(stream.failure.take_remaining())
                self.assertEqual(len(finished) + len(left), 200)
                self.assertEqual([part.index for part in left if isinstance(part, Part)],
                                 list(range(len(finished), len(finished) + sum(isinstance(part, Part) for part in left))))
                self.assertLessEqual({part.move_id for part in finished}, set(machine.done))

    def test_what_is_no_move_is_told_where_it_comes(self):
        stream = Stream([MoveTo((0, 0, 0)), "G1 X5"], MachineModel(random.Random(1), 10).state(), 10)
        with self.assertRaisesRegex(InvalidValue, "G1 X5"):
            for _ in range(5):
                stream.next_batch()

    def test_what_is_no_program_is_told(self):
        with self.assertRaisesRegex(InvalidValue, "5 is no program: give moves"):
            Stream(5, MachineModel(random.Random(1), 10).state(), 10)

    def test_a_move_that_no_line_can_hold_is_told_and_batches_stay_small(self):
        state = MachineModel(random.Random(1), 1000).state()
        curve = NurbsCurve(1, [0, *range(5000), 4999], [(0.1 * number, 0, 0) for number in range(5000)])
        with self.assertRaisesRegex(InvalidValue, "split the curve"):
            Stream([Nurbs(curve)], state, 1000, line_bytes=50_000).next_batch()
        stream = Stream([MoveTo((0, 0, 0))] + [Nurbs(curve)] * 5, state, 1000)
        self.assertEqual(len(stream.next_batch()), 1)
        stream.answered([None])
        while batch := stream.next_batch():
            self.assertEqual(len(batch), 1)
            stream.answered([None])
        self.assertEqual(stream.ledger.taken, 6)


class OpenEndsTest(unittest.TestCase):
    def test_a_move_may_not_begin_where_an_earlier_one_ends_but_the_one_before_it(self):
        for seed in range(300):
            draw = random.Random(seed)
            ends = OpenEnds()
            ends.add((0.0, 0.0, 0.0))
            ends.answered(1)  # so that it is known where the queue ends
            order = [(0.0, 0.0, 0.0)]
            for _ in range(60):
                place = tuple(draw.choice((0, 0.05, -0.05, 1)) + draw.uniform(-3e-3, 3e-3) for _ in range(3))
                near = any(max(abs(a - b) for a, b in zip(place, end)) < 1e-3 for end in order[:-1])
                if near:
                    self.assertFalse(ends.may_follow(place), f"seed {seed}")
                ends.add(place)
                order.append(place)
                if draw.random() < 0.3:
                    ends.answered(1)
                    order.pop(0)

    def test_ends_far_apart_hold_nobody_up(self):
        ends = OpenEnds()
        ends.add((0.0, 0.0, 0.0))
        ends.answered(1)
        for number in range(1000):
            self.assertTrue(ends.may_follow((number * 0.01, 0.0, 0.0)))
            ends.add((number * 0.01 + 0.01, 0.0, 0.0))


if __name__ == "__main__":
    unittest.main()

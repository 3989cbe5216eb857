"""Where an interrupted program goes on, by what the machine tells; and where nothing is sent."""

import random
import unittest

from machine_model import MachineModel
from rmac.errors import CannotResume, ConnectionLost
from rmac.generated import calls
from rmac.moves import Dwell, JointNurbs, Line, MoveTo, item
from rmac.geometry.nurbs import NurbsCurve
from rmac.streaming.part import Part
from rmac.streaming.progress import MachineStopped, MoveRefused
from rmac.streaming.resuming import resume
from rmac.streaming.stream import Stream

LINES = [Line((float(n), 0, 0), (n + 1.0, 0, 0)) for n in range(6)]


def interrupted(program, taken, done=0):
    """A run of which so much was taken, and so much known to be done, when its connection ended."""
    machine = MachineModel(random.Random(1), 100)
    stream = Stream(program, machine.state(), 100)
    while stream.ledger.taken < taken and (batch := stream.next_batch()):
        stream.answered([None] * len(batch))
    for _ in range(2):  # a state counts what was taken before the one before it
        stream.heard(machine.state() | {"move_id": done + 1 if done else 0, "moves_in_buffer": stream.ledger.taken - done, "moving": True})
    stream.lost(ConnectionLost("cut"))
    return stream.failure


def stands(move_id, s_mm=0.0, x=0.0, **members):
    state = {"state": "Idle", "mechanism": "M", "cycle": 99, "moving": False, "moves_in_buffer": 0, "move_id": move_id, "s_mm": s_mm, "pose": [x, 0, 0, 0, 0, 1]}
    return state | members


def requests(moves):
    return [(move.method, move.params(0)) for move in (one.move if isinstance(one, Part) else item(one) for one in moves)]


class ResumingTest(unittest.TestCase):
    def test_it_goes_on_in_the_move_that_was_begun_and_with_all_behind_it(self):
        for place in range(1, 6):
            rest, index = resume(interrupted(LINES, 6, done=place - 1), stands(place, 0.25, place - 0.75))
            here = (place - 0.75, 0, 0)
            self.assertEqual(index, place - 1)
            self.assertEqual(requests(rest), requests([MoveTo(here), Line(here, (place, 0, 0)), *LINES[place:]]))

    def test_what_was_never_sent_comes_behind_what_was_dropped(self):
        program = iter(LINES)
        rest, _ = resume(interrupted(program, 1), stands(1, 0.5, 0.5))
        self.assertEqual(requests(rest)[2:], requests(LINES[1:]))

    def test_a_move_that_is_behind_is_not_done_again(self):
        rest, _ = resume(interrupted(LINES, 6), stands(2, 1.0, 2.0))
        self.assertEqual(requests(rest), requests([MoveTo((2, 0, 0)), *LINES[2:]]))

    def test_a_program_that_was_not_begun_begins_at_its_begin(self):
        rest, index = resume(interrupted(LINES, 6), stands(0, 7.0, 0.0))
        self.assertEqual((requests(rest), index), (requests([MoveTo((0, 0, 0)), *LINES]), 0))

    def test_a_move_without_motion_is_behind_although_the_machine_is_never_at_it(self):
        cut = interrupted([*LINES[:2], MoveTo((2, 0, 0)), *LINES[2:]], 7)
        cut.ledger._forget(3, 3)  # told by the count of what is queued, while the state before told of none of them
        rest, index = resume(cut, stands(2, 1.0, 2.0))
        self.assertEqual((requests(rest), index), (requests([MoveTo((2, 0, 0)), *LINES[2:]]), 3))

    def test_what_rests_anywhere_is_begun_anew(self):
        rest, _ = resume(interrupted([MoveTo((5, 0, 0)), Dwell(1), *LINES], 8), stands(2, 0.0, 5.0))
        self.assertEqual(requests(rest), requests([Dwell(1), *LINES]))

    def test_settings_are_those_of_the_place(self):
        slow, fast = calls.RMAC_CAM.SetFeedrate(100), calls.RMAC_CAM.SetFeedrate(900)
        program = [slow, MoveTo((0, 0, 0)), LINES[0], fast, LINES[1]]
        rest, _ = resume(interrupted(program, 5), stands(3, 0.5, 0.5))
        self.assertEqual([request for request in requests(rest) if "Feed" in request[0]], requests([slow, fast]))
        with self.assertRaisesRegex(CannotResume, "SetFeedrate was called further on"):
            resume(interrupted(program[1:], 4), stands(2, 0.5, 0.5))

    def test_a_place_in_doubt_is_refused(self):
        curve = JointNurbs(NurbsCurve(1, [0, 0, 1, 1], [(0, 0), (1, 1)]))
        for program, state, told in (
            (LINES, stands(3, 0.5, 3.6), "stands 1.100 mm"),
            (LINES, stands(1, 0.0, -1.01), "stands 1.010 mm"),
            (LINES, stands(77), "move 77"),
            (LINES, stands(1, mechanism="N"), "N now"),
            (LINES, stands(1, cycle=1), "started anew"),
            (LINES, stands(1, moving=True), "end that cycle"),
            (LINES, stands(1, state="Running"), "is Running"),
            (LINES, stands(1, moves_in_buffer=2), "queued"),
            ([curve], stands(1, 0.5), "JointNurbs"),
            ([{"method": "RMAC_CAM.MoveToXYZ", "params": {"MoveID": 9}}], stands(9), "Request"),
        ):
            with self.subTest(told=told), self.assertRaisesRegex(CannotResume, told):
                resume(interrupted(program, len(program)), state)


class RefusalTest(unittest.TestCase):
    def refused(self, *then, cycles=1, **members):
        """What it comes to where the machine is so when it is asked, and so in the asks `then`, so many cycles apart."""
        machine = MachineModel(random.Random(1), 100, beyond=lambda place: place[0] > 2.5)
        stream = Stream(LINES, machine.state(), 100)
        while not stream.asks_state:
            machine.send(stream.next_batch())
            stream.answered(machine.carry_out())
        self.assertFalse(stream.ended)
        states = iter((members, *then))
        cycle = machine.state()["cycle"]
        while stream.asks_state:
            members = next(states, members)
            cycle += cycles
            stream.confirm(machine.state() | {"cycle": cycle} | members)
        self.assertTrue(stream.ended)
        return stream.failure

    def test_a_refusal_is_told_as_one(self):
        failure = self.refused()
        self.assertIsInstance(failure, MoveRefused)
        self.assertEqual(failure.index, 2)
        self.assertIsInstance(self.refused(cycles=0), MoveRefused, "of a machine that has no cycles")

    def test_a_refusal_that_came_of_a_stop_is_told_as_the_stop(self):
        self.assertIsInstance(self.refused(state="Stopping"), MachineStopped)
        stop = {"cycle": 5000, "message": "StopNow of panel"}
        self.assertIn("StopNow of panel", str(self.refused(state="Idle", last_stop=stop)))
        self.assertIsInstance(self.refused({}, {"state": "Stopping"}), MachineStopped, "it stops a cycle or two later")
        old = {"cycle": 1, "message": "long ago"}
        self.assertIsInstance(self.refused(state="Idle", last_stop=old), MoveRefused)


if __name__ == "__main__":
    unittest.main()

"""Jogs while a button is held, and the part frame set where the tool stands: what is decided without a window."""

import math
import queue
import random
import threading
import unittest

import FreeCAD
from rmac_freecad.jogging import Axis, HeldJog, is_machine_frame, place_part, steps

import rmac  # isort: skip

X = Axis("X", (1.0, 0.0, 0.0), None, 33.0)
Y = Axis("Y", (0.0, 1.0, 0.0), None, 33.0)
BOUND_S = 60


class Machine:
    """Answers when it is told to; what it was asked comes in order."""

    def __init__(self):
        self.asked = queue.Queue()
        self.answers = queue.Queue()
        self.begun = 0

    def begin(self):
        self.begun += 1
        return self.call

    def call(self, call):
        self.asked.put(call)
        answer = self.answers.get(timeout=BOUND_S)
        if isinstance(answer, Exception):
            raise answer

    def next(self):
        """The velocity that was asked for, which is answered."""
        call = self.asked.get(timeout=BOUND_S)
        self.answers.put(True)
        return call.params["Velocity"]


class HeldJogTest(unittest.TestCase):
    def setUp(self):
        self.machine = Machine()
        self.told = queue.Queue()
        self.jog = HeldJog(self.machine.begin, self.told.put)
        self.addCleanup(self.jog.end)

    def test_each_renewal_is_the_window_s_own(self):
        for _ in range(5):
            self.jog.hold(X, 7, moving=False)
            self.assertEqual(self.machine.next(), 7)
        self.assertTrue(self.machine.asked.empty())
        self.assertEqual(self.machine.begun, 1)

    def test_letting_go_sends_a_velocity_of_0_once(self):
        self.jog.hold(X, 7, moving=False)
        self.machine.next()
        self.jog.release()
        self.jog.release()
        self.assertEqual(self.machine.next(), 0)
        self.jog.end()
        self.assertTrue(self.machine.asked.empty())

    def test_renewals_that_wait_for_an_answer_become_one_and_none_goes_out_after_letting_go(self):
        self.jog.hold(X, 7, moving=False)
        first = self.machine.asked.get(timeout=BOUND_S)
        for velocity in (8, 9):
            self.jog.hold(X, velocity, moving=True)
        self.jog.release()
        self.machine.answers.put(True)
        self.assertEqual((first.params["Velocity"], self.machine.next()), (7, 0))
        self.jog.end()
        self.assertTrue(self.machine.asked.empty())

    def test_another_way_begins_when_the_machine_rests(self):
        self.jog.hold(X, 7, moving=True)
        self.assertFalse(self.jog.held)
        self.jog.hold(X, 7, moving=False)
        self.machine.next()
        self.jog.hold(Y, 7, moving=True)
        self.assertTrue(self.machine.asked.empty())

    def test_what_was_stopped_waits_for_the_button_to_come_up(self):
        self.jog.hold(X, 7, moving=False)
        self.machine.next()
        self.jog.stop()
        self.assertEqual(self.machine.next(), 0)
        self.jog.hold(X, 7, moving=False)
        self.assertFalse(self.jog.held)
        self.jog.release()
        self.jog.hold(X, 7, moving=False)
        self.assertEqual(self.machine.next(), 7)

    def test_a_refusal_is_told_once_and_ends_the_hold(self):
        self.jog.hold(X, 7, moving=False)
        self.machine.asked.get(timeout=BOUND_S)
        self.machine.answers.put(rmac.RmacError("at its limit"))
        self.assertEqual(str(self.told.get(timeout=BOUND_S)), "at its limit")
        self.jog.hold(X, 7, moving=False)
        self.jog.end()
        self.assertTrue(self.machine.asked.empty())
        self.assertTrue(self.told.empty())

    def test_a_button_let_go_before_authority_came_moves_nothing(self):
        came = threading.Event()
        entered = threading.Event()

        def begin():
            entered.set()
            came.wait(BOUND_S)
            return self.machine.call

        jog = HeldJog(begin, self.told.put)
        jog.hold(X, 7, moving=False)
        self.assertTrue(entered.wait(BOUND_S))
        jog.release()
        came.set()
        jog.end()
        self.assertTrue(self.machine.asked.empty())

    def test_no_axis_is_asked_for_more_than_it_may_go(self):
        self.assertEqual(X.at(50).params["Velocity"], 33)
        self.assertEqual(X.at(-50).params["Velocity"], -33)


class Cam:
    """A machine whose tool stands at `tip`, in the machine's frame."""

    def __init__(self, frame, tip):
        self.frame, self._tip = frame, tip
        self.cam = self

    def GetPartFrame(self):
        return self.frame

    def SetPartFrame(self, frame):
        self.frame = frame

    def state(self):
        rotation = FreeCAD.Rotation(*self.frame["q"][1:], self.frame["q"][0])
        read = rotation.inverted().multVec(FreeCAD.Vector(*self._tip) - FreeCAD.Vector(*self.frame["p"]))
        return {"pose": [*read, 0, 0, 1]}


class PartFrameTest(unittest.TestCase):
    def test_the_tool_reads_what_it_is_to_and_other_axes_stay(self):
        for seed in range(200):
            chance = random.Random(seed)
            q = [chance.gauss(0, 1) for _ in range(4)]
            frame = {"p": [chance.uniform(-50, 50) for _ in range(3)], "q": [part / math.hypot(*q) for part in q]}
            client = Cam(frame, [chance.uniform(-50, 50) for _ in range(3)])
            before = client.state()["pose"]
            readings = {axis: chance.uniform(-5, 5) for axis in chance.sample("XYZ", chance.randint(1, 3))}
            place_part(client, readings)
            for number, axis in enumerate("XYZ"):
                self.assertAlmostEqual(client.state()["pose"][number], readings.get(axis, before[number]), 9, f"seed {seed}")
            self.assertEqual(client.frame["q"], frame["q"])

    def test_a_frame_that_nobody_set_is_the_machine_s(self):
        self.assertTrue(is_machine_frame({"p": [0, 0, 0], "q": [1, 0, 0, 0]}))
        self.assertTrue(is_machine_frame({"p": [0, 0, 0], "q": [-1, 0, 0, 0]}))
        self.assertFalse(is_machine_frame({"p": [0, 0, 0.1], "q": [1, 0, 0, 0]}))
        self.assertFalse(is_machine_frame({"p": [0, 0, 0], "q": [0, 0, 0, 1]}))


class StepsTest(unittest.TestCase):
    def test_steps_are_round_in_the_unit_that_is_shown(self):
        self.addCleanup(FreeCAD.Units.setSchema, FreeCAD.Units.getSchema())
        for schema, inches in ((0, False), (1, False), (2, True), (3, True), (4, False), (5, True), (6, False), (7, True), (8, False)):
            FreeCAD.Units.setSchema(schema)
            self.assertAlmostEqual(steps()[-1], 25.4 if inches else 50, msg=f"schema {schema}")


if __name__ == "__main__":
    unittest.main()

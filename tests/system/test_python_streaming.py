"""Programs that the Python package streams: done once and in order, refused, stopped, and interrupted in their midst."""

import itertools
import math
import random
import sys
import threading
import unittest

from appliance import SOURCE, Appliance
from bending_mill import device_of, rigid

sys.path[:0] = [str(SOURCE / "clients/python/src")]

import rmac  # noqa: E402
from rmac.hearing import Hearer  # noqa: E402


def spiral(count, step=0.02):
    """Short lines that come back to no place."""
    for number in range(count + 1):
        angle, radius = number * step / 5, 5 + number * 1e-4
        yield radius * math.cos(angle) - 5, radius * math.sin(angle), 0


class Watcher:
    """Another client, which hears what the machine does."""

    def __init__(self, appliance, rate_hz=1000):
        self.client = rmac.connect(f"127.0.0.1:{appliance.port}", "watcher")
        self.events, self.samples = [], []
        self.client.hear(Hearer("events", 100, self.events.append, lambda error: None))
        self.client.hear(Hearer("joints", rate_hz, lambda params: self.samples.extend(params["samples"]), lambda error: None))

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self.client.close()

    def catch_up(self):
        """Until all has come that happened so far: a cycle's sample comes behind its events."""
        cycle = self.client.state()["cycle"]
        while not self.samples or self.samples[-1]["cycle"] < cycle:
            self.client.state()

    def done(self):
        """Ids of moves that are done."""
        self.catch_up()
        return [event["move_id"] for event in self.events if event["kind"] == "MoveDone"]

    def positions(self):
        self.catch_up()
        return [sample["q"][0] for sample in self.samples]


class PythonStreamingTest(unittest.TestCase):
    def start(self, **configuration):
        self.appliance = Appliance(own_tree=True, **configuration)
        with device_of(self.appliance) as device:
            rigid(device)
        self.enterContext(self.appliance)
        self.address = f"127.0.0.1:{self.appliance.port}"
        client = self.enterContext(rmac.connect(self.address, "streamer"))
        self.lease = self.enterContext(client.authority())
        client.load("DMACXYZ")
        client.cam.SetFeedrate(1800)
        client.cam.SetPathTolerance(0.01)
        return client

    def test_a_program_is_done_once_and_in_order(self):
        client = self.start()
        with Watcher(self.appliance) as watcher:
            program = [rmac.MoveTo((0, 0, 0)), *rmac.polyline(spiral(2000))]
            run = client.run(program)
            self.assertEqual(len(run), len(program))
            done = list(run)
            self.assertEqual([part.index for part in done], list(range(len(program))))
            self.assertIs(done[7].move, program[7])
            told = watcher.done()
            self.assertEqual(told, sorted(set(told)))
            self.assertEqual(told[-1], done[-1].move_id)
            self.assertEqual(client.state()["moves_in_buffer"], 0)

    def test_ids_go_on_from_program_to_program(self):
        client = self.start()
        first = [part.move_id for part in client.run([rmac.MoveTo((1, 0, 0)), rmac.MoveTo((2, 0, 0))])]
        second = [part.move_id for part in client.run([rmac.MoveTo((1, 0, 0))])]
        chosen = [part.move_id for part in client.run([rmac.MoveTo((2, 0, 0))], first_id=500)]
        self.assertEqual((first, second, chosen), ([1, 2], [3], [500]))

    def test_nothing_of_a_long_program_is_kept_but_what_is_in_the_queue(self):
        client = self.start(queue_capacity=100)
        count, asked = 5000, 0

        def program():
            nonlocal asked
            for move in itertools.chain([rmac.MoveTo((0, 0, 0))], rmac.polyline(spiral(count))):
                asked += 1
                yield move

        run = client.run(program())
        with self.assertRaises(TypeError):
            len(run)
        most = ahead = told = 0
        for _ in run:
            told += 1
            most = max(most, len(run._stream.ledger.kept) + len(run._stream._under_way))
            ahead = max(ahead, asked - run.done)
        self.assertEqual(told, count + 1)
        self.assertLessEqual(most, 100)
        self.assertLessEqual(ahead, 101)

    def test_a_full_queue_loses_and_repeats_nothing(self):
        client = self.start(queue_capacity=50)
        object.__setattr__(client.greeting, "queue_capacity", 5000)  # so that more is sent than there is room for
        with Watcher(self.appliance) as watcher:
            done = [part.move_id for part in client.run([rmac.MoveTo((0, 0, 0)), *rmac.polyline(spiral(600, step=0.1))])]
            self.assertEqual(done, list(range(1, 602)))
            self.assertEqual(watcher.done(), done)

    def test_what_is_behind_a_refused_move_is_not_taken_wherever_it_begins(self):
        # The third leaves the machine's travel; those behind it begin where the queue ends then, one of them again and again.
        away, back = rmac.Line((0, 0, 0), (90, 0, 0)), rmac.Line((90, 0, 0), (0, 0, 0))
        program = [rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (1, 0, 0)), rmac.Line((1, 0, 0), (0, 0, 0)), away, back]
        client = self.start()
        for behind in ([rmac.Line((0, 0, 0), (0, 1, 0))], [rmac.MoveTo((0, 1, 0))], [rmac.MoveJoints((0, 1, 0))],
                       [rmac.Arc((0, 0, 0), (0, 0, 0), (0, 1, 0), closed=True)], [rmac.output("Coolant", True)]):
            with self.subTest(behind=behind), self.assertRaises(rmac.MoveRefused) as caught:
                client.run(program + behind).wait()
            self.assertEqual((caught.exception.index, caught.exception.move), (3, away))
            self.assertEqual(caught.exception.refusal.minor_name, "MACHINE_ERR_TRAVEL_LIMIT")
            while (state := client.state())["moves_in_buffer"] or state["moving"]:
                pass
            self.assertEqual([round(place, 2) for place in state["joints"]], [0, 0, 0])
            self.assertEqual(state["outputs"], 0)

    def test_calls_and_requests_take_their_turn_among_moves(self):
        client = self.start()
        with Watcher(self.appliance) as watcher:
            program = [
                rmac.MoveTo((0, 0, 0)), rmac.calls.RMAC_CAM.SetFeedrate(600), rmac.Line((0, 0, 0), (1, 0, 0)), rmac.Dwell(0.01),
                rmac.calls.RMAC_CAM.SetFeedrate(1200), rmac.Line((1, 0, 0), (20, 0, 0)),
                {"method": "RMAC_CAM.MoveAlongLine", "params": rmac.Line((20, 0, 0), (21, 0, 0)).request(77)["params"]},
            ]
            done = list(client.run(program))
            self.assertEqual([part.move_id for part in done], [1, 2, 3, 4, 5, 6, 77])
            watcher.catch_up()
            feeds = {number: max(sample["feed_mm_s"] for sample in watcher.samples if sample["move_id"] == number) for number in (3, 6)}
        self.assertAlmostEqual(feeds[3], 10, places=3)
        self.assertAlmostEqual(feeds[6], 20, places=3)

    def test_a_machine_that_somebody_stops_ends_the_run(self):
        client = self.start()
        client.cam.SetFeedrate(60)
        with rmac.connect(self.address, "panel") as panel, self.assertRaises(rmac.MachineStopped):
            for part in client.run([rmac.MoveTo((0, 0, 0)), *rmac.polyline(spiral(5000))]):
                if part.index == 20:
                    panel.cam.StopNow()

    def test_a_program_may_ask_the_machine_while_it_is_made(self):
        client = self.start()

        def program():
            yield rmac.MoveTo((0, 0, 0))
            for line in rmac.polyline(spiral(300)):
                self.assertEqual(client.state()["mechanism"], "DMACXYZ")
                yield line

        self.assertEqual([part.index for part in client.run(program())], list(range(301)))

    def test_two_programs_are_not_mixed(self):
        client = self.start()
        first, second = client.run([rmac.MoveTo((1, 0, 0)), rmac.MoveTo((2, 0, 0))]), client.run([rmac.MoveTo((3, 0, 0))])
        next(iter(first))
        with self.assertRaisesRegex(rmac.RmacError, "another run"):
            second.wait()
        first.close()
        client.until_done()
        client.run([rmac.MoveTo((3, 0, 0))]).wait()

    def test_a_run_made_before_another_one_counts_its_own_moves_only(self):
        client = self.start()
        program = [rmac.MoveTo((0, 0, 0)), *rmac.polyline((x, 0, 0) for x in range(11))]
        with Watcher(self.appliance) as watcher:
            first, second = client.run(program), client.run(program)
            ids = [part.move_id for part in first]
            for part in second:
                ids.append(part.move_id)
                self.assertGreaterEqual(client.state()["move_id"], part.move_id)  # what is given as done is begun at least
            self.assertEqual(len(set(ids)), 2 * len(program))
            self.assertEqual(client.state()["moves_in_buffer"], 0)
            self.assertTrue(set(watcher.done()) <= set(ids))

    def test_a_run_left_by_an_exception_stands_in_nobodys_way(self):
        client = self.start()
        with self.assertRaises(KeyError), client.authority():
            for _ in client.run([rmac.MoveTo((1, 0, 0)), rmac.MoveTo((2, 0, 0)), rmac.MoveTo((3, 0, 0))]):
                raise KeyError
        with client.authority():
            client.run([rmac.MoveTo((4, 0, 0))]).wait()
            client.cam.SetFeedrate(5)
            left = client.run([rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (40, 0, 0))])
            next(iter(left))
        with client.authority(), self.assertRaises(rmac.RmacError):
            left.wait()

    def test_a_run_waits_for_a_machine_that_still_stops(self):
        client = self.start()
        for x in (40, 0, 40, 0, 40):
            with client.authority():
                parts = iter(client.run([rmac.MoveTo((0, 0, 0)), *rmac.polyline((far, 0, 0) for far in (0, 1, 40, 0))]))
                self.assertEqual([next(parts).index, next(parts).index], [0, 1])
            with client.authority():
                client.run([rmac.MoveTo((x, 0, 0))]).wait()

    def test_a_connection_that_ends_before_a_run_begins_blocks_no_later_run(self):
        client = self.start()
        run = client.run([rmac.MoveTo((1, 0, 0))])
        client.close()
        with self.assertRaises(rmac.ConnectionLost):
            run.wait()
        client.reconnect()
        with client.authority():
            client.run([rmac.MoveTo((2, 0, 0))]).wait()

    def test_a_program_that_was_sent_in_part_is_not_told_as_not_sent(self):
        client = self.start()

        def program():
            yield from (rmac.MoveTo((x, 0, 0)) for x in range(1, 10))
            client.close()
            yield rmac.MoveTo((0, 0, 0))

        with self.assertRaises(rmac.Interrupted) as lost:
            client.run(program()).wait()
        self.assertNotIn("nothing of this was sent", str(lost.exception))
        self.assertRegex(str(lost.exception), "closed.*; [0-9]+ moves of the program were known to be done, [0-9]+ taken; reconnect, then resume")

    def test_what_could_not_be_taken_up_is_not_lost_and_is_taken_up_once(self):
        client = self.start()
        interrupted = self.interrupt(client, [rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (40, 0, 0)), rmac.Line((40, 0, 0), (40, 5, 0))], 0)
        client.reconnect()
        with self.assertRaises(rmac.AuthorityRequired):
            client.resume(interrupted).wait()
        with client.authority():
            client.resume(interrupted).wait()
            self.assertAlmostEqual(client.state()["joints"][1], 5, places=2)
            with self.assertRaisesRegex(rmac.CannotResume, "already"):
                client.resume(interrupted)

    def test_an_appliance_that_was_started_anew_does_not_go_on(self):
        client = self.start()
        interrupted = self.interrupt(client, [rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (40, 0, 0))], 0)
        client.close()
        with Appliance() as anew, rmac.connect(f"127.0.0.1:{anew.port}") as client, client.authority():
            with self.assertRaisesRegex(rmac.CannotResume, "None now"):
                client.resume(interrupted)
            client.load("DMACXYZ")
            with self.assertRaises(rmac.CannotResume):
                client.resume(interrupted)

    def test_another_thread_may_stop_what_a_run_feeds(self):
        client = self.start()
        client.cam.SetFeedrate(60)
        stopped = threading.Thread(target=client.cam.StopNow)
        with self.assertRaises(rmac.MachineStopped):
            for part in client.run([rmac.MoveTo((0, 0, 0)), *rmac.polyline(spiral(5000))]):
                if part.index == 20:
                    stopped.start()
        stopped.join()

    def interrupt(self, client, program, at, beyond=None):
        """Runs it slowly, seconds of computing behind that place, and cuts the connection when a part of it is done, or when
        the first joint is beyond a place then."""
        client.cam.SetFeedrate(20)
        with self.assertRaises(rmac.Interrupted) as caught:
            for part in client.run(program):
                if part.index == at:
                    while beyond is not None and client.state()["joints"][0] < beyond:
                        pass
                    client._connection._socket.shutdown(2)
        client.reconnect()
        with client.authority():
            client.cam.SetFeedrate(1800)
        return caught.exception

    def test_an_interrupted_program_goes_on_where_it_was_and_repeats_nothing(self):
        client = self.start()
        lines = 400
        program = [rmac.MoveTo((-40, 0, 0)), *rmac.polyline((-40 + 80 * number / lines, 0, 0) for number in range(lines + 1))]
        with Watcher(self.appliance) as watcher:
            interrupted = self.interrupt(client, program, 40)
            with client.authority():
                rest = [part.index for part in client.resume(interrupted)]
            places = watcher.positions()
        began = places.index(min(places))
        path = places[began:]
        # It rests on a drive's own place, micrometres beside the path's; what is repeated would be a line of 0.2 mm.
        back = max(before - after for before, after in zip(itertools.accumulate(path, max), path))
        self.assertLess(back, 0.01)
        self.assertAlmostEqual(path[-1], 40, places=6)
        self.assertLess(max(after - before for before, after in zip(path, path[1:])), 1800 / 60 / 1000 * 1.001, "a gap")
        self.assertLess(rest[0], lines)

    def test_a_program_that_is_interrupted_again_and_again_is_done_once(self):
        client = self.start()
        # Long and short lines, with rests between them, and a feed that changes.
        program = [rmac.calls.RMAC_CAM.SetFeedrate(30), rmac.MoveTo((-40, 0, 0))]
        place = -40.0
        draw = random.Random(4)
        while place < 38:
            after = place + draw.choice((0.02, 0.3, 2.0))
            program.append(rmac.Line((place, 0, 0), (after, 0, 0)))
            if draw.random() < 0.2:
                program.append(draw.choice((rmac.MoveTo((after, 0, 0)), rmac.Dwell(0.02), rmac.calls.RMAC_CAM.SetFeedrate(draw.choice((30, 45))))))
            place = after
        with Watcher(self.appliance) as watcher:
            run, behind, cuts = client.run(program), 0, 0
            while True:
                try:
                    left = draw.randint(1, 12)
                    for part in run:
                        behind += 1
                        left -= 1
                        if left == 0:
                            client._connection._socket.shutdown(2)
                    break
                except rmac.Interrupted as interrupted:
                    cuts += 1
                    client.reconnect()
                    client.lease.acquire()
                    run = client.resume(interrupted)
            path = watcher.positions()
        path = path[path.index(min(path)) :]
        self.assertGreater(cuts, 2)
        self.assertAlmostEqual(path[-1], place, places=6)
        self.assertLess(max(before - after for before, after in zip(itertools.accumulate(path, max), path)), 0.01)
        self.assertLess(max(after - before for before, after in zip(path, path[1:])), 1800 / 60 / 1000 * 1.001, "a gap")

    def test_an_interrupted_curve_goes_on_as_the_same_curve(self):
        client = self.start()
        curve = rmac.NurbsCurve(3, [0, 0, 0, 0, 1, 2, 3, 3, 3, 3], [(0, 0, 0), (5, 8, 0), (10, -8, 0), (15, 8, 0), (20, -8, 0), (25, 0, 0)], [1, 2, 1, 3, 1, 1])
        with Watcher(self.appliance) as watcher:
            before = len(watcher.samples)
            client.run([rmac.MoveTo((0, 0, 0)), rmac.Nurbs(curve)]).wait()
            watcher.catch_up()
            whole = [sample["q"] for sample in watcher.samples[before:]]
            client.run([rmac.MoveTo((0, 0, 0))]).wait()
            watcher.catch_up()
            before = len(watcher.samples)
            interrupted = self.interrupt(client, [rmac.MoveTo((0, 0, 0)), rmac.Nurbs(curve)], 0, beyond=8)
            with client.authority():
                client.resume(interrupted).wait()
            watcher.catch_up()
            resumed = [sample["q"] for sample in watcher.samples[before:]]
        self.assertAlmostEqual(resumed[-1][0], 25, places=6)
        whole.sort()
        for place in resumed[:: max(1, len(resumed) // 200)]:
            near = [other for other in whole if abs(other[0] - place[0]) < 0.05]
            self.assertLess(min(math.dist(place, other) for other in near), 0.03)

    def test_the_feed_of_the_place_comes_back(self):
        client = self.start()
        feed = rmac.calls.RMAC_CAM.SetFeedrate
        program = [feed(12), rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (30, 0, 0)), feed(24), rmac.Line((30, 0, 0), (31, 0, 0))]
        interrupted = self.interrupt(client, program, 1)
        with client.authority(), Watcher(self.appliance) as watcher:
            client.resume(interrupted).wait()
            watcher.catch_up()
            fastest = {round(sample["q"][0]) > 30: 0 for sample in watcher.samples}
            for sample in watcher.samples:
                fastest[sample["q"][0] > 30] = max(fastest.get(sample["q"][0] > 30, 0), sample["feed_mm_s"])
        self.assertAlmostEqual(fastest[False], 0.2, places=3)
        self.assertGreater(fastest[True], 0.3)

    def test_a_place_in_doubt_is_not_taken_up(self):
        client = self.start()
        program = [rmac.MoveTo((0, 0, 0)), *rmac.polyline((number / 10, 0, 0) for number in range(400))]
        interrupted = self.interrupt(client, program, 50)
        with rmac.connect(self.address, "other") as other, other.authority():
            other.run([rmac.MoveTo((-5, 0, 0))], first_id=5000).wait()
        with client.authority(), self.assertRaisesRegex(rmac.CannotResume, "move 5000"):
            client.resume(interrupted)
        with rmac.connect(self.address, "other") as other, other.authority():
            other.load("DMACXY")
        with client.authority(), self.assertRaisesRegex(rmac.CannotResume, "DMACXY now"):
            client.resume(interrupted)

    def test_a_tool_that_was_moved_aside_is_not_sent_back_through_the_part(self):
        client = self.start()
        interrupted = self.interrupt(client, [rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (40, 0, 0))], 0)
        with client.authority():
            client.at_rest()
            client.cam.JogJoint(1, 5)
            client.at_rest()
            with self.assertRaises(rmac.CannotResume):
                client.resume(interrupted)


if __name__ == "__main__":
    unittest.main()

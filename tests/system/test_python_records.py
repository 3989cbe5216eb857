"""Events, topics and records of the Python package, into numpy."""

import sys
import unittest

import numpy

from appliance import SOURCE, Appliance

sys.path[:0] = [str(SOURCE / "clients/python/src")]

import rmac  # noqa: E402
import rmac.aio  # noqa: E402

PROGRAM = [rmac.MoveTo((0, 0, 0)), rmac.Line((0, 0, 0), (10, 5, 0)), rmac.Line((10, 5, 0), (10, 0, 0))]


class PythonRecordsTest(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.address = f"127.0.0.1:{self.appliance.port}"
        self.client = self.enterContext(rmac.connect(self.address))
        self.enterContext(self.client.authority())
        self.client.load("DMACXYZ")
        self.client.cam.SetFeedrate(1200)

    def check(self, record):
        self.assertEqual(record.lost, 0)
        self.assertTrue((numpy.diff(record.cycle) == 1).all())
        self.assertEqual(record.q.shape, (len(record), 3))
        numpy.testing.assert_allclose(record.q[-1], (10, 0, 0), atol=1e-9)
        numpy.testing.assert_allclose(record.error, record.q - record.a, atol=1e-12)
        # Loads of simulated axes: near the motors, and not where these are.
        self.assertEqual(record.truth.shape, record.a.shape)
        numpy.testing.assert_allclose(record.truth, record.a, atol=0.02)
        self.assertGreater(abs(record.truth - record.a).max(), 1e-4)
        # Positions are what velocities add up to, to the second order in a cycle of 1 ms.
        moved = record.qd[:-1] * 0.5e-3 + record.qd[1:] * 0.5e-3
        numpy.testing.assert_allclose(numpy.diff(record.q, axis=0), moved, atol=1e-5)
        self.assertLessEqual(set(record.move_id[record.moving]), {1, 2, 3})
        self.assertAlmostEqual(record.feed_mm_s.max(), 20, places=4)

    def test_a_record_has_every_cycle_to_the_last(self):
        with self.client.record() as recording:
            self.client.run(PROGRAM).wait()
        self.check(recording.record())

    def test_two_who_hear_one_topic_get_the_faster_rate_and_end_by_themselves(self):
        with self.client.record() as fast:
            with self.client.record(10):
                self.client.run(PROGRAM).wait()
            fast.catch_up()
        self.check(fast.record())

    def test_events_come_in_order_and_end_with_the_connection(self):
        with rmac.connect(self.address) as watcher, watcher.events() as events:
            self.client.run(PROGRAM).wait()
            done = []
            while done[-1:] != [3]:
                event = events.next(60)
                if event.kind == "MoveDone":
                    done.append(event.move_id)
            self.assertEqual(done, [1, 2, 3])
            with self.assertRaises(rmac.NotAnswered):
                while True:
                    events.next(0.01)
            watcher.close()
            with self.assertRaises(rmac.ConnectionLost):
                for _ in events:
                    pass
            with self.assertRaises(rmac.ConnectionLost):
                next(events)

    def test_a_rate_that_was_refused_is_not_asked_for_again(self):
        with rmac.connect(self.address) as other, self.client.record():
            with self.assertRaises(rmac.errors.RateTaken), other.record():
                pass
            with other.record(100):
                pass
            other.reconnect()

    def test_states_come_as_often_as_asked(self):
        with self.client.states(50) as states:
            cycles = [next(states)["cycle"] for _ in range(5)]
        # The first comes at once, the others in step.
        self.assertTrue(all(b - a == 20 for a, b in zip(cycles[1:], cycles[2:])), cycles)

    def test_an_animation_has_the_tip_where_the_program_takes_it(self):
        geometry = self.client.geometry()
        self.assertEqual((geometry.machine, geometry.missing), ("DMACXYZ", ""))
        self.assertTrue(all(body.link in geometry.links for body in geometry.bodies))
        seen = []
        with self.client.animation() as animations:
            self.client.run(PROGRAM).wait()
            done = self.client.state()["cycle"]
            while not seen or seen[-1][1].cycle < done:
                animation = next(animations)
                seen += [(animation, sample) for sample in animation.samples]
        for animation, sample in seen:
            self.assertEqual(animation.geometry, geometry.number)
            on_part = animation.part(sample).inverse().times(animation.tip(sample, geometry))
            numpy.testing.assert_allclose(on_part.p, sample.pose[:3], atol=1e-6, err_msg=f"cycle {sample.cycle}")
        self.assertEqual({b.cycle - a.cycle for (_, a), (_, b) in zip(seen, seen[1:])}, {16, 17})
        self.assertGreater(max(sample.pose[1] for _, sample in seen), 4)

    def test_what_was_recorded_of_two_machines_is_no_record(self):
        with self.client.record() as recording:
            recording.catch_up()
            self.client.load("DMACXY")
            recording.catch_up()
        with self.assertRaisesRegex(rmac.RmacError, "another machine"):
            recording.record()

    def test_a_flight_record_is_read_whole(self):
        with self.client.events() as events:
            self.client.run(PROGRAM).wait()
            name = self.client.recorder.Record()
            while events.next(60).kind != "FlightRecord":
                pass
        record = self.client.flight_record(name)
        self.assertEqual(record.head["mechanism"], "DMACXYZ")
        cycles = record.columns["cycle"]
        self.assertTrue((numpy.diff(cycles) == 1).all())
        self.assertEqual(len({len(column) for column in record.columns.values()}), 1)


class PythonAioRecordsTest(unittest.IsolatedAsyncioTestCase):
    async def test_records_and_events(self):
        appliance = self.enterContext(Appliance())
        client = await self.enterAsyncContext(await rmac.aio.connect(f"127.0.0.1:{appliance.port}"))
        async with client.authority():
            await client.load("DMACXYZ")
            await client.cam.SetFeedrate(1200)
            async with client.record() as recording, client.events() as events:
                await (await client.run(PROGRAM)).wait()
                async for event in events:
                    if event.kind == "MoveDone" and event.move_id == 3:
                        break
            name = await client.recorder.Record()
            async with client.states() as states:
                async for _ in states:
                    break
            geometry = await client.geometry()
            async with client.animation() as animations:
                async for animation in animations:
                    self.assertEqual(animation.geometry, geometry.number)
                    self.assertEqual(set(animation.samples[0].links), set(geometry.links))
                    break
            self.assertTrue(name)
        record = recording.record()
        self.assertEqual(record.lost, 0)
        numpy.testing.assert_allclose(record.q[-1], (10, 0, 0), atol=1e-9)


if __name__ == "__main__":
    unittest.main()

"""The asyncio client of the Python package: as the blocking one, awaited."""

import asyncio
import sys
import unittest

from appliance import SOURCE, Appliance

sys.path[:0] = [str(SOURCE / "clients/python/src")]

import rmac.aio  # noqa: E402


class PythonAioTest(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        self.appliance = self.enterContext(Appliance())
        self.address = f"127.0.0.1:{self.appliance.port}"
        self.client = await self.enterAsyncContext(await rmac.aio.connect(self.address, "loop"))

    async def test_machines_authority_and_refusals(self):
        self.assertEqual([machine.name for machine in await self.client.machines("Name = 'DMACXYZ'")], ["DMACXYZ"])
        with self.assertRaises(rmac.AuthorityRequired):
            await self.client.device.Load("DMACXYZ")
        other = await self.enterAsyncContext(await rmac.aio.connect(f"unix:{self.appliance.folder}/state/rmacd.sock", "other"))
        async with self.client.authority():
            self.assertEqual(len((await self.client.load("DMACXYZ", virtual=True)).joints), 3)
            with self.assertRaisesRegex(rmac.AuthorityHeld, "loop"):
                async with other.authority():
                    self.fail("both have it")
        async with other.authority():
            self.assertIn("other", (await other.state())["authority"])

    async def test_a_block_of_authority_within_another_one_leaves_it_authority(self):
        async with self.client.authority():
            async with self.client.authority():
                pass
            self.assertNotEqual((await self.client.state())["authority"], "")
        self.assertEqual((await self.client.state())["authority"], "")

    async def test_a_second_task_watches_and_stops_what_the_first_feeds(self):
        async with self.client.authority():
            await self.client.load("DMACXYZ")
            await self.client.cam.SetFeedrate(60)
            seen = []

            async def feed():
                async for part in await self.client.run([rmac.MoveTo((0, 0, 0)), *rmac.polyline((0.01 * n, 0, 0) for n in range(4000))]):
                    seen.append(part.index)

            feeding = asyncio.ensure_future(feed())
            while len(seen) < 10:
                await self.client.state()
            await self.client.cam.StopNow()
            with self.assertRaises(rmac.MachineStopped):
                await feeding
            self.assertEqual(seen, list(range(len(seen))))

    async def test_a_program_is_done_and_an_interrupted_one_goes_on(self):
        program = [rmac.MoveTo((0, 0, 0)), *rmac.polyline((0.1 * n, 0, 0) for n in range(400))]
        async with self.client.authority():
            await self.client.load("DMACXYZ")
            await self.client.cam.SetFeedrate(1200)
            run = await self.client.run(program)
            self.assertEqual([part.index async for part in run], list(range(len(program))))
            self.assertEqual((run.done, run.taken, len(run)), (400, 400, 400))
            await self.client.cam.SetFeedrate(20)
            with self.assertRaises(rmac.Interrupted) as caught:
                async for part in await self.client.run(program):
                    if part.index == 50:
                        self.client._connection._writer.transport.abort()
        await self.client.reconnect()
        async with self.client.authority():
            rest = [part.index async for part in await self.client.resume(caught.exception)]
        self.assertGreaterEqual(rest[0], 50)
        self.assertAlmostEqual((await self.client.state())["joints"][0], 39.9, places=2)

    async def test_a_program_that_was_sent_in_part_is_not_told_as_not_sent(self):
        def program():
            yield from (rmac.MoveTo((x, 0, 0)) for x in range(1, 10))
            self.cut()
            yield rmac.MoveTo((0, 0, 0))

        async with self.client.authority():
            await self.client.load("DMACXYZ")
            await self.client.cam.SetFeedrate(1800)
            with self.assertRaises(rmac.Interrupted) as lost:
                await (await self.client.run(program())).wait()
        self.assertNotIn("nothing of this was sent", str(lost.exception))
        self.assertRegex(str(lost.exception), "it was cut; [0-9]+ moves of the program were known to be done, [0-9]+ taken; reconnect, then resume")

    async def test_an_error_of_the_program_is_told_also_where_the_connection_was_lost(self):
        def bad_move():
            yield rmac.MoveTo((float("nan"), 0, 0))

        def own_error():
            raise rmac.InvalidValue("this pocket has no floor")
            yield

        for broken, told in ((bad_move, "nan"), (own_error, "no floor")):
            with self.subTest(told):

                def program():
                    yield rmac.MoveTo((1, 0, 0))
                    self.cut()
                    yield from broken()

                async with self.client.authority():
                    await self.client.load("DMACXYZ")
                    with self.assertRaisesRegex(rmac.InvalidValue, told):
                        await (await self.client.run(program())).wait()
                await self.client.reconnect()

    def cut(self):
        """Ends the connection before anything else runs in the loop."""
        self.client._connection._finish(rmac.ConnectionLost("it was cut"))

    async def test_what_cannot_be_reached_or_is_lost_is_told(self):
        with self.assertRaisesRegex(rmac.CannotConnect, "no such file"):
            await rmac.aio.connect("unix:/nowhere")
        with self.assertRaisesRegex(rmac.CannotConnect, "rmacd running"):
            await rmac.aio.connect("127.0.0.1:1")
        await self.client.close()
        with self.assertRaises(rmac.ConnectionLost):
            await self.client.state()


if __name__ == "__main__":
    unittest.main()

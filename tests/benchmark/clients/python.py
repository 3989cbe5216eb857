"""How many moves a second the Python package sends, and sustains while they are machined as fast as cycles are computed.

All of it on one computer: the client, the daemon's parsing and planning, and its cycles share its cores.
"""

import asyncio
import math
import resource
import sys
import threading
import time

import rmac
import rmac.aio
from appliance import Appliance
from figures import Figures

LEAST = 20_000


def spiral(count, step=0.05, pitch=0.05):
    """Lines of one length, which come back to no place."""
    angle, radius = 0.0, 5.0
    for _ in range(count + 1):
        yield radius * math.cos(angle) - 5, radius * math.sin(angle), 0.0
        angle += step / radius
        radius += pitch * step / radius / (2 * math.pi)


def ready(client):
    client.load("DMACXYZ")
    client.cam.SetFeedrate(1800)
    client.cam.SetPathTolerance(0.01)
    client.run([rmac.MoveTo((0, 0, 0))]).wait()


def taken(figures, count):
    """Made, sent, parsed and answered, into the queue of a machine that does not run."""
    with Appliance() as appliance, rmac.connect(f"127.0.0.1:{appliance.port}") as client, client.authority():
        ready(client)
        client.cam.CycleStop("AUTOMATIC")
        client.at_rest()
        run = client.run(rmac.polyline(spiral(count)), start=False)
        began = time.perf_counter()

        def feed():
            try:
                run.wait()
            except rmac.MachineStopped:
                pass  # by the StopNow below, which ends it

        feeding = threading.Thread(target=feed)
        feeding.start()
        while run.taken < count:
            time.sleep(0.001)
        took_s = time.perf_counter() - began
        with rmac.connect(f"127.0.0.1:{appliance.port}", "panel") as panel:
            # A cycle must have been, for its end to be seen.
            client.cam.CycleStart("AUTOMATIC")
            panel.cam.StopNow()
        feeding.join()
    figures.add_least("moves_taken", count / took_s, "1/s", LEAST, f"{count} lines, blocking client")


def machined(figures, count):
    """From a generator to the end of the motion; the first quarter is the run-up, for memory."""
    with Appliance() as appliance, rmac.connect(f"127.0.0.1:{appliance.port}") as client, client.authority():
        ready(client)
        kib = 0
        began, cpu_s = time.perf_counter(), time.process_time()
        for part in client.run(rmac.polyline(spiral(count))):
            if part.index == count // 4:
                kib = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        took_s = time.perf_counter() - began
        grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - kib
    figures.add("moves_machined", count / took_s, "1/s", note=f"{count} lines, blocking client")
    figures.add("client_cpu", 1e6 * (time.process_time() - cpu_s) / count, "us/move", 1e6 / LEAST, "making, sending, hearing; of one core")
    figures.add("memory_grown", grown / 1024, "MiB", 8, f"peak of the client, from a quarter of {count} moves to their end")


def machined_aio(figures, count):
    async def cut(port):
        async with await rmac.aio.connect(f"127.0.0.1:{port}") as client, client.authority():
            await client.load("DMACXYZ")
            await client.cam.SetFeedrate(1800)
            await client.cam.SetPathTolerance(0.01)
            await (await client.run([rmac.MoveTo((0, 0, 0))])).wait()
            began = time.perf_counter()
            await (await client.run(rmac.polyline(spiral(count)))).wait()
            return time.perf_counter() - began

    with Appliance() as appliance:
        took_s = asyncio.run(cut(appliance.port))
    figures.add("moves_machined_asyncio", count / took_s, "1/s", note=f"{count} lines")


def alone(figures, calls):
    """A move that waits for the answer to the one before it, as a drilling cycle's do."""
    with Appliance() as appliance, rmac.connect(f"127.0.0.1:{appliance.port}") as client, client.authority():
        ready(client)
        began = time.perf_counter()
        client.run(rmac.MoveTo((0.01 * (number % 2), 0, 0)) for number in range(calls)).wait()
        figures.add("positioning_moves", calls / (time.perf_counter() - began), "1/s", note=f"{calls} moves to alternating places, one under way at a time")


def main():
    quick = "--quick" in sys.argv[1:]
    if quick:
        print("quick: fewer moves")
    figures = Figures()
    taken(figures, 9000)  # the queue has 10 000
    machined(figures, 20_000 if quick else 400_000)
    machined_aio(figures, 20_000 if quick else 200_000)
    alone(figures, 500 if quick else 5000)
    sys.exit(0 if figures.table() else 1)


main()

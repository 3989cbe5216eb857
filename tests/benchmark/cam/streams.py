"""A program of rounded lines through the socket, in real pace: whether the machine rests before its end, however its lines arrive."""

import itertools
import json
import math
import sys
import threading
import time

from appliance import Appliance, line
from figures import Figures

LINES = 5197
TOLERANCE_MM = 0.01
REST_CYCLES = 3  # as many setpoints alike are a rest


def trefoil(lines):
    """Its corners, rounded to a micrometre and begun at zero; the path is evenly cut, as near as a parameter's steps allow."""
    def at(t):
        return 9 * (math.sin(t) + 2 * math.sin(2 * t)), 9 * (math.cos(t) - 2 * math.cos(2 * t)), -9 * math.sin(3 * t)
    steps = 40 * lines
    points = [at(2 * math.pi * i / steps) for i in range(steps + 1)]
    lengths = [0.0, *itertools.accumulate(math.dist(a, b) for a, b in itertools.pairwise(points))]
    wanted, corners = 0, []
    for length, point in zip(lengths, points):
        if length >= lengths[-1] * wanted / lines - 1e-12:
            corners.append(tuple(round(value - start, 3) for value, start in zip(point, points[0])))
            wanted += 1
    return corners


class Arrival:
    """How lines reach the appliance: `each` of them, and then a pause."""

    def __init__(self, name, each, pause_s, feed_mm_min):
        self.name, self.each, self.pause_s, self.feed_mm_min = name, each, pause_s, feed_mm_min

    def send(self, client, requests):
        began = time.monotonic()
        for number, begin in enumerate(range(0, len(requests), self.each)):
            time.sleep(max(0.0, began + number * self.pause_s - time.monotonic()))
            client.send_bytes(b"".join(requests[begin:begin + self.each]))


# At 500 lines a second a client is as fast as 25 mm/s; the program's feed leaves the machine no reason to wait.
ARRIVALS = [Arrival("at_once", LINES, 0, 12000), Arrival("in_bursts", 400, 0.1, 12000), Arrival("at_500_a_second", 5, 0.01, 1200)]


def machine_of(appliance):
    """The mill of the device tree, with the feed that its joints allow."""
    file = appliance.tree / "mill/3-axis/DMACXYZ/device.json"
    device = json.loads(file.read_text())
    device["MaxFeedrate"] = 12000
    file.write_text(json.dumps(device))


def rests(samples):
    """Between the first and the last motion, and how long that took (s)."""
    moved = [i for i in range(1, len(samples)) if samples[i]["q"] != samples[i - 1]["q"]]
    gaps = sum(1 for a, b in itertools.pairwise(moved) if b - a > REST_CYCLES)
    return gaps, samples[moved[-1]]["t_s"] - samples[moved[0]]["t_s"]


def travelled(arrival):
    with Appliance(pace="real-time", own_tree=True, real_time={"degraded_allowed": True, "lock_memory": False}) as appliance:
        machine_of(appliance)
        operator = appliance.operator()
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=arrival.feed_mm_min)
        operator.call("RMAC_CAM.SetPathTolerance", Tolerance=TOLERANCE_MM)
        corners = trefoil(LINES)
        requests = [
            json.dumps({"jsonrpc": "2.0", "id": k + 1, "method": "RMAC_CAM.MoveAlongLine", "params": line(a, b, k + 1)}).encode() + b"\n"
            for k, (a, b) in enumerate(itertools.pairwise(corners))]
        watch = appliance.client("watch")
        watch.call("subscribe", topics=["joints"], rate_hz=1000)
        operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        sender = threading.Thread(target=arrival.send, args=(operator, requests))
        sender.start()
        samples, done = [], False
        end = corners[-1]
        while not done:
            for sample in watch.wait_note("joints")["samples"]:
                samples.append(sample)
                at_end = len(samples) > 1000 and not sample["moving"] and math.dist(sample["q"], end) < 1e-6
                done = done or (at_end and samples[-1000]["q"] == sample["q"])
        sender.join()
        misses = appliance.client("state").state()["deadline_misses"]
        operator.call("RMAC_CAM.StopNow")
        return (*rests(samples), misses)


def main():
    figures = Figures()
    for arrival in ARRIVALS:
        stops, time_s, misses = travelled(arrival)
        note = f"{LINES} lines; {misses} cycles missed"
        figures.add(f"stream_{arrival.name}_rests", stops, "rests", 0, note)
        figures.add(f"stream_{arrival.name}", time_s, "s", note=note)
    sys.exit(0 if figures.table() else 1)


main()

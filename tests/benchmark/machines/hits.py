"""Touches a sphere again and again, the probe's contact bouncing: how far hits are from the sphere, and what went wrong meanwhile.

The truth is the simulated sphere of drivers/cmm/3-axis/CMM/device.json, which the controller does not know. Rigid axes show what a hit
lacks itself; the machine as it comes, what its axes add, for its encoders are the motors'."""

import json
import math
import random
import statistics
import sys

from appliance import SOURCE, Appliance, wait_for_rest
from bending_mill import device_of, rigid
from client import Refused
from figures import Figures

DEVICE = json.loads((SOURCE / "drivers/cmm/3-axis/CMM/device.json").read_text())
SIMULATED = DEVICE["DigitalIOInterface"]["Parameters"]
*CENTER, RADIUS = SIMULATED["sphere_mm"]
REACH = RADIUS + SIMULATED["probe_radius_mm"]
COUNT_UM = 1e3 * 10 / DEVICE["Actuators"][0]["CountsPerRevolution"]
CLEAR = 4.0  # mm, from where a point is measured
STEP = math.radians(40)  # further apart than this the way between two points would meet the sphere
SPEED = 10  # mm/s


def at(normal, distance):
    return dict(zip("xyz", (c + distance * n for c, n in zip(CENTER, normal))))


def unit(vector):
    return [c / math.hypot(*vector) for c in vector]


def next_normal(normal, source):
    """Another direction from the sphere's centre, upwards, not far from the last one."""
    while True:
        other = unit([source.gauss(0, 1), source.gauss(0, 1), abs(source.gauss(0, 1))])
        if other[2] > 0.2 and math.acos(min(1, sum(a * b for a, b in zip(normal, other)))) < STEP:
            return other


def touch(appliance, hits):
    """How far each hit is off the sphere in µm, and how often something else went wrong."""
    source = random.Random(20261121)
    errors_um, false_errors, normal = [], 0, [0, 0, 1]
    with appliance:
        client = appliance.operator("CMM")
        client.call("RMAC_CAM.Parameter", ParamNumber="MACH_SCAN_SPEED", newVal=SPEED)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, Speed=30, x=0, y=0, z=0)
        client.call("RMAC_CAM.MoveToXYZ", MoveID=1, Speed=30, **(at(normal, REACH + CLEAR) | {"z": 0}))
        for i in range(hits):
            try:
                client.call("RMAC_CAM.MoveToXYZ", MoveID=2, Speed=30, **at(normal, REACH + CLEAR))
                client.call("RMAC_CAM.AutoMeasure", MoveID=3, Speed=30, **at(normal, REACH))
                wait_for_rest(client)
                if not client.call("RMAC_CAM.NewHit"):
                    raise Refused("AutoMeasure", {"code": 0, "message": "no hit"})
                place = client.call("RMAC_CAM.LastHitPosition")
                errors_um.append(1e3 * abs(math.dist(place, CENTER) - REACH))
                client.call("RMAC_CAM.MoveToXYZ", MoveID=4, Speed=30, **at(normal, REACH + CLEAR))
            except Refused as refused:
                print(f"hit {i}: {refused}", file=sys.stderr)
                false_errors += 1
            false_errors += not client.call("RMAC_CAM.Ok")
            normal = next_normal(normal, source)
    return errors_um, false_errors


def measure(figures, hits, hits_as_it_comes):
    exact = Appliance(own_tree=True)
    with device_of(exact, "CMM") as device:
        rigid(device)
    errors_um, false_errors = touch(exact, hits)
    cases = f"{hits} hits at {SPEED} mm/s, a contact that bounces for {SIMULATED['probe_bounce_ms']} ms, rigid axes"
    figures.add("hit_position_at_10_mm_s", max(errors_um), "um", 0.1 + COUNT_UM, cases + "; the largest")
    figures.add("hit_position_median", statistics.median(errors_um), "um")
    figures.add("hits_false_errors", false_errors, "errors", 0, cases)
    errors_um, false_errors = touch(Appliance(), hits_as_it_comes)
    cases = f"{hits_as_it_comes} of these, on axes that bend, stick and cog, by motors' encoders"
    figures.add("hit_position_as_it_comes", max(errors_um), "um", 1e3 * DEVICE["RepeatabilityTolerance"], cases + "; the largest")
    figures.add("hit_position_as_it_comes_median", statistics.median(errors_um), "um")
    figures.add("hits_false_errors_as_it_comes", false_errors, "errors", 0, cases)


def main():
    figures = Figures()
    measure(figures, *((200, 200) if "--quick" in sys.argv[1:] else (10_000, 1000)))
    sys.exit(0 if figures.table() else 1)


main()

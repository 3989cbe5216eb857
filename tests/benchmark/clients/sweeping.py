"""FreeCAD runs this file: the free-form face of ./demo.sh cad, swept. What the paths leave is told by code that shares nothing with the sweep
(clients/freecad/tests/swept_part.py), and how long it takes from Cut to the first motion by a daemon that keeps real time."""

import os
import pathlib
import sys
import time
import traceback

SOURCE = pathlib.Path(os.environ["RMAC_SOURCE"])
sys.path[:0] = [str(SOURCE / place) for place in ("tests/system", "tests/benchmark/support", "clients/freecad/RMAC", "clients/freecad/tests", "demo", "demo/cad")]

import rmac_freecad  # noqa: E402, F401
from appliance import Appliance  # noqa: E402
from figures import Figures  # noqa: E402
from rmac_freecad.parts import recognise  # noqa: E402
from rmac_freecad.running import Machining  # noqa: E402
from rmac_freecad.station import Station  # noqa: E402
from rmac_freecad.surfaces import ball_end, plan_faces  # noqa: E402

import designer  # noqa: E402
import rmac  # noqa: E402
from recorder import Recorder  # noqa: E402
from swept_part import ball_gouge, face_points, left_over, reachable, tips  # noqa: E402

MACHINE, TOOL = "DMACXYZ", 1
RADIUS, FEED, RAPID = 4.0, 1200.0, 2000.0
RISE_MM = 15.0
GOUGE_UM, SCALLOP_SHARE, FIRST_MOTION_S = 1.0, 1.05, 2.0


def swept(figures, shape, scallop_mm):
    names = recognise(shape).free_form
    began = time.perf_counter()
    program = plan_faces("Part", shape, names, ball_end(RADIUS), scallop_mm=scallop_mm, feed_mm_min=FEED, along=90.0, tool=TOOL, rpm=800).program("Part", RAPID)
    figures.add("sweep_planned", time.perf_counter() - began, "s", note=f"{len(program)} moves, scallop {scallop_mm:g} mm, on 30 x 40 mm")
    return names, program


def left(figures, shape, names, program, scallop_mm, every, count):
    places = tips(program)
    figures.add("sweep_gouge", 1000 * max(float(ball_gouge(shape, RADIUS, places[::every])), 0.0), "um", GOUGE_UM, f"{len(places[::every])} places of the ball, against the whole part")
    worst = 0.0
    for name in names:
        points, normals = face_points(shape.getElement(name), count, 1)
        up = left_over(points, normals, places, RADIUS)
        high = up > 0.9 * scallop_mm
        free = reachable(shape, points[high], normals[high], RADIUS)
        worst = max(worst, up[high][free].max(initial=0))
    figures.add("sweep_scallop", float(worst) / scallop_mm, "of asked", SCALLOP_SHARE, f"{count} random places")


def first_motion(figures, program, times):
    """From Cut, with the machine loaded, its tool in, and the paths planned."""
    slowest = 0.0
    with Appliance(pace="real-time") as appliance:
        station = Station("bench")
        client = station.connect(f"127.0.0.1:{appliance.port}")
        with client.authority():
            client.load(MACHINE)
            client.cam.SetTool(TOOL, 30.0, RADIUS)
            client.cam.SetPartFrame({"p": [0, 0, -30], "q": [1, 0, 0, 0]})
            client.cam.JogJoint(2, Distance=RISE_MM)
            client.until_done()
            mount(client)
        for _ in range(times):
            slowest = max(slowest, cut_begun(station, client, program))
        station.disconnect()
    figures.add("cut_to_motion", slowest, "s", FIRST_MOTION_S, f"the slowest of {times}, real time; the spindle comes to speed in it")


def mount(client):
    with client.states() as states:
        client.start_cycle()
        client.cam.DoToolChange(TOOL)
        while not next(states)["tool_prompt"]:
            pass
        client.cam.ConfirmToolChange(TOOL)
    client.until_done()


def cut_begun(station, client, program):
    """Seconds to the first motion; the cut is stopped then."""
    errors = []
    with Recorder(client) as recorder:
        machining = Machining(station, lambda: client)
        began = time.monotonic()
        machining.start(program, lambda: None, errors.append)
        while recorder.first_motion is None:
            station.deliver()
            if errors:
                raise errors[0]
        took = recorder.first_motion - began
        client.cam.StopNow()
        while machining.running:
            station.deliver()
    return took


def main():
    quick = "--quick" in os.environ.get("RMAC_BENCH_OPTIONS", "").split()
    scallop_mm, every, count = (0.2, 200, 400) if quick else (0.05, 20, 4000)
    figures = Figures()
    shape = designer.draw().Part.Shape
    print()  # FreeCAD is in the midst of a line
    names, program = swept(figures, shape, scallop_mm)
    left(figures, shape, names, program, scallop_mm, every, count)
    first_motion(figures, program, 2 if quick else 10)
    return 0 if figures.table() else 1


code = 1
try:
    code = main()
except BaseException:
    traceback.print_exc()
sys.stdout.flush()
sys.stderr.flush()
os._exit(code)

"""Cuts a part that is clamped wrong, twice: as it is taken to lie, and measured where it is cut.

In the second run the roughing is held and parked, the probe is put in, the measuring machine is loaded over the mill, the
part is measured, its frame corrected, and the cut goes on from its place. One JSON line for each figure, and one for all of
them last; the exit code is 0 only if every figure is within its bound.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import time

import groove
import numpy as np
from measure_report import draw
from recorder import Recorder

import rmac  # from clients/python, where `recorder` found it

HERE = pathlib.Path(__file__).parent
MILL, MEASURER = "DMACXYZ", "CMM"
SPINDLE_RPM = 800
FIRST_RISE_MM = 45  # clear of the block
BACK_FROM_MM = 4


def say(text):
    print(text, flush=True)


class Run:
    """One cut on a mill that was just loaded."""

    def __init__(self, program, host, port, out):
        self.rmac_program, self.host, self.port, self.out = program, host, port, out
        self.client = rmac.connect(f"{host}:{port}", "measuring demo")
        self.cam = self.client.cam
        self.events = self.client.events()

    def state(self):
        return self.client.state()

    def rmac(self, *words):
        """The command line client's answer; it needs the lease for itself."""
        self.client.lease.release()
        done = subprocess.run([self.rmac_program, "--host", self.host, "--port", str(self.port), "--json", *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        self.client.lease.acquire()
        if done.returncode != 0:
            raise RuntimeError(done.stderr.strip())
        return json.loads(done.stdout) if done.stdout.strip() else None

    def until(self, reached, what, seconds=120):
        deadline = time.monotonic() + seconds
        while not reached():
            if time.monotonic() > deadline:
                told = "; ".join(event.message for event in self.events.so_far()[-3:])
                raise TimeoutError(f"{what} did not come within {seconds} s: the machine is {self.state()['state']}; {told}")
            time.sleep(0.01)

    def put_in(self, tool):
        """A change by hand, with the demo for the person; a tool stays in the spindle from one run to the next."""
        if self.state()["tool"] == tool:
            return
        self.cam.DoToolChange(tool)
        self.cam.CycleStart("AUTOMATIC")
        self.until(lambda: self.state()["tool_prompt"], "the question for the tool")
        self.cam.ConfirmToolChange(tool)
        self.until(lambda: self.state()["tool"] == tool, "the tool")
        self.cam.CycleStop("AUTOMATIC")
        self.until(lambda: self.state()["state"] == "Idle", "rest")

    def begin(self):
        """Loads the mill, clear of the part and with the cutter in and turning."""
        self.client.lease.acquire()
        self.events.__enter__()
        self.client.load(MILL)
        self.cam.SetTool(ToolNumber=groove.CUTTER, Name="end mill 4", Length=groove.CUTTER_LENGTH,
                  Radius=groove.CUTTER_RADIUS)
        self.cam.SetTool(ToolNumber=groove.PROBE, Name="touch probe", Length=groove.PROBE_LENGTH,
                  Radius=groove.TIP_RADIUS, NeedsSpindle=False)
        self.cam.JogJoint(2, Distance=FIRST_RISE_MM - self.state()["joints"][2])
        self.client.until_done()
        self.until(lambda: self.state()["state"] == "Idle", "rest")
        self.put_in(groove.CUTTER)
        self.cam.SetSpindleRPM(0, SPINDLE_RPM)

    def cut(self, hold_in=None):
        """Sends the whole program and runs it; with `hold_in`, until that move is under way, and holds there."""
        # Whoever takes every cycle hears of events behind them all; this connection hears of them at once.
        with rmac.connect(f"{self.host}:{self.port}", "measuring demo, holding") as watcher, watcher.events() as events:
            with Recorder(self.client) as recorder:
                self.client.call_all([rmac.Call(request["method"], request["params"]) for request in groove.program()])
                self.cam.CycleStart("AUTOMATIC")
                if hold_in is None:
                    self.client.until_done()
                else:
                    while (event := events.next(120)).kind != "MoveStarted" or event.move_id != hold_in:
                        pass
                    watcher.cam.FeedHold()
                    self.until(lambda: not self.state()["moving"], "rest")
            return recorder.record()

    def go_on(self):
        with Recorder(self.client) as recorder:
            self.cam.TakeUpProgram()
            self.cam.FeedResume()
            self.client.until_done()
        return recorder.record()

    def measure(self, *options):
        """The probe's turn: in, over the part, and out again. Leaves the cutter in, over the part."""
        self.client.load(MEASURER)
        self.put_in(groove.PROBE)
        plan = self.out / "measuring-plan.json"
        plan.write_text(json.dumps(groove.plan(), indent=2))
        told = self.rmac("measure", str(plan), *options)
        self.put_in(groove.CUTTER)
        return told

    def end(self):
        self.client.device.Unload()
        self.client.lease.release()
        self.client.close()


def uncorrected(*where):
    run = Run(*where)
    run.begin()
    record = run.cut()
    run.end()
    return record


def corrected(*where):
    run = Run(*where)
    run.begin()
    before = run.cut(hold_in=groove.PASSES["rough"][0] + 3)
    run.cam.ParkProgram()
    parked = run.cam.GetParkedProgram()
    say(f"  held and parked {parked['s_mm']:.3f} mm along move {parked['move_id']}, {parked['moves']} moves to do")
    measured = run.measure("--apply", "--upright")
    place = run.rmac("parked", "--back", str(BACK_FROM_MM))
    say(f"  measured, and back {1000 * place['off_mm']:.1f} um from the place in the corrected frame")
    run.client.load(MILL)
    after = run.go_on()
    again = run.measure()
    run.end()
    return before, measured, after, again


def worst_feature(report, when):
    return max(abs(feature[when]["worst_mm"]) for feature in report["features"])


def worst_of(record, joints):
    """Largest distance of the finished walls and floors from where they belong."""
    passes = [groove.off_pass(record, name, joints)[1:3] for name in groove.PASSES if name != "rough"]
    return max(float(np.abs(off).max()) for both in passes for off in both)


def frame_error(measured):
    """How far the found frame lays the block's corners from where they are."""
    turn = np.radians(groove.TURN_DEG)
    truth = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    w, *v = measured["part_frame"]["q"]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    found = np.eye(3) + 2 * w * cross + 2 * cross @ cross
    corners = np.array([[x, y, z] for x in (-20, 20) for y in (-15, 15) for z in (-40, -20)])
    off = corners @ (found - truth).T + measured["part_frame"]["p"] - np.array(groove.PLACE_MM)
    return float(np.linalg.norm(off, axis=1).max())


def figures(first, measured, after, again):
    """Name, value in um, bound in um (None: told, not judged)."""
    return [
        ("datum faces off, as the part was taken to lie", worst_feature(measured, "before"), None),
        ("groove off in the part, not corrected", worst_of(first, first.truth), None),
        ("corners of the part off in the frame that was found", frame_error(measured), 2),
        ("datum faces off after the correction: the residual", worst_feature(again, "before"), 2),
        ("groove off in the part, corrected: setpoints", worst_of(after, after.q), 2),
        ("groove off in the part, corrected: by the motors", worst_of(after, after.a), 30),
        ("groove off in the part, corrected: the truth", worst_of(after, after.truth), 30),
    ]


def run(program, host, port, out):
    out.mkdir(parents=True, exist_ok=True)
    where = (program, host, port, out)
    say(f"The part is clamped {np.linalg.norm(groove.PLACE_MM):.2f} mm and {groove.TURN_DEG} degrees off")
    say("Cut as it is taken to lie")
    first = uncorrected(*where)
    say("Cut, paused, measured, corrected, finished")
    before, measured, after, again = corrected(*where)
    rough = int(before.move[-1])
    table = figures(first, measured, after, again)
    picture = out / "measure.png"
    draw(first, before, after, picture)
    say(f"\n{'figure':56}{'um':>10}{'bound':>8}")
    lines = []
    for name, value_mm, bound_um in table:
        off_um = 1000 * value_mm
        lines.append({"figure": name, "um": round(off_um, 4), "bound_um": bound_um, "ok": bound_um is None or off_um <= bound_um})
        say(f"{name:56}{off_um:10.3f}{'-' if bound_um is None else bound_um:>8}")
    held = groove.PASSES["rough"][0] <= rough < groove.PASSES["rough"][0] + 9
    if not held:
        say(f"the cut was held in move {rough}, which is not in the roughing")
    say(f"\npicture: {picture}")
    for line in lines:
        say(json.dumps(line))
    ok = held and all(line["ok"] for line in lines)
    um = {line["figure"]: line["um"] for line in lines}
    say(json.dumps({"ok": ok, "clamped_off_mm": float(np.linalg.norm(groove.PLACE_MM)), "turned_deg": groove.TURN_DEG,
                    "before_um": um["groove off in the part, not corrected"], "after_um": um["groove off in the part, corrected: the truth"],
                    "residual_um": um["datum faces off after the correction: the residual"]}))
    return 0 if ok else 1


def main():
    parser = argparse.ArgumentParser(description="A part measured where it is cut, on a running rmacd.")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=7402)
    parser.add_argument("--rmac", default=str(HERE.parent / "build/release/bin/rmac"), help="the command line client")
    parser.add_argument("--out", default="out", type=pathlib.Path)
    parser.add_argument("--clamp", nargs=2, metavar=("BUILT", "TREE"), help="only make the device tree with the part")
    arguments = parser.parse_args()
    if arguments.clamp:
        groove.clamp(*arguments.clamp)
        return 0
    try:
        return run(arguments.rmac, arguments.host, arguments.port, arguments.out)
    except (rmac.RmacError, RuntimeError, OSError, ValueError, TimeoutError) as error:
        print(f"run_measure: {error}", file=sys.stderr)
        print(json.dumps({"ok": False, "error": str(error)}))
        return 1


if __name__ == "__main__":
    sys.exit(main())

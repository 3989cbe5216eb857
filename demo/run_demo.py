"""Machines the headlight on a running appliance and judges the result.

The session of the dissertation's second experiment: search for a machine, load DMACXYZ, sweep the surface with native
NURBS moves, load DMACXY while the appliance keeps running, face-mill the rim with lines and arcs. The last line printed
is one JSON object; the exit code is 0 only if every figure is within bounds.json.
"""

import argparse
import json
import pathlib
import sys
import time

import figures
import toolpaths
from recorder import Recorder

import rmac  # from clients/python, where `recorder` found it

HERE = pathlib.Path(__file__).parent
# The part needs 2 x (48 + overlap) mm of travel in x and 2 x 44 mm in y, 25 mm in z.
SEARCH = (
    "Type = 'Mill' AND ConfigurationType = '3-axis' "
    "AND Length >= 100 AND Width >= 90 AND Depth >= 30 AND PositioningTolerance <= 0.05 ORDER BY Length * Width * Depth"
)
REFUSALS = (rmac.errors.TravelLimit, rmac.errors.InvalidParameterValue, rmac.errors.UnsupportedOperation)


def say(text):
    print(text, flush=True)


def search(client):
    """Names of the mills that can do the work, the smallest first."""
    names = [found.name for found in client.machines(SEARCH)]
    say(f"  {len(client.machines())} machines known, {len(names)} fit: {', '.join(names)}")
    return names


def split(program):
    """A program's requests before its first move, and the rest."""
    first = next(n for n, r in enumerate(program.requests) if ".Move" in r["method"])
    return program.requests[:first], program.requests[first:]


def prepare(client, requests):
    for request in requests:
        client.call(rmac.Call(request["method"], request["params"]))


def machine(client, requests):
    """Runs moves to their end while every cycle is recorded: (recorder, wall clock when the first was sent, state)."""
    with Recorder(client) as recorder:
        sent = time.monotonic()
        client.run(requests, start=False).wait()
    wall = time.monotonic() - sent
    say(f"  {len(requests)} requests done after {wall:.1f} s of wall time; {recorder.cycles} cycles watched")
    return recorder, sent, client.state()


def probe_off_plane(client, plan, session):
    """A move that leaves the plane of the two-axis mill must be refused, and nothing may move by it."""
    x, y = plan.wait_mm
    before = client.state()["joints"]
    try:
        client.cam.MoveAlongLine(999, rmac.Pose((x, y, 0)), rmac.Pose((x, y, 5)))
        session.problems.append("a move 5 mm off the plane of DMACXY was accepted")
    except rmac.Refused as refusal:
        say(f"  {refusal}")
        if isinstance(refusal, REFUSALS):
            session.off_plane_refusal = f"refused: {refusal.minor_name}"
        else:
            session.problems.append(f"the off-plane move was refused, but with {refusal.minor_name or 'no minor code'}")
    after = client.state()
    if after["moving"] or max(abs(a - b) for a, b in zip(before, after["joints"])) > 0.01:
        session.problems.append("the machine moved although the off-plane move was refused")


def cut(client, session, ready, plan, sweep, rim):
    """The records, by the names of their files."""
    say("DMACXYZ: sweep the headlight (ball end)")
    preparation, moves = split(sweep)
    prepare(client, preparation)
    recorder, sent, _ = machine(client, moves)
    session.plan_to_motion_ms = (recorder.first_motion - ready) * 1e3
    session.send_to_motion_ms = (recorder.first_motion - sent) * 1e3
    session.lost_samples += recorder.lost
    records = {"record.csv": recorder.record()}

    say("DMACXY: face-mill the rim (flat end), the appliance running on")
    preparation, moves = split(rim)
    prepare(client, preparation)
    probe_off_plane(client, plan, session)
    recorder, _, state = machine(client, moves)
    session.lost_samples += recorder.lost
    records["record-rim.csv"] = recorder.record()
    say(f"  held drive stands at {state['held_joints']} mm")

    client.cam.SetSpindleRPM(0, 0)
    client.cam.TurnCoolantOff()
    return records


def run(host, port, out, device_tree):
    out = pathlib.Path(out)
    session = figures.Session()
    say("The process plan")
    plan, sweep, rim = toolpaths.make(out)
    say(
        f"  {plan.sweeps} sweeps, {plan.sweep_length_mm / 1000:.2f} m, ridges up to {plan.scallop_planned_um:.1f} um; "
        f"NURBS within {plan.fit_error_um:.2f} um of the offset surface"
    )
    ready = time.monotonic()

    say("Search for a machine")
    with rmac.connect(f"{host}:{port}", "headlight demo") as client, client.events() as events:
        names = search(client)
        if "DMACXYZ" not in names:
            raise RuntimeError(f"the search did not find DMACXYZ, but {names or 'nothing'}")
        with client.authority():
            records = cut(client, session, ready, plan, sweep, rim)
        session.problems += [f"fault: {event.message}" for event in events.so_far() if "fault" in event.kind.lower()]

    say("Checks")
    for name, record in records.items():
        record.write(out / name)
    rows, line = figures.judge(out, device_tree, session, records)
    figures.print_table(rows)
    say(f"  {out / 'report.html'} has the pictures, {out / 'record.csv'} every cycle")
    return line


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=7402)
    parser.add_argument("--out", default="out")
    parser.add_argument("--device-tree", default=HERE.parent / "drivers", help="where the device.json files are")
    arguments = parser.parse_args()
    try:
        line = run(arguments.host, arguments.port, arguments.out, arguments.device_tree)
    except (rmac.RmacError, RuntimeError, OSError, ValueError) as error:
        print(f"run_demo: {error}", file=sys.stderr)
        print(json.dumps({"ok": False, "error": str(error)}))
        return 1
    print(json.dumps(line))
    return 0 if line["ok"] else 1


if __name__ == "__main__":
    sys.exit(main())

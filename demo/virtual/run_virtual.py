"""A five-axis part on SuginoXYZAC, first rehearsed and then machined by the simulated appliance.

The first program brings the holder to a clamp: the simulation finds it, and the appliance holds before it. The second leans the
tool the other way; what it is predicted to leave is compared with what the axes then cut. The last line is the figures
as JSON; the exit code is 0 only if every figure is within bounds.json.
"""

import argparse
import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(1, str(HERE.parent))

import clamping  # noqa: E402
import dome  # noqa: E402
import drawing  # noqa: E402
import rehearsal  # noqa: E402
import replay  # noqa: E402
import sweeps  # noqa: E402
import verdict  # noqa: E402
from machining import Machining  # noqa: E402

import rmac  # noqa: E402 from clients/python, where `machining` found it

TOWARDS_CLAMP, AWAY = 1, -1
MESH_STEP = 0.5


def say(text):
    print(text, flush=True)


def tell(finding):
    x, y, z = finding["place_mm"]
    say(f"  line {finding['line']}, move {finding['move_id']}, at {finding['t_s']:.3f} s: {finding['bodies'][1]} is {finding['depth_mm']:.2f} mm deep in "
        f"{finding['bodies'][0]}, at {x:.2f} {y:.2f} {z:.2f} mm of the part frame")  # fmt: skip


def run(arguments):
    out = arguments.out
    rmac.connect(f"{arguments.host}:{arguments.port}", "virtual demo").close()  # whether it is there is known before anything is simulated
    out.mkdir(parents=True, exist_ok=True)
    clamping.write_tools(out / "tools")
    setup_file, setup = clamping.write_setup(out, dome.mesh(MESH_STEP))
    programs = {name: sweeps.program(arguments.step, lean) for name, lean in (("first", TOWARDS_CLAMP), ("second", AWAY))}

    def simulate(name, requests, with_surface=True):
        file = out / f"{name}.rmac"
        sweeps.write(file, requests)
        return rehearsal.simulate(arguments.rmac, file, setup_file, out / "tools", arguments.device_tree, arguments.resolution, with_surface)

    say("Simulated: the first program, whose tool leans towards the clamp")
    first = simulate("first", programs["first"], with_surface=False)
    for finding in first.told["collisions"]:
        tell(finding)
    say(f"  {first.page} shows it")
    say("Simulated: the second, which leans the other way")
    second = simulate("second", programs["second"])
    say(f"  {len(second.told['collisions'])} collisions, {second.told['cycle_time_s']:.1f} s of machine time; {second.page} shows it, {second.stock} is the predicted part")
    with Machining(arguments.host, arguments.port, setup) as machine:
        say("On the appliance, its check on: the first program")
        held = machine.until_held(programs["first"])
        say(f"  held: {held.message}")
        say("On the appliance: the second program, to its end")
        record = machine.run(programs["second"])
        record.write(out / "record.csv")
    say("Simulated: what the axes did, where they truly were")
    replayed = simulate("machined", replay.program(record.move, record.truth))
    say(f"  {replayed.stock} is the machined part")
    return judge(arguments, first, held, second, record, replayed)


def judge(arguments, first, held, second, record, replayed):
    out = arguments.out
    wrong = list(verdict.problems(first, held, second))
    figures, cut, off = verdict.of_second(second, record)
    figures += verdict.of_replay(replayed, second, record, arguments.resolution)
    if first.told["collisions"]:
        figures = verdict.of_first(first, held) + figures
        picture = out / "virtual.png"
        drawing.draw(first, second, cut, off, picture)
        say(f"  picture: {picture}")
    say(f"\n{'figure':58}{'':>12}{'':7}{'bound':>12}")
    for figure in figures:
        say(f"{figure.name:58}{figure.value:12.3f} {figure.unit:6}{figure.bound():>12}{'' if figure.ok() else '   <-- NOT FINE'}")
    for problem in wrong:
        say(f"NOT FINE: {problem}")
    ok = not wrong and all(figure.ok() for figure in figures)
    say(json.dumps({"ok": ok} | {figure.key: round(figure.value, 4) for figure in figures if figure.key}))
    return 0 if ok else 1


def main():
    parser = argparse.ArgumentParser(description="A part rehearsed, and then machined on a running rmacd.")
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=7402)
    parser.add_argument("--rmac", default=ROOT / "build/release/bin/rmac", type=pathlib.Path, help="the command line client")
    parser.add_argument("--device-tree", default=ROOT / "build/release/drivers", type=pathlib.Path, help="the daemon's")
    parser.add_argument("--step", default=1.0, type=float, help="mm from sweep to sweep")
    parser.add_argument("--resolution", default=0.1, type=float, help="mm from ray to ray of the predicted part")
    parser.add_argument("--out", default="out", type=pathlib.Path)
    parser.add_argument("--tools", metavar="FOLDER", type=pathlib.Path, help="only write the machine's tool table there, for the daemon")
    arguments = parser.parse_args()
    if arguments.tools:
        clamping.write_tools(arguments.tools)
        return 0
    try:
        return run(arguments)
    except (rmac.RmacError, RuntimeError, OSError, ValueError, TimeoutError, subprocess.SubprocessError) as error:
        print(f"run_virtual: {error}", file=sys.stderr)
        print(json.dumps({"ok": False, "error": str(error)}))
        return 1


if __name__ == "__main__":
    sys.exit(main())

"""How much memory an hour of machine time takes: the five-axis part of ./demo.sh virtual with its fixtures, swept in ever so many lines."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from figures import Figures

ROOT, BUILD = pathlib.Path(os.environ["RMAC_SOURCE"]), pathlib.Path(os.environ["RMAC_BUILD"])
sys.path[:0] = [str(ROOT / "demo"), str(ROOT / "demo/virtual")]
import clamping  # noqa: E402
import dome  # noqa: E402
import sweeps  # noqa: E402

CLEAR = -1  # the lean with which the holder stays clear of the clamp
SWEEP_S = 3.46  # machine time of a sweep and of the loop to the next
MESH_MM = 0.5
RESOLUTION = 0.05


def write(folder, machine_s):
    """A program that takes so long, and what it needs."""
    clamping.write_tools(folder / "tools")
    setup, _ = clamping.write_setup(folder, dome.mesh(MESH_MM))
    # Without the material nobody asks for forces, which is another bench's.
    setup.write_text(json.dumps({key: value for key, value in json.loads(setup.read_text()).items() if key != "Material"}))
    program = folder / "program.rmac"
    program.write_text("".join(json.dumps(line) + "\n" for line in sweeps.program(dome.WIDTH * SWEEP_S / machine_s, CLEAR)))
    return program, setup


def simulate(folder, program, setup):
    """The report, and the most that was resident, bytes."""
    words = ["--setup", setup, "--tools", folder / "tools", "--resolution", str(RESOLUTION), "--json"]
    report = folder / "report.json"
    with report.open("w") as out:
        child = subprocess.Popen([BUILD / "bin/rmac", "simulate", program, "--machine", clamping.MACHINE, *words],
                                 stdin=subprocess.DEVNULL, stdout=out)
        _, status, usage = os.wait4(child.pid, 0)  # what this child took, and no other
        child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise SystemExit(f"rmac simulate {program}: exit code {child.returncode}, {report.read_text()[:1000] or 'and it told nothing'}")
    return json.loads(report.read_text()), usage.ru_maxrss * 1024


def main():
    quick = "--quick" in sys.argv[1:]
    figures = Figures()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program, setup = write(folder, 300 if quick else 3600)
        report, most = simulate(folder, program, setup)
    figures.add("memory.five_axis_hour", most / 1e9, "GB", 2,
                f"{report['cycle_time_s']:.0f} s of machine time, {report['moves']} moves, {report['material']['strokes']} strokes, rays {RESOLUTION} mm apart, "
                f"{report['cpu_time_s']:.0f} s of CPU time" + (": --quick" if quick else ""))
    return 0 if figures.table() else 1


if __name__ == "__main__":
    sys.exit(main())

"""The same three-axis program by `rmac simulate` and by FreeCAD's own Path simulator: how long each takes, and how far both are from the closed form."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import waves
from figures import Figures
from material import ROOT, pose, simulated

sys.path.append(str(ROOT / "demo/virtual"))
import stl  # noqa: E402


def by_rmac(folder):
    """CPU time without and with the surface, and the surface."""
    tips = [pose(*tip) for tip in waves.tips().tolist()]
    requests = [("SetFeedrate", {"Feedrate": 2000}), ("MoveToPathTarget", {"MoveID": 1, "TargetFrame": tips[0]})]
    requests += [("MoveAlongLine", {"MoveID": n + 2, "StartPoint": a, "EndPoint": b}) for n, (a, b) in enumerate(zip(tips[:-1], tips[1:], strict=True))]
    program, surface = folder / "waves.rmac", folder / "left.stl"
    program.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": n, "method": "RMAC_CAM." + method, "params": params}) + "\n"
                               for n, (method, params) in enumerate(requests)))
    block = {"Stock": {"Shape": {"Box": {"Size": list(waves.BLOCK)}}, "Pose": pose(0, 0, -waves.BLOCK[2] / 2)}}
    cut = simulated(folder, program, block, waves.RADIUS, waves.RESOLUTION)
    whole = simulated(folder, program, block, waves.RADIUS, waves.RESOLUTION, None, "--stock-out", surface)
    return cut["cpu_time_s"], whole["cpu_time_s"] - cut["cpu_time_s"], stl.corners(surface).reshape(-1, 3, 3), whole["material"]


def by_freecad(folder):
    result = folder / "freecad.npz"
    environment = os.environ | {"RMAC_BENCH_RESULT": str(result), "FREECAD_USER_HOME": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(["freecadcmd", pathlib.Path(__file__).with_name("in_freecad.py")], env=environment, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, check=False)
    if not result.exists():
        raise SystemExit(f"freecadcmd {pathlib.Path(__file__).with_name('in_freecad.py')}: no result; {done.stderr[-1000:]}")
    return np.load(result)


def main():
    figures = Figures()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        cut_s, surface_s, corners, material = by_rmac(folder)
        ours = waves.deviation(corners)
        program = f"{len(waves.tips()) - 1} lines, {waves.RESOLUTION} mm apart"
        # What is wanted of it is that it is the better one: without the other there is nothing to hold it against.
        theirs, other = (float("nan"),) * 3, "FreeCAD is not installed (freecadcmd): not compared"
        if shutil.which("freecadcmd"):
            made = by_freecad(folder)
            theirs, other = waves.deviation(made["corners"]), f"FreeCAD {made['version']}"
            figures.add("freecad.cut", float(made["cut_s"]), "s", None, f"{other}, {program}, CPU time")
            figures.add("freecad.surface", float(made["surface_s"]), "s", None, f"{len(made['corners'])} triangles")
            for what, value in zip(("mean", "99_percent", "most"), theirs, strict=True):
                figures.add(f"freecad.off.{what}", 1000 * value, "um")
        figures.add("against_freecad.cut", cut_s, "s", None, f"rmac simulate, {program}, planning and collision checks in it")
        figures.add("against_freecad.surface", surface_s, "s", None, f"{len(corners)} triangles, {material['stock_points_apart_mm']:g} mm apart")
        for what, value, bound in zip(("mean", "99_percent", "most"), ours, theirs, strict=True):
            figures.add(f"against_freecad.off.{what}", 1000 * value, "um", 1000 * bound, other)
    return 0 if figures.table() else 1


if __name__ == "__main__":
    sys.exit(main())

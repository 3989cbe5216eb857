"""How fast material is removed, and how right: the demo's headlight cut in one pass from a block, and a ball's slot whose volume is known, and what that takes."""

import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

from figures import Figures

ROOT, BUILD = pathlib.Path(os.environ["RMAC_SOURCE"]), pathlib.Path(os.environ["RMAC_BUILD"])
sys.path.insert(0, str(ROOT / "demo"))
import toolpaths  # noqa: E402

LENGTH = 45  # of the tool


def pose(x, y, z):
    return {"p": [x, y, z], "axis": [0, 0, 1]}


def simulated(folder, program, setup, radius, resolution, teeth=None, *words):
    """The report of `rmac simulate`."""
    (folder / "setup.json").write_text(json.dumps({"Machine": "DMACXYZ", "Clearance": 0.1} | setup))
    (folder / "tools").mkdir(exist_ok=True)
    shape = {"DC": 2 * radius, "RE": radius, "LCF": 30, "OAL": LENGTH}
    if teeth:
        shape |= {"LCF": 10, "ZEFP": teeth, "BMC": "HM", "Holder": [{"Cylinder": {"Radius": 15, "Height": LENGTH - 16}}]}
    tool = {"ToolNumber": 7, "Length": LENGTH, "Radius": radius, "NeedsSpindle": False, "Shape": shape}
    (folder / "tools/DMACXYZ.json").write_text(json.dumps({"Mounted": 7, "Tools": [tool]}))
    # Collisions with the part's own block are what a cut in one pass is full of: exit code 1 says so.
    done = subprocess.run([BUILD / "bin/rmac", "simulate", program, "--machine", "DMACXYZ", "--setup", folder / "setup.json", "--tools",
                           folder / "tools", "--resolution", str(resolution), "--json", *words], capture_output=True, text=True, check=False)
    if not done.stdout:
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)


def headlight(figures, folder, quick):
    toolpaths.make(folder, (0.45, 0.55) if quick else None)
    plan = toolpaths.Plan()
    setup = {"PartFrame": {"p": list(plan.part_origin_mm), "q": [1, 0, 0, 0]},
             "Stock": {"Shape": {"Box": {"Size": [2 * plan.block_half_mm[0], 2 * plan.block_half_mm[1], 31]}}, "Pose": pose(0, 0, 5.5)}}
    report = simulated(folder, folder / "headlight-sweep.rmac", setup, plan.ball_radius_mm, 0.05)
    figures.add_least("material.headlight.real_time", report["cycle_time_s"] / report["cpu_time_s"], "times", 20,
                      f"{report['cycle_time_s']:.0f} s of machine time, rays 0.05 mm apart" + (", a band of it: --quick" if quick else ""))
    figures.add("material.headlight.rays", report["material"]["memory_mb"], "MB")


def slot(figures, folder):
    """A ball of 6 mm goes 4 mm deep through a block of 60 mm: a half cylinder and what is above its middle."""
    radius, depth, length = 3, 4, 60
    requests = [("RMAC_CAM.SetFeedrate", {"Feedrate": 1000}),
                ("RMAC_CAM.MoveToPathTarget", {"MoveID": 1, "TargetFrame": pose(-40, 0, -depth)}),
                ("RMAC_CAM.MoveAlongLine", {"MoveID": 2, "StartPoint": pose(-40, 0, -depth), "EndPoint": pose(40, 0, -depth)})]
    program = folder / "slot.rmac"
    program.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": i, "method": method, "params": params}) + "\n"
                               for i, (method, params) in enumerate(requests)))
    setup = {"Stock": {"Shape": {"Box": {"Size": [length, 20, 10]}}, "Pose": pose(0, 0, -5)}}
    exact = length * (math.pi * radius**2 / 2 + 2 * radius * (depth - radius))
    for resolution in (0.2, 0.05):
        removed = simulated(folder, program, setup, radius, resolution)["material"]["removed_mm3"]
        figures.add(f"material.slot.{resolution}", 100 * abs(removed / exact - 1), "% off", 0.1 if resolution == 0.05 else None,
                    f"{removed:.2f} of {exact:.2f} mm³")


def forces(figures, folder):
    """The same ball through the same block at 900 rpm: what the chips take is the material's Ktc for each mm³, whatever the ball's shape makes of it."""
    material = next(m for m in json.loads((ROOT / "etc/materials.json").read_text())["Materials"] if m["Name"] == "Al7075-T6")
    own = folder / "chips.json"
    own.write_text(json.dumps({"Materials": [material | {"Kte": 0, "Kre": 0, "Kae": 0}]}))
    rpm, depth = 900, 4
    requests = [("RMAC_CAM.SetFeedrate", {"Feedrate": 100}), ("RMAC_CAM.SetSpindleRPM", {"SpindleNumber": 0, "RPM": rpm}),
                ("RMAC_CAM.MoveToPathTarget", {"MoveID": 1, "TargetFrame": pose(-40, 0, -depth)}),
                ("RMAC_CAM.MoveAlongLine", {"MoveID": 2, "StartPoint": pose(-40, 0, -depth), "EndPoint": pose(40, 0, -depth)})]
    program = folder / "forces.rmac"
    program.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": i, "method": method, "params": params}) + "\n"
                               for i, (method, params) in enumerate(requests)))
    block = {"Stock": {"Shape": {"Box": {"Size": [60, 20, 10]}}, "Pose": pose(0, 0, -5)}}
    without = simulated(folder, program, block, 3, 0.2, teeth=2)
    report = simulated(folder, program, block | {"Material": "Al7075-T6"}, 3, 0.2, 2, "--materials", own)
    taken = report["forces"]["mean_power_w"] * report["forces"]["cutting_s"]
    chips = material["Ktc"] * report["material"]["removed_mm3"] / 1000
    figures.add("forces.slot.energy", 100 * abs(taken / chips - 1), "% off", 5, f"{taken:.1f} J of {chips:.1f} J, rays 0.2 mm apart")
    figures.add("forces.slot.cpu", report["cpu_time_s"] - without["cpu_time_s"], "s more", None,
                f"than {without['cpu_time_s']:.1f} s, for {report['cycle_time_s']:.0f} s of machine time")
    dynamics = simulated(folder, program, block | {"Material": "Al7075-T6"}, 3, 0.2, 2, "--dynamics")
    figures.add("dynamics.slot.cpu", dynamics["cpu_time_s"] - report["cpu_time_s"], "s more", None,
                f"with three axes, the tool's bending and its chatter, from {dynamics['dynamics']['chatter_from_percent']:.0f} % on")


def main():
    figures = Figures()
    with tempfile.TemporaryDirectory() as folder:
        slot(figures, pathlib.Path(folder))
        forces(figures, pathlib.Path(folder))
        headlight(figures, pathlib.Path(folder), "--quick" in sys.argv[1:])
    return 0 if figures.table() else 1


if __name__ == "__main__":
    sys.exit(main())

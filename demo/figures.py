"""From a recorded run to its figures: the table, the verdict and the JSON line."""

import dataclasses
import json
import pathlib

import entities
import nurbs
import part as parts
import report
import verify
from record import Record

HERE = pathlib.Path(__file__).parent
RECORDS = {"record.csv": "headlight-sweep.rmac", "record-rim.csv": "headlight-rim.rmac"}


@dataclasses.dataclass
class Session:
    """What only the client saw."""

    plan_to_motion_ms: float = float("nan")
    send_to_motion_ms: float = float("nan")
    machine: str = "DMACXYZ, DMACXY"
    off_plane_refusal: str = ""
    lost_samples: int = 0
    problems: list = dataclasses.field(default_factory=list)


def load_records(out):
    return {name: Record.read(out / name) for name in RECORDS}


def judge(out, device_tree, session, records=None):
    """Checks the run in `out`, writes report.html and figures.json, and gives (table rows, JSON line)."""
    out = pathlib.Path(out)
    bounds = json.loads((HERE / "bounds.json").read_text(encoding="utf-8"))
    plan = json.loads((out / "plan.json").read_text(encoding="utf-8"))
    records = records or load_records(out)
    checks, programs = [], []
    for name, program_name in RECORDS.items():
        record = records[name]
        joints = record.joints
        start = None
        if programs:
            start = [*plan["wait_mm"], 0.0]
        program = entities.read_program(out / program_name, start)
        if program.moves[0].method == "MoveToPathTarget":
            first = verify.tips_of(record.q[:1], program)[0]
            program.moves[0].shape = entities.Line(first, program.moves[0].shape.end)
        device = verify.find_device(device_tree, program.mechanism)
        if len(device["Joints"]) != joints:
            raise ValueError(f"{name} has {joints} joints, device.json of {program.mechanism} {len(device['Joints'])}")
        programs.append(program)
        checks.append(verify.check_run(record, program, device))

    height_map = machined(plan, records, programs)
    deviation = parts.summary(height_map)
    rows, ok = table(checks, deviation, plan, bounds, session)
    runs = list(zip(records.values(), checks))
    report.write(out, rows, height_map, runs, bounds, plan, ok)
    line = {
        "ok": ok,
        "machine": session.machine,
        "moves": sum(c["moves"] for c in checks),
        "cycle_time_s": round(sum(c["cycle_time_s"] for c in checks), 3),
        "path_deviation_um": float(f"{max(c['path']['deviation_um'] for c in checks):.3g}"),
        "following_error_um": round(max(c["following"]["largest_um"] for c in checks), 3),
        "following_error_truth_um": round(max(c["following_truth"]["largest_um"] for c in checks), 3),
        "part_deviation_um": round(deviation["part_deviation_um"], 3),
        "limit_violations": sum(c["limits"]["violations"] + c["feed"]["violations"] for c in checks),
        "plan_to_motion_ms": round(session.plan_to_motion_ms, 1),
    }
    for check in checks:
        check["path"].pop("distance_um")
    figures = {"line": line, "part": deviation, "runs": checks, "plan": plan, "session": dataclasses.asdict(session)}
    (out / "figures.json").write_text(json.dumps(figures, indent=1) + "\n", encoding="utf-8")
    return rows, line


def machined(plan, records, programs):
    """The height map that the tool leaves where it truly was in both runs."""
    height_map = parts.blank(nurbs.Surface.read(HERE / "headlight.json"), plan)
    sweep, rim = records.values()
    tips = verify.tips_of(sweep.truth[:, : sweep.joints], programs[0])
    parts.cut(height_map, tips, plan["ball_radius_mm"], ball=True)
    tips = verify.tips_of(rim.truth[:, : rim.joints], programs[1])
    # the mill's third axis is held: where it stands, seen from the part frame of the first run
    tips[:, 2] = rim.truth[:, rim.joints] - plan["part_origin_mm"][2]
    parts.cut(height_map, tips, plan["flat_radius_mm"], ball=False)
    return height_map


def table(checks, deviation, plan, bounds, session):
    """Rows (what, value, bound, fine) and whether all are fine."""
    rows = []

    def row(what, value, unit="", bound=None, form=".3f", fine=None):
        if fine is None:
            fine = bound is None or value <= bound
        text = format(value, form) if isinstance(value, float) else str(value)
        rows.append((what, f"{text} {unit}".strip(), "" if bound is None else f"{bound:g} {unit}".strip(), bool(fine)))

    count = lambda key: sum(len(c["path"][key]) if key == "unfinished_moves" else c["path"][key] for c in checks)
    violations = sum(c["limits"]["violations"] + c["feed"]["violations"] for c in checks)
    row("Moves sent and travelled", sum(c["moves"] for c in checks))
    row("Moves not travelled from end to end", count("unfinished_moves"), bound=0)
    row("Cycles with motion outside any move", count("stray_rows"), bound=0)
    for check in checks:
        row(f"Cycle time, {check['mechanism']}", check["cycle_time_s"], "s")
    row("Setpoints off the exact path, largest", max(c["path"]["deviation_um"] for c in checks), "µm",
        bounds["path_deviation_um"], ".1e")  # fmt: skip
    row("Reported tool tip off the joints', largest", max(c["pose_disagrees_um"] for c in checks), "µm",
        bounds["pose_disagrees_um"], ".1e")  # fmt: skip
    for check in checks:
        row(f"Following error, {check['mechanism']}, largest of any joint, by the motors", check["following"]["largest_um"], "µm",
            bounds["following_error_um"])  # fmt: skip
        row("  the truth, at the loads", check["following_truth"]["largest_um"], "µm", bounds["following_error_um"])
    row("Tool off the exact path, largest, by the motors", max(c["contour_um"] for c in checks), "µm")
    row("  the truth, by the loads", max(c["contour_truth_um"] for c in checks), "µm")
    row("Limit violations (travel, feed, speed, acceleration, jerk, lost cycles)", violations, bound=0)
    for check in checks:
        peak = max(j["peak_jerk"] / j["limit_jerk"] for j in check["limits"]["joints"])
        row(f"Peak jerk, {check['mechanism']}", 100 * peak, "% of the limit", form=".2f")
    row("Part off the surface, largest, ridges included", deviation["part_deviation_um"], "µm",
        bounds["part_deviation_um"])  # fmt: skip
    row("  of that: material left / cut too deep", f"{deviation['left_um']:.2f} / {deviation['gouge_um']:.2f}", "µm")
    row("  ridges as planned / median / 99 % of cells below", f"{plan['scallop_planned_um']:.1f} / "
        f"{deviation['deviation_p50_um']:.2f} / {deviation['deviation_p99_um']:.2f}", "µm")  # fmt: skip
    for held in checks[1]["held"]:
        row("Held drive off the plane it was left in, mean", abs(held["position_mm"] - plan["part_origin_mm"][2]) * 1e3,
            "µm", bounds["held_strayed_um"])  # fmt: skip
        row("Held drive strayed from its place, largest", held["strayed_um"], "µm", bounds["held_strayed_um"])
    if not checks[1]["held"]:
        row("Held drive's position", "not in the record", fine=False)
    row("Move off the two-axis plane", session.off_plane_refusal or "was not refused",
        fine=bool(session.off_plane_refusal))  # fmt: skip
    row("Samples lost on the way to the client", session.lost_samples, bound=0)
    row("Plan ready to first motion, search and driver loading included", session.plan_to_motion_ms, "ms", form=".1f")
    row("First move sent to first motion", session.send_to_motion_ms, "ms", form=".1f")
    row("  conventional way (Table 6-1): post-processing and file handling", report.CONVENTIONAL_MIN, "min")
    for problem in session.problems:
        row("Problem", problem, fine=False)
    return rows, all(fine for *_, fine in rows)


def print_table(rows):
    width = max(len(what) for what, *_ in rows)
    for what, value, bound, fine in rows:
        limit = f"  (bound {bound})" if bound else ""
        print(f"  {what:<{width}}  {value}{limit}{'' if fine else '   <-- NOT FINE'}")

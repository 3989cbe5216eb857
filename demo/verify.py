"""Checks of a recorded run that share no code with the planner: limits, path, following error.

Limits are checked on differences of the recorded joint setpoints from cycle to cycle, not on what the controller says
its velocity, acceleration and jerk are.
"""

import json
import pathlib

import numpy as np

TOLERANCE = 1.001  # on speed, acceleration, jerk and feed: 0.1 %
TRAVEL_MM = 1e-6


def find_device(tree, mechanism):
    """The device.json of a mechanism in the device tree."""
    found = sorted(pathlib.Path(tree).glob(f"**/{mechanism}/device.json"))
    if not found:
        raise FileNotFoundError(f"no device.json of {mechanism} under {tree}")
    return json.loads(found[0].read_text(encoding="utf-8"))


def stretches(record, period_s):
    """Slices of rows that follow each other cycle by cycle, and how many gaps lie between rows that differ."""
    gap = np.flatnonzero(np.abs(np.diff(record.t) - period_s) > 0.01 * period_s)
    edges = [0, *(gap + 1), len(record.t)]
    moved = sum(bool(np.any(record.q[g] != record.q[g + 1])) for g in gap)
    return [slice(a, b) for a, b in zip(edges, edges[1:])], moved


def check_limits(record, joints, period_s=0.001):
    """Peaks of each joint and the number of rows that break a limit. `joints` as in device.json."""
    rows, lost = stretches(record, period_s)
    result = {"violations": 0, "lost_cycles": lost, "joints": []}
    for number, joint in enumerate(joints):
        q = record.q[:, number]
        over = np.maximum(q - joint["Max"], joint["Min"] - q)
        report = {"name": joint["Name"], "lowest": float(q.min()), "highest": float(q.max())}
        report["travel_violations"] = int((over > TRAVEL_MM).sum())
        for order, (name, key) in enumerate(
            [("velocity", "MaxSpeed"), ("acceleration", "MaxAcceleration"), ("jerk", "MaxJerk")], 1
        ):
            pieces = [np.abs(np.diff(q[r], order)) / period_s**order for r in rows]
            values = np.concatenate([*pieces, [0.0]])
            report[f"peak_{name}"] = float(values.max())
            report[f"limit_{name}"] = joint[key]
            report[f"{name}_violations"] = int((values > joint[key] * TOLERANCE).sum())
        result["violations"] += sum(v for k, v in report.items() if k.endswith("_violations"))
        result["joints"].append(report)
    result["violations"] += lost
    return result


def setpoint_tips(record, program):
    """Tool tips from joint setpoints: these mills have one linear joint an axis, so the machine frame is the joints'."""
    return tips_of(record.q, program)


def tips_of(joints, program):
    machine = np.zeros((len(joints), 3))
    machine[:, : joints.shape[1]] = joints
    return machine - program.part_origin_mm


def check_feed(record, program, period_s=0.001):
    """Rows in which the tool tip is faster than the feed in force for their move."""
    feeds = {m.id: m.feed_mm_min for m in program.moves}
    rows, _ = stretches(record, period_s)
    tips, peak, violations = setpoint_tips(record, program), 0.0, 0
    for r in rows:
        feed = np.linalg.norm(np.diff(tips[r], axis=0), axis=1) / period_s * 60
        ids = record.move[r]
        # the step into a move may still belong to the faster one before it
        allowed = np.array([feeds.get(i, 0) for i in ids])
        allowed = np.maximum(allowed[1:], allowed[:-1])
        violations += int((feed > allowed * TOLERANCE + 1e-6).sum())
        peak = max(peak, feed.max(initial=0))
    return {"peak_feed_mm_min": float(peak), "violations": violations}


def check_path(record, program, tips, max_reach_mm=0.1):
    """Distance of tool tips from the exact geometry of the move that their row names.

    Also finds moves that were not travelled from end to end, and rows that moved although no move of the program was in
    force.
    """
    distance = np.full(len(record.t), np.nan)
    unfinished = []
    order = np.argsort(record.move, kind="stable")
    ids, first = np.unique(record.move[order], return_index=True)
    rows_of = dict(zip(ids.tolist(), np.split(order, first[1:])))
    for move in program.moves:
        rows = rows_of.pop(move.id, np.array([], int))
        if len(rows) == 0:
            unfinished.append(move.id)
            continue
        distance[rows], s = move.shape.closest(tips[rows])
        if s.max() - s.min() < move.shape.length_mm - max_reach_mm:
            unfinished.append(move.id)
    moved = np.zeros(len(record.t), bool)
    moved[1:] = np.any(np.diff(record.q, axis=0) != 0, axis=1)
    stray = int((np.isnan(distance) & moved).sum())
    worst = int(np.nanargmax(distance)) if np.isfinite(distance).any() else 0
    return {
        "deviation_um": float(distance[worst] * 1e3),
        "at_move": int(record.move[worst]),
        "at_s_mm": float(record.s[worst]),
        "unfinished_moves": unfinished,
        "stray_rows": stray,
        "distance_um": distance * 1e3,
    }


def check_following(record, positions):
    """Largest difference of setpoint and position, of any joint in any cycle."""
    error = np.abs(record.q - positions[:, : record.joints]) * 1e3
    return {"per_joint_um": error.max(axis=0).tolist(), "largest_um": float(error.max())}


def check_held(record):
    """Where the axes that the mechanism holds stood, and how far they strayed from their mean: their loads."""
    held = record.truth[:, record.joints :]
    return [{"position_mm": float(h.mean()), "strayed_um": float(np.abs(h - h.mean()).max() * 1e3)} for h in held.T]


def check_run(record, program, device, period_s=0.001):
    """Everything about one program's run."""
    tips = setpoint_tips(record, program)
    path = check_path(record, program, tips)
    off_path = {name: check_path(record, program, tips_of(positions[:, : record.joints], program))["deviation_um"]
                for name, positions in (("measured", record.a), ("truth", record.truth))}  # fmt: skip
    pose_gap = np.abs(record.pose[:, : record.joints] - tips[:, : record.joints]).max()
    return {
        "mechanism": program.mechanism,
        "moves": len(program.moves),
        "cycle_time_s": cycle_time_s(record),
        "limits": check_limits(record, device["Joints"], period_s),
        "feed": check_feed(record, program, period_s),
        "path": path,
        "contour_um": off_path["measured"],
        "contour_truth_um": off_path["truth"],
        "following": check_following(record, record.a),
        "following_truth": check_following(record, record.truth),
        "held": check_held(record),
        "pose_disagrees_um": float(pose_gap * 1e3),
    }


def cycle_time_s(record):
    """From the first to the last cycle in which the setpoint moved."""
    moved = np.flatnonzero(np.any(np.diff(record.q, axis=0) != 0, axis=1))
    return float(record.t[moved[-1] + 1] - record.t[moved[0]]) if len(moved) else 0.0

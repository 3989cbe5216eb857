#!/usr/bin/python3
"""Proposes gains for a joint: tune.py RECORD JOINT BEGIN BANDWIDTH MARGIN PICTURE.

RECORD is a flight record of the joint's excitation, which begins after BEGIN (t_s), JOINT its number from 0, BANDWIDTH
in Hz (0: nine tenths of what the delay lets it have), MARGIN in degrees. Draws Bode and step plots of the loop before
and after into PICTURE, and prints what was found as JSON."""

import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import servo_model as model


def feedback_gains(joint):
    """Kp, Ki, Kd of the law that is in force; None where it has none."""
    gains = joint["gains"]
    if len(gains) in (3, 7):
        return tuple(gains[:3])
    if len(gains) == 4:  # fuzzy: what it is at its centre
        error_range, rate_range, effort_range, ki = gains
        return 2 * effort_range / error_range, ki, 2 * effort_range / rate_range
    return None


def describe(plant, gains):
    """Gains, and what the loop is with them."""
    crossover, margin, peak = model.margins(plant, gains)
    return {"gains": list(gains), "bandwidth_hz": crossover, "phase_margin_deg": margin, "sensitivity_peak": peak}


def draw(head, joint, plant, loops, period, path):
    """Open loop and step of each of `loops` (label, gains)."""
    figure, (size, phase, step) = plt.subplots(3, 1, figsize=(9, 11), constrained_layout=True)
    frequency = np.geomspace(1, 0.5 / period, 2000)
    for label, gains in loops:
        magnitude, angle = model.bode(plant, gains, frequency)
        crossover, margin, _ = model.margins(plant, gains)
        size.loglog(frequency, magnitude, label=f"{label}: {crossover:.1f} Hz")
        phase.semilogx(frequency, angle, label=f"{label}: margin {margin:.0f}°")
        time, position = model.step_response(plant, gains, period)
        step.plot(1e3 * time, position, label=label)
    size.axhline(1, color="grey", linewidth=0.8)
    size.set_ylabel("open loop")
    phase.axhline(-180, color="grey", linewidth=0.8)
    phase.set_ylim(-400, 0)
    phase.set_ylabel("phase, degrees")
    phase.set_xlabel("Hz")
    step.axhline(1, color="grey", linewidth=0.8)
    step.set_ylim(0, 2)
    step.set_ylabel("step, without friction and bounds")
    step.set_xlabel("ms")
    for axes in (size, phase, step):
        axes.grid(alpha=0.3, which="both")
        axes.legend(fontsize=8)
    figure.suptitle(f"{head['mechanism']}, joint {joint['name']}: mass {1e3 * plant.mass:.3g}e-3, friction "
                    f"{plant.friction:.3g} + {plant.viscous:.3g} v, load {plant.load:.3g}, delay "
                    f"{1e3 * plant.delay_s:.2f} ms", fontsize=9)
    figure.savefig(path, dpi=120)


def main():
    """Exit code 1 with one line that says why, when the record or the wish does not do."""
    if len(sys.argv) != 7:
        print("usage: tune.py RECORD JOINT BEGIN BANDWIDTH MARGIN PICTURE", file=sys.stderr)
        return 2
    number, begin, bandwidth, margin = int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4]), float(sys.argv[5])
    head, columns = model.read_record(sys.argv[1], begin)
    joint = head["joints"][number]
    column = number + 1
    try:
        plant = model.identify(columns["t_s"], columns[f"a{column}"], columns[f"effort{column}"])
        if bandwidth == 0:
            bandwidth = 0.9 * model.largest_bandwidth_hz(plant, margin)
        gains = model.gains_for(plant, bandwidth, margin)
    except (model.Unidentifiable, ValueError) as problem:
        print(problem, file=sys.stderr)
        return 1
    before = feedback_gains(joint)
    loops = ([("before", before)] if before else []) + [("proposed", gains)]
    draw(head, joint, plant, loops, float(np.median(np.diff(columns["t_s"]))), sys.argv[6])
    forward = [*gains, plant.viscous, plant.mass, plant.friction, plant.load]
    print(json.dumps({
        "joint": joint["name"], "unit": joint["unit"], "law": joint["law"], "plant": model.as_json(plant),
        "before": describe(plant, before) if before else None, "proposed": describe(plant, gains),
        "pid_gains": list(gains), "feedforward_feedback_gains": forward, "lead_s": plant.delay_s,
        "apply": {3: list(gains), 7: forward}.get(len(joint["gains"]))}))
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Draws the circle test of ISO 230-4: measure_following.py RECORD MOVE BEGIN RADIUS PICTURE.

RECORD is a flight record in which the first two joints go round a circle, MOVE the number of the full turn, which begins
after BEGIN (t_s), RADIUS in mm. Prints the circular deviations and the reversal spikes as JSON."""

import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import servo_model as model

# After a joint turns round, friction shows within this angle; before it the radius is what it would be without.
WINDOW = np.radians(8)
TILE = 0.35  # of the picture's radius: how large the largest deviation is drawn


class NoCircle(Exception):
    """The record does not hold the turn."""


def error_of(head, columns, joint):
    """How far the joint (from 1) was in each row's cycle from where it was wanted in it: the drive tells that so many cycles later."""
    name = f"error{joint}"
    if name not in columns or "answer_delay" not in head["joints"][joint - 1]:
        raise NoCircle("the record tells no following errors, as those of an older appliance; update that, too")
    error, delay = columns[name], head["joints"][joint - 1]["answer_delay"]
    return np.concatenate([error[delay:], np.repeat(error[-1:], delay)])


def turn_of(head, columns, move):
    """Wanted and measured points of the turn, mm, as rows of x and y about the circle's centre."""
    rows = np.flatnonzero(columns["move_id"] == move)
    if len(rows) < 100:
        raise NoCircle("the record does not hold the turn; let flight_recorder in rmacd.json go back further")
    wanted = np.column_stack([columns["x"], columns["y"]])[rows]
    joints = np.column_stack([columns["q1"], columns["q2"]])[rows]
    if np.ptp(wanted - joints, axis=0).max() > 1e-6 or [joint["unit"] for joint in head["joints"][:2]] != ["mm", "mm"]:
        raise NoCircle("the first two joints are not X and Y: only such machines are measured so far")
    measured = wanted - np.column_stack([error_of(head, columns, joint)[rows] for joint in (1, 2)])
    angle = np.unwrap(np.arctan2(*(wanted - wanted.mean(axis=0)).T[::-1]))
    if abs(angle[-1] - angle[0]) < 2 * np.pi * 0.98:
        raise NoCircle("the record begins within the turn; let flight_recorder in rmacd.json go back further, or take a "
                       "smaller radius or a higher feed")
    centre = (wanted.max(axis=0) + wanted.min(axis=0)) / 2
    return wanted - centre, measured - centre


def reversal_spikes(angle, deviation):
    """Largest departure, after an axis turns round, from the mean before; of each quadrant that the record holds both of."""
    spikes = []
    for quadrant in range(4):
        after = np.remainder(angle - quadrant * np.pi / 2 + np.pi, 2 * np.pi) - np.pi
        before = deviation[(after < 0) & (after > -WINDOW)]
        behind = deviation[(after >= 0) & (after < WINDOW)]
        if len(before) and len(behind):
            departure = behind - before.mean()
            spikes.append(float(departure[np.argmax(np.abs(departure))]))
    return spikes


def deviations(wanted, measured, radius):
    """Angles, radial deviations, and what ISO 230-4 makes of them; mm."""
    angle = np.arctan2(wanted[:, 1], wanted[:, 0])
    deviation = np.hypot(*measured.T) - radius
    # Circular deviation: about the centre that fits best (least squares), as a ballbar's software removes its own.
    design = np.column_stack([np.cos(angle), np.sin(angle), np.ones_like(angle)])
    fit, *_ = np.linalg.lstsq(design, deviation, rcond=None)
    about_best = deviation - design[:, :2] @ fit[:2]
    return angle, deviation, {
        "circular_deviation_um": float(1e3 * np.ptp(about_best)),
        "radial_deviation_um": [float(1e3 * deviation.min()), float(1e3 * deviation.max())],
        "reversal_spikes_um": [1e3 * spike for spike in reversal_spikes(angle, deviation)],
        "following_error_um": float(1e3 * np.max(np.hypot(*(wanted - measured).T)))}


def draw(head, angle, deviation, result, radius, feed, path):
    """The ballbar picture: deviations from the circle, magnified."""
    largest = max(np.abs(deviation).max(), 1e-6)
    unit = 10 ** np.floor(np.log10(1e3 * largest)) * 1e-3
    scale = TILE * radius / largest
    figure, axes = plt.subplots(figsize=(8, 8.6), constrained_layout=True)
    round_angle = np.linspace(0, 2 * np.pi, 720)
    for level in range(-2, 3):
        ring = radius + level * unit * scale
        axes.plot(ring * np.cos(round_angle), ring * np.sin(round_angle), color="grey",
                  linewidth=1.0 if level == 0 else 0.4)
    axes.plot((radius + deviation * scale) * np.cos(angle), (radius + deviation * scale) * np.sin(angle),
              color="crimson", linewidth=0.9)
    for quadrant, spike in enumerate(result["reversal_spikes_um"]):
        at = quadrant * np.pi / 2
        axes.annotate(f"{spike:+.1f} µm", (0.75 * radius * np.cos(at), 0.75 * radius * np.sin(at)), ha="center",
                      fontsize=8)
    axes.set_aspect("equal")
    axes.axis("off")
    low, high = result["radial_deviation_um"]
    axes.set_title(f"{head['mechanism']}, {head['utc']}: radius {radius:g} mm, {feed:.0f} mm/min, a ring is "
                   f"{1e3 * unit:g} µm\ncircular deviation {result['circular_deviation_um']:.1f} µm, radial "
                   f"{low:+.1f} to {high:+.1f} µm, following error {result['following_error_um']:.1f} µm", fontsize=9)
    figure.savefig(path, dpi=120)


def main():
    """Exit code 1 with one line that says why, when the record does not do."""
    if len(sys.argv) != 6:
        print("usage: measure_following.py RECORD MOVE BEGIN RADIUS PICTURE", file=sys.stderr)
        return 2
    move, begin, radius = int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    head, columns = model.read_record(sys.argv[1], begin)
    try:
        wanted, measured = turn_of(head, columns, move)
    except NoCircle as problem:
        print(problem, file=sys.stderr)
        return 1
    angle, deviation, result = deviations(wanted, measured, radius)
    feed = 60 * float(np.median(columns["feed_mm_s"][columns["move_id"] == move]))
    draw(head, angle, deviation, result, radius, feed, sys.argv[5])
    print(json.dumps({"radius_mm": radius, "feed_mm_min": feed, **result}))
    return 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/python3
"""Draws a flight record: plot_flight_record.py RECORD PICTURE.

The record is a line of JSON, then CSV with one row a servo cycle (docs/flight-recorder.md). The picture's format
follows from its name: .png, .svg, .pdf."""

import csv
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read(path):
    """The head, and the columns by name: numbers as arrays, words as lists."""
    with open(path, encoding="utf-8", newline="") as file:
        head = json.loads(file.readline())
        rows = csv.reader(file)
        names = next(rows)
        table = list(zip(*rows, strict=True))
    words = ("state", "servo_state", "fault", "horizon_limit")
    columns = {name: list(cells) if name in words else np.array(cells, dtype=float)
               for name, cells in zip(names, table, strict=True)}
    return head, columns


def spans(time, values):
    """Stretches of equal values: (begin, end, value)."""
    begin = 0
    for row in range(1, len(values) + 1):
        if row == len(values) or values[row] != values[begin]:
            yield time[begin], time[min(row, len(values) - 1)], values[begin]
            begin = row


def draw_states(axes, time, columns):
    """A band each for the cycle's state, the servo loop's, the fault, and why motion was planned no further ahead."""
    palette = plt.get_cmap("tab20")
    known = {}
    bands = [("horizon_limit", "horizon"), ("fault", "fault"), ("servo_state", "servo loop"), ("state", "cycle")]
    bands = [(name, title) for name, title in bands if name in columns]  # records had no horizon once
    for height, (name, _) in enumerate(bands):
        for begin, end, value in spans(time, columns[name]):
            colour = known.setdefault(value, palette(len(known) % palette.N))
            axes.broken_barh([(begin, max(end - begin, 1e-9))], (height + 0.1, 0.8), facecolors=colour)
    axes.set_yticks([height + 0.5 for height in range(len(bands))], [title for _, title in bands])
    handles = [plt.Rectangle((0, 0), 1, 1, color=colour) for colour in known.values()]
    axes.set_ylim(0, len(bands) + 0.6)  # the legend has its place above the bands
    axes.legend(handles, known, loc="upper left", fontsize=7, ncols=max(len(known), 1))


def draw(head, columns, path):
    """One panel a quantity, all over the seconds before the record's cycle."""
    time = columns["t_s"] - head["t_s"]
    joints = head["joints"]
    panels = [
        ("position", lambda j: columns[f"a{j}"]),
        # Records that know nothing of drives that answer late tell none.
        ("following error", lambda j: columns.get(f"error{j}", columns[f"q{j}"] - columns[f"a{j}"])),
        ("velocity", lambda j: columns[f"ad{j}"]),
        ("effort", lambda j: columns[f"effort{j}"]),
    ]
    figure, axes = plt.subplots(len(panels) + 1, 1, figsize=(11, 12), sharex=True, constrained_layout=True)
    for panel, (title, of_joint) in zip(axes, panels, strict=False):
        for number, joint in enumerate(joints, start=1):
            panel.plot(time, of_joint(number), linewidth=0.8, label=f"{joint['name']} ({joint['unit']})")
        panel.set_ylabel(title)
        panel.grid(alpha=0.3)
        panel.axvline(0, color="crimson", linewidth=0.8)
    axes[0].legend(loc="upper left", fontsize=7, ncols=max(len(joints), 1))
    draw_states(axes[-1], time, columns)
    axes[-1].axvline(0, color="crimson", linewidth=0.8)
    axes[-1].set_xlabel(f"s from cycle {head['cycle']}")
    what = f"{head['mechanism']}, {head['utc']}, cycle {head['cycle']}"
    figure.suptitle(f"{what}\n{head['message']}", fontsize=9, wrap=True)
    figure.savefig(path, dpi=120)


def main():
    """Exit code 2 when called with anything but two names."""
    if len(sys.argv) != 3:
        print("usage: plot_flight_record.py RECORD PICTURE", file=sys.stderr)
        return 2
    draw(*read(sys.argv[1]), sys.argv[2])
    return 0


if __name__ == "__main__":
    sys.exit(main())

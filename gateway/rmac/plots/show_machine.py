#!/usr/bin/python3
"""Draws what a machine reaches, how fast it is and what it is made of: show_machine.py DEVICE_TREE NAME PICTURE.

The values are those of the machine's device.json in the device tree. The picture's format follows from its name."""

import json
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import MaxNLocator

from machine_bodies import draw_bodies

SLIDE, TURN = "#2a6f97", "#c06030"
LIMITS = (("MaxSpeed", ""), ("MaxAcceleration", "²"), ("MaxJerk", "³"))


def find(tree, name):
    """The machine's device.json, and its folder: drivers/<type>/<configuration>/<Mechanism>."""
    for file in sorted(pathlib.Path(tree).glob("*/*/*/device.json")):
        device = json.loads(file.read_text())
        if device["MechanismName"] == name:
            return device, file.parent
    raise ValueError(f"{tree} holds no machine that is called {name}")


def slides(device):
    return [joint for joint in device["Joints"] if joint["Type"] == "Linear"]


def draw_reach(axes, device):
    """The box of the slides' travel, and in it the working volume, about its middle."""
    ends = [(joint["Min"], joint["Max"]) for joint in slides(device)[:3]]
    ends += [(0.0, 0.0)] * (3 - len(ends))
    volume = [device["WorkingVolume"][key] for key in ("Length", "Width", "Depth")]
    middle = [(low + high) / 2 for low, high in ends]
    inner = [(m - v / 2, m + v / 2) for m, v in zip(middle, volume)]
    for box, colour, width in ((ends, SLIDE, 1.6), (inner, "#888888", 0.8)):
        for axis in range(3):
            others = [k for k in range(3) if k != axis]
            for a in (0, 1):
                for b in (0, 1):
                    line = [None] * 3
                    line[axis] = box[axis]
                    line[others[0]] = (box[others[0]][a],) * 2
                    line[others[1]] = (box[others[1]][b],) * 2
                    axes.plot(*line, color=colour, linewidth=width, linestyle="-" if box is ends else "--")
    names = [joint["Name"] for joint in slides(device)] + ["", "", ""]
    axes.set(xlabel=f"{names[0]}, mm", ylabel=f"{names[1]}, mm", zlabel=f"{names[2]}, mm" if names[2] else "")
    axes.xaxis.labelpad = axes.yaxis.labelpad = 4
    axes.tick_params(labelsize=8, pad=-1)
    for axis in (axes.xaxis, axes.yaxis, axes.zaxis):
        axis.set_major_locator(MaxNLocator(4, steps=[1, 2, 2.5, 5, 10]))
    if not names[2]:
        axes.set_zticks([])
    spans = np.array([max(high - low, high_in - low_in, 1) for (low, high), (low_in, high_in) in zip(ends, inner)])
    axes.set_box_aspect(spans / spans.max(), zoom=0.85)
    axes.set_title("Travel of the slides\n(dashed: working volume)", fontsize=9)


def draw_turns(axes, turns):
    """An arc a rotary joint, from its least to its largest angle; a whole ring turns without end."""
    for ring, joint in zip(np.arange(1, 10, 1.4), turns):
        endless = joint["LimitType"] != "Limited"
        low, high = (-180, 180) if endless else (joint["Min"], joint["Max"])
        turns_over = max(int(np.ceil((high - low) / 360)), 1)
        angle = np.radians(np.linspace(low, high, 361 * turns_over))
        radius = ring + np.linspace(0, 0.25 * (turns_over - 1), len(angle))
        axes.plot(angle, radius, color=TURN, linewidth=5, solid_capstyle="butt", alpha=0.8)
        told = "without end" if endless else f"{low:g} to {high:g}°"
        axes.annotate(f"{joint['Name']}: {told}", (np.pi / 2, radius.max() + 0.22), ha="center", fontsize=8)
    axes.set(ylim=(0, 1.4 * len(turns) + 0.4), yticks=[])
    axes.set_theta_zero_location("E")
    axes.set_title("Travel of the turns", fontsize=9, pad=2)


def draw_limits(figure, grid, joints):
    """Speed, acceleration and jerk of each joint, on one scale a quantity and kind."""
    panels = grid.subgridspec(len(LIMITS), 1)
    names = [joint["Name"] for joint in joints]
    for row, (key, power) in enumerate(LIMITS):
        axes = figure.add_subplot(panels[row])
        values = [joint[key] for joint in joints]
        colours = [SLIDE if joint["Type"] == "Linear" else TURN for joint in joints]
        bars = axes.barh(range(len(joints)), values, color=colours, height=0.6)
        units = ["mm" if joint["Type"] == "Linear" else "°" for joint in joints]
        axes.bar_label(bars, [f"{v:g} {u}/s{power}" for v, u in zip(values, units)], padding=3, fontsize=7)
        axes.set_yticks(range(len(joints)), names, fontsize=8)
        axes.invert_yaxis()
        axes.set_xlim(0, 1.6 * max(values))
        axes.set_xticks([])
        axes.spines[["top", "right", "bottom"]].set_visible(False)
        axes.set_title({"MaxSpeed": "Speed", "MaxAcceleration": "Acceleration", "MaxJerk": "Jerk"}[key], fontsize=9,
                       loc="left")


def draw(device, folder, path):
    turns = [joint for joint in device["Joints"] if joint["Type"] != "Linear"]
    bodies = bool(device.get("Geometry"))
    columns = (3 if turns else 2) + bodies
    figure = plt.figure(figsize=(3.6 * columns, 4.0), layout="constrained")
    grid = figure.add_gridspec(1, columns, width_ratios=[1.15] + [1] * (columns - 1 - bodies) + [1.3] * bodies)
    draw_reach(figure.add_subplot(grid[0], projection="3d"), device)
    if turns:
        draw_turns(figure.add_subplot(grid[1], projection="polar"), turns)
    draw_limits(figure, grid[columns - 1 - bodies], device["Joints"])
    if bodies:
        draw_bodies(figure.add_subplot(grid[columns - 1], projection="3d"), device, folder)
    figure.suptitle(f"{device['MechanismName']}: {device['Description']}\n", fontsize=10)
    figure.savefig(path, dpi=90, bbox_inches="tight")


def main(words):
    if len(words) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        draw(*find(words[0], words[1]), words[2])
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""The picture of `./demo.sh measure`: the groove before and after, in the part as it is clamped."""

import matplotlib

matplotlib.use("Agg")
import groove  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True})
plt.rcParams.update({"grid.alpha": 0.25, "grid.linewidth": 0.6, "figure.constrained_layout.use": True})
TIMES = 5  # so much larger deviations are drawn than they are
WRONG, RIGHT, ROUGH = "#c03028", "#2a6f97", "#9a9a9a"
WALLS = [name for name in groove.PASSES if name != "rough"]


def exaggerated(points, offset):
    """Points moved off their loop by `TIMES` their distance from it, along its normal."""
    step = 1e-4
    here = groove.off_loop(points, offset)
    slope = [(groove.off_loop(points + np.eye(3)[i] * step, offset) - here) / step for i in (0, 1)]
    return points[:, :2] + (TIMES - 1) * here[:, None] * np.column_stack(slope)


def nominal(offset, turns=720):
    angle = np.linspace(0, 2 * np.pi, turns)
    directions = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    low, high = np.zeros(turns), np.full(turns, 40.0)
    for _ in range(60):
        middle = (low + high) / 2
        outside = groove.off_loop(directions * middle[:, None], offset) > 0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    return (directions * low[:, None])[:, :2]


def draw_plan(axis, first, before, after):
    axis.add_patch(plt.Rectangle((-20, -15), 40, 30, facecolor="#eeeeea", edgecolor="#666666"))
    axis.add_patch(plt.Circle((0, 0), 8, facecolor="white", edgecolor="#666666"))
    rows = before.move >= groove.PASSES["rough"][0]
    rough = groove.in_part(before.truth[rows])
    axis.plot(rough[:, 0], rough[:, 1], color=ROUGH, linewidth=1, label="roughed before the pause")
    axis.plot(*rough[-1, :2], "o", color="black", markersize=4, label="paused here")
    for name in WALLS:
        offset = groove.PASSES[name][2]
        edge = groove.CUTTER_RADIUS * np.sign(offset)
        label = name == WALLS[0]
        axis.plot(*nominal(offset + edge).T, "--", color="black", linewidth=0.7, zorder=3,
                  label="walls as designed" if label else None)
        for record, colour, text in ((first, WRONG, "not corrected"), (after, RIGHT, "corrected")):
            *_, points = groove.off_pass(record, name, record.truth)
            wall = exaggerated(points, offset)
            normal = wall - points[:, :2]
            away = np.where(np.abs(groove.off_loop(points, offset))[:, None] > 1e-9, normal, 0)
            shifted = shifted_out(points, offset, edge) + away
            axis.plot(shifted[:, 0], shifted[:, 1], color=colour, linewidth=1.2, label=text if label else None)
    axis.set(aspect="equal", xlabel="x in the part, mm", ylabel="y in the part, mm",
             title=f"The groove's walls; deviations drawn {TIMES} times as large")
    axis.grid(False)
    axis.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=5, fontsize=8, columnspacing=1, handlelength=1.5, frameon=False)


def shifted_out(points, offset, by):
    """Points of a loop moved outwards: the wall that a cutter of that radius leaves."""
    step = 1e-4
    here = groove.off_loop(points, offset)
    slope = np.column_stack([(groove.off_loop(points + np.eye(3)[i] * step, offset) - here) / step for i in (0, 1)])
    return points[:, :2] + by * slope


def draw_deviation(axis, record, colour, title):
    for name, style in zip(WALLS, ("-", ":")):
        turn, wall, floor, _ = groove.off_pass(record, name, record.truth)
        order = np.argsort(turn)
        axis.plot(turn[order], 1000 * wall[order], style, color=colour, linewidth=1, label=name)
        if name == WALLS[0]:
            axis.plot(turn[order], 1000 * floor[order], color="#e0a030", linewidth=1, label="floor")
    axis.set(title=title, ylabel="off, µm", xlim=(-180, 180), xticks=range(-180, 181, 90))
    axis.margins(y=0.2)
    axis.legend(loc="upper right", ncols=3, frameon=False)


def draw(first, before, after, file):
    figure = plt.figure(figsize=(12, 5.6))
    grid = figure.add_gridspec(2, 2, width_ratios=[1.25, 1])
    draw_plan(figure.add_subplot(grid[:, 0]), first, before, after)
    draw_deviation(figure.add_subplot(grid[0, 1]), first, WRONG, "Not corrected: the tool off in the part")
    last = figure.add_subplot(grid[1, 1])
    draw_deviation(last, after, RIGHT, "Measured and corrected (another scale)")
    last.set_xlabel("place on the groove, degrees about its middle")
    figure.savefig(file, dpi=130)
    plt.close(figure)

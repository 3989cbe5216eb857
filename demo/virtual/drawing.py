"""The picture of `./demo.sh virtual`."""

import matplotlib

matplotlib.use("Agg")
import clamping  # noqa: E402
import clash  # noqa: E402
import dome  # noqa: E402
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
import swept  # noqa: E402

plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "figure.constrained_layout.use": True})
STEEL, DARK, BRASS, PART, STOCK, HIT, STRUCK = "#b8bec6", "#5a6672", "#e7c86e", "#8fb3c9", "#dde6ec", "#c03028", "#e58f7b"


def outline(plot, colour, middle, u, points):
    """Of (radius, height above the tip) about the tool's axis, as one sees it along x."""
    side = np.array([u[2], -u[1]]) / np.hypot(u[1], u[2])
    tip = middle[1:] - clamping.BALL_RADIUS * u[1:]
    corners = [tip + height * u[1:] + sign * radius * side for sign, some in ((1, points), (-1, points[::-1])) for radius, height in some]
    plot.add_patch(plt.Polygon(corners, facecolor=colour, edgecolor=DARK, linewidth=0.8, zorder=3))


def tool(plot, motion, holder_colour):
    middle, u = motion.middle[0], motion.axis[0]
    r = clamping.BALL_RADIUS
    turn = np.linspace(0, np.pi / 2, 20)
    ball = [(r * np.sin(t), r - r * np.cos(t)) for t in turn]
    outline(plot, BRASS, middle, u, [*ball, (r, clamping.CUTS_UP_TO)])
    outline(plot, STEEL, middle, u, [(r, clamping.CUTS_UP_TO), (r, clamping.HOLDER_FROM)])
    height = clamping.HOLDER_FROM
    for low, high, tall in clamping.HOLDER:
        outline(plot, holder_colour, middle, u, [(low, height), (high, height + tall)])
        height += tall


def bodies(plot, x, stud_colour):
    half, (_, y) = dome.WIDTH / 2, clamping.STUD_PLACE
    for left, low, wide, tall, colour in ((-55, -clamping.PLATE, 120, clamping.PLATE, STEEL), (-half - 15, 0, 15, 8, DARK), (half, 0, 40, 8, DARK),
                                          (-half, 0, 2 * half, dome.STOCK_HEIGHT, STOCK),
                                          (y - clamping.STUD_RADIUS, 0, 2 * clamping.STUD_RADIUS, clamping.STUD_TOP, stud_colour)):  # fmt: skip
        plot.add_patch(plt.Rectangle((left, low), wide, tall, facecolor=colour, edgecolor=DARK, linewidth=0.8, zorder=1))
    across_y = np.linspace(-half, half, 81)
    plot.fill_between(across_y, 0, dome.height(x, across_y), color=PART, zorder=2, linewidth=0)


def scene(plot, joints, title, hit):
    motion = swept.motion(joints[None])
    bodies(plot, motion.middle[0, 0], HIT if hit else DARK)
    tool(plot, motion, STRUCK if hit else STEEL)
    plot.set(aspect="equal", xlim=(-58, 86), ylim=(-16, 122), xlabel="y of the part, mm", ylabel="z, mm", title=title)


def draw(first, second, cut, off_um, file):
    """The deepest moment of the first program, the second where its ball is at the same place, and how far the machined part is off the predicted one."""
    found = first.finding()
    meeting = first.joints[(first.times >= found["t_s"]) & (first.times <= found["until_s"])][::5]
    deepest = meeting[np.argmin(clash.gaps(meeting))]
    same = second.joints[np.argmin(np.linalg.norm(swept.motion(second.joints).middle - swept.motion(deepest[None]).middle, axis=1))]
    figure, (left, right, chart) = plt.subplots(1, 3, figsize=(14, 5), width_ratios=[1, 1, 1.35])
    scene(left, deepest, f"First program: holder {found['depth_mm']:.1f} mm deep in the stud", True)
    scene(right, same, "Second: it leans the other way", False)
    reach = max(float(np.percentile(np.abs(off_um), 99.5)), 0.5)
    dots = chart.scatter(cut[:, 0], cut[:, 1], c=off_um, s=6, cmap="RdBu_r", vmin=-reach, vmax=reach, linewidths=0)
    figure.colorbar(dots, ax=chart, label="left (red) or cut deeper (blue), µm", shrink=0.8)
    chart.set(aspect="equal", xlabel="x, mm", ylabel="y, mm", title=f"Machined part off the predicted one: {np.sqrt((off_um**2).mean()):.2f} µm rms")
    figure.savefig(file, dpi=110)
    plt.close(figure)

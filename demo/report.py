"""Pictures of a run and report.html that holds them and the table of figures."""

import base64
import html
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import part as parts  # noqa: E402
import render  # noqa: E402

CONVENTIONAL_MIN = 17  # Table 6-1: planning hand-over, post-processing and file handling that this way does not have
plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True})
plt.rcParams.update({"grid.alpha": 0.25, "grid.linewidth": 0.6, "figure.constrained_layout.use": True})


def envelope(t, values, bins=1200):
    """Lowest and highest value in each of many equal pieces of time: a curve of a million rows, nothing hidden."""
    bins = max(min(bins, len(t)), 1)
    edges = np.linspace(0, len(t), bins + 1).astype(int)[:-1]
    return t[edges], np.minimum.reduceat(values, edges), np.maximum.reduceat(values, edges)


def fill(axis, t, values, colour, label=None):
    at, low, high = envelope(t, values)
    axis.fill_between(at, low, high, color=colour, linewidth=0.7, label=label)


def picture_of_part(height_map):
    return render.view(height_map.x, height_map.y, height_map.z, height_map.inside)


def deviation_figure(height_map, bound_um):
    deviation = parts.deviation_um(height_map)
    figure, (map_axis, axis) = plt.subplots(1, 2, figsize=(12, 4.4), width_ratios=[1.9, 1])
    figure.set_layout_engine("compressed")  # closes the gap that the map's fixed aspect leaves
    extent = (height_map.x[0], height_map.x[-1], height_map.y[0], height_map.y[-1])
    scale = max(10.0, np.ceil(np.nanmax(np.abs(deviation)) / 10) * 10)
    image = map_axis.imshow(
        deviation, extent=extent, origin="lower", cmap="RdBu_r", vmin=-scale, vmax=scale, interpolation="antialiased"
    )
    map_axis.set(xlabel="x, mm", ylabel="y, mm", title="Machined part minus ideal part, along its normal")
    map_axis.grid(False)
    figure.colorbar(image, ax=map_axis, label="µm (red: material left)", shrink=0.85)
    axis.hist(deviation[height_map.inside], bins=160, color="#4878a8", log=True)
    for bound in (-bound_um, bound_um):
        axis.axvline(bound, color="#c03028", linewidth=1)
    axis.set(xlabel="deviation, µm", ylabel="cells of 0.1 mm", title="All cells; red lines: the bound")
    return figure


def time_figure(runs):
    figure, axes = plt.subplots(2, len(runs), figsize=(12, 4.8), squeeze=False, sharex="col")
    for column, (record, check) in enumerate(runs):
        t = record.t - record.t[0]
        fill(axes[0, column], t, record.feed * 60, "#2a6f97")
        axes[0, column].set(title=check["mechanism"], ylabel="feed of the setpoint, mm/min")
        following = np.abs(record.q - record.truth[:, : record.joints]).max(axis=1) * 1e3
        fill(axes[1, column], t, following, "#b5542d")
        axes[1, column].set(xlabel="machine time, s", ylabel="loads off their setpoints, µm")
    return figure


def detail_figure(record, seconds=4.5):
    """One reversal in detail: the end of a sweep, the loop and the start of the next."""
    ids, counts = np.unique(record.move, return_counts=True)
    short = ids[(counts > 100) & (counts < np.median(counts))]
    start = record.t[np.searchsorted(record.move, short[len(short) // 2])] if len(short) else record.t[len(record.t) // 2]
    rows = (record.t > start - seconds / 2) & (record.t < start + seconds / 2)
    t, q = record.t[rows] - start, record.q[rows]
    figure, axes = plt.subplots(1, 3, figsize=(12, 3))
    axes[0].plot(t, record.feed[rows] * 60, color="#2a6f97", linewidth=1)
    axes[0].set(xlabel="s", title="feed of the setpoint, mm/min")
    for joint in range(record.joints):
        axes[1].plot(t[1:-2], np.diff(q[:, joint], 3) / 1e-9, linewidth=0.8, label=f"q{joint + 1}")
        axes[2].plot(t, (q - record.truth[rows][:, : record.joints])[:, joint] * 1e3, linewidth=0.8, label=f"q{joint + 1}")
    axes[1].set(xlabel="s", title="jerk (third difference), mm/s³")
    axes[2].set(xlabel="s", title="loads off their setpoints, µm")
    axes[2].legend(frameon=False, loc="upper left")
    return figure


def limits_figure(record, check, period_s=0.001):
    joints = check["limits"]["joints"]
    figure, axes = plt.subplots(len(joints), 3, figsize=(12, 1.75 * len(joints) + 0.4), squeeze=False, sharex=True)
    units = ("mm/s", "mm/s²", "mm/s³")
    t = record.t - record.t[0]
    for row, joint in enumerate(joints):
        for order, name in enumerate(("velocity", "acceleration", "jerk"), 1):
            axis, limit = axes[row, order - 1], joint[f"limit_{name}"]
            values = np.diff(record.q[:, row], order) / period_s**order
            whole = np.abs(t[order:] - t[:-order] - order * period_s) < 0.01 * period_s
            fill(axis, t[order:], np.where(whole, values, 0), "#5a8f5a")
            for bound in (-limit, limit):
                axis.axhline(bound, color="#c03028", linewidth=0.9)
            axis.set_ylim(-1.15 * limit, 1.15 * limit)
            share = 100 * joint[f"peak_{name}"] / limit
            axis.set_title(f"{joint['name']} {name}, {units[order - 1]}: peak {share:.2f} % of the limit", fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("machine time, s")
    return figure


def embedded(figure_or_picture, alternative, out, name):
    data = io.BytesIO()
    if isinstance(figure_or_picture, np.ndarray):
        plt.imsave(data, np.clip(figure_or_picture, 0, 1))
    else:
        figure_or_picture.savefig(data, dpi=110, bbox_inches="tight")
        plt.close(figure_or_picture)
    (out / name).write_bytes(data.getvalue())
    code = base64.b64encode(data.getvalue()).decode()
    return f'<img alt="{html.escape(alternative)}" src="data:image/png;base64,{code}">'


STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:75rem;margin:2rem auto;padding:0 1rem;color:#222}
img{max-width:100%;height:auto} table{border-collapse:collapse} td,th{padding:.25rem .9rem .25rem 0;text-align:left;
border-bottom:1px solid #ddd} td:nth-child(n+2){font-variant-numeric:tabular-nums} .bad{color:#b00020;font-weight:600}"""


def write(out, rows, height_map, runs, bounds, plan, ok):
    """Writes report.html and its pictures. `rows`: (what, value, bound or "", fine) as printed."""
    cells = "".join(
        f'<tr><td>{html.escape(what)}</td><td class="{"" if fine else "bad"}">{html.escape(value)}</td>'
        f"<td>{html.escape(bound)}</td></tr>"
        for what, value, bound, fine in rows
    )
    show = lambda thing, text, name: embedded(thing, text, out, name)
    sections = [
        show(picture_of_part(height_map), "The machined part", "part.png"),
        f"<table><tr><th>figure</th><th>value</th><th>bound</th></tr>{cells}</table>",
        "<h2>The part against the surface</h2><p>A ball end of radius "
        f"{plan['ball_radius_mm']:g} mm, then a flat end of radius {plan['flat_radius_mm']:g} mm, swept where its loads "
        f"truly were. The ridges between sweeps were planned {plan['scallop_planned_um']:.1f} µm high.</p>",
        show(deviation_figure(height_map, bounds["part_deviation_um"]), "Deviation map", "deviation.png"),
        "<h2>Feed and following error</h2>",
        show(time_figure(runs), "Feed and following error over time", "time.png"),
        show(detail_figure(runs[0][0]), "One reversal in detail", "detail.png"),
        "<h2>Joints against their limits</h2><p>Differences of the recorded setpoints from cycle to cycle.</p>",
        *(
            show(limits_figure(record, check), f"Limits of {check['mechanism']}", f"limits-{check['mechanism']}.png")
            for record, check in runs
        ),
    ]
    verdict = "every figure within its bound" if ok else "NOT within its bounds"
    document = (
        '<!doctype html><html lang="en"><meta charset="utf-8"><title>A headlight, machined</title>'
        f"<style>{STYLE}</style><h1>A headlight, machined through a socket: {verdict}</h1>" + "\n".join(sections)
    )
    (out / "report.html").write_text(document + "</html>\n", encoding="utf-8")

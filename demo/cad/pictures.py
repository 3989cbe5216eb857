"""Pictures of the measured part, and the report that holds them, the figures and the steps."""

import html

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.colors import TwoSlopeNorm  # noqa: E402

import report  # noqa: E402
import verdict  # noqa: E402

FACETS_MM = 0.01  # how far a triangle may be off the part
CELL_MM = 0.1
ROOM_MM = 1.5  # around the part
LIGHT = np.array([-0.55, -0.35, 0.76])
BLUE_RED = "RdBu_r"
COLOURS = "#2a6f97", "#c07020", "#777777", "#3a9050"  # of programs


def draw(user, inspected, out):
    """deviations.png and paths.png."""
    embed = []
    for figure, text, name in ((measured_figure(inspected), "Deviations where the part was measured, in colours on the part", "deviations.png"),
                               (paths_figure(user), "Tool paths, as they were machined", "paths.png")):  # fmt: skip
        embed.append(report.embedded(figure, text, out, name))
    return embed


def measured_figure(inspected):
    figure = plt.figure(figsize=(12.5, 8))
    grid = figure.add_gridspec(2, 2, height_ratios=[1.5, 1])
    seen = shaded(inspected.nominal)
    for column, (found, title) in enumerate(((inspected.before, "As the part was taken to lie"), (inspected.after, "Where it was found to lie"))):
        axis = figure.add_subplot(grid[0, column])
        axis.imshow(seen[0], extent=seen[1], origin="lower", cmap="gray", vmin=0, vmax=1.1)
        full = max(1000 * abs(found.worst), 1)
        points = np.array([one.place.point for one in found.touched])
        shown = axis.scatter(*points[:, :2].T, c=1000 * found.off, cmap=BLUE_RED, norm=TwoSlopeNorm(0, -full, full), s=42, edgecolors="#222222", linewidths=0.6, zorder=3)
        low_x, high_x, low_y, high_y = seen[1]
        axis.set(xlabel="x, mm", ylabel="y, mm", xlim=(low_x - ROOM_MM, high_x + ROOM_MM), ylim=(low_y - ROOM_MM, high_y + ROOM_MM))
        axis.grid(False)
        axis.set_title(f"{title}: rms {1000 * found.rms:.1f} µm, worst {1000 * found.worst:+.1f} µm", fontsize=10)
        figure.colorbar(shown, ax=axis, shrink=0.75, label="off the model, µm (red: material left)")
    axis = figure.add_subplot(grid[1, :])
    names = list(dict.fromkeys(one.place.face for one in inspected.touched))
    for found, colour, label, shift in ((inspected.before, "#c03028", "as taken to lie", -0.24), (inspected.after, "#2a6f97", "where it lies", 0.0), (inspected.corrected, "#3a9050", "and the model corrected", 0.24)):
        places = [names.index(one.place.face) + shift for one in found.touched]
        axis.plot(places, 1000 * found.off, "o", color=colour, markersize=4, label=label)
    axis.set_xticks(range(len(names)), [_told(inspected.found, name) for name in names], rotation=40, ha="right", fontsize=8)
    axis.set(ylabel="off the model, µm")
    axis.axhline(0, color="#666666", linewidth=0.8)
    axis.legend(frameon=False, ncols=3)
    return figure


def paths_figure(user):
    figure = plt.figure(figsize=(12.5, 4.8))
    grid = figure.add_gridspec(len(user.records), 2, width_ratios=[1.2, 1])
    plan = figure.add_subplot(grid[:, 0])
    for number, ((name, record), colour) in enumerate(zip(user.records.items(), COLOURS)):
        tips = record.truth[:, :3] - verdict.frame_and_length()
        plan.plot(*np.where((tips[:, 2] < 0.5)[:, None], tips, np.nan)[::5, :2].T, color=colour, linewidth=0.8, label=name)
        if name == "holes":
            down = tips[tips[:, 2] < 0, :2]
            plan.plot(*down[::50].T, "o", color=colour, markersize=5)
        axis = figure.add_subplot(grid[number, 1])
        report.fill(axis, record.t - record.t[0], record.feed * 60, colour)
        axis.set(ylabel=f"{name}\nmm/min")
        if not number:
            axis.set_title("Feed of the setpoint over the machine time of each program, s", fontsize=9)
    plan.set(aspect="equal", xlabel="x in the part, mm", ylabel="y in the part, mm", title="Tips below Z 0.5, where they truly were")
    plan.legend(frameon=False, ncols=4, loc="upper center", bbox_to_anchor=(0.5, -0.14))
    return figure


def shaded(shape):
    """The part from above, as brightness, and its extent: of each triangle that looks up, where it is the highest."""
    vertices, facets = shape.tessellate(FACETS_MM)
    triangles = np.array([tuple(vertex) for vertex in vertices])[np.array(facets)]
    low, high = triangles.min((0, 1)), triangles.max((0, 1))
    x, y = (np.arange(a + CELL_MM / 2, b, CELL_MM) for a, b in zip(low[:2], high[:2]))
    heights, bright = np.full((len(y), len(x)), -np.inf), np.ones((len(y), len(x)))
    for corners in triangles:
        a, b, c = corners
        normal = np.cross(b - a, c - a)
        if normal[2] <= 1e-9:
            continue
        columns, rows = (slice(*np.searchsorted(line, [corners[:, k].min(), corners[:, k].max() + 1e-9])) for k, line in enumerate((x, y)))
        across, up = np.meshgrid(x[columns], y[rows])
        inside = np.ones(across.shape, bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= (q[0] - p[0]) * (up - p[1]) - (q[1] - p[1]) * (across - p[0]) >= -1e-9
        z = a[2] - (normal[0] * (across - a[0]) + normal[1] * (up - a[1])) / normal[2]
        inside &= z > heights[rows, columns]
        heights[rows, columns][inside] = z[inside]
        bright[rows, columns][inside] = 0.35 + 0.6 * max(float(normal @ LIGHT) / float(np.linalg.norm(normal)), 0) + 0.04 * z[inside]
    return np.where(np.isfinite(heights), bright, 1.1), (low[0], high[0], low[1], high[1])


def _told(found, name):
    kinds = ((found.free_form, "free-form"), (found.tops, "top"), (found.sides, "side"), ([one.floor for one in found.recesses], "floor"),
             ([wall for one in found.recesses for wall in one.walls], "wall"), ([wall for hole in found.holes for wall in hole.faces], "hole"))  # fmt: skip
    return f"{next((kind for names, kind in kinds if name in names), '')} {name}"


def report_html(user, rows, pictures, ok):
    cells = "".join(f'<tr><td>{html.escape(what)}</td><td class="{"" if fine else "bad"}">{html.escape(value)}</td><td>{html.escape(bound)}</td></tr>' for what, value, bound, fine in rows)
    direct = dict(zip(verdict.DIRECT, [user.steps.seconds(name) for name in verdict.DIRECT]))
    runs = user.first_motion - user.began - sum(direct.values())
    ours = [("creates part (its STEP file is opened)", direct["open the STEP file"]), ("searches and selects a machine", direct["search and select a machine"] + direct[verdict.DIRECT[3]]),
            ("generates tool paths", direct["make the tool paths"]), ("runs program (dry run, and tools by hand, to the first motion)", runs)]  # fmt: skip
    rows_of_steps = "".join(f"<tr><td>{html.escape(name)}</td><td>{seconds:.1f} s</td></tr>" for name, seconds in ours)
    theirs = "".join(f"<tr><td>{html.escape(name)}</td><td>{f'{minutes} min' if minutes else 'as long as the direct way'}</td><td>{html.escape(file)}</td></tr>" for name, minutes, file in verdict.CONVENTIONAL)
    every = "".join(f"<tr><td>{html.escape(name)}</td><td>{seconds:.1f} s</td></tr>" for name, seconds in user.steps.done)
    verdict_text = "every figure within its bound" if ok else "NOT within its bounds"
    files = sum(bool(file) for _, _, file in verdict.CONVENTIONAL)
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>From the model to the measured part</title><style>{report.STYLE}</style>'
        f"<h1>From the model to the measured part: {verdict_text}</h1>" + "".join(pictures) +
        f"<table><tr><th>figure</th><th>value</th><th>bound</th></tr>{cells}</table>"
        f"<h2>Steps from the model to the first motion</h2><p>The direct way has {len(ours)} steps and no file between. Seconds were measured while this report was made, and are the computer's: nobody's thinking is in them.</p>"
        f"<table><tr><th>direct</th><th>measured</th></tr>{rows_of_steps}</table>"
        f"<p>The conventional way, as Table 6-1 of the dissertation has it: {len(verdict.CONVENTIONAL)} steps, {sum(minutes for _, minutes, _ in verdict.CONVENTIONAL)} minutes more; {files} times something is handed on. "
        f"Its minutes are the dissertation's and were not measured here.</p><table><tr><th>conventional</th><th>longer by</th><th>handed on</th></tr>{theirs}</table>"
        f"<h2>What the session did</h2><table>{every}</table>"
        "<h2>Left out by the sweep</h2><ul>" + "".join(f"<li>{html.escape(text)}</li>" for text in user.left_out) + "</ul></html>\n"
    )

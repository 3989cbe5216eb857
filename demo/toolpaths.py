"""The process plan: tool paths over the headlight and round its rim, as the requests that a CAM program sends.

Ball-end paths follow the surface offset by the ball: tip = surface point + R n - R z. Each sweep is one quintic B-spline
fitted to that offset curve, sent with its own poles and knots; neighbouring sweeps are joined beside the part by a loop
that continues position, tangent and curvature. Part frame, mm, mm/min.
"""

import dataclasses
import json
import pathlib

import numpy as np
from scipy.optimize import brentq

import nurbs

HERE = pathlib.Path(__file__).parent
DEGREE = 5
SAFE_Z_MM = 25.0
UP = [0.0, 0.0, 1.0]


@dataclasses.dataclass
class Plan:
    """What the programs cut, and with what; written to plan.json for the checks. Angles and rotations are not used."""

    ball_radius_mm: float = 4.0
    scallop_um: float = 25.0
    fit_tolerance_um: float = 1.0
    flat_radius_mm: float = 3.0
    feed_mm_min: float = 2000.0
    approach_feed_mm_min: float = 600.0
    spindle_rpm: float = 1000.0
    part_origin_mm: tuple = (1.5, -2.5, -25.0)  # of the part frame in the machine frame; axes parallel
    part_half_mm: tuple = (40.0, 30.0)  # the surface in plan
    block_half_mm: tuple = (48.0, 38.0)  # the blank in plan, corners rounded
    block_corner_mm: float = 17.0
    stock_mm: float = 0.6  # what the blank is higher than the part
    rim_tracks_mm: tuple = ((41.0, 31.0, 10.0), (45.4, 35.4, 14.4))  # half length, half width, corner radius
    wait_mm: tuple = (-20.0, -44.0)  # where tools are changed and mechanisms swapped, clear of the blank
    fit_error_um: float = 0.0
    scallop_planned_um: float = 0.0
    sweeps: int = 0
    sweep_length_mm: float = 0.0


def frame(point):
    return {"p": [float(c) for c in point], "axis": UP}


def offset_points(row, v, radius_mm):
    points, normals = row(v)
    return points + radius_mm * (normals - UP)


def fit(points, tolerance_mm, fixed_mm=2.2):
    """Quintic B-spline through the ends of `points` and within the tolerance of all of them at equal arc length.

    The path is straight along x for its first and last `fixed_mm`: three poles at each end share the end's y and z, so
    tangent and curvature there are exact. Returns the curve and its largest distance, mm.
    """
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    inner = np.concatenate([[0], np.linspace(fixed_mm, s[-1] - fixed_mm, int(s[-1] / 5)), [s[-1]]])
    while True:
        knots = np.concatenate([[0.0] * DEGREE, inner, [s[-1]] * DEGREE])
        count = len(knots) - DEGREE - 1
        first, values = nurbs.basis(knots, DEGREE, s)
        matrix = np.zeros((len(s), count))
        np.put_along_axis(matrix, first[:, None] + np.arange(DEGREE + 1), values, axis=1)
        poles = np.empty((count, 3))
        for axis in range(3):
            held = 1 if axis == 0 else 3
            poles[:held, axis], poles[-held:, axis] = points[0, axis], points[-1, axis]
            ends = np.r_[0:held, count - held : count]
            rest = points[:, axis] - matrix[:, ends] @ poles[ends, axis]
            poles[held:-held, axis] = np.linalg.lstsq(matrix[:, held:-held], rest, rcond=None)[0]
        curve = nurbs.Curve(DEGREE, knots, poles)
        error = np.linalg.norm(curve(s) - points, axis=1)
        bad = np.unique(np.searchsorted(inner, s[error > 0.7 * tolerance_mm], side="left").clip(1, len(inner) - 1))
        if len(bad) == 0:
            return curve, error.max()
        if count > 400:
            raise ValueError(f"no fit within {tolerance_mm * 1e3} um with {count} poles: the offset path is not smooth")
        inner = np.sort(np.concatenate([inner, (inner[bad - 1] + inner[bad]) / 2]))


def fit_error_mm(curve, exact):
    """Largest distance of points of the exact offset curve, others than those of the fit, from the fitted curve."""
    if np.linalg.norm(exact[0] - curve(curve.domain[0])) > np.linalg.norm(exact[-1] - curve(curve.domain[0])):
        exact = exact[::-1]
    t = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(exact, axis=0), axis=1))])
    t = np.clip(t + np.linalg.norm(exact[0] - curve(curve.domain[0])), *curve.domain)
    for _ in range(4):
        p, d = curve.evaluate(t, 1)
        t = np.clip(t + np.einsum("nd,nd->n", exact - p, d) / np.einsum("nd,nd->n", d, d), *curve.domain)
    return np.linalg.norm(exact - curve(t), axis=1).max()


def scallop_mm(row, v0, v1, radius_mm):
    """Largest height of the ridge that balls at v0 and v1 leave: the point both spheres share, above the surface."""
    (p0, n0), (p1, n1) = row(v0), row(v1)
    c0, c1 = p0 + radius_mm * n0, p1 + radius_mm * n1
    middle, normal = row((v0 + v1) / 2)
    across = c1 - c0
    half = np.linalg.norm(across, axis=1) / 2
    down = normal - across * (np.einsum("nd,nd->n", normal, across) / (4 * half**2))[:, None]
    down /= np.linalg.norm(down, axis=1)[:, None]
    ridge = (c0 + c1) / 2 - down * np.sqrt(np.maximum(radius_mm**2 - half**2, 0))[:, None]
    return np.einsum("nd,nd->n", ridge - middle, normal).max()


def sweep_parameters(surface, radius_mm, scallop_limit_mm, v_range=None):
    """Parameters v of the sweeps: as far apart as the ridge between neighbours allows, drawn together to end on time."""
    row = surface.row(np.linspace(*surface.domain[0], 240))
    first, end = v_range or surface.domain[1]
    chosen, step = [first], 0.5
    while chosen[-1] < end:
        v = chosen[-1]
        excess = lambda step: scallop_mm(row, v, v + step, radius_mm) - scallop_limit_mm
        widest = min(1.2, surface.domain[1][1] - v)
        if widest > 1e-3 and excess(widest) > 0:
            step = 0.94 * brentq(excess, 1e-3, widest, xtol=1e-4)
        chosen.append(v + step)
    scale = (end - first) / (chosen[-1] - first)
    return [first + scale * (v - first) for v in chosen[:-1]] + [end]


# Poles of the loop between two sweeps a unit apart, x away from the part. Four poles on each tangent keep curvature and
# its change at zero where the loop meets the straight sweeps.
LOOP = np.array([[0, 0], [0.9, 0], [1.8, 0], [2.9, 0], [4.4, -1.3], [4.4, 2.3], [2.9, 1], [1.8, 1], [0.9, 1], [0, 1]])


def loop(start, end, outward):
    """Curve of degree 9 that turns the tool round beside the part, in the rim's plane."""
    step = abs(end[1] - start[1])
    shape = LOOP * [max(step, 0.5), step]
    points = [[start[0] + outward * x, start[1] + y * np.sign(end[1] - start[1]), start[2]] for x, y in shape]
    points[-1] = list(end)
    degree = len(points) - 1
    return nurbs.Curve(degree, [0.0] * (degree + 1) + [1.0] * (degree + 1), points)


class Program:
    """Requests in order, one JSON-RPC object each."""

    def __init__(self, first_move):
        self.requests = []
        self.next_move = first_move

    def call(self, method, **parameters):
        self.requests.append({"jsonrpc": "2.0", "id": len(self.requests) + 1, "method": method, "params": parameters})

    def move(self, method, **parameters):
        self.call("RMAC_CAM." + method, MoveID=self.next_move, **parameters)
        self.next_move += 1

    def line(self, start, end):
        self.move("MoveAlongLine", StartPoint=frame(start), EndPoint=frame(end))

    def prepare(self, mechanism, origin, plan):
        self.call("Device.Load", Name=mechanism)
        self.call("RMAC_CAM.SetPartFrame", PartFrame={"p": list(origin), "q": [1.0, 0.0, 0.0, 0.0]})
        self.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=plan.spindle_rpm)
        self.call("RMAC_CAM.TurnCoolantOn")
        self.call("RMAC_CAM.SetPathTolerance", Tolerance=0.0)
        self.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def write(self, path):
        path.write_text("".join(json.dumps(r) + "\n" for r in self.requests), encoding="utf-8")


def sweep_program(surface, plan, v_range=None):
    """The ball-end sweep of the whole surface (or of a band of it), then the way to the rim's plane."""
    radius = plan.ball_radius_mm
    parameters = sweep_parameters(surface, radius, plan.scallop_um * 1e-3, v_range)
    u0, u1 = surface.domain[0]
    fitted, between = surface.row(np.linspace(u0, u1, 1501)), surface.row(np.linspace(u0, u1, 4004))
    program = Program(1)
    program.prepare("DMACXYZ", plan.part_origin_mm, plan)
    curves = []
    for number, v in enumerate(parameters):
        points = offset_points(fitted, v, radius)
        curve, _ = fit(points if number % 2 == 0 else points[::-1], plan.fit_tolerance_um * 1e-3)
        plan.fit_error_um = max(plan.fit_error_um, 1e3 * fit_error_mm(curve, offset_points(between, v, radius)))
        curves.append(curve)
    plan.scallop_planned_um = 1e3 * max(scallop_mm(fitted, a, b, radius) for a, b in zip(parameters, parameters[1:]))
    if plan.scallop_planned_um > plan.scallop_um or plan.fit_error_um > plan.fit_tolerance_um:
        raise ValueError(
            f"tool paths leave ridges of {plan.scallop_planned_um:.2f} um (allowed {plan.scallop_um}) and are fitted to "
            f"{plan.fit_error_um:.2f} um (allowed {plan.fit_tolerance_um}): tighten sweep_parameters or fit"
        )
    plan.sweeps = len(curves)
    plan.sweep_length_mm = float(sum(c.domain[1] for c in curves))

    start = curves[0].points[0]
    above = [start[0], start[1], SAFE_Z_MM]
    program.call("RMAC_CAM.SetFeedrate", Feedrate=plan.feed_mm_min)
    program.move("MoveToPathTarget", TargetFrame=frame(above))
    program.call("RMAC_CAM.SetFeedrate", Feedrate=plan.approach_feed_mm_min)
    program.line(above, start)
    program.call("RMAC_CAM.SetFeedrate", Feedrate=plan.feed_mm_min)
    for number, curve in enumerate(curves):
        if number:
            before = curves[number - 1].points[-1]
            link = loop(before, curve.points[0], 1 if number % 2 else -1)
            program.move("MoveAlongNurbs", Nurbs=link.to_wire())
        program.move("MoveAlongNurbs", Nurbs=curve.to_wire())
    end = curves[-1].points[-1]
    wait = list(plan.wait_mm)
    program.line(end, [end[0], end[1], SAFE_Z_MM])
    program.move("MoveToPathTarget", TargetFrame=frame([*wait, SAFE_Z_MM]))
    program.move("MoveToPathTarget", TargetFrame=frame([*wait, 0.0]))
    return program


def rounded_rectangle(half_x, half_y, radius):
    """Lines and corner arcs, counter-clockwise from the middle of the lower side: (centre or None, start, end)."""
    x, y = half_x - radius, half_y - radius
    pieces = [(None, (0, -half_y), (x, -half_y))]
    corners = [(x, -y, (x, -half_y), (half_x, -y)), (x, y, (half_x, y), (x, half_y))]
    corners += [(-x, y, (-x, half_y), (-half_x, y)), (-x, -y, (-half_x, -y), (-x, -half_y))]
    for number, (cx, cy, start, end) in enumerate(corners):
        if number:
            pieces.append((None, pieces[-1][2], start))
        pieces.append(((cx, cy), start, end))
    return pieces + [(None, pieces[-1][2], (0, -half_y))]


def rim_program(plan):
    """Face-milling of the rim with two axes: z stays 0, the plane in which the third drive holds."""
    flat = lambda p: [float(p[0]), float(p[1]), 0.0]
    program = Program(1001)
    program.prepare("DMACXY", (*plan.part_origin_mm[:2], 0.0), plan)
    program.call("RMAC_CAM.SetFeedrate", Feedrate=plan.feed_mm_min)
    at = plan.wait_mm
    for half_x, half_y, radius in plan.rim_tracks_mm:
        entry = (-8.0, -half_y - 8.0)
        program.line(flat(at), flat(entry))
        lead = ((0.0, -half_y - 8.0), entry, (0.0, -half_y))
        for centre, start, end in [lead, *rounded_rectangle(half_x, half_y, radius)]:
            if centre is None:
                program.line(flat(start), flat(end))
            else:
                sign = -1 if centre == lead[0] and start == entry else 1
                program.move(
                    "MoveAlongArc", RotSign=sign, Closed=False, CenterPoint=frame(flat(centre)),
                    StartPoint=frame(flat(start)), EndPoint=frame(flat(end)),
                )  # fmt: skip
        at = (0.0, -half_y)
    program.line(flat(at), flat((0.0, plan.wait_mm[1])))
    return program


def make(out, v_range=None):
    """Writes both programs and plan.json; returns (plan, sweep program, rim program)."""
    out = pathlib.Path(out)
    out.mkdir(parents=True, exist_ok=True)
    surface = nurbs.Surface.read(HERE / "headlight.json")
    plan = Plan()
    sweep = sweep_program(surface, plan, v_range)
    rim = rim_program(plan)
    sweep.write(out / "headlight-sweep.rmac")
    rim.write(out / "headlight-rim.rmac")
    (out / "plan.json").write_text(json.dumps(dataclasses.asdict(plan), indent=1) + "\n", encoding="utf-8")
    return plan, sweep, rim


if __name__ == "__main__":
    print(make(HERE.parent / "out")[0])

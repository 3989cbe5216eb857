"""The programs: a ball end goes over the top in lines to and fro, each one NURBS of tip and tool axis, joined by loops.

The middle of the ball is on the offset of the surface, tip = surface point + R n - R a, however the axis a leans.
"""

import dataclasses
import json

import chain
import clamping
import dome
import numpy as np
from scipy.interpolate import BSpline, make_interp_spline

FEED_MM_MIN, APPROACH_MM_MIN, RPM = 1500, 5000, 3800
HIGH = 200.0  # joint Z: above all, however the table lies
SAFE = [0, 0, HIGH, 0, 0]
BESIDE = dome.LENGTH / 2 + clamping.BALL_RADIUS  # from there on the ball does not reach the block
APART = 2.5  # of the places through which a curve goes
MOST_OFF_UM = 0.1
DEGREE, LOOP_DEGREE = 5, 9
LOOP = 18.0  # length of a loop's parameter
DOWN = 3  # MoveID of the line onto the block; before it the machine comes from wherever it stood
FIRST_SWEEP = 100  # MoveID of the first; loops have the odd ones between


@dataclasses.dataclass
class Curve:
    """Of tip and axis together, (n, 6)."""

    degree: int
    knots: np.ndarray
    points: np.ndarray

    def to_wire(self):
        return {"space": "pose", "degree": self.degree, "knots": self.knots.tolist(), "points": self.points.tolist()}


def axis(x, y, lean):
    """Unit vectors along the tool, from its tip: it leans by 20 to 25 degrees towards +y (`lean` 1) or -y (-1) and opens like a fan along x."""
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    a = np.stack([0.22 * x / BESIDE, lean * (0.42 + 0.05 * np.sin(y / 14)), np.ones_like(x)], axis=-1)
    return a / np.linalg.norm(a, axis=-1, keepdims=True)


def poses(x, y, lean):
    """Tip and axis, (…, 6), where the ball touches the surface."""
    points, normals = dome.surface(x, y)
    a = axis(x, y, lean)
    return np.concatenate([points + clamping.BALL_RADIUS * (normals - a), a], axis=-1)


def sweep(y, ways, lean):
    """The curve at y, towards +x (`ways` 1) or -x, as scipy's B-spline over mm."""
    x = ways * np.linspace(-BESIDE, BESIDE, round(2 * BESIDE / APART) + 1)
    through = poses(x, y, lean)
    length = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(through[:, :3], axis=0), axis=1))])
    return make_interp_spline(length, through, k=DEGREE)


def off_surface_um(spline):
    """How far the ball's middle is from the offset surface, most, at places between those of the fit; by Newton's steps in x and y."""
    at = spline(np.linspace(spline.t[0], spline.t[-1], 501))
    a = at[:, 3:] / np.linalg.norm(at[:, 3:], axis=1, keepdims=True)
    middle = at[:, :3] + clamping.BALL_RADIUS * a
    foot = middle[:, :2].copy()
    for _ in range(20):
        points, normals = dome.surface(*foot.T)
        foot += (middle - clamping.BALL_RADIUS * normals - points)[:, :2]
    points, normals = dome.surface(*foot.T)
    return 1000 * float(np.abs(np.linalg.norm(middle - points, axis=1) - clamping.BALL_RADIUS).max())


def loop(before, behind):
    """From the end of one sweep to the begin of the next, with equal tangents and curvature."""
    unit = LOOP / LOOP_DEGREE

    def ends(spline, t, sign):
        p, d, c = (spline(t, nu) for nu in range(3))
        first = p + sign * unit * d
        second = 2 * first - p + LOOP**2 / (LOOP_DEGREE * (LOOP_DEGREE - 1)) * c
        return [p, first, second, second + sign * unit * d]

    head, tail = ends(before, before.t[-1], 1), ends(behind, behind.t[0], -1)
    out = 1.5 * unit * before(before.t[-1], 1)
    swing = np.zeros(6)
    swing[:3] = tail[0][:3] - head[0][:3]
    swing *= unit / np.linalg.norm(swing)
    points = np.array([*head, head[-1] + out - swing, tail[-1] + out + swing, *tail[::-1]])
    # The tool turns from one end's axis to the other's.
    points[4:6, 3:] = (points[3, 3:] * [[2], [1]] + points[6, 3:] * [[1], [2]]) / 3
    return Curve(LOOP_DEGREE, np.repeat([0.0, LOOP], LOOP_DEGREE + 1), points)


def rows(step):
    """Places of the sweeps along y, from the clamp to the jaw."""
    return np.linspace(dome.WIDTH / 2, -dome.WIDTH / 2, round(dome.WIDTH / step) + 1)


def pose_of(place):
    return {"p": place[:3].tolist(), "axis": (place[3:] / np.linalg.norm(place[3:])).tolist()}


class Requests:
    """As the lines of a .rmac file have them."""

    def __init__(self):
        self.lines = []

    def call(self, method, **parameters):
        self.lines.append({"jsonrpc": "2.0", "id": len(self.lines) + 1, "method": "RMAC_CAM." + method, "params": parameters})

    def begin(self):
        self.call("SetPathTolerance", Tolerance=0)
        self.call("SetSpindleRPM", SpindleNumber=0, RPM=RPM)


def program(step, lean):
    """The whole of it, from above all and back there."""
    splines = [sweep(y, 1 if n % 2 == 0 else -1, lean) for n, y in enumerate(rows(step))]
    off = max(off_surface_um(spline) for spline in splines)
    if off > MOST_OFF_UM:
        raise ValueError(f"the sweeps leave the offset surface by {off:.3f} um, {MOST_OFF_UM} um is the most: put their places nearer than {APART} mm")
    first, last = splines[0](splines[0].t[0]), splines[-1](splines[-1].t[-1])
    first_joints, last_joints = chain.joints(first), chain.joints(last)
    # Up and down along the tool, which is the machine's Z.
    above, away = (pose_of(np.concatenate([place[:3] + (HIGH - joints[2]) * place[3:], place[3:]])) for place, joints in ((first, first_joints), (last, last_joints)))
    requests = Requests()
    requests.begin()
    call = requests.call
    call("SetFeedrate", Feedrate=APPROACH_MM_MIN)
    call("MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": SAFE})
    call("MoveToJointTarget", MoveID=2, JointTargetFrame={"joints": [*first_joints[:2], HIGH, *first_joints[3:]]})
    call("MoveAlongLine", MoveID=DOWN, StartPoint=above, EndPoint=pose_of(first))
    call("SetFeedrate", Feedrate=FEED_MM_MIN)
    for n, spline in enumerate(splines):
        if n:
            call("MoveAlongNurbsND", MoveID=FIRST_SWEEP + 2 * n - 1, NurbsND=loop(splines[n - 1], spline).to_wire())
        call("MoveAlongNurbsND", MoveID=FIRST_SWEEP + 2 * n, NurbsND=Curve(DEGREE, spline.t, spline.c).to_wire())
    end = FIRST_SWEEP + 2 * len(splines)
    call("SetFeedrate", Feedrate=APPROACH_MM_MIN)
    call("MoveAlongLine", MoveID=end, StartPoint=pose_of(last), EndPoint=away)
    call("MoveToJointTarget", MoveID=end + 1, JointTargetFrame={"joints": SAFE})
    return requests.lines


def write(file, requests):
    file.write_text("".join(json.dumps(request) + "\n" for request in requests), encoding="utf-8")

"""The part as it was really cut, from where its loads truly were, and as it lies on the measuring machine.

Nothing here knows FreeCAD, the planner or the fits. The simulated probe touches blocks, bores and balls, so the part
is made of them: blocks whose sides are where the cutter left them, bores where the drill was, and beneath each place of a bent face that
will be measured a ball whose surface is where the cutter left it.
"""

import json
import pathlib
from dataclasses import dataclass

import numpy as np

BLANK_OVER_MM = 0.6  # of the casting over the finished part; its top was faced before
BEHIND_MM = 1.0  # farther inside of the material no cutter belongs to a place
BALL_MM = 6.0  # beneath bent faces: smaller than any of their radii
SAME_MM = 1e-6
MOST_NUMBERS = 64
ALONG = 1 - 1e-9


@dataclass(frozen=True)
class Cut:
    """Tips of a cutter in the part frame, one a cycle, as it really is, whatever the tool table says of it."""

    tips: np.ndarray
    radius_mm: float
    ball: bool  # else flat


def tips_of(joints, frame, length_mm):
    """From the joints of a machine of three slides."""
    return joints[:, :3] - np.asarray(frame) - [0, 0, length_mm]


def as_cut(points, normals, cuts):
    """How far the surface is off each point along its normal; where no cutter came, as the blank is: 0."""
    return np.array([min([entered(point, normal, cut) for cut in cuts if len(cut.tips)], default=np.inf) for point, normal in zip(points, normals)])


def finished(off):
    """The top was faced before; whatever no cutter came to within the blank is as it was."""
    return np.where(off > BLANK_OVER_MM, 0.0, off)


def entered(point, normal, cut):
    """Where the line from a point inside along its normal first comes into what a cutter took away."""
    reach = cut.radius_mm + BEHIND_MM
    near = cut.tips[(np.abs(cut.tips[:, :2] - point[:2]) < reach).all(1)]
    if cut.ball:
        way = near + [0, 0, cut.radius_mm] - point
        along = way @ normal
        beside = cut.radius_mm**2 - (way**2).sum(1) + along**2
        along, beside = along[beside > 0], beside[beside > 0]
        found = along - np.sqrt(beside)
    elif normal[2] > ALONG:
        under = np.hypot(*(near[:, :2] - point[:2]).T) < cut.radius_mm
        found = near[under, 2] - point[2]
    else:
        flat = normal[:2]
        way = near[near[:, 2] < point[2], :2] - point[:2]
        along = way @ flat
        beside = cut.radius_mm**2 - (way**2).sum(1) + along**2
        found = along[beside > 0] - np.sqrt(beside[beside > 0])
    found = found[found > -BEHIND_MM]
    return found.min(initial=np.inf)


def placed(place, points):
    """`place`: x, y, z in mm, and a turn about Z in degrees."""
    turn = np.radians(place[3])
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return np.asarray(points) @ rotation.T + np.asarray(place[:3])


def flattened(faces, normals, off):
    """Flat faces are flat: each is taken to lie where the cutter left the middle of its places."""
    off = np.array(off)
    for face in dict.fromkeys(faces):
        chosen = np.array([one == face for one in faces])
        if (np.abs(np.asarray(normals)[chosen]).max(1) > ALONG).all():
            off[chosen] = off[chosen].mean()
    return off


def as_left(block, points, normals, off):
    """The sides of a block of the part as designed that were measured, and where the cutter left them."""
    for point, normal, by in zip(points, normals, off):
        axis = int(np.abs(normal).argmax())
        side = axis + (3 if normal[axis] > 0 else 0)
        if abs(normal[axis]) > ALONG and abs(block[side] - point[axis]) < SAME_MM:
            yield side, point[axis] + by * normal[axis]


def clamp(tree, place, points, normals, off, bores, body, tip_radius_mm):
    """Puts the part on the measuring machine of a device tree. `bores`: x, y, radius, bottom, top; `body`: the part as designed, of blocks. `off` of
    the places of one flat face are the same."""
    blocks = []
    for block in body:
        left = list(map(float, block))
        for side, value in as_left(block, points, normals, off):
            left[side] = float(value)
        blocks += left
    bent = np.abs(normals).max(1) < ALONG
    balls = [value for point, normal, by in zip(points[bent], normals[bent], off[bent]) for value in (*placed(place, point + (by - BALL_MM) * normal), BALL_MM)]
    for what, values in (("blocks", blocks), ("bores", [value for bore in bores for value in bore]), ("balls", balls)):
        if len(values) > MOST_NUMBERS:
            raise ValueError(f"the simulated part takes {len(values)} numbers of {what}; a description of a machine has room for {MOST_NUMBERS}")
    file = pathlib.Path(tree) / "cmm/3-axis/CMM/device.json"
    device = json.loads(file.read_text())
    parameters = {
        "probe_input": device["DigitalIOInterface"]["Inputs"]["Probe"], "probe_stylus_mm": [0, 0, 0], "probe_radius_mm": tip_radius_mm,
        "probe_bounce_ms": 2, "part_place": [*map(float, place[:3]), 0, 0, float(place[3])], "part_block_mm": blocks,
        "part_bore_mm": [float(value) for bore in bores for value in bore], "sphere_mm": [float(value) for value in balls],
    }  # fmt: skip
    device["DigitalIOInterface"]["Parameters"] = {name: value for name, value in parameters.items() if value != []}
    file.write_text(json.dumps(device, indent=2))

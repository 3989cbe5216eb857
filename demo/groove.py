"""The part of `./demo.sh measure`: a block with a groove round its bore, how it is cut, and how far a cut is off.

Part frame, mm; z is 0 above the block, whose top lies at -20. The groove's middle is a rectangle with round corners: it is
roughed along the middle, and each wall is then finished.
"""

import json
import pathlib
import shutil

import numpy as np

# Where the part is clamped, and nobody knows: 0.3 mm off, turned by 0.2 degrees about z.
PLACE_MM = (0.2, -0.2, 0.1)
TURN_DEG = 0.2
TOP = -20.0
HALF, CORNER = (11.0, 7.0), 4.0  # of the groove's middle
CUTTER, PROBE = 1, 9  # tool numbers
CUTTER_LENGTH, CUTTER_RADIUS = 40.0, 2.0
PROBE_LENGTH, TIP_RADIUS = 30.0, 1.0
SAFE, DEPTH = -5.0, -21.0
# What is left for the finish is more than the part may be off.
ALLOWANCE = 0.5
PASSES = {"rough": (100, DEPTH + 0.3, 0.0), "outer wall": (200, DEPTH, ALLOWANCE), "inner wall": (300, DEPTH, -ALLOWANCE)}
FEED = {"rough": 120, "outer wall": 400, "inner wall": 400}


def clamp(built_tree, tree):
    """A device tree in which DMACXYZ has a touch probe and the part is clamped."""
    shutil.copytree(built_tree, tree)
    file = pathlib.Path(tree) / "mill/3-axis/DMACXYZ/device.json"
    device = json.loads(file.read_text())
    device["DigitalIOInterface"]["Parameters"] = {
        "probe_input": device["DigitalIOInterface"]["Inputs"]["Probe"],
        "probe_stylus_mm": [0, 0, -PROBE_LENGTH],
        "probe_radius_mm": TIP_RADIUS,
        "probe_bounce_ms": 2,
        "part_place": [*PLACE_MM, 0, 0, TURN_DEG],
        "part_block_mm": [-20, -15, -40, 20, 15, TOP],
        "part_bore_mm": [0, 0, 8, -35, TOP],
    }
    file.write_text(json.dumps(device, indent=2))


def plan():
    """What is measured: faces of the block that the groove does not touch."""
    faces = {
        "top": [((x, y, TOP), (0, 0, 1)) for x, y in ((-17, -12), (17, -12), (17, 12), (-17, 12))],
        "left": [((-20, y, -28), (-1, 0, 0)) for y in (-10, 10)],
        "front": [((x, -15, -28), (0, -1, 0)) for x in (-15, 0, 15)],
    }
    features = [{"Name": name, "Points": [{"Point": p, "Normal": n} for p, n in face]} for name, face in faces.items()]
    return {"SafeHeight": SAFE, "TipRadius": TIP_RADIUS, "Features": features}


def frame(x, y, z):
    return {"p": [x, y, z], "axis": [0, 0, 1]}


def loop(offset, z, first_id):
    """Requests of one loop, anticlockwise from the middle of its lower side, `offset` outside of the groove's middle."""
    half_x, half_y, radius = HALF[0] + offset, HALF[1] + offset, CORNER + offset
    inner_x, inner_y = half_x - radius, half_y - radius
    corners = [((inner_x, -half_y), (inner_x, -inner_y), (half_x, -inner_y)),
               ((half_x, inner_y), (inner_x, inner_y), (inner_x, half_y)),
               ((-inner_x, half_y), (-inner_x, inner_y), (-half_x, inner_y)),
               ((-half_x, -inner_y), (-inner_x, -inner_y), (-inner_x, -half_y))]
    at, number, requests = (0.0, -half_y), first_id, []
    for start, centre, end in corners:
        requests.append(("MoveAlongLine", {"MoveID": number, "StartPoint": frame(*at, z), "EndPoint": frame(*start, z)}))
        requests.append(("MoveAlongArc", {"MoveID": number + 1, "RotSign": 1, "Closed": False,
                                          "CenterPoint": frame(*centre, z), "StartPoint": frame(*start, z),
                                          "EndPoint": frame(*end, z)}))
        at, number = end, number + 2
    requests.append(("MoveAlongLine", {"MoveID": number, "StartPoint": frame(*at, z), "EndPoint": frame(0.0, -half_y, z)}))
    return requests


def program():
    """The whole cut, as (function, parameters)."""
    requests, at = [("SetPathTolerance", {"Tolerance": 0.002})], None
    for name, (first_id, z, offset) in PASSES.items():
        begin = (0.0, -HALF[1] - offset, z)
        requests.append(("SetFeedrate", {"Feedrate": FEED[name]}))
        if at is None:
            above = (begin[0], begin[1], SAFE)
            requests.append(("MoveToPathTarget", {"MoveID": 1, "TargetFrame": frame(*above)}))
            at = above
        requests.append(("MoveAlongLine", {"MoveID": first_id - 1, "StartPoint": frame(*at), "EndPoint": frame(*begin)}))
        requests += loop(offset, z, first_id)
        at = begin
    requests.append(("MoveToPathTarget", {"MoveID": 999, "TargetFrame": frame(at[0], at[1], SAFE)}))
    return [{"method": "RMAC_CAM." + function, "params": parameters} for function, parameters in requests]


def in_part(joints):
    """Where the cutter's tip was in the part as it is clamped, from the joints of a machine of three slides."""
    turn = np.radians(TURN_DEG)
    rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    return (joints + [0, 0, -CUTTER_LENGTH] - np.array(PLACE_MM)) @ rotation


def off_loop(points, offset):
    """Distance of points from a loop in plan, positive outside (Quilez' signed distance of a round box)."""
    half = np.array(HALF) - CORNER
    beyond = np.abs(points[:, :2]) - half
    outside = np.hypot(*np.maximum(beyond, 0).T)
    return outside + np.minimum(beyond.max(axis=1), 0) - (CORNER + offset)


def off_pass(record, name, joints):
    """Of the rows of one pass: how far along it (turn about the middle, degrees), off its wall, off its floor. mm."""
    first_id, z, offset = PASSES[name]
    rows = (record.move >= first_id) & (record.move < first_id + 9)
    points = in_part(joints[rows])
    turn = np.degrees(np.arctan2(points[:, 1], points[:, 0]))
    return turn, off_loop(points, offset), points[:, 2] - z, points

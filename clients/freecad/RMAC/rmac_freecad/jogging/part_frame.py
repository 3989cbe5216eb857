"""The part frame, set where the tool stands."""

import math

CLOSE_MM, CLOSE = 1e-6, 1e-9


def place_part(client, readings):
    """Moves the part frame, turned as it is, so that the tool tip reads `readings` there: mm by axis, as {"Z": 0}. At rest.
    Gives the frame."""
    frame, tip = client.cam.GetPartFrame(), client.state()["pose"]
    shift = [tip["XYZ".index(axis)] - readings[axis] if axis in readings else 0.0 for axis in "XYZ"]
    moved = {"p": [a + b for a, b in zip(frame["p"], _turned(frame["q"], shift))], "q": frame["q"]}
    client.cam.SetPartFrame(moved)
    return moved


def is_machine_frame(frame):
    """Nobody has set it: the part's zero is the machine's."""
    w, x, y, z = frame["q"]
    return math.hypot(*frame["p"]) < CLOSE_MM and math.hypot(x, y, z) < CLOSE


def _turned(q, v):
    """v turned by the unit quaternion q (w x y z): v + 2 w (u × v) + 2 u × (u × v)."""
    w, u = q[0], q[1:]
    once = _cross(u, v)
    twice = _cross(u, once)
    return [a + 2 * (w * b + c) for a, b, c in zip(v, once, twice)]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

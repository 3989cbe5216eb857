"""The true motion of the axes, as a program: NURBS through the places where the tool was, so that `rmac simulate` cuts what the machine cut."""

import chain
import numpy as np
import sweeps
from scipy.interpolate import make_interp_spline

APART = 0.05  # mm of the tip's way between places
DEGREE = 3


def places(joints):
    """Tip and axis, (n, 6), about `APART` apart; the first and the last row always."""
    tip = chain.places(joints, 0)
    pose = np.concatenate([tip, chain.places(joints, 1) - tip], axis=1)
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(tip, axis=0), axis=1))])
    keep = np.flatnonzero(np.diff(np.floor(way / APART), prepend=-1) > 0)
    if way[-1] - way[keep[-1]] < APART / 2:
        keep = keep[:-1]
    keep = np.append(keep, len(pose) - 1)
    return way[keep], pose[keep]


def program(moves, joints):
    """Each move that was cut, from where the one before ended to its own last row."""
    requests = sweeps.Requests()
    requests.begin()
    path = np.flatnonzero((moves >= sweeps.DOWN) & (moves < moves.max()))
    first = joints[path[0]]
    requests.call("MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": first.tolist()})
    requests.call("SetFeedrate", Feedrate=sweeps.FEED_MM_MIN)
    begin = path[0]
    for move in np.unique(moves[path]):
        end = np.flatnonzero(moves == move)[-1]
        way, through = places(joints[begin : end + 1])
        spline = make_interp_spline(way, through, k=DEGREE)
        requests.call("MoveAlongNurbsND", MoveID=int(move), NurbsND=sweeps.Curve(DEGREE, spline.t, spline.c).to_wire())
        begin = end
    return requests.lines

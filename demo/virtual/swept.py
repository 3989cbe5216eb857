"""What a tool takes away that goes where joints were: by formulas that share nothing with the appliance.

A place's height over what a ball end sweeps is the least, over time, of its distance from the tool: 0 on the surface that is
left, positive where material is left beyond it, negative where it was cut. Part frame, mm.
"""

import dataclasses

import chain
import clamping
import dome
import numpy as np
from scipy.spatial import cKDTree

COARSE = 1.0  # way between the places at which the tool's straight part is looked at first
CHUNK = 500  # places looked at together


@dataclasses.dataclass
class Motion:
    """Of the tool against the part, a row a cycle."""

    middle: np.ndarray  # of the ball
    axis: np.ndarray  # unit vectors from the tip up


def motion(joints):
    middle = chain.places(joints, clamping.BALL_RADIUS)
    return Motion(middle, chain.places(joints, clamping.BALL_RADIUS + 1) - middle)


def moving(motion, step=1e-4):
    """Only rows that are a step away from the one before: rests say nothing."""
    way = np.linalg.norm(np.diff(motion.middle, axis=0), axis=1) + 20 * np.linalg.norm(np.diff(motion.axis, axis=0), axis=1)
    far = np.floor(np.concatenate([[0], np.cumsum(way)]) / step)
    keep = np.concatenate([[True], np.diff(far) > 0])
    return Motion(motion.middle[keep], motion.axis[keep])


def from_ball(points, motion):
    """Least distance from the ball on its way, straight from row to row."""
    _, near = cKDTree(motion.middle).query(points)
    least = np.full(len(points), np.inf)
    for first in (near - 1, near):
        first = np.clip(first, 0, len(motion.middle) - 2)
        start, way = motion.middle[first], motion.middle[first + 1] - motion.middle[first]
        share = np.clip(np.einsum("ij,ij->i", points - start, way) / np.maximum(np.einsum("ij,ij->i", way, way), 1e-18), 0, 1)
        least = np.minimum(least, np.linalg.norm(points - start - share[:, None] * way, axis=1))
    return least - clamping.BALL_RADIUS


def from_straight_part(points, motion):
    """Least distance from the straight part above the ball, at the rows; infinite where it never was beside the place."""
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(motion.middle, axis=0), axis=1))])
    looks = np.unique(np.searchsorted(way, np.arange(0, way[-1], COARSE)))
    tall = clamping.CUTS_UP_TO - clamping.BALL_RADIUS

    def beside(up, across):
        return np.where((up >= 0) & (up <= tall), across - clamping.BALL_RADIUS, np.inf)

    least = np.empty(len(points))
    middle, axis = motion.middle[looks], motion.axis[looks]
    own = np.einsum("ij,ij->i", middle, axis)
    for begin in range(0, len(points), CHUNK):
        some = points[begin : begin + CHUNK]
        up = some @ axis.T - own
        squared = (some**2).sum(1)[:, None] + (middle**2).sum(1) - 2 * some @ middle.T
        rough = beside(up, np.sqrt(np.maximum(squared - up**2, 0)))
        best = looks[np.argmin(rough, axis=1)]
        least[begin : begin + CHUNK] = rough.min(axis=1)
        # Every row around the best look.
        span = int(np.diff(looks).max(initial=1))
        rows = np.clip(best[:, None] + np.arange(-span, span + 1), 0, len(motion.middle) - 1)
        w = some[:, None] - motion.middle[rows]
        up = np.einsum("ijk,ijk->ij", w, motion.axis[rows])
        fine = beside(up, np.sqrt(np.maximum((w**2).sum(2) - up**2, 0))).min(axis=1)
        least[begin : begin + CHUNK] = np.minimum(least[begin : begin + CHUNK], fine)
    return least


def left_over(points, motion):
    """How much material is left beyond each place, along the surface's normal; negative where more was cut."""
    return np.minimum(from_ball(points, motion), from_straight_part(points, motion))


def out_of_stock(points):
    """Distance from the block as it was before; negative inside."""
    half = np.array([dome.LENGTH, dome.WIDTH, dome.STOCK_HEIGHT]) / 2
    outside = np.abs(points - [0, 0, half[2]]) - half
    return np.linalg.norm(np.maximum(outside, 0), axis=1) + np.minimum(outside.max(axis=1), 0)

"""Places of the faces, spread evenly, that tell what two passes as they were laid really left between them: also where the pass in
their middle touches nothing, because the mill bridges a place that is bent more than it is."""

import math

import numpy as np

from rmac_freecad.surfaces.bspline import value
from rmac_freecad.surfaces.drop import tips
from rmac_freecad.surfaces.fit import DEGREE
from rmac_freecad.surfaces.ridges import left_standing
from rmac_freecad.surfaces.rows import Row

APART = 0.06  # of the step between passes on a plane
FEWEST, MOST = 1000, 400_000  # of a face
SHARE = 20_000  # of them are looked at together
TRACE = 24  # samples of a pass a radius; that far a place is sought for along it
FREE_MM = 1e-6  # the mill gets to a place where it stands no higher than this above it
AT_ONCE = 16
PLASTIC = 1.324717957244746  # its powers spread places over a square more evenly than chance does, and on no lines


class Witnesses:
    def __init__(self, part, drop, mill, family, steepest, step_mm):
        self._drop, self._mill, self._family = drop, mill, family
        found = [
            self._of(face, uv, steepest)
            for face in (part.faces[label] for label in family.targets)
            for uv in _shares(spread(face, APART * step_mm))
        ]
        w, t, point, normal, tip = (np.concatenate(column) for column in zip(*found))
        order = np.argsort(w)
        self._w, self._t, self._point, self._normal, self._tip = (column[order] for column in (w, t, point, normal, tip))

    def _of(self, face, uv, steepest):
        tip, point, normal = tips(face, self._mill, uv)
        w, t = self._family.places(uv, tip)
        good = (normal[:, 2] >= math.cos(steepest)) & np.isfinite(tip).all(1)
        return [column[good] for column in (w, t, point, normal, tip)]

    def trace(self, row, stretches):
        """A pass as its curves are, in many samples."""
        first, last = self._family.t_range
        t = np.linspace(first, last, int((last - first) * self._family.t_mm / self._mill.radius_mm * TRACE) + 2 * TRACE)
        there = np.full((len(t), 3), np.nan)
        for knots, poles in (curve for curves in stretches for curve in curves):
            on = (t >= knots[0]) & (t <= knots[-1])
            there[on] = value(knots, DEGREE, poles, t[on])
        used = np.isfinite(there[:, 2])
        return Row(row.w, t, there, there, there, used, used)

    def highest(self, before, after, limit_mm):
        """What two traces leave at most of a place between them that the mill gets to, and the place; where that is no more than the
        limit, 0 and None."""
        chosen = np.arange(*np.searchsorted(self._w, (before.w, after.w)))
        if not len(chosen):
            return 0.0, None
        up = np.concatenate([self._left(before, after, some) for some in _shares(chosen)])
        high = np.flatnonzero(up > limit_mm)
        if not len(high):
            return 0.0, None
        high = high[np.argsort(self._t[chosen[high]])]  # neighbours together: quicker
        high = high[~self._drop.surely_blocked(self._tip[chosen[high]], FREE_MM)]
        high = high[np.argsort(-up[high])]
        for some in np.array_split(high, math.ceil(len(high) / AT_ONCE)) if len(high) else ():
            tip = self._tip[chosen[some]]
            free = some[self._drop(tip[:, :2]).z <= tip[:, 2] + FREE_MM]
            if len(free):
                return up[free[0]], self._point[chosen[free[0]]]
        return 0.0, None

    def _left(self, before, after, chosen):
        at = np.rint((self._t[chosen] - before.t[0]) / (before.t[1] - before.t[0])).astype(int)
        each = [left_standing(self._mill, one, at, self._point[chosen], self._normal[chosen], TRACE) for one in (before, after)]
        return np.minimum(*each)


def spread(face, apart_mm):
    """Parameters as dense in space everywhere."""
    low, high = face.trim.low, face.trim.high
    coarse = low + (high - low) * _sequence(400)
    most = _size(face, coarse).max() * 1.1
    count = np.clip(most * np.prod(high - low) / apart_mm**2, FEWEST, MOST)
    uv = low + (high - low) * _sequence(int(count))
    uv = uv[face.trim.inside(uv)]
    size = np.concatenate([_size(face, some) for some in _shares(uv)])
    return uv[size >= most * np.random.default_rng(1).uniform(size=len(uv))]


def _shares(uv):
    return np.array_split(uv, len(uv) // SHARE + 1)


def _sequence(count):
    return np.mod(0.5 + np.arange(1, count + 1)[:, None] / (PLASTIC, PLASTIC**2), 1)


def _size(face, uv):
    _, u, v = face.evaluate(uv, 1)
    return np.linalg.norm(np.cross(u, v), axis=1)

"""Places of the faces, spread evenly, that tell what passes as they were laid really left: between two of them, and at the end."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.five import fit
from rmac_freecad.surfaces.five.ridges import left_standing
from rmac_freecad.surfaces.witnesses import spread

APART = 0.12  # of the step between passes on a plane
TRACE = 24  # samples of a curve a radius
FREE_MM = 1e-6
AT_ONCE = 16
TOLD = 1500  # places of a face, by which what is left out is told


@dataclass
class Trace:
    w: float
    centre: np.ndarray
    feed: np.ndarray
    used: np.ndarray


class Witnesses:
    def __init__(self, rows, clearance, step_mm):
        self._rows, self._clearance, self._radius = rows, clearance, rows.radius_mm
        self._family, found = rows.family, []
        for label in self._family.targets:
            uv = spread(rows.family.face(label), APART * step_mm)
            point, normal, centre = self._family.touch(label, uv)
            good = self._family.gentle(normal) & np.isfinite(centre).all(1)
            found.append([column[good] for column in (self._family.places(uv, centre), point, normal)])
        w, point, normal = (np.concatenate(column) for column in zip(*found))
        order = np.argsort(w)
        self._w, self._point, self._normal = w[order], point[order], normal[order]
        self._free = np.full(len(w), np.nan)  # where that was asked

    def trace(self, row, stretches):
        """A pass as its curves are, in many samples."""
        parts = [np.full((1, 6), np.nan)]
        for knots, poles in (curve for curves in stretches for curve in curves):
            s = np.linspace(knots[0], knots[-1], int((knots[-1] - knots[0]) / self._radius * TRACE) + 4)
            centre, _ = fit.balls(knots, poles, s, self._radius)
            ahead = np.gradient(centre, axis=0)
            parts += [np.column_stack([centre, ahead]), np.full((1, 6), np.nan)]
        both = np.concatenate(parts)
        return Trace(getattr(row, "w", math.nan), both[:, :3], both[:, 3:], np.isfinite(both[:, 0]))

    def highest(self, before, after, limit_mm):
        """What two traces leave at most of a place between them that the mill gets to, and the place; where that is no more than the
        limit, 0 and None."""
        chosen = np.arange(*np.searchsorted(self._w, (before.w, after.w)))
        if not len(chosen):
            return 0.0, None
        up = np.minimum(*(left_standing(self._radius, one.centre, one.used, self._point[chosen], self._normal[chosen]) for one in (before, after)))
        high = np.flatnonzero(up > limit_mm)
        high = high[np.argsort(-up[high])]
        for some in np.array_split(high, math.ceil(len(high) / AT_ONCE)) if len(high) else ():
            free = some[self._gets_to(chosen[some], before, after)]
            if len(free):
                return up[free[0]], self._point[chosen[free[0]]]
        return 0.0, None

    def _gets_to(self, index, *traces):
        asked = index[np.isnan(self._free[index])]
        if len(asked):
            ideal = self._point[asked] + self._radius * self._normal[asked]
            free = self._clearance(ideal) >= self._radius - FREE_MM
            cut = [one for one in traces if one.used.any()]
            if free.any() and cut:
                centres, feeds = (np.concatenate([getattr(one, name)[one.used] for one in cut]) for name in ("centre", "feed"))
                free[free] = self._rows.comes(self._point[asked[free]], self._normal[asked[free]], centres, feeds)
            self._free[asked] = free
        return self._free[index] == 1

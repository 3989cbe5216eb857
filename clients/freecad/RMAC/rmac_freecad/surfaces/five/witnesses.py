"""Places of the faces, spread evenly, that tell what passes as they were laid really left: between two of them, and at the end."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.five import fit, solid
from rmac_freecad.surfaces.five.ridges import Line, joined, left_standing
from rmac_freecad.surfaces.witnesses import spread

APART = 0.12  # of the step between passes on a plane
TRACE = 24  # samples of a curve a radius
FREE_MM = 1e-6
AT_ONCE = 16
MOST_ALONG = 20_000
BARRED = 0.34  # radii from its curves, where a pass was to go and does not


@dataclass
class Trace:
    w: float
    line: Line
    barred: np.ndarray  # centres of the ball where the rest of the mill keeps it from going


class Witnesses:
    def __init__(self, rows, clearance, step_mm):
        self._rows, self._clearance, self._mill = rows, clearance, rows.mill
        self._spacing = self._mill.radius_mm / TRACE
        self._family, found = rows.family, []
        for label in self._family.targets:
            face = rows.family.face(label)
            uv = spread(face, APART * step_mm)
            uv = np.concatenate([uv, *(_along(face, loop, APART * step_mm) for loop in face.trim.loops)]) if self._mill.flat_mm else uv
            point, normal, centre = self._family.touch(label, uv)
            good = self._family.gentle(normal) & np.isfinite(centre).all(1)
            found.append([column[good] for column in (self._family.places(uv, centre), point, normal)])
        w, point, normal = (np.concatenate(column) for column in zip(*found))
        order = np.argsort(w)
        self._w, self._point, self._normal = w[order], point[order], normal[order]
        self._free = np.full(len(w), np.nan)  # where that was asked

    def trace(self, row, stretches):
        """A pass as its curves are, in many samples."""
        line = joined([self._line(*curve) for curves in stretches for curve in curves])
        wanted = row.places.centre[row.ball & (row.places.inside | row.used)]
        return Trace(row.w, line, wanted[_away(wanted, line.centre[line.used]) > BARRED * self._mill.radius_mm])

    def _line(self, knots, poles):
        tips, axes = fit.poses(knots, poles, np.linspace(knots[0], knots[-1], int((knots[-1] - knots[0]) / self._spacing) + 4))
        ahead = np.gradient(tips, axis=0)  # a disc leans to where it goes, and touches ahead
        return Line(solid.centres(self._mill, tips, -ahead, axes), np.ones(len(tips), bool), tips, axes, self._spacing)

    def highest(self, before, after, limit_mm):
        """What two traces leave at most of a place between them that the mill gets to, and the place; where that is no more than the
        limit, 0 and None. Not where the mill's side bars the way: more passes would not get there either."""
        chosen = np.arange(*np.searchsorted(self._w, (before.w, after.w)))
        if not len(chosen):
            return 0.0, None
        up = np.minimum(*(left_standing(self._mill, one.line, self._point[chosen], self._normal[chosen]) for one in (before, after)))
        high = np.flatnonzero(up > limit_mm)
        high = high[np.argsort(-up[high])]
        for some in np.array_split(high, math.ceil(len(high) / AT_ONCE)) if len(high) else ():
            free = some[self._gets_to(chosen[some], before, after)]
            if len(free):
                return up[free[0]], self._point[chosen[free[0]]]
        return 0.0, None

    def _gets_to(self, index, *traces):
        asked = index[np.isnan(self._free[index])]
        ideal = self._point[asked] + self._mill.corner_mm * self._normal[asked]
        self._free[asked] = self._clearance(ideal) >= self._mill.corner_mm - FREE_MM
        index_free = self._free[index] == 1
        ideal = self._point[index] + self._mill.corner_mm * self._normal[index]
        cut, barred = (np.concatenate(column) for column in zip(*((one.line.centre[one.line.used], one.barred) for one in traces)))
        return index_free & (_away(ideal, cut) <= _away(ideal, barred))


def _along(face, loop, apart_mm):
    """The border of a face, where passes end and a disc leaves most."""
    loop = np.append(loop, loop[:1], 0)
    far = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(face.evaluate(loop), axis=0), axis=1))])
    even = np.linspace(0, far[-1], min(int(far[-1] / apart_mm), MOST_ALONG) + 2)
    return np.column_stack([np.interp(even, far, loop[:, k]) for k in (0, 1)])


def _away(places, others):
    return np.linalg.norm(places[:, None] - others, axis=2).min(1, initial=np.inf)

"""The part of a surface that is a face: polygons of its wires in (u, v). What lies outside by a polygon's error is touched at
the edge instead, and no height differs by more than that error's square."""

import numpy as np

POINTS = 60  # an interval of an edge's curve in (u, v)
MOST_AT_ONCE = 4_000_000


class Trim:
    def __init__(self, face):
        self.low, self.high = (np.array(face.ParameterRange[k::2]) for k in (0, 1))
        self.loops = [_loop(face, wire) for wire in face.Wires]
        size = self.high - self.low
        edge = np.concatenate(self.loops)
        on_rim = ((np.abs(edge - self.low) < 1e-9 * size) | (np.abs(edge - self.high) < 1e-9 * size)).any(1)
        self.rectangle = len(self.loops) == 1 and bool(on_rim.all())
        self._from = np.concatenate(self.loops)
        self._to = np.concatenate([np.roll(loop, -1, 0) for loop in self.loops])

    def inside(self, uv):
        found = ((uv >= self.low) & (uv <= self.high)).all(1)
        if self.rectangle:
            return found
        chosen = np.flatnonzero(found)
        for part in np.array_split(chosen, len(chosen) * len(self._from) // MOST_AT_ONCE + 1):
            found[part] = self._odd(uv[part])
        return found

    def _odd(self, uv):
        """Whether a ray along u crosses the loops an odd number of times."""
        u, v = uv[:, :1], uv[:, 1:]
        across = (self._from[:, 1] > v) != (self._to[:, 1] > v)
        rise = np.where(self._to[:, 1] == self._from[:, 1], 1, self._to[:, 1] - self._from[:, 1])
        at = self._from[:, 0] + (v - self._from[:, 1]) * (self._to[:, 0] - self._from[:, 0]) / rise
        return (across & (u < at)).sum(1) % 2 == 1


def _loop(face, wire):
    points = []
    for edge in wire.OrderedEdges:
        found = face.curveOnSurface(edge)
        curve, first, last = found[0], *found[-2:]
        knots = getattr(curve, "NbKnots", 2) if getattr(curve, "Degree", 3) > 1 else 0
        t = np.linspace(first, last, POINTS * max(knots - 1, 1) + 1 if knots else 17)
        if edge.Orientation == "Reversed":
            t = t[::-1]
        at = [curve.value(float(one)) for one in t[:-1]]
        points += [(one.x, one.y) for one in at]
    return np.array(points)

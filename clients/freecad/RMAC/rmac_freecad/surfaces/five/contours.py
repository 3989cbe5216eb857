"""Where a function over a rectangle of parameters has a value: lines of places, in their order."""

import numpy as np

PAIRS = {1: ((3, 0),), 2: ((0, 1),), 3: ((3, 1),), 4: ((1, 2),), 6: ((0, 2),), 7: ((3, 2),), 8: ((2, 3),), 9: ((2, 0),), 11: ((2, 1),), 12: ((1, 3),), 13: ((1, 0),), 14: ((0, 3),)}


class Contours:
    """Of values at the places of a grid, `values[i, j]` at (u[i], v[j])."""

    def __init__(self, u, v, values):
        self._u, self._v, self._values = u, v, values

    def at(self, level):
        """Arrays of (u, v); a closed line ends where it begins."""
        above = self._values > level
        corners = above[:-1, :-1] + 2 * above[1:, :-1] + 4 * above[1:, 1:] + 8 * above[:-1, 1:]
        known = np.isfinite(self._values)
        whole = known[:-1, :-1] & known[1:, :-1] & known[1:, 1:] & known[:-1, 1:]
        ways = {}
        for i, j in zip(*np.nonzero((corners > 0) & (corners < 15) & whole)):
            for a, b in self._pairs(corners[i, j], i, j, level):
                ends = self._edge(i, j, a), self._edge(i, j, b)
                for one, other in (ends, ends[::-1]):
                    ways.setdefault(one, []).append(other)
        return [np.array([self._place(edge, level) for edge in line]) for line in _lines(ways)]

    def _pairs(self, kind, i, j, level):
        if kind in PAIRS:
            return PAIRS[kind]
        middle = self._values[i : i + 2, j : j + 2].mean() > level
        return ((3, 2), (1, 0)) if (kind == 5) == bool(middle) else ((3, 0), (1, 2))

    def _edge(self, i, j, side):
        """Sides 0 to 3: along u at v[j], along v at u[i+1], along u at v[j+1], along v at u[i]."""
        return ((i, j, 0), (i + 1, j, 1), (i, j + 1, 0), (i, j, 1))[side]

    def _place(self, edge, level):
        i, j, axis = edge
        k, m = (i + 1, j) if axis == 0 else (i, j + 1)
        a, b = self._values[i, j], self._values[k, m]
        share = (level - a) / (b - a)
        return self._u[i] + share * (self._u[k] - self._u[i]), self._v[j] + share * (self._v[m] - self._v[j])


def _lines(ways):
    """From the ends first, then what is closed."""
    found, left = [], dict.fromkeys(sorted(ways, key=lambda edge: len(ways[edge])))
    while left:
        start = next(iter(left))
        line = [start]
        del left[start]
        while True:
            onward = next((edge for edge in ways[line[-1]] if edge in left), None)
            if onward is None:
                break
            line.append(onward)
            del left[onward]
        if len(line) > 2 and start in ways[line[-1]]:
            line.append(start)
        if len(line) > 1:
            found.append(line)
    return found

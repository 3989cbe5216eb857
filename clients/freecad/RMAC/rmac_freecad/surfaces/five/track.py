"""A line of contact on a face, by the length of the way that the centre of the ball goes along it."""

from dataclasses import dataclass

import numpy as np

DENSE = 24  # places a detail of the mill, by which the length is told
FEWEST, MOST = 48, 20_000
SHORTEST_MM = 1e-9
MEETS = 1e-6


NAMES = ("centre", "point", "normal", "feed", "inside", "bend")


@dataclass
class Places:
    centre: np.ndarray  # of the ball that touches there
    point: np.ndarray
    normal: np.ndarray  # away from the material
    feed: np.ndarray  # where that centre goes, at right angles to the normal
    inside: np.ndarray  # of the face
    bend: np.ndarray  # of the face toward the mill, 1/mm: along the feed, along and across, across

    def of(self, chosen):
        return Places(*(getattr(self, name)[chosen] for name in NAMES))


class Track:
    """Of the ball of a mill's corner. `contact(t)` gives points, normals, feeds, what is inside, and bends for parameters from `first` to `last`. Beyond both the line goes
    on straight, `over_mm` far; or round, where it is closed and a disc goes along it."""

    def __init__(self, label, contact, first, last, mill, over_mm):
        self.label, self._contact, self._radius, self.over_mm = label, contact, mill.corner_mm, over_mm
        rough = self._centres(np.linspace(first, last, FEWEST))
        steps = np.nan_to_num(np.linalg.norm(np.diff(rough, axis=0), axis=1))
        self._t = np.linspace(first, last, int(np.clip(steps.sum() / mill.detail_mm * DENSE, FEWEST, MOST)) + 1)
        steps = np.nan_to_num(np.linalg.norm(np.diff(self._centres(self._t), axis=0), axis=1))
        self._s = np.concatenate([[0], np.cumsum(np.maximum(steps, SHORTEST_MM))])
        self._slope = np.gradient(self._t, self._s)
        self.length = self._s[-1]
        self.closed = mill.flat_mm > 0 and self._ends_meet()
        self.first, self.last = -over_mm, self.length + over_mm

    def _centres(self, t):
        point, normal = self._contact(t)[:2]
        return point + self._radius * normal

    def _ends_meet(self):
        point, normal, feed, *_ = (column[[0, -1]] for column in self._contact(self._t[[0, -1]]))
        return all(np.abs(column[0] - column[1]).max() < MEETS for column in (point, normal, feed))

    def parameter(self, s):
        """Cubic between the places that are known, with one slope at each: the length is smooth."""
        i = np.clip(np.searchsorted(self._s, s, side="right") - 1, 0, len(self._s) - 2)
        wide = self._s[i + 1] - self._s[i]
        x = (s - self._s[i]) / wide
        a, b = self._t[i], self._t[i + 1]
        u, v = self._slope[i] * wide, self._slope[i + 1] * wide
        return a + x * (u + x * (3 * (b - a) - 2 * u - v + x * (u + v - 2 * (b - a))))

    def at(self, s):
        s = np.asarray(s, float)
        inner = (0 <= s) & (s <= self.length)
        within = np.where(inner, s, np.mod(s, self.length)) if self.closed else np.clip(s, 0, self.length)
        t = np.clip(self.parameter(within), min(self._t[0], self._t[-1]), max(self._t[0], self._t[-1]))
        point, normal, feed, inside, bend = self._contact(t)
        if not self.closed:
            point = point + (s - within)[:, None] * feed
        return Places(point + self._radius * normal, point, normal, feed, inside & inner, bend)

"""A pass as samples: where the tip is, what it touches, and which of them are cut."""

from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.ridges import ridge

STEEPEST_CLIMB = 12.0  # a tip that rises faster than so much a millimetre has come to a wall
STEEPEST_OVER = 2.5  # and beyond the end of what is cut: there the mill may touch with its side, where heights hang on nothing
MOST_SAMPLES = 4000


def runs(used):
    """First and last sample of each stretch that is cut."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], used.astype(int), [0]])))
    return list(zip(edges[::2], edges[1::2] - 1))


@dataclass
class Row:
    w: float
    t: np.ndarray
    tips: np.ndarray
    point: np.ndarray
    normal: np.ndarray
    core: np.ndarray  # where a target is cut
    used: np.ndarray  # and over its ends

    def runs(self):
        return runs(self.used)


class Rows:
    def __init__(self, family, drop, part, mill, spacing_mm):
        self.family, self.drop, self._mill = family, drop, mill
        self._floor = part.floor + 0.2
        first, last = family.t_range
        count = int(np.clip((last - first) * family.t_mm / spacing_mm, 40, MOST_SAMPLES)) + 1
        self.t = np.linspace(first, last, count)

    def at(self, w):
        return self._several(w)[0]

    def at_and_between(self, w, between):
        """A pass, and one that is not cut, by which its ridge is told."""
        return self._several(w, between)

    def _several(self, *wanted):
        """Together they are quicker."""
        t = self.t
        plans = [self.family.plan(w, t) for w in wanted]
        together = self.drop(np.nan_to_num(np.concatenate(plans), nan=1e9))
        found, begin = [], 0
        for w, xy in zip(wanted, plans):
            heights = together.part(begin, begin + len(t))
            begin += len(t)
            core = self.family.cuts(w, t, heights)
            found.append(Row(w, t, np.column_stack([xy, heights.z]), heights.point, heights.normal, core, core.copy()))
        return found

    def goes(self, a, b, steepest=STEEPEST_CLIMB):
        """Whether the tip may go from there to there along the part: no wall, no drop from it."""
        with np.errstate(invalid="ignore"):  # where nothing is
            climb = np.abs(b[..., 2] - a[..., 2]) <= steepest * np.linalg.norm(b[..., :2] - a[..., :2], axis=-1)
        return climb & np.isfinite(b[..., 2]) & (b[..., 2] > self._floor)

    def ridge(self, before, middle, after):
        return ridge(self._mill, before, middle, after)

    def reach(self, row, other, over_mm):
        """Lets a pass go on over its ends to where the other one, its neighbour, cuts, and somewhat farther: else places at a
        slanting border of the face would be far from both."""
        wanted = row.core | other.core
        cut = row.t[wanted]
        if not len(cut):
            return
        after = np.clip(np.searchsorted(cut, row.t), 1, len(cut) - 1) if len(cut) > 1 else np.zeros(len(row.t), int)
        away = np.minimum(np.abs(row.t - cut[after]), np.abs(row.t - cut[np.maximum(after - 1, 0)]))
        near = away * self.family.t_mm <= max(over_mm, (row.t[1] - row.t[0]) * self.family.t_mm * 1.01)
        forth, back = (self.goes(a, b, STEEPEST_OVER) for a, b in ((row.tips[:-1], row.tips[1:]), (row.tips[1:], row.tips[:-1])))
        with np.errstate(invalid="ignore"):
            ahead = _goes_ahead(row.tips)
        for i in range(1, len(near)):
            row.used[i] |= row.used[i - 1] and near[i] and forth[i - 1] and ahead[i - 1]
        for i in range(len(near) - 2, -1, -1):
            row.used[i] |= row.used[i + 1] and near[i] and back[i] and ahead[i + 1]


def _goes_ahead(tips):
    """Where the line of the pass does not turn back, as that of a face bent more than the mill does."""
    steps = np.diff(tips[:, :2], axis=0)
    ahead = np.ones(len(tips), bool)
    ahead[1:-1] = (steps[1:] * steps[:-1]).sum(1) > 0.7 * np.linalg.norm(steps[1:], axis=1) * np.linalg.norm(steps[:-1], axis=1)
    return ahead

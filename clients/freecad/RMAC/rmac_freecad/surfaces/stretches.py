"""From the samples of a pass to its curves: ends where a wall or the part's own end is, and a new curve at each kink."""

import numpy as np

from rmac_freecad.surfaces import fit

PARTS = 16  # that an interval is cut into, all looked at together
NARROWINGS = 6
JUMP = 4.0  # a contact that moves so many times as far as the tip may have gone from one place of the part to another
LEAST_MM = 0.01


class Stretches:
    def __init__(self, rows, mill, band_mm):
        self._rows, self._mill, self._band_mm = rows, mill, band_mm

    def of(self, row):
        """Lists of curves (knots, poles), each list one stretch without a gap. A run that leads up a wall between two samples, as over the
        rim of a groove, is parted there."""
        found, waiting = [], row.runs()[::-1]
        while waiting:
            first, last = waiting.pop()
            try:
                found.append(self._stretch(row, first, last))
            except fit.Upright as upright:
                waiting += _parted(first, last, int(np.searchsorted(row.t, upright.t)))
        return [curves for curves in found if curves]

    def _tips(self, w, t):
        xy = self._rows.family.plan(w, t)
        heights = self._rows.drop(np.nan_to_num(xy, nan=1e9))
        return np.column_stack([xy, heights.z]), heights

    def _stretch(self, row, first, last):
        t, tips, points = (column[first : last + 1] for column in (row.t, row.tips, row.point))
        new = [end for end in (self._end(row, last, 1), self._end(row, first, -1)) if end is not None]
        t = np.concatenate([t, [at for at, _, _ in new]])
        tips, points = (np.concatenate([column, np.reshape([end[k] for end in new], (-1, 3))]) for k, column in ((1, tips), (2, points)))
        order = np.argsort(t)
        t, tips, points = t[order], tips[order], points[order]
        if (t[-1] - t[0]) * self._rows.family.t_mm < LEAST_MM:
            return []
        kinks = self._kinks(row, t, tips, points)
        inner, z = kinks[:, 0], kinks[:, 1]
        t, z = np.concatenate([t, inner]), np.concatenate([tips[:, 2], z])
        t, index = np.unique(t, return_index=True)
        z = z[index]
        breaks = np.concatenate([[t[0]], np.sort(inner), [t[-1]]])
        return self._curves(row.w, t, z, [(a, b) for a, b in zip(breaks, breaks[1:]) if b > a])

    def _end(self, row, index, way):
        """Where the last sample's neighbour is behind a wall: how far it goes. None where it ends for another reason."""
        beyond = index + way
        if not row.core[index] or not 0 <= beyond < len(row.t):
            return None
        good, bad = row.t[index], row.t[beyond]
        tip, found = row.tips[index], None
        for _ in range(NARROWINGS):
            t = np.linspace(good, bad, PARTS + 1)[1:-1]
            tried, heights = self._tips(row.w, t)
            goes = self._rows.goes(np.concatenate([[tip], tried[:-1]]), tried) & self._rows.family.cuts(row.w, t, heights)
            count = len(t) if goes.all() else int(goes.argmin())
            bad = bad if count == len(t) else t[count]
            if count:
                good, tip = t[count - 1], tried[count - 1]
                found = good, tip, heights.point[count - 1]
        return found

    def _kinks(self, row, t, tips, points):
        """Places and heights where the contact leaps, and the slope with it."""
        moved = np.linalg.norm(np.diff(points, axis=0), axis=1)
        leaps = np.flatnonzero(moved > JUMP * np.linalg.norm(np.diff(tips, axis=0), axis=1) + 1e-6)
        if not len(leaps):
            return np.zeros((0, 2))
        low, high = t[leaps], t[leaps + 1]
        from_, to = points[leaps], points[leaps + 1]
        each = np.arange(len(leaps))
        for _ in range(NARROWINGS):
            tried = np.linspace(low, high, PARTS + 1, axis=1)
            point = self._tips(row.w, tried[:, 1:-1].ravel())[1].point.reshape(len(leaps), PARTS - 1, 3)
            point = np.concatenate([from_[:, None], point, to[:, None]], 1)
            near = np.linalg.norm(point - from_[:, None], axis=2) < np.linalg.norm(point - to[:, None], axis=2)
            near[:, -1] = False
            last = near.argmin(1) - 1
            low, high, from_, to = tried[each, last], tried[each, last + 1], point[each, last], point[each, last + 1]
        step = fit.KINK_STEP_MM / self._rows.family.t_mm
        around = np.concatenate([low - 2 * step, low - step, low, high, high + step, high + 2 * step])
        z = self._tips(row.w, around)[0][:, 2].reshape(6, -1)
        bent = np.abs((z[5] - z[4]) - (z[1] - z[0])) > fit.KINK_SLOPE * fit.KINK_STEP_MM
        inside = (low - 2 * step > t[0]) & (high + 2 * step < t[-1])
        return np.column_stack([low, z[2]])[bent & inside]

    def _curves(self, w, t, z, ranges):
        """One after the other; kinks that leap too little to be seen in the samples part them too."""
        found, waiting = [], ranges[::-1]
        while waiting:
            first, last = waiting.pop()
            try:
                found.append(self._curve(w, t, z, first, last))
            except fit.Kink as kink:
                index = np.searchsorted(t, kink.t)
                t, z = np.insert(t, index, kink.t), np.insert(z, index, kink.z)
                waiting += [(kink.t, last), (first, kink.t)]
        return found

    def _curve(self, w, t, z, first, last):
        family = self._rows.family
        plan = fit.Plan(lambda t: family.plan(w, t), first, last, self._coarse(first, last), self._band_mm)
        chosen = (t >= first) & (t <= last)

        def height_at(t):
            return self._rows.drop(plan(t)).z

        known, heights = t[chosen], z[chosen]
        if not family.straight:
            heights = height_at(known)
        return fit.fit(plan, height_at, known, heights, self._band_mm, family.t_mm)

    def _coarse(self, first, last):
        return max(int((last - first) * self._rows.family.t_mm / (4 * self._mill.radius_mm)), 1)


def _parted(first, last, after):
    """Without the way between the sample `after` a place and the one before it; the later part first."""
    if after <= first:
        parts = [(first + 1, last)]
    elif after > last:
        parts = [(first, last - 1)]
    else:
        parts = [(after, last), (first, after - 1)]
    return [(a, b) for a, b in parts if a < b]

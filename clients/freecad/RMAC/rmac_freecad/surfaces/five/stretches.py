"""From the samples of a pass to its curves, each held against the part once more as it is."""

import numpy as np

from rmac_freecad.surfaces.five import fit

PARTS, NARROWINGS = 8, 4  # an end at a wall is looked for in so many parts, so many times
LEAST_MM = 0.01
BALL_CHECKS, SIDE_CHECKS = 20, 12  # places a radius
MAY_MM = 2e-4  # that the ball is in the part by the check
TRIES = 3
ASIDE = 6  # of a radius, that is left out beside a place where it touches a second time


class Stretches:
    def __init__(self, rows, clearance, access):
        self._rows, self._clearance, self._access = rows, clearance, access
        self._radius, self._band = rows.radius_mm, rows.band_mm

    def of(self, row):
        """Lists of curves (knots, poles), each list one stretch without a gap."""
        return [[curve] for first, last in row.runs() for curve in self._stretch(row, first, last)]

    def _stretch(self, row, first, last):
        track = row.tracks[row.line[first]]
        s, angles = row.s[first : last + 1], row.angles[first : last + 1]
        begin, end = self._end(row, track, first, -1), self._end(row, track, last, 1)

        def axes_at(places, at):
            here = np.column_stack([np.interp(at, s, angles[:, k]) for k in (0, 1)])
            return self._rows.leaning.lean.axes(places.normal, places.feed, here)

        return self._laid(track, axes_at, begin, end, TRIES)

    def _laid(self, track, axes_at, begin, end, tries):
        """Where no curve fits, or it would touch the part, it is laid on both sides of that place."""
        if end - begin < LEAST_MM:
            return []
        try:
            curve = fit.fit(track, axes_at, begin, end, self._radius, self._band)
            bad = self._touching(curve)
        except fit.Unfit as kink:
            bad = np.array([kink.s])
        if not len(bad):
            return [curve]
        if not tries:
            return []
        aside = self._radius / ASIDE if tries < TRIES else fit.SHORTEST_MM
        return [one for a, b in ((begin, bad.min() - aside), (bad.max() + aside, end)) for one in self._laid(track, axes_at, a, b, tries - 1)]

    def _touching(self, curve):
        knots, poles = curve
        length = knots[-1] - knots[0]
        s = np.linspace(knots[0], knots[-1], int(length / self._radius * BALL_CHECKS) + 5)
        centres, _ = fit.balls(knots, poles, s, self._radius)
        bad = s[self._clearance(centres) < self._radius - MAY_MM]
        s = np.linspace(knots[0], knots[-1], int(length / self._radius * SIDE_CHECKS) + 3)
        centres, axes = fit.balls(knots, poles, s, self._radius)
        return np.concatenate([bad, s[~self._access(centres, axes[:, None])[:, 0]]])

    def _end(self, row, track, index, way):
        """How far it goes behind the last sample, where something is in the ball's way at the next."""
        beyond = index + way
        good = row.s[index]
        if not 0 <= beyond < len(row.s) or not np.isfinite(row.s[beyond]) or row.ball[beyond]:
            return good
        bad = row.s[beyond]
        for _ in range(NARROWINGS):
            tried = np.linspace(good, bad, PARTS + 1)[1:-1]
            free = self._rows.ball(track.at(tried))
            count = len(tried) if free.all() else int(free.argmin())
            bad = bad if count == len(tried) else tried[count]
            good = good if not count else tried[count - 1]
        return good

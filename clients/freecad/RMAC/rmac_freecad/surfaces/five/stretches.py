"""From the samples of a pass to its curves, each held against the part once more as it is."""

import numpy as np

from rmac_freecad.surfaces.five import fit

PARTS, NARROWINGS = 8, 4  # an end at a wall is looked for in so many parts, so many times
LEAST_MM = 0.01
TRIES = 3
GIVES_WAY = 8  # times, that a curve is laid anew with other angles
ASIDE = 6  # of a radius, that is left out beside a place where it touches a second time


class Stretches:
    def __init__(self, rows, touching):
        self._rows, self._touching = rows, touching
        self._mill, self._band = rows.mill, rows.band_mm

    def of(self, row):
        """Lists of curves (knots, poles), each list one stretch without a gap."""
        return [[curve] for first, last in row.runs() for curve in self._stretch(row, first, last)]

    def _stretch(self, row, first, last):
        track = row.tracks[row.line[first]]
        span = self._end(row, track, first, -1), self._end(row, track, last, 1)
        return self._laid(track, row.s[first : last + 1], row.angles[first : last + 1], *span, TRIES)

    def _laid(self, track, s, angles, begin, end, tries):
        """Where no curve fits, or it would touch the part whatever way the axis gives, it is laid on both sides of that place."""
        if end - begin < LEAST_MM:
            return []
        bad = np.zeros(0)
        for times in range(GIVES_WAY):
            try:
                curve = fit.fit(track, self._axes(s, angles), begin, end, self._mill, self._band)
                bad = self._touching(*curve)
            except fit.Unfit as kink:
                bad = np.array([kink.s])
                break
            if not len(bad):
                return [curve]
            other = self._rows.leaning.given_way(s, angles, bad, times)
            if other is None:
                break
            angles = other
        if not tries:
            return []
        aside = self._mill.radius_mm / ASIDE if tries < TRIES else fit.SHORTEST_MM
        spans = (begin, bad.min() - aside), (bad.max() + aside, end)
        return [one for a, b in spans for one in self._laid(track, s, angles, a, b, tries - 1)]

    def _axes(self, s, angles):
        def axes_at(places, at):
            here = np.column_stack([np.interp(at, s, angles[:, k]) for k in (0, 1)])
            return self._rows.leaning.lean.axes(places.normal, places.feed, here)

        return axes_at

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

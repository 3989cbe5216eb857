"""One quintic B-spline a stretch: exact in plan, and never below the heights that the part allows."""

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces import bspline

DEGREE = 5
IN_A_SPAN = 6
SHORTEST_MM = 2e-4
KINK_SLOPE = 2e-3
KINK_SPAN_MM = 0.06  # where spans are to be so short, one is looked for
KINK_STEP_MM = 1e-3
PARTS = 16
NARROWINGS = 4


class Kink(Exception):
    """The heights bend in one place, between whose sides no smooth curve can lie as near as is wanted."""

    def __init__(self, t, z):
        super().__init__(f"at {t:g}")
        self.t, self.z = t, z


class Upright(Exception):
    """The heights go up or down as a wall does there: no smooth curve is near enough, however short its spans."""

    def __init__(self, t):
        super().__init__(f"at {t:g}")
        self.t = t


class Plan:
    """A stretch of a pass as seen from above. `at` gives its places; a straight one is exact with any knots."""

    def __init__(self, at, first, last, breaks, band_mm):
        self.at = at
        self.breaks = np.linspace(first, last, breaks + 1)
        self._poles = None
        while not self._fits(band_mm):
            pass

    def _fits(self, band_mm):
        t = _filled(self.breaks, IN_A_SPAN)
        places = self.at(t)
        knots = bspline.clamped(self.breaks, DEGREE)
        self._poles = bspline.fitted(knots, DEGREE, t, places)
        off = np.linalg.norm(bspline.value(knots, DEGREE, self._poles, t) - places, axis=1)
        bad = _spans_of(self.breaks, t[off > band_mm / 2])
        if len(self.breaks) > 4000:
            raise JobRefused("the line of the pass is not smooth; take planes (along=0)")
        self._knots = knots
        if len(bad):
            self.breaks = _halved(self.breaks, bad)
        return not len(bad)

    def __call__(self, t):
        return bspline.value(self._knots, DEGREE, self._poles, t)

    def poles(self, knots):
        """The same curve with more knots."""
        t = _filled(np.unique(knots), IN_A_SPAN)
        return bspline.fitted(knots, DEGREE, t, self(t))


def fit(plan, height_at, t, z, band_mm, mm_a_unit):
    """Knots and poles of the tip's curve: at most `band_mm` above the heights and never below. `t`, `z` are what is known of them,
    both ends among them; `height_at(t)` tells more. Raises `Kink` where there is one, and `Upright`."""
    breaks = plan.breaks
    while True:
        t, z = _completed(breaks, t, z, height_at)
        knots = bspline.clamped(breaks, DEGREE)
        poles = bspline.fitted(knots, DEGREE, t, z + band_mm / 2)
        bad = _off(knots, poles, t, z, band_mm, 0.42)
        if not len(bad):
            between = (t[1:] + t[:-1]) / 2
            more = height_at(between)
            bad = _off(knots, poles, between, more, band_mm, 0.48)
            t, z = np.concatenate([t, between]), np.concatenate([z, more])
            order = np.argsort(t)
            t, z = t[order], z[order]
            if not len(bad):
                return knots, np.column_stack([plan.poles(knots), poles])
        bad = _spans_of(breaks, bad)
        for span in bad[np.diff(breaks)[bad] * mm_a_unit < KINK_SPAN_MM]:
            _refuse_kink(height_at, breaks, span, mm_a_unit)
        shortest = bad[np.diff(breaks)[bad].argmin()]
        if (breaks[shortest + 1] - breaks[shortest]) * mm_a_unit < SHORTEST_MM:
            raise Upright((breaks[shortest] + breaks[shortest + 1]) / 2)
        breaks = _halved(breaks, bad)


def _refuse_kink(height_at, breaks, span, mm_a_unit):
    low, high = breaks[span], breaks[span + 1]
    for _ in range(NARROWINGS):
        tried = np.linspace(low, high, PARTS + 1)
        most = np.abs(np.diff(height_at(tried), 2)).argmax()
        low, high = tried[most], tried[most + 2]
    step = KINK_STEP_MM / mm_a_unit
    around = np.array([low - 2 * step, low - step, low, high, high + step, high + 2 * step])
    if around[0] < breaks[0] or around[-1] > breaks[-1]:
        return
    z = height_at(around)
    steep = np.abs(np.diff(z)).max() > 10 * KINK_STEP_MM  # a wall, where no curve goes on
    if not steep and abs((z[5] - z[4]) - (z[1] - z[0])) > KINK_SLOPE * KINK_STEP_MM:
        raise Kink(around[2], z[2])


def _off(knots, poles, t, z, band_mm, share):
    above = bspline.value(knots, DEGREE, poles, t) - z
    return t[np.abs(above - band_mm / 2) > share * band_mm]


def _completed(breaks, t, z, height_at):
    """With enough samples in each span."""
    counts = np.histogram(t, breaks)[0]
    poor = np.flatnonzero(counts < IN_A_SPAN)
    if not len(poor):
        return t, z
    share = (np.arange(IN_A_SPAN) + 0.5) / IN_A_SPAN
    new = (breaks[poor][:, None] + np.diff(breaks)[poor][:, None] * share).ravel()
    new = np.setdiff1d(new, t)
    t, z = np.concatenate([t, new]), np.concatenate([z, height_at(new)])
    order = np.argsort(t)
    return t[order], z[order]


def _filled(breaks, count):
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(count) / count
    return np.append(inner.ravel(), breaks[-1])


def _spans_of(breaks, t):
    return np.unique(np.clip(np.searchsorted(breaks, t, side="right") - 1, 0, len(breaks) - 2))


def _halved(breaks, spans):
    return np.sort(np.concatenate([breaks, (breaks[spans] + breaks[spans + 1]) / 2]))

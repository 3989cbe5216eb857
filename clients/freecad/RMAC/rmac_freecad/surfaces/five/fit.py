"""One quintic B-spline a stretch, of the tip and of the tool's axis together: x y z i j k."""

import numpy as np

from rmac_freecad.surfaces import bspline
from rmac_freecad.surfaces.five import solid
from rmac_freecad.surfaces.fit import DEGREE

IN_A_SPAN = 8
SHARE = 0.35  # of the band, that the ball may be off to each side along the normal
ALONG_MM = 2e-3  # and along the pass, where that changes nothing but the feed
AXIS_DEG = 0.25
DISC_AXIS_DEG = 0.03  # of a disc, which fits the face only as it leans
SHORTEST_MM = 5e-3
PIECE = 3.0  # radii a span at first


class Unfit(Exception):
    """`s` is where no smooth curve lies near enough."""

    def __init__(self, s):
        super().__init__(f"at {s:g}")
        self.s = s


def fit(track, axes_at, first, last, mill, band_mm):
    """Knots and poles between two lengths on a track. The corner's ball is lifted off the face by half of the band; `axes_at(places, s)` tells
    the axis."""
    breaks = np.linspace(first, last, max(int((last - first) / (PIECE * mill.radius_mm)), 1) + 1)
    while True:
        s = _filled(breaks)
        knots = bspline.clamped(breaks, DEGREE)
        places = track.at(s)
        axes = axes_at(places, s)
        turned = _fitted(knots, DEGREE, s, axes)
        ball = places.centre + band_mm / 2 * places.normal
        tips = _fitted(knots, DEGREE, s, solid.tips(mill, ball, places.normal, _unit(bspline.value(knots, DEGREE, turned, s))))
        poles = np.column_stack([tips, turned])
        between = np.concatenate([s, (s[1:] + s[:-1]) / 2])
        bad = between[_off(knots, poles, track, axes_at, between, mill, band_mm)]
        if not len(bad):
            return knots, poles
        spans = np.unique(np.clip(np.searchsorted(breaks, bad, side="right") - 1, 0, len(breaks) - 2))
        short = np.diff(breaks)[spans] < SHORTEST_MM
        if short.any():
            raise Unfit(breaks[spans[short][0] : spans[short][0] + 2].mean())
        breaks = np.sort(np.concatenate([breaks, (breaks[spans] + breaks[spans + 1]) / 2]))


def poses(knots, poles, s, degree=DEGREE):
    """Tips and axes along a curve."""
    there = bspline.value(knots, degree, poles, s)
    return there[:, :3], _unit(there[:, 3:])


def _off(knots, poles, track, axes_at, s, mill, band_mm):
    places = track.at(s)
    tips, axes = poses(knots, poles, s)
    off = solid.centres(mill, tips, places.normal, axes) - places.centre - band_mm / 2 * places.normal
    along = (off * places.normal).sum(1)
    aside = np.linalg.norm(off - along[:, None] * places.normal, axis=1)
    turned = np.linalg.norm(axes - axes_at(places, s), axis=1)
    return (np.abs(along) > SHARE * band_mm) | (aside > ALONG_MM) | (turned > np.radians(DISC_AXIS_DEG if mill.flat_mm else AXIS_DEG))


def _fitted(knots, degree, t, values):
    """As `bspline.fitted`, by normal equations: quicker, and good enough for what is checked behind it."""
    rows = bspline.matrix(knots, degree, t)
    poles = np.empty((rows.shape[1], values.shape[1]))
    poles[0], poles[-1] = values[0], values[-1]
    inner = rows[:, 1:-1]
    poles[1:-1] = np.linalg.solve(inner.T @ inner, inner.T @ (values - rows[:, [0, -1]] @ poles[[0, -1]]))
    return poles


def _filled(breaks):
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(IN_A_SPAN) / IN_A_SPAN
    return np.append(inner.ravel(), breaks[-1])


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-30)

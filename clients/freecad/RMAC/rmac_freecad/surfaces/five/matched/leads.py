"""The lead at which the disc fits the face: as little as its curvature across the pass allows, and as much more as the rest of the part
wants."""

import numpy as np

from rmac_freecad.surfaces.five import solid
from rmac_freecad.surfaces.rows import runs

MOST = 75.0  # degrees
LOWEST = -1e-6  # an axis that points further down would need a spindle below the part
PLACES = 4  # a radius, where leads are looked for
MORE = (0.0, 0.3, 0.7, 1.2, 2.0, 3.0, 4.5, 6.5, 9.0, 12.0, 16.0, 21.0, 27.0, 34.0, 42.0, 50.0, 58.0, 66.0, 72.0)  # degrees above what the curvature asks for
HALVINGS = 4
AGAIN, ABOUT = 0.1, 0.5  # degrees more, twice as many each time, so many radii about a place where a curve touches


class Leads:
    """`lean` has the least lead; the mill is lifted by half of the band as curves are."""

    barred = f"bent more than the mill follows, or barred by the part, with any lead of up to {MOST:g} degrees: give a smaller mill"

    def __init__(self, lean, distance, mill, band_mm):
        self.lean, self._distance, self._mill, self._lift = lean, distance, mill, band_mm / 2

    def angles(self, places, wanted):
        """Leads, and tilts of 0, at each place that is wanted; nan where no lead does."""
        found = np.full((len(wanted), 2), np.nan)
        for first, last in runs(wanted):
            found[first : last + 1, 0] = self._way(places.of(slice(first, last + 1)))
        found[np.isfinite(found[:, 0]), 1] = 0
        return found

    def given_way(self, s, angles, bad, times):
        """More lead about places of a curve that touch; None where there is no more."""
        near = np.abs(s[:, None] - bad).min(1) / (self._mill.radius_mm * ABOUT)
        more = AGAIN * 2**times * (1 + np.cos(np.pi * np.clip(near, 0, 1))) / 2
        raised = np.minimum(angles[:, 0] + more, MOST)
        return None if (raised == angles[:, 0]).all() else np.column_stack([raised, angles[:, 1]])

    def _way(self, places):
        """Evened out over places that are far enough apart; nowhere less than what was found."""
        fitting = self._fitting(places.bend)
        step = np.linalg.norm(np.diff(places.centre, axis=0), axis=1)
        far = np.concatenate([[0], np.cumsum(step)])
        some = np.unique(np.searchsorted(far, np.linspace(0, far[-1], int(far[-1] / self._mill.radius_mm * PLACES) + 2)).clip(0, len(far) - 1))
        found = self._free(places.of(some), fitting[some])
        more = np.interp(far, far[some], found - fitting[some])
        window = int(np.ceil(self._mill.radius_mm / PLACES / max(far[-1] / max(len(far) - 1, 1), 1e-9)))
        return _evened(fitting + more, window)

    def _fitting(self, bend):
        """Degrees, at which the mill is bent as the face is across the pass, where both bend least apart; nan where none is."""
        along, twist, across = bend.T
        corner = 1 / self._mill.corner_mm
        with np.errstate(divide="ignore", invalid="ignore"):
            needed = across + np.where(twist != 0, twist**2 / np.where(along < corner, corner - along, 0), 0)
            sine = np.where(needed > 0, needed * self._mill.flat_mm / (1 - needed * self._mill.corner_mm), 0)
        fits = (needed * self._mill.corner_mm < 1) & (along < corner) & (sine < np.sin(np.radians(MOST)))
        return np.where(fits, np.maximum(np.degrees(np.arcsin(np.clip(sine, 0, 1))), self.lean.lead), np.nan)

    def _free(self, places, fitting):
        """The least leads from there on at which the mill is nowhere in the part."""
        found, below = np.full(len(fitting), np.nan), fitting.copy()
        left = np.flatnonzero(np.isfinite(fitting))
        for more in MORE:
            free = self._passes(places.of(left), fitting[left] + more)
            found[left[free]] = fitting[left[free]] + more
            below[left[~free]] = fitting[left[~free]] + more
            left = left[~free]
            if not len(left):
                break
        raised = np.flatnonzero(found > fitting)
        for _ in range(HALVINGS):
            middle = (found[raised] + below[raised]) / 2
            free = self._passes(places.of(raised), middle)
            found[raised[free]], below[raised[~free]] = middle[free], middle[~free]
        return found

    def _passes(self, places, leads):
        axes = self.lean.axes(places.normal, places.feed, np.column_stack([leads, np.zeros(len(leads))]))
        good = np.flatnonzero((axes[:, 2] >= LOWEST) & (leads <= MOST))
        lifted = places.centre[good] + self._lift * places.normal[good]
        free = np.zeros(len(leads), bool)
        free[good] = self._distance(solid.tips(self._mill, lifted, places.normal[good], axes[good]), axes[good]) >= 0
        return free


def _evened(leads, window):
    """The highest within a window to each side, and the mean of these: smooth, and nowhere less."""
    known = np.isfinite(leads)
    highest = _windows(np.where(known, leads, -np.inf), window).max(1)
    weight = np.isfinite(highest)
    mean = _windows(np.where(weight, highest, 0), window).sum(1) / np.maximum(_windows(weight, window).sum(1), 1)
    return np.where(known, mean, np.nan)


def _windows(values, window):
    return np.lib.stride_tricks.sliding_window_view(np.pad(values, window, mode="edge"), 2 * window + 1)

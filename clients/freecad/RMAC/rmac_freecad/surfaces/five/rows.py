"""A pass as samples: its lines one behind the other, where the ball and the tool's side pass, and what is cut."""

from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.five import solid
from rmac_freecad.surfaces.five.ridges import Line, left_standing
from rmac_freecad.surfaces.five.track import NAMES, Places
from rmac_freecad.surfaces.rows import runs

SAMPLES = 6  # a radius
DETAIL_SAMPLES = 3  # and a detail of the mill
OVER = 1.05  # steps: a pass goes on over its ends to places that are so near to what its neighbour cuts
MOST_BESIDE = 0.95  # of a disc
TOUCHING = 0.4  # of the band, that the lifted ball keeps off the part


@dataclass
class Row:
    w: float
    tracks: list
    line: np.ndarray  # which of the tracks; between two lines one sample is nothing
    s: np.ndarray
    places: Places
    ball: np.ndarray  # where it touches nothing else
    angles: np.ndarray  # lead and tilt
    core: np.ndarray  # where a target is cut
    used: np.ndarray  # and over its ends

    @property
    def again(self):
        """Where a line that is closed has been or will be."""
        lengths = np.array([track.length if track.closed else np.inf for track in self.tracks])
        begins = np.array([0 if track.closed else -np.inf for track in self.tracks])
        return (self.s < begins[self.line]) | (self.s > lengths[self.line])

    def runs(self):
        return runs(self.used)


class Rows:
    def __init__(self, family, clearance, leaning, mill, band_mm):
        self.family, self.leaning, self.mill, self.band_mm = family, leaning, mill, band_mm
        self._spacing = min(mill.radius_mm / SAMPLES, mill.detail_mm / DETAIL_SAMPLES)
        self._clearance = clearance

    def at(self, w):
        return self._row(w, True)

    def at_and_between(self, w, between):
        """A pass, and one that is not cut and needs no axis, by which its ridge is told."""
        return self._row(w, True), self._row(between, False)

    def _row(self, w, leans):
        tracks = self.family.tracks(w)
        lines = [np.append(_samples(track, self._spacing), np.nan) for track in tracks]
        s = np.concatenate([np.zeros(0), *lines])
        line = np.concatenate([np.zeros(0, int), *(np.full(len(one), number) for number, one in enumerate(lines))])
        found = [track.at(np.nan_to_num(one)) for track, one in zip(tracks, lines)]
        empty = {name: np.zeros((0,) if name == "inside" else (0, 3), bool if name == "inside" else float) for name in NAMES}
        places = Places(*(np.concatenate([empty[name], *(getattr(one, name) for one in found)]) for name in NAMES))
        places.centre[np.isnan(s)] = np.nan
        ball = self.ball(places)
        angles = self.leaning.angles(places, ball) if leans else np.where(ball[:, None], [0.0, 0.0], np.nan)
        core = ball & places.inside & np.isfinite(angles[:, 0])
        return Row(w, tracks, line, s, places, ball, angles, core, core.copy())

    def ball(self, places):
        """Whether it touches the part there alone, lifted as curves lift it."""
        lifted = places.centre + self.band_mm / 2 * places.normal
        return self._clearance(lifted) >= self.mill.corner_mm + TOUCHING * self.band_mm

    def reach(self, row, other, over_mm):
        """Lets a pass go on over its ends to where its neighbour cuts, else places at a slanting border would be far from both."""
        cut = other.places.centre[other.core]
        if not len(cut) or not row.core.any():
            return
        may = row.ball & np.isfinite(row.angles[:, 0]) & ~row.used
        chosen = np.flatnonzero(may)
        away = np.linalg.norm(row.places.centre[chosen][:, None] - cut, axis=2).min(1, initial=np.inf)
        may[chosen] = (away <= OVER * over_mm) & ~row.again[chosen]
        for i in range(1, len(may)):
            row.used[i] |= may[i] and row.used[i - 1]
        for i in range(len(may) - 2, -1, -1):
            row.used[i] |= may[i] and row.used[i + 1]
        if self.mill.flat_mm:
            self._run_out(row, over_mm)

    def _run_out(self, row, gap_mm):
        """A disc cuts what is beside its corner's way only when the corner is ahead of that."""
        flat, may = self.mill.flat_mm, row.ball & np.isfinite(row.angles[:, 0])
        ahead = left = self._spacing + flat - np.sqrt(flat**2 - min(gap_mm / 2, MOST_BESIDE * flat) ** 2)
        for i in range(1, len(may)):
            left = ahead if row.used[i] else left - (row.s[i] - row.s[i - 1])
            row.used[i] |= bool(left >= 0 and may[i] and row.used[i - 1])

    def ridge(self, before, middle, after):
        """As that of the heights, but only where both go beside: what their ends leave is told by witnesses."""
        chosen = np.flatnonzero(middle.core)
        for row in (before, after):
            known = np.flatnonzero(np.isfinite(row.s))
            if len(chosen) and len(known):
                away = np.linalg.norm(middle.places.centre[chosen][:, None] - row.places.centre[known], axis=2)
                chosen = chosen[row.used[known[away.argmin(1)]]]
        if not len(chosen):
            return None
        points, normals = middle.places.point[chosen], middle.places.normal[chosen]
        sides = [np.sqrt(left_standing(self.mill, self._line(row), points, normals)) for row in (before, after)]
        found = ((sides[0] + sides[1]) / 2) ** 2
        found = found[np.isfinite(found)]
        return found.max() if len(found) else None

    def _line(self, row):
        axes = self.leaning.lean.axes(row.places.normal, row.places.feed, row.angles)
        return Line(row.places.centre, row.used, solid.tips(self.mill, row.places.centre, row.places.normal, axes), axes, self._spacing)


def _samples(track, spacing):
    """Evenly, both ends of the face among them."""
    count = max(int(np.ceil(track.length / spacing)), 4)
    over = max(int(np.ceil(track.over_mm / spacing)), 1)
    outside = track.over_mm * np.arange(1, over + 1) / over
    return np.concatenate([-outside[::-1], np.linspace(0, track.length, count + 1), track.length + outside])

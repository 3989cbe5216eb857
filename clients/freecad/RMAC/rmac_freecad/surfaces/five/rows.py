"""A pass as samples: its lines one behind the other, where the ball and the tool's side pass, and what is cut."""

from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.five.ridges import left_standing
from rmac_freecad.surfaces.five.track import Places

SAMPLES = 6  # a radius
OVER = 1.05  # steps: a pass goes on over its ends to places that are so near to what its neighbour cuts
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

    def runs(self):
        """First and last sample of each stretch that is cut."""
        edges = np.flatnonzero(np.diff(np.concatenate([[0], self.used.astype(int), [0]])))
        return list(zip(edges[::2], edges[1::2] - 1))


class Rows:
    def __init__(self, family, clearance, leaning, radius_mm, band_mm):
        self.family, self.leaning, self.radius_mm, self.band_mm = family, leaning, radius_mm, band_mm
        self._clearance = clearance

    def at(self, w):
        tracks = self.family.tracks(w)
        lines = [np.append(_samples(track, self.radius_mm / SAMPLES), np.nan) for track in tracks]
        s = np.concatenate([np.zeros(0), *lines])
        line = np.concatenate([np.zeros(0, int), *(np.full(len(one), number) for number, one in enumerate(lines))])
        found = [track.at(np.nan_to_num(one)) for track, one in zip(tracks, lines)]
        names = Places.__dataclass_fields__
        empty = {name: np.zeros((0,) if name == "inside" else (0, 3), bool if name == "inside" else float) for name in names}
        places = Places(*(np.concatenate([empty[name], *(getattr(one, name) for one in found)]) for name in names))
        places.centre[np.isnan(s)] = np.nan
        ball = self.ball(places)
        angles = self.leaning.angles(places, ball)
        core = ball & places.inside & np.isfinite(angles[:, 0])
        return Row(w, tracks, line, s, places, ball, angles, core, core.copy())

    def several(self, wanted):
        return [self.at(w) for w, _ in wanted]

    def ball(self, places):
        """Whether it touches the part there alone, lifted as curves lift it."""
        lifted = places.centre + self.band_mm / 2 * places.normal
        return self._clearance(lifted) >= self.radius_mm + TOUCHING * self.band_mm

    def comes(self, points, normals, centres, feeds):
        """Whether the mill gets to places of a face at any angle, going as the nearest of these centres does."""
        ideal = points + self.radius_mm * normals
        nearest = np.linalg.norm(ideal[:, None] - centres, axis=2).argmin(1)
        feed = feeds[nearest]
        feed = feed - (feed * normals).sum(1, keepdims=True) * normals
        feed /= np.maximum(np.linalg.norm(feed, axis=1, keepdims=True), 1e-30)
        return self.leaning.passes(Places(ideal, points, normals, feed, np.ones(len(points), bool)))

    def reach(self, row, other, over_mm):
        """Lets a pass go on over its ends to where its neighbour cuts, else places at a slanting border would be far from both."""
        cut = other.places.centre[other.core]
        if not len(cut) or not row.core.any():
            return
        may = row.ball & np.isfinite(row.angles[:, 0]) & ~row.used
        chosen = np.flatnonzero(may)
        away = np.linalg.norm(row.places.centre[chosen][:, None] - cut, axis=2).min(1, initial=np.inf)
        may[chosen] = away <= OVER * over_mm
        for i in range(1, len(may)):
            row.used[i] |= may[i] and row.used[i - 1]
        for i in range(len(may) - 2, -1, -1):
            row.used[i] |= may[i] and row.used[i + 1]

    def ridge(self, before, middle, after, every):
        """As that of the heights; all samples are looked at."""
        chosen = np.flatnonzero(middle.core)
        if not len(chosen):
            return None
        points, normals = middle.places.point[chosen], middle.places.normal[chosen]
        sides = [np.sqrt(left_standing(self.radius_mm, row.places.centre, row.used, points, normals)) for row in (before, after)]
        found = ((sides[0] + sides[1]) / 2) ** 2
        found = found[np.isfinite(found)]
        return found.max() if len(found) else None


def _samples(track, spacing):
    """Evenly, both ends of the face among them."""
    count = max(int(np.ceil(track.length / spacing)), 4)
    over = max(int(np.ceil(track.over_mm / spacing)), 1)
    outside = track.over_mm * np.arange(1, over + 1) / over
    return np.concatenate([-outside[::-1], np.linspace(0, track.length, count + 1), track.length + outside])

"""The way down into the material: a helix that touches the first loop, or along that loop."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.pockets.chains import cut_from, slope_length
from rmac_freecad.pockets.refusal import PocketRefused
from rmac_freecad.pockets.tracks import ArcTrack
from rmac_freecad.profiles.pieces import FULL, Bow

WIDEST, NARROWEST = 0.9, 0.3  # radii of the tool: wider ones leave a core, narrower ones are hardly more than a plunge
TRIED = 13
SHORT = 2  # radii of the tool: along a loop that is shorter it would go round and round
MOST_TURNS = 40
NEARER_MM = 1e-6
GENTLER = 1 - 1e-3  # what a slope is planned as: fits of splines are not even to the last digit


@dataclass(frozen=True)
class Helix:
    circle: ArcTrack
    angle_deg: float

    def way(self, depth):
        turns = max(math.ceil(slope_length(depth, self.angle_deg) / self.circle.length), 1)
        return [self.circle] * turns


@dataclass(frozen=True)
class Ramp:
    tracks: tuple
    angle_deg: float

    def way(self, depth):
        length, whole = slope_length(depth, self.angle_deg), sum(track.length for track in self.tracks)
        if length > MOST_TURNS * whole:
            place = tuple(map(float, self.tracks[0].at(0.0)))
            raise PocketRefused(
                f"there is no room to go down: {length:.4g} mm of slope along a loop of {whole:.4g} mm; give a smaller tool or step-down, or a steeper ramp",
                place, self.tracks[0].name)  # fmt: skip
        return cut_from(self.tracks, length)


def entry_of(outline, first, pocket):
    """For the loop that is cut first; it ends where that begins."""
    angle = pocket.ramp_deg * GENTLER
    if pocket.entry == "helix" or is_short(first.loop, pocket):
        circle = circle_at(outline, first.loop.tracks[0], 0.0, pocket)
        if circle is not None:
            return Helix(circle, angle)
    return Ramp(first.loop.tracks, angle)


def is_short(loop, pocket):
    return loop.length < SHORT * pocket.radius_mm


def circle_at(outline, track, share, pocket):
    """The widest that touches a loop there from its inside, keeps off the walls, and goes the loop's way; None where none has room."""
    place, ahead = track.at(share), track.tangent(share)
    sense = 1 if pocket.climb else -1  # which side the pocket's middle is on
    inwards = sense * np.array([-ahead[1], ahead[0]])
    radii = pocket.radius_mm * np.linspace(WIDEST, NARROWEST, TRIED)
    away = outline.wall.nearest(place + radii[:, None] * inwards)[1]
    fits = np.flatnonzero(away >= pocket.radius_mm + radii - NEARER_MM)
    if not len(fits):
        return None
    radius = float(radii[fits[0]])
    centre = tuple(map(float, place + radius * inwards))
    return ArcTrack(Bow("", centre, radius, math.atan2(place[1] - centre[1], place[0] - centre[0]), sense * FULL))

"""What the tool leaves, told by squares that are halved where it is not yet certain: knows nothing of how the loops were made."""

import itertools
from dataclasses import dataclass, field

import numpy as np

from rmac_freecad.pockets.tracks import SideTrack
from rmac_freecad.pockets.wall import Wall
from rmac_freecad.profiles.pieces import Straight

HALVINGS = 7  # of squares as large as the tool's radius
AT_ONCE = 20_000
CHORD_MM = 1e-3  # that chords of parallels may be off, and more


@dataclass(frozen=True)
class Spot:
    place: tuple  # about its middle, x y
    area_mm2: float
    within: np.ndarray = field(repr=False, compare=False)  # places of it


def area_where(depth, low, high, size, halvings=HALVINGS):
    """Spots where `depth(places, half)` is above 0; it changes by no more than 1 a mm, and below -half nobody asks how much. The last
    squares count by their middles."""
    xs, ys = (np.arange(a, b + size, size) + size / 2 for a, b in zip(low, high))
    middles = np.array(list(itertools.product(xs, ys)))
    sure_places, sure_areas = [], []
    for halving in range(halvings + 1):
        if not len(middles):
            break
        half = size * np.sqrt(0.5)
        found = np.concatenate([depth(middles[i : i + AT_ONCE], half) for i in range(0, len(middles), AT_ONCE)])
        sure = found > (half if halving < halvings else 1e-9)
        sure_places.append(middles[sure])
        sure_areas.append(np.full(sure.sum(), size**2))
        middles = middles[~sure & (found > -half)] if halving < halvings else middles[:0]
        size /= 2
        middles = (middles[:, None] + size / 2 * np.array([(-1, -1), (1, -1), (-1, 1), (1, 1)])).reshape(-1, 2)
    if not sure_places:
        return []
    return _spots(np.concatenate(sure_places), np.concatenate(sure_areas), size * 2 ** (halvings - 1))


def _spots(places, areas, apart):
    """Those that are near to each other are one; the largest first."""
    bins = {}
    for number, key in enumerate(map(tuple, np.floor(places / apart).astype(int))):
        bins.setdefault(key, []).append(number)
    spots = []
    while bins:
        found, ahead = [], [next(iter(bins))]
        while ahead:
            x, y = ahead.pop()
            if (x, y) in bins:
                found += bins.pop((x, y))
                ahead += [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        weight = areas[found]
        spots.append(Spot(tuple(map(float, weight @ places[found] / weight.sum())), float(weight.sum()), places[found]))
    return sorted(spots, key=lambda spot: -spot.area_mm2)


def swath(loops):
    """Tells how far places are from what loops go along; from parallels of splines by chords."""
    return Wall([piece for loop in loops for track in loop.tracks for piece in _pieces(track)])


def _pieces(track):
    if not isinstance(track, SideTrack):
        return [track.piece]
    points = [tuple(point) for point in track.chords()]
    return [Straight(track.name, a, b) for a, b in zip(points, points[1:]) if a != b]


def unreached(outline, loops, radius):
    """Spots that the tool cannot get to: beside all discs of its radius that are in the pocket. `loops` are those along the walls."""
    along = swath(loops)

    def depth(places, half):
        away = outline.wall.nearest(places)[1]
        return _lower(np.where(outline.wall.inside(places), np.minimum(away, radius - away), -away), places, half, along, radius)

    return area_where(depth, *outline.wall.box, radius)


def missed(outline, levels, radius):
    """Spots that the tool's centre may be at, and that no loop clears."""
    along = swath([loop for level in levels for loop in level])

    def depth(places, half):
        away = outline.wall.nearest(places)[1]
        return _lower(np.where(outline.wall.inside(places), away - radius, -away), places, half, along, radius)

    return area_where(depth, *outline.wall.box, radius)


def _lower(depth, places, half, along, radius):
    """By what the tool clears along there, where it is not certain without."""
    open_ones = depth > -half
    depth[open_ones] = np.minimum(depth[open_ones], along.nearest(places[open_ones])[1] - radius - CHORD_MM)
    return depth

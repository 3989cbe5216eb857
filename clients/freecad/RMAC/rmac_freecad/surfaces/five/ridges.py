"""What a mill that went along a line leaves above places of a face."""

from dataclasses import dataclass

import numpy as np

from rmac_freecad.surfaces.five.solid import outside, seen_along, slopes
from rmac_freecad.surfaces.ridges import least

WINDOW = 6  # samples to each side of the nearest
BEHIND, AHEAD = 0.35, 1.05  # radii, where a disc cuts before and after its corner goes by
AT_ONCE, DISCS_AT_ONCE = 4_000_000, 300_000
NEWTON = 12
HIT_MM = 1e-6
FINER, FINE = 3, np.linspace(-1, 1, 9)  # times that it is looked between samples, a quarter as far apart each time
STEEP = 0.05  # what is met at a slope less than that stands higher than elsewhere along the line


@dataclass
class Line:
    """Samples in their order. A ball end is told by its centres; else these are of the corner's ball."""

    centre: np.ndarray
    used: np.ndarray
    tip: np.ndarray
    axis: np.ndarray
    spacing_mm: float


def joined(lines):
    """One behind the other."""
    gap = np.full((1, 3), np.nan)
    columns = (np.concatenate([gap, *(one for line in lines for one in (getattr(line, name), gap))]) for name in ("centre", "tip", "axis"))
    centre, tip, axis = columns
    return Line(centre, np.isfinite(centre[:, 0]), tip, axis, min((line.spacing_mm for line in lines), default=1.0))


def left_standing(mill, line, points, normals):
    """Above each point along its normal; infinite where no mill comes."""
    up = np.full(len(points), np.inf)
    index = np.flatnonzero(line.used)
    if not len(index):
        return up
    cut = line.centre[index]
    ideal = points + mill.corner_mm * normals
    behind, ahead = (int(np.ceil(share * mill.radius_mm / line.spacing_mm)) for share in (BEHIND, AHEAD)) if mill.flat_mm else (WINDOW, WINDOW)
    window = np.arange(-behind, ahead + 1)
    shares = max(len(points) * len(cut) // AT_ONCE, len(points) * len(window) // DISCS_AT_ONCE) + 1
    for some in np.array_split(np.arange(len(points)), shares):
        away = (cut**2).sum(1) - 2 * ideal[some] @ cut.T
        nearest = away.argmin(1)
        up[some] = _about(index[nearest], window, mill, line, points[some], normals[some])
        if mill.flat_mm:
            bar = away[np.arange(len(some)), nearest] + line.spacing_mm**2
            away[np.abs(np.arange(len(cut)) - nearest[:, None]) <= ahead] = np.inf
            again = np.flatnonzero(away.min(1) < bar)  # by a pass that closes and goes on round: at its very end nothing is ahead
            if len(again):
                up[some[again]] = np.minimum(up[some[again]], _about(index[away[again].argmin(1)], window, mill, line, points[some[again]], normals[some[again]]))
    return up


def _about(nearest, window, mill, line, points, normals):
    near = nearest[:, None] + window
    inside = (near >= 0) & (near < len(line.centre))
    near = np.clip(near, 0, len(line.centre) - 1)
    inside &= line.used[near]
    return (_over_disc if mill.flat_mm else _over_ball)(mill, line, near, inside, points[:, None], normals[:, None])


def _over_ball(mill, line, near, inside, points, normals):
    way = np.where(inside[:, :, None], line.centre[near], 0) - points
    along = (way * normals).sum(2)
    beside = mill.radius_mm**2 - (way**2).sum(2) + along**2
    entry = np.maximum(along - np.sqrt(np.maximum(beside, 0)), 0)
    return least(np.where(inside & (beside > 0), entry, np.inf))


def _over_disc(mill, line, near, inside, points, normals):
    """Between samples, too: what the edge of a disc comes over is lowest as soon as it does."""
    axes = np.where(inside[:, :, None], line.axis[near], (0.0, 0.0, 1.0))
    found = _into_disc(mill, np.where(inside[:, :, None], line.tip[near], 0), axes, inside, points, normals)
    best = found.argmin(1)
    up, index = found[np.arange(len(found)), best], near[np.arange(len(found)), best]
    met = np.flatnonzero(np.isfinite(up))
    index, points, normals = index[met], points[met], normals[met]
    sides = [np.where((0 <= index + way) & (index + way < len(line.used)), line.used[(index + way) % len(line.used)], False) for way in (-1, 1)]
    at, width = np.zeros(len(met)), 1.0
    for _ in range(FINER):
        tried = np.clip(at[:, None] + width * FINE, -1.0 * sides[0][:, None], 1.0 * sides[1][:, None])
        tips, axes = (_through(one, index, sides, tried) for one in (line.tip, line.axis))
        axes /= np.linalg.norm(axes, axis=2, keepdims=True)
        found = _into_disc(mill, tips, axes, np.ones(tried.shape, bool), points, normals)
        best = found.argmin(1)
        at, width = tried[np.arange(len(met)), best], width / 4
        up[met] = np.minimum(up[met], found[np.arange(len(met)), best])
    return up


def _through(samples, index, sides, shares):
    """The parabola through a sample and its neighbours; the line, where there is but one."""
    middle = samples[index][:, None]
    before, after = (np.where(there[:, None, None], samples[(index + way) % len(samples)][:, None], np.nan) for way, there in zip((-1, 1), sides))
    before, after = np.where(np.isnan(before), 2 * middle - after, before), np.where(np.isnan(after), 2 * middle - before, after)
    before, after = np.where(np.isnan(before), middle, before), np.where(np.isnan(after), middle, after)
    t = shares[:, :, None]
    return middle + t * (after - before) / 2 + t**2 * (after - 2 * middle + before) / 2


def _into_disc(mill, tips, axes, inside, points, normals):
    """By Newton's method: the mill is convex, so that its distance falls ever more slowly along the normal up to where it is met."""
    ways = points - tips - mill.corner_mm * axes
    rise = (normals * axes).sum(2)
    up = np.zeros(inside.shape)
    for _ in range(NEWTON):
        place = ways + up[:, :, None] * normals
        off, height = seen_along(place, axes)
        far = outside(mill, off, height)
        outward = ((place * normals).sum(2) - height * rise) / np.maximum(off, 1e-12)
        away, along = slopes(mill, off, height)
        slope = away * outward + along * rise
        step = np.where(far > 0, far, 0) / np.maximum(-slope, 1e-3)
        up = up + step
        if not (step[inside & (slope < -STEEP)] > HIT_MM).any():
            break
    hit = outside(mill, *seen_along(ways + up[:, :, None] * normals, axes)) < HIT_MM
    return np.where(inside & hit, up, np.inf)

"""What stands between two passes: how far above a point of the face the mill passes on its closest way by."""

import numpy as np

WINDOW = 12  # samples of a pass to each side, where nothing else is said
NEWTON = 8


def left_standing(mill, row, at, points, normals, window=WINDOW):
    """Above each point along its normal, by the pass `row`; `at` are the samples of it that are nearest."""
    index = at[:, None] + np.arange(-window, window + 1)
    inside = (index >= 0) & (index < len(row.t))
    index = np.clip(index, 0, len(row.t) - 1)
    tips = row.tips[index]
    inside &= row.used[index] & np.isfinite(tips[:, :, 2])
    way = points[:, None] - np.where(np.isfinite(tips), tips, 0)
    if not mill.flat_mm:
        return least(np.where(inside, _below_ball(mill.radius_mm, way, normals), np.inf))
    if not mill.corner_mm:
        return least(np.where(inside, _below_cylinder(mill.radius_mm, way, normals), np.inf))
    up = np.zeros(way.shape[:2])
    for _ in range(NEWTON):
        place = way + up[:, :, None] * normals[:, None]
        off = np.linalg.norm(place[:, :, :2], axis=2)
        beyond = np.maximum(off - mill.flat_mm, 0)
        inside &= beyond < mill.corner_mm * 0.999
        depth = np.sqrt(np.maximum(mill.corner_mm**2 - beyond**2, 1e-12))
        height = mill.corner_mm - np.where(inside, depth, 0)
        outward = (place[:, :, :2] * normals[:, None, :2]).sum(2) / np.maximum(off, 1e-12)
        slope = normals[:, None, 2] - beyond / depth * outward
        up = up + (height - place[:, :, 2]) / np.maximum(slope, 1e-3)
    up = np.where(inside, np.maximum(up, 0), np.inf)
    return least(up)


def _below_ball(radius, way, normals):
    """Where the normal's line enters a ball, `way` leading from its lowest place."""
    centre = np.array([0, 0, radius]) - way
    along = (centre * normals[:, None]).sum(2)
    beside = radius**2 - (centre**2).sum(2) + along**2
    return np.where(beside > 0, np.maximum(along - np.sqrt(np.maximum(beside, 0)), 0), np.inf)


def _below_cylinder(radius, way, normals):
    """Where the normal's line enters a flat end: above its disc, and within its side."""
    across = normals[:, None, :2]
    a, b, c = (across**2).sum(2), (way[:, :, :2] * across).sum(2), (way[:, :, :2] ** 2).sum(2) - radius**2
    root = np.sqrt(np.maximum(b**2 - a * c, 0))
    upright = a < 1e-12
    a = np.where(upright, 1, a)
    enters, leaves = np.where(upright, 0, (-b - root) / a), np.where(upright, np.inf, (-b + root) / a)
    up = np.maximum(np.maximum(enters, -way[:, :, 2] / normals[:, None, 2]), 0)
    return np.where((b**2 >= a * c) & ~(upright & (c > 0)) & (up <= leaves), up, np.inf)


def least(up):
    """Of each line of samples, between samples, too, by the parabola through the least and its neighbours."""
    best = up.argmin(1)
    rows = np.arange(len(up))
    middle = np.clip(best, 1, up.shape[1] - 2)
    a, b, c = (up[rows, middle + k] for k in (-1, 0, 1))
    with np.errstate(invalid="ignore", divide="ignore"):
        bent = a - 2 * b + c
        between = b - (a - c) ** 2 / (8 * bent)
    good = np.isfinite(between) & (bent > 0) & (best == middle)
    return np.where(good, np.maximum(between, 0), up[rows, best])


def ridge(mill, before, middle, after):
    """The highest between two passes, by the pass in their middle, which is not cut: heights go with the square of the distance,
    so that those over the middle tell where both are equal. None where no place lies between both."""
    chosen = np.flatnonzero(middle.core & np.isfinite(middle.normal).all(1))
    points, normals = middle.point[chosen], middle.normal[chosen]
    if not len(chosen):
        return None
    sides = [np.sqrt(left_standing(mill, row, chosen, points, normals)) for row in (before, after)]
    found = ((sides[0] + sides[1]) / 2) ** 2
    found = found[np.isfinite(found)]
    return found.max() if len(found) else None

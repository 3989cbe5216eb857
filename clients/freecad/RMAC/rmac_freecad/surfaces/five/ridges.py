"""What a ball that went along a line leaves above places of a face."""

import numpy as np

from rmac_freecad.surfaces.ridges import least

WINDOW = 6  # samples to each side of the nearest
AT_ONCE = 4_000_000


def left_standing(radius, centres, used, points, normals):
    """Above each point along its normal; infinite where no ball comes. `centres` are in the order of the line, those that are used."""
    up = np.full(len(points), np.inf)
    index = np.flatnonzero(used)
    if not len(index):
        return up
    cut = centres[index]
    ideal = points + radius * normals
    for some in np.array_split(np.arange(len(points)), len(points) * len(cut) // AT_ONCE + 1):
        away = (cut**2).sum(1) - 2 * ideal[some] @ cut.T
        near = index[away.argmin(1)][:, None] + np.arange(-WINDOW, WINDOW + 1)
        inside = (near >= 0) & (near < len(centres))
        near = np.clip(near, 0, len(centres) - 1)
        inside &= used[near]
        way = np.where(inside[:, :, None], centres[near], 0) - points[some][:, None]
        along = (way * normals[some][:, None]).sum(2)
        beside = radius**2 - (way**2).sum(2) + along**2
        entry = np.maximum(along - np.sqrt(np.maximum(beside, 0)), 0)
        up[some] = least(np.where(inside & (beside > 0), entry, np.inf))
    return up

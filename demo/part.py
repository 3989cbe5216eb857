"""What a tool cut that truly was at these places: a height map of the blank, and its deviation from the ideal part.

Each cell holds the lowest height that any tool position left at the cell's centre, computed from the exact shape of the
tool, so cells do not round heights: only what lies between centres is unseen. Part frame, mm.
"""

import dataclasses

import numpy as np

CELL_MM = 0.1
SPACING_MM = 0.05  # of tool positions along the path: a ball of 4 mm leaves 0.1 um between them


@dataclasses.dataclass
class HeightMap:
    x: np.ndarray  # cell centres
    y: np.ndarray
    z: np.ndarray  # height, [y, x]
    inside: np.ndarray  # the blank in plan, [y, x]
    surface: np.ndarray  # ideal height, [y, x]
    slope: np.ndarray  # z component of the ideal surface's normal, [y, x]


def block_mask(x, y, half, corner):
    beyond = np.maximum(np.abs(np.stack(np.broadcast_arrays(x, y))) - (np.array(half) - corner).reshape(2, 1, 1), 0)
    return np.hypot(*beyond) <= corner


def blank(surface, plan, cell_mm=CELL_MM, y_range=None):
    """The blank before machining: the ideal part plus the stock allowance. `y_range` keeps a band of it only."""
    half_x, half_y = plan["block_half_mm"]
    low, high = y_range or (-half_y, half_y)
    x = np.arange(-half_x + cell_mm / 2, half_x, cell_mm)
    y = np.arange(low + cell_mm / 2, high, cell_mm)
    grid_x, grid_y = np.meshgrid(x, y)
    ideal, slope = np.zeros(grid_x.shape), np.ones(grid_x.shape)
    over = (np.abs(grid_x) < plan["part_half_mm"][0]) & (np.abs(grid_y) < plan["part_half_mm"][1])
    points, normals = surface.normal(*surface.at_xy(grid_x[over], grid_y[over]))
    ideal[over], slope[over] = points[:, 2], normals[:, 2]
    inside = block_mask(x[None, :], y[:, None], plan["block_half_mm"], plan["block_corner_mm"])
    return HeightMap(x, y, ideal + plan["stock_mm"], inside, ideal, slope)


def thinned(tips, spacing_mm=SPACING_MM):
    """Tool tips about `spacing_mm` apart along their path, taken from the recorded ones, ends included."""
    s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))])
    keep = np.searchsorted(s, np.arange(0, s[-1] + spacing_mm, spacing_mm)).clip(0, len(tips) - 1)
    return tips[np.unique(np.concatenate([[0], keep, [len(tips) - 1]]))]


def cut(part, tips, radius_mm, ball):
    """Takes away what a tool (ball end or flat end) sweeps with its tip at these positions."""
    cell = part.x[1] - part.x[0]
    reach = int(np.ceil(radius_mm / cell))
    for tip_x, tip_y, tip_z in thinned(tips):
        column, row = round((tip_x - part.x[0]) / cell), round((tip_y - part.y[0]) / cell)
        columns = slice(max(column - reach, 0), max(column + reach + 1, 0))
        rows = slice(max(row - reach, 0), max(row + reach + 1, 0))
        window = part.z[rows, columns]
        if window.size == 0:
            continue
        square = radius_mm**2 - (part.y[rows, None] - tip_y) ** 2 - (part.x[None, columns] - tip_x) ** 2
        if ball:
            height = (tip_z + radius_mm) - np.sqrt(np.maximum(square, 0))
            height[square < 0] = np.inf
        else:
            height = np.where(square >= 0, tip_z, np.inf)
        np.minimum(window, height, out=window)


def deviation_um(part):
    """Distance of the machined part from the ideal one along its normal, positive where material was left.

    To first order: the vertical distance times the normal's z; at 0.05 mm on a radius of 5 mm that is right to 0.25 um.
    NaN outside the blank.
    """
    return np.where(part.inside, (part.z - part.surface) * part.slope * 1e3, np.nan)


def summary(part):
    deviation = deviation_um(part)
    values = deviation[part.inside]
    return {
        "part_deviation_um": float(np.abs(values).max()),
        "left_um": float(values.max()),
        "gouge_um": float(-values.min()),
        "deviation_p50_um": float(np.percentile(np.abs(values), 50)),
        "deviation_p99_um": float(np.percentile(np.abs(values), 99)),
        "cells": int(part.inside.sum()),
    }

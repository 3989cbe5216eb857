"""Draws a height map as a milled piece seen from above at an angle (floating horizon, front to back)."""

import numpy as np
from scipy.ndimage import map_coordinates

METAL = np.array([0.72, 0.75, 0.79])
BACKGROUND = np.array([1.0, 1.0, 1.0])


def shaded(normals, light, view):
    """Colours of a matt metal: ambient, diffuse and a broad highlight."""
    light, view = np.asarray(light) / np.linalg.norm(light), np.asarray(view) / np.linalg.norm(view)
    diffuse = np.clip(normals @ light, 0, 1)
    half = (light + view) / np.linalg.norm(light + view)
    shine = np.clip(normals @ half, 0, 1) ** 40
    return np.clip(METAL * (0.30 + 0.66 * diffuse)[..., None] + 0.40 * shine[..., None], 0, 1)


def view(x, y, z, inside, azimuth_deg=-28, elevation_deg=38, base_mm=-7.0, pixel_mm=0.1):
    """RGB picture of the piece; `inside` masks its plan, `base_mm` is the height of its underside."""
    angle, elevation = np.radians([azimuth_deg, elevation_deg])
    reach = np.hypot(x[-1] - x[0], y[-1] - y[0]) / 2
    across = np.arange(-reach, reach, pixel_mm)
    depth = np.arange(-reach, reach, pixel_mm / 2)
    a, d = np.meshgrid(across, depth)
    plan_x, plan_y = a * np.cos(angle) - d * np.sin(angle), a * np.sin(angle) + d * np.cos(angle)
    cell = x[1] - x[0]
    where = [(plan_y - y[0]) / cell, (plan_x - x[0]) / cell]
    height = map_coordinates(np.where(inside, z, 0.0), where, order=1, mode="nearest")
    solid = map_coordinates(inside.astype(float), where, order=0, mode="constant") > 0.5
    in_picture = (plan_x > x[0]) & (plan_x < x[-1]) & (plan_y > y[0]) & (plan_y < y[-1])
    solid &= in_picture
    slope_d, slope_a = np.gradient(height, pixel_mm / 2, pixel_mm)
    normals = np.stack([-slope_a, -slope_d, np.ones_like(height)], axis=2)
    normals /= np.linalg.norm(normals, axis=2)[..., None]
    colours = shaded(normals, (-0.62, -0.30, 0.72), (0, -np.cos(elevation), np.sin(elevation)))
    top = (d * np.sin(elevation) + height * np.cos(elevation)) / pixel_mm
    foot = (d * np.sin(elevation) + base_mm * np.cos(elevation)) / pixel_mm
    low = np.floor(foot[solid].min()) - 8
    rows = int(np.ceil(top[solid].max()) - low) + 8
    picture = np.tile(BACKGROUND, (rows, len(across), 1))
    horizon = np.full(len(across), -1.0)
    column = np.arange(len(across))
    edge_light = 0.30 + 0.16 * np.cos(column / len(across) * np.pi)
    for line in range(len(depth)):
        mask = solid[line]
        if not mask.any():
            continue
        level, bottom = top[line] - low, foot[line] - low
        fresh = mask & (horizon < 0)  # the first solid cell of a column shows the side wall
        for c in column[fresh]:
            picture[int(bottom[c]) : int(level[c]) + 1, c] = METAL * edge_light[c]
        horizon[fresh] = level[fresh]
        rises = mask & (level > horizon)
        steps = int(np.ceil((level - horizon)[rises].max())) if rises.any() else 0
        for step in range(steps + 1):
            row = np.floor(horizon + step).astype(int)
            paint = rises & (row <= level)
            picture[row[paint], column[paint]] = colours[line, paint]
        horizon = np.where(rises, level, horizon)
    filled = np.any(picture != BACKGROUND, axis=2)
    columns = np.flatnonzero(filled.any(axis=0))
    return picture[::-1, max(columns[0] - 8, 0) : columns[-1] + 8]

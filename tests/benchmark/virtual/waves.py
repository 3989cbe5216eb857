"""A three-axis program whose result is known in closed form: a ball goes to and fro in straight lines up and down over a block. mm; numpy alone,
so that FreeCAD's Python reads it too."""

import numpy as np

RADIUS, CUTS_UP_TO = 3.0, 30.0
BLOCK = (40.0, 30.0, 12.0)  # its top is at z = 0, its middle at x = y = 0
PASSES, LINES = 15, 40
RESOLUTION = 0.1


def tips():
    """Of the ball, (n, 3): the corners of the lines. The first and the last of a pass are beside the block."""
    x = np.linspace(-BLOCK[0] / 2 - 2 * RADIUS, BLOCK[0] / 2 + 2 * RADIUS, LINES + 1)
    corners = []
    for n, y in enumerate(np.linspace(-BLOCK[1] / 2 + RADIUS, BLOCK[1] / 2 - RADIUS, PASSES)):
        one = np.stack([x, np.full_like(x, y), -3.5 + 1.5 * np.sin(x / 5 + n / 4)], axis=-1)
        corners.append(one if n % 2 == 0 else one[::-1])
    return np.concatenate(corners)


def off(points):
    """How far points are outside of what the ball passed, below 0 inside: the nearest of the lines' capsules."""
    middles = tips() + [0, 0, RADIUS]
    least = np.full(len(points), np.inf)
    for a, b in zip(middles[:-1], middles[1:], strict=True):
        way = b - a
        part = np.clip((points - a) @ way / (way @ way), 0, 1)
        least = np.minimum(least, np.linalg.norm(points - a - part[:, None] * way, axis=1) - RADIUS)
    return least


def deviation(corners, count=20_000):
    """(mean, 99 %, most) of how far a surface, (n, 3, 3) by its triangles, is from where the ball left it, on either side, at places spread evenly over it.
    Left out is what lies within a cell of the block's own sides and above the middles of the ball, where its cylinder cuts."""
    half_x, half_y = BLOCK[0] / 2 - 2 * RESOLUTION, BLOCK[1] / 2 - RADIUS
    random = np.random.default_rng(5)
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = corners[random.choice(len(corners), 20 * count, p=area / area.sum())]
    u, v = np.sqrt(random.random(len(chosen))), random.random(len(chosen))
    places = (1 - u)[:, None] * chosen[:, 0] + (u * (1 - v))[:, None] * chosen[:, 1] + (u * v)[:, None] * chosen[:, 2]
    x, y, z = places.T
    places = places[(np.abs(x) < half_x) & (np.abs(y) < half_y) & (z > -BLOCK[2] + 2) & (z < -2 * RESOLUTION)][:count]
    if len(places) < count:
        raise ValueError(f"of {20 * count} places on a surface of {len(corners)} triangles {len(places)} lie where the ball cut: {count} are needed")
    distance = np.abs(off(places))
    return float(distance.mean()), float(np.quantile(distance, 0.99)), float(distance.max())

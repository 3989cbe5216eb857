"""The mill as a solid that leans: a disc, as thick as its corner, on the side of which the face is touched, and the side above it
without an end."""

import numpy as np


def tips(mill, centres, normals, axes):
    """Of mills whose corners touch there: `centres` are those of the corner's ball, a corner's radius off the face."""
    return centres - mill.corner_mm * axes - _to_the_corner(mill, normals, axes)


def centres(mill, tips, normals, axes):
    """Of the corner's ball, where it is lowest against the normals."""
    return tips + mill.corner_mm * axes + _to_the_corner(mill, normals, axes)


def _to_the_corner(mill, normals, axes):
    """From the middle of the disc."""
    if not mill.flat_mm:
        return 0.0
    lowest = (normals * axes).sum(-1, keepdims=True) * axes - normals
    return mill.flat_mm * lowest / np.maximum(np.linalg.norm(lowest, axis=-1, keepdims=True), 1e-30)


def seen_along(ways, axes):
    """How far off the axis ways from the middle of the disc lead, and how far up along it."""
    up = (ways * axes).sum(-1)
    return np.sqrt(np.maximum((ways**2).sum(-1) - up**2, 0)), up


def outside(mill, off, up):
    """How far a place is outside of the mill; negative inside."""
    beyond, below = off - mill.flat_mm, -up
    return np.hypot(np.maximum(beyond, 0), np.maximum(below, 0)) + np.minimum(np.maximum(beyond, below), 0) - mill.corner_mm


def slopes(mill, off, up):
    """Of that distance: away from the axis, and up along it."""
    beyond, below = off - mill.flat_mm, -up
    rounded = (beyond > 0) & (below > 0)
    long = np.where(rounded, np.maximum(np.hypot(beyond, below), 1e-300), 1.0)
    return np.where(rounded, beyond / long, beyond >= below), np.where(rounded, -below / long, np.where(beyond >= below, 0.0, -1.0))

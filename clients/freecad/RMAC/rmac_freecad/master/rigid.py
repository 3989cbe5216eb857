"""Small turns and shifts, and what measured distances say of them."""

import math

import FreeCAD
import numpy as np

from rmac_freecad.master.refusal import MasterRefused

HELD = 1e-3  # mm of distance, root mean square, a mm of freedom; less is not held
FREEDOMS = ("place along X", "place along Y", "place along Z", "turn about X", "turn about Y", "turn about Z")


def rows(points, normals, centre):
    """How distances change when points are shifted, and turned about the centre: six columns, mm and rad."""
    return np.hstack([normals, np.cross(points - centre, normals)])


def matrix_of(turn):
    """Rodrigues."""
    angle = np.linalg.norm(turn)
    cross = np.array([[0, -turn[2], turn[1]], [turn[2], 0, -turn[0]], [-turn[1], turn[0], 0]])
    if angle < 1e-12:
        return np.eye(3) + cross
    return np.eye(3) + math.sin(angle) / angle * cross + (1 - math.cos(angle)) / angle**2 * cross @ cross


def placement_of(rotation, shift):
    flat = [*rotation[0], shift[0], *rotation[1], shift[1], *rotation[2], shift[2], 0, 0, 0, 1]
    return FreeCAD.Placement(FreeCAD.Matrix(*map(float, flat)))


def check_held(jacobian, names, scales):
    """Refused where the distances leave a freedom: one that changes them by hardly anything. `scales` are what a mm of each is."""
    scaled = jacobian / scales
    _, sizes, directions = np.linalg.svd(scaled, full_matrices=True)
    sizes = np.concatenate([sizes, np.zeros(len(directions) - len(sizes))])
    for size, direction in zip(sizes[::-1], directions[::-1]):
        if size / math.sqrt(len(jacobian)) < HELD:
            free = ", ".join(name for name, share in zip(names, direction) if abs(share) > 0.3)
            raise MasterRefused(f"the measured places do not hold its {free}; measure faces that look another way, or places farther apart")


def spread_of(points, centre):
    return max(math.sqrt(((points - centre) ** 2).sum(1).mean()), 1e-6)


def covariance(jacobian, left, instrument_mm):
    """Of the unknowns: by what is left, and no better than the instrument."""
    freedom = len(left) - jacobian.shape[1]
    if freedom < 1:
        raise MasterRefused(f"{len(left)} places were measured for {jacobian.shape[1]} unknowns; measure {jacobian.shape[1] + 1} at least, so that something tells how sure they are")
    variance = max(float(left @ left) / freedom, instrument_mm**2)
    return variance * np.linalg.inv(jacobian.T @ jacobian)

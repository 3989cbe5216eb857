"""What of the faces is not cut, and why."""

import math

import numpy as np

from rmac_freecad.surfaces.drop import tips

SAMPLES = 1500
REACHED_MM = 1e-3


def left_out(part, drop, mill, steepest):
    """Texts, with areas as samples of the faces tell them."""
    found = []
    for label in part.targets:
        points, uv = part.of_target(label)
        if not len(uv):
            continue
        chosen = np.unique(np.linspace(0, len(uv) - 1, SAMPLES).astype(int))
        face = part.faces[label]
        tip, point, normal = tips(face, mill, uv[chosen])
        tip = np.where(np.isfinite(tip), tip, point)
        _, u, v = face.evaluate(uv[chosen], 1)
        size = np.linalg.norm(np.cross(u, v), axis=1)
        steep = ~(normal[:, 2] >= math.cos(steepest))
        blocked = ~steep
        blocked[blocked] = drop(tip[blocked, :2]).z > tip[blocked, 2] + REACHED_MM
        whole = size.sum()
        for what, where in (("steeper than what is to be cut", steep), ("below other places of the part, or too narrow for the mill", blocked)):
            share = size[where].sum() / whole
            if share > 1e-3:
                found.append(f"Face{label + 1}: {100 * share:.1f} % is {what}")
    return found

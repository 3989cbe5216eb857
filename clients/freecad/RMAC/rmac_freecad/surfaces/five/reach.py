"""What of the faces is not cut by passes as they were laid, and why."""

import numpy as np

from rmac_freecad.surfaces.five.ridges import left_standing

SAMPLES = 1500
TOUCHED_MM = 1e-6
CUT = 1.5  # scallops: what stands higher was not cut
STEEP = "steeper than what is to be cut"
BLOCKED = "beside other places of the part, or too narrow for the mill"
ASIDE = "out of reach: the mill's side, up to the spindle, would touch the part with any axis that does not point down"


def left_out(body, clearance, families, traces, scallop_mm):
    """Texts, with areas as samples of the faces tell them."""
    found = []
    centre = np.concatenate([np.full((1, 3), np.nan), *(one.centre for one in traces)])
    used = np.isfinite(centre[:, 0])
    for family in families:
        for label in family.targets:
            face = family.face(label)
            uv = body.of_target(label)
            uv = uv[np.unique(np.linspace(0, len(uv) - 1, SAMPLES).astype(int))]
            point, normal, ideal = family.touch(label, uv)
            known = np.isfinite(ideal).all(1)
            uv, point, normal, ideal = uv[known], point[known], normal[known], ideal[known]
            _, u, v = face.evaluate(uv, 1)
            size = np.linalg.norm(np.cross(u, v), axis=1)
            steep = ~family.gentle(normal)
            blocked = ~steep & (clearance(ideal) < body.radius_mm - TOUCHED_MM)
            aside = ~steep & ~blocked & (left_standing(body.radius_mm, centre, used, point, normal) > CUT * scallop_mm)
            for what, where in ((STEEP, steep), (BLOCKED, blocked), (ASIDE, aside)):
                share = size[where].sum() / size.sum()
                if share > 1e-3:
                    found.append(f"Face{label + 1}: {100 * share:.1f} % is {what}")
    return found

"""What of the faces is not cut by passes as they were laid, and why."""

import numpy as np

from rmac_freecad.surfaces.five.ridges import joined, left_standing

SAMPLES = 1500
TOUCHED_MM = 1e-6
CUT = 1.5  # scallops: what stands higher was not cut
STEEP = "steeper than what is to be cut"
BLOCKED = "beside other places of the part, or too narrow for the mill"


def left_out(body, clearance, families, traces, scallop_mm, barred):
    """Texts, with areas as samples of the faces tell them; `barred` says why the ball alone gets to a place."""
    found = []
    mill, lines = body.mill, [one.line for one in traces]
    # The nearest pass leaves least of what a ball leaves, but not always of what discs do, which lean by more or less.
    lines = lines if mill.flat_mm else [joined(lines)]
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
            blocked = ~steep & (clearance(ideal) < mill.corner_mm - TOUCHED_MM)
            up = np.min([left_standing(mill, line, point, normal) for line in lines], axis=0, initial=np.inf)
            aside = ~steep & ~blocked & (up > CUT * scallop_mm)
            for what, where in ((STEEP, steep), (BLOCKED, blocked), (barred, aside)):
                share = size[where].sum() / size.sum()
                if share > 1e-3:
                    found.append(f"Face{label + 1}: {100 * share:.1f} % is {what}")
    return found

"""How the axis is to lean: by lead and tilt against the normal, along a direction of its own, or as the face is bent."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused

MOST = 80.0  # degrees from the normal
MATCHED = "matched"
LEAST, LEAST_MATCHED, MOST_MATCHED = 0.5, 3.0, 45.0  # degrees of lead; the second where none is given


@dataclass(frozen=True)
class Lean:
    """Degrees: `lead` to where the mill goes, `tilt` to the left of that; or an `axis` that never turns."""

    lead: float = 0.0
    tilt: float = 0.0
    axis: tuple | None = None
    matched: bool = False  # the lead goes with the face's curvature, and is no less than that

    def check(self, mill):
        """Raises `JobRefused`."""
        if self.matched and not mill.flat_mm:
            raise JobRefused("a ball end has no disc that could fit the face; with axis='matched' give flat_end(radius) or bull_nose(radius, corner)")
        if mill.flat_mm and not self.matched:
            raise JobRefused("with five axes faces are swept with a ball end, or with a flat end or bull nose and axis='matched'; give one of these, or neither lead_deg, tilt_deg nor axis")

    @property
    def one_way(self):
        """With a lead the axis would swing over from pass to pass, went they to and fro."""
        return self.lead != 0 and self.axis is None

    def axes(self, normal, feed, angles):
        """Unit vectors; `angles` are leads and tilts, (…, 2)."""
        if self.axis is not None:
            return np.broadcast_to(np.array(self.axis), np.broadcast_shapes(normal.shape, (*angles.shape[:-1], 3))).copy()
        lead, tilt = np.radians(angles[..., :1]), np.radians(angles[..., 1:])
        side = np.cross(normal, feed)
        return np.sin(lead) * feed + np.cos(lead) * (np.cos(tilt) * normal + np.sin(tilt) * side)


def lean_of(lead_deg, tilt_deg, axis):
    """None where nothing of them is given: then the axis stays along Z. Raises `JobRefused`."""
    if isinstance(axis, str) and axis == MATCHED:
        return _matched(lead_deg, tilt_deg)
    if axis is not None:
        if lead_deg is not None or tilt_deg is not None:
            raise JobRefused("give an axis, which never turns, or lead_deg and tilt_deg, not both")
        return Lean(axis=_direction(axis))
    if lead_deg is None and tilt_deg is None:
        return None
    angles = [0.0 if given is None else given for given in (lead_deg, tilt_deg)]
    for name, angle in zip(("lead_deg", "tilt_deg"), angles):
        if not (_number(angle) and abs(angle) <= 360):
            raise JobRefused(f"{name} is {angle!r}: give degrees against the face's normal")
    off = math.degrees(math.acos(math.cos(math.radians(angles[0])) * math.cos(math.radians(angles[1]))))
    if max(map(abs, angles)) > MOST or off > MOST + 1e-9:
        raise JobRefused(f"lead_deg {angles[0]:g} and tilt_deg {angles[1]:g} lean the tool by {off:.0f} degrees: at most {MOST:g} are possible, then its side would cut")
    return Lean(float(angles[0]), float(angles[1]))


def _matched(least_deg, tilt_deg):
    if tilt_deg is not None:
        raise JobRefused("give a tilt_deg, or axis='matched', by which the mill leans to where it goes, not both")
    if least_deg is not None and not (_number(least_deg) and LEAST <= least_deg <= MOST_MATCHED):
        raise JobRefused(f"lead_deg is {least_deg!r}: with axis='matched' give the least lead, {LEAST:g} to {MOST_MATCHED:g} degrees")
    return Lean(LEAST_MATCHED if least_deg is None else float(least_deg), matched=True)


def _number(given):
    return isinstance(given, (int, float, np.floating, np.integer)) and not isinstance(given, bool) and math.isfinite(given)


def _direction(axis):
    try:
        found = [float(one) if _number(one) else math.nan for one in axis]
    except TypeError:
        found = []
    length = math.sqrt(sum(one * one for one in found)) if len(found) == 3 else 0.0
    if not math.isfinite(length) or length < 1e-9:
        raise JobRefused(f"axis is {axis!r}: give i, j, k from the tip to the spindle")
    if found[2] < 0:
        raise JobRefused(f"axis is {axis!r}: the spindle would be below the tip; give one that does not point down")
    return tuple(one / length for one in found)

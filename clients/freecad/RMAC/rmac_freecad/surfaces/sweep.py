"""Faces of a part, swept with a mill: the passes, and the program that they are."""

import math
from dataclasses import dataclass, field

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.drop import Drop
from rmac_freecad.surfaces.families import Isolines, Planes
from rmac_freecad.surfaces.part import Part
from rmac_freecad.surfaces.passes import Passes
from rmac_freecad.surfaces.reach import left_out
from rmac_freecad.surfaces.rows import Rows
from rmac_freecad.surfaces.stretches import Stretches
from rmac_freecad.surfaces.witnesses import Witnesses

BAND_SHARE = 0.025  # of the scallop, which the curves may be above the part
SAMPLES = 6  # a radius
ABOVE = 1.01  # times the scallop: where two passes really left more, one is laid between them


@dataclass
class Swept:
    passes: list = field(default_factory=list)
    left_out: list = field(default_factory=list)  # what is not cut, and why, for people


def sweep(shape, targets, mill, *, scallop_mm, tolerance_mm=0.005, along=0.0, steepest_deg=80.0):
    """`targets` are indices of the shape's faces. Raises `JobRefused`."""
    _check(mill, scallop_mm, tolerance_mm, steepest_deg)
    steepest = math.radians(steepest_deg)
    part = Part(shape, targets, mill.radius_mm)
    drop = Drop(part, mill)
    swept = Swept(left_out=left_out(part, drop, mill, steepest))
    if along in ("u", "v"):
        families = [Isolines(part, mill, steepest, label, "uv".index(along)) for label in targets]
    else:
        families = [Planes(part, mill, steepest, angle_of(along))]
    band = min(tolerance_mm, BAND_SHARE * scallop_mm)
    for family in families:
        witnesses = Witnesses(part, drop, mill, family, steepest, math.sqrt(8 * mill.radius_mm * scallop_mm))
        rows = Rows(family, drop, part, mill, mill.radius_mm / SAMPLES)
        one = Passes(rows, Stretches(rows, mill, band), mill.radius_mm, scallop_mm - band)
        swept.passes += one.laid(witnesses, ABOVE * scallop_mm)
        swept.left_out += one.high
    if not any(one.stretches for one in swept.passes):
        raise JobRefused("nothing of the faces can be cut: " + "; ".join(swept.left_out or ["the mill does not get there"]))
    return part, drop, swept


def _check(mill, scallop_mm, tolerance_mm, steepest_deg):
    check_sizes(mill, scallop_mm, tolerance_mm, steepest_deg=steepest_deg)
    if steepest_deg > 85:
        raise JobRefused(f"steepest_deg is {steepest_deg:g}: give at most 85; what is steeper is cut with the side of a mill, or with a lead or tilt")


def check_sizes(mill, scallop_mm, tolerance_mm, **others):
    for name, value in {"scallop_mm": scallop_mm, "tolerance_mm": tolerance_mm, **others}.items():
        if isinstance(value, bool) or not isinstance(value, (int, float, np.floating)) or not math.isfinite(value) or value <= 0:
            raise JobRefused(f"{name} is {value!r}: give a number that is more than 0")
    if scallop_mm > mill.radius_mm / 4:
        raise JobRefused(f"a scallop of {scallop_mm:g} mm is more than a quarter of the mill's radius of {mill.radius_mm:g} mm; give a smaller one")
    if scallop_mm < 1e-4:
        raise JobRefused(f"a scallop of {scallop_mm:g} mm is less than 0.0001 mm; give a larger one")


def angle_of(along):
    if isinstance(along, bool) or not isinstance(along, (int, float, np.floating)) or not abs(along) <= 360:
        raise JobRefused(f"along is {along!r}: give the direction of the passes in degrees from X, or 'u' or 'v', or with five axes 'level'")
    return math.radians(along)

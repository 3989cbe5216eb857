"""Faces of a part, swept with a ball end whose axis leans against them."""

import math
from dataclasses import dataclass

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.five.access import Access
from rmac_freecad.surfaces.five.body import Body
from rmac_freecad.surfaces.five.clearance import Clearance
from rmac_freecad.surfaces.five.families import Isolines, Planes
from rmac_freecad.surfaces.five.leaning import Axes, Lean
from rmac_freecad.surfaces.five.links import Links
from rmac_freecad.surfaces.five.reach import left_out
from rmac_freecad.surfaces.five.rows import Rows
from rmac_freecad.surfaces.five.stretches import Stretches
from rmac_freecad.surfaces.five.witnesses import Witnesses
from rmac_freecad.surfaces.five.writer import Writer
from rmac_freecad.surfaces.passes import Passes
from rmac_freecad.surfaces.sweep import ABOVE, BAND_SHARE, angle_of, check_sizes

CLOSEST = 1 / 8  # of a step on a plane: there what is left is told instead
TOLD = 3  # places where passes leave more
ASIDE_MM = 5.0  # of the part, where the mill goes up beside it
OVER = 1.3  # steps, that a pass may go on beyond its face


@dataclass(frozen=True)
class Leaning:
    passes: list
    left_out: list
    links: Links
    one_way: bool

    def program(self, label, feeds, tool, rpm):
        writer = Writer(label, self.links, feeds)
        writer.begin(tool, rpm)
        for number, one in enumerate(self.passes, 1):
            curves = [curve for stretch in one.stretches for curve in stretch]
            writer.cut(number, curves if number % 2 or self.one_way else _reversed(curves))
        writer.end(rpm)
        return writer.program


def sweep(shape, targets, mill, lean: Lean, *, scallop_mm, tolerance_mm, along, steepest_deg, clear_mm):
    """`targets` are indices of the shape's faces; `along` is "u", "v", "level", or degrees from X. Raises `JobRefused`."""
    if mill.flat_mm:
        raise JobRefused("with five axes faces are swept with a ball end; give ball_end(radius), or neither lead_deg, tilt_deg nor axis")
    check_sizes(mill, scallop_mm, tolerance_mm, **({} if steepest_deg is None else {"steepest_deg": steepest_deg}))
    band_mm, step = min(tolerance_mm, BAND_SHARE * scallop_mm), math.sqrt(8 * mill.radius_mm * scallop_mm)
    direction = along if isinstance(along, str) and along in ("u", "v", "level") else angle_of(along)
    steepest = None if steepest_deg is None else math.radians(steepest_deg)
    body = Body(shape, targets, mill.radius_mm)
    clearance, access = Clearance(body), Access(body)
    if direction in ("u", "v"):
        families = [Isolines(body, label, "uv".index(direction), steepest, OVER * step) for label in targets]
    else:
        families = [Planes(body, targets, direction, steepest, OVER * step)]
    passes, traces, high = [], [], []
    for family in families:
        rows = Rows(family, clearance, Axes(lean, access), mill.radius_mm, band_mm)
        witnesses = Witnesses(rows, clearance, step)
        one = Passes(rows, Stretches(rows, clearance, access), mill.radius_mm, scallop_mm - band_mm, CLOSEST)
        laid = one.laid(witnesses, ABOVE * scallop_mm)
        passes += laid
        traces += [each.trace for each in laid]
        high += one.high[:TOLD] + ([f"and so at {len(one.high) - TOLD} other places"] if len(one.high) > TOLD else [])
    told = left_out(body, clearance, families, traces, scallop_mm)
    if not any(one.stretches for one in passes):
        raise JobRefused("nothing of the faces can be cut: " + "; ".join(told or ["the mill does not get there"]))
    return Leaning(passes, told + high, Links(body, clearance, access, clear_mm, ASIDE_MM), lean.one_way)


def _reversed(curves):
    return [(knots[0] + knots[-1] - knots[::-1], poles[::-1]) for knots, poles in curves[::-1]]

"""Faces of a part, swept with a ball end whose axis leans against them."""

import math
from dataclasses import dataclass, replace

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.five.access import Access
from rmac_freecad.surfaces.five.body import Body
from rmac_freecad.surfaces.five.clearance import Clearance
from rmac_freecad.surfaces.five.families import Isolines, Planes
from rmac_freecad.surfaces.five.lean import Lean
from rmac_freecad.surfaces.five.leaning import Axes
from rmac_freecad.surfaces.five.links import Links
from rmac_freecad.surfaces.five.matched import Distance, Leads
from rmac_freecad.surfaces.five.reach import left_out
from rmac_freecad.surfaces.five.rows import Rows
from rmac_freecad.surfaces.five.stretches import Stretches
from rmac_freecad.surfaces.five.touching import ball_touching, disc_touching
from rmac_freecad.surfaces.five.witnesses import Witnesses
from rmac_freecad.surfaces.five.writer import Writer
from rmac_freecad.surfaces.mill import ball_end
from rmac_freecad.surfaces.passes import WIDEST, Passes
from rmac_freecad.surfaces.sweep import ABOVE, BAND_SHARE, angle_of, check_sizes

CLOSEST = 1 / 8  # of a step on a plane: there what is left is told instead
TOLD = 3  # places where passes leave more
ASIDE_MM = 5.0  # of the part, where the mill goes up beside it
DISC_CLOSEST = 1 / 2  # of a disc: what passes so close to each other leave, more of them do not take away
DISC_WIDEST, CORNER_WIDEST = 1.6, 0.8  # radii of a disc, and of its corner, from pass to pass
DISC_WITNESSES = 0.4  # radii of a disc, whose ridges are wide, for the step that tells how densely they are looked at
OVER = 1.3  # steps, that a pass may go on beyond its face


@dataclass(frozen=True)
class Leaning:
    passes: list
    left_out: list
    links: Links
    one_way: bool
    spare_mm: float = 0.0  # that the mill was held larger all round
    ball_passes: int | None = None  # that a ball end of the same radius and scallop takes, where the lead is matched

    def program(self, label, feeds, tool, rpm):
        writer = Writer(label, self.links, feeds, self.spare_mm)
        writer.begin(tool, rpm)
        for number, one in enumerate(self.passes, 1):
            curves = [curve for stretch in one.stretches for curve in stretch]
            writer.cut(number, curves if number % 2 or self.one_way else _reversed(curves))
        writer.end(rpm)
        return writer.program


@dataclass(frozen=True)
class Wanted:
    scallop_mm: float
    band_mm: float
    direction: object
    steepest: float | None

    def families(self, body):
        over_mm = max(OVER * self.step_mm(body.mill), body.mill.flat_mm)
        if self.direction in ("u", "v"):
            return [Isolines(body, label, "uv".index(self.direction), self.steepest, over_mm) for label in body.targets]
        return [Planes(body, body.targets, self.direction, self.steepest, over_mm)]

    def step_mm(self, mill):
        """Of a ball end on a plane."""
        return math.sqrt(8 * mill.radius_mm * self.scallop_mm)

    def passes(self, rows, touching=None):
        mill = rows.mill
        widest = WIDEST * mill.radius_mm if not mill.flat_mm else DISC_WIDEST * mill.flat_mm + CORNER_WIDEST * mill.corner_mm
        return Passes(rows, Stretches(rows, touching), mill.radius_mm, self.scallop_mm - self.band_mm, DISC_CLOSEST if mill.flat_mm else CLOSEST, widest)


def sweep(shape, targets, mill, lean: Lean, *, scallop_mm, tolerance_mm, along, steepest_deg, clear_mm):
    """`targets` are indices of the shape's faces; `along` is "u", "v", "level", or degrees from X. Raises `JobRefused`."""
    lean.check(mill)
    check_sizes(mill, scallop_mm, tolerance_mm, **({} if steepest_deg is None else {"steepest_deg": steepest_deg}))
    if steepest_deg is not None and steepest_deg > 180:
        raise JobRefused(f"steepest_deg is {steepest_deg:g}: give at most 180, which is a face that looks straight down")
    direction = along if isinstance(along, str) and along in ("u", "v", "level") else angle_of(along)
    asked = Wanted(scallop_mm, min(tolerance_mm, BAND_SHARE * scallop_mm), direction, None if steepest_deg is None else math.radians(steepest_deg))
    spare_mm = max(asked.band_mm - mill.corner_mm, 0)  # a sharp edge is held as one that is rounded outward
    wanted = replace(asked, scallop_mm=scallop_mm - spare_mm)
    body = Body(shape, targets, mill.grown(spare_mm))
    clearance, access = Clearance(body), Access(body)
    axes, touching = _leaning(body, clearance, access, lean, wanted.band_mm)
    families = wanted.families(body)
    passes, traces, high = [], [], []
    for family in families:
        rows = Rows(family, clearance, axes, body.mill, wanted.band_mm)
        one = wanted.passes(rows, touching)
        laid = one.laid(Witnesses(rows, clearance, max(wanted.step_mm(body.mill), DISC_WITNESSES * mill.flat_mm)), ABOVE * wanted.scallop_mm)
        passes += laid
        traces += [each.trace for each in laid]
        high += one.high[:TOLD] + ([f"and so at {len(one.high) - TOLD} other places"] if len(one.high) > TOLD else [])
    told = left_out(body, clearance, families, traces, wanted.scallop_mm, axes.barred)
    if not any(one.stretches for one in passes):
        told = told or ["the mill does not get there"]
        closer = "" if lean.matched else f". Passes are up to {wanted.step_mm(mill):.3g} mm apart; what is narrower may lie between two, and a smaller scallop lays them closer"
        raise JobRefused(f"nothing of the faces can be cut: {'; '.join(told)}{closer}")
    ball_passes = _ball_passes(shape, targets, mill, lean, asked) if lean.matched else None
    return Leaning(passes, told + high, Links(body, touching, clear_mm, ASIDE_MM), lean.one_way, spare_mm, ball_passes)


def _leaning(body, clearance, access, lean, band_mm):
    """What gives axes, and what tells where a curve touches the part."""
    if lean.matched:
        distance = Distance(body)
        return Leads(lean, distance, body.mill, band_mm), disc_touching(body.mill, distance)
    return Axes(lean, access), ball_touching(body.mill, clearance, access)


def _ball_passes(shape, targets, mill, lean, wanted):
    """At the least lead; None where it could not keep the scallop."""
    body = Body(shape, targets, ball_end(mill.radius_mm))
    clearance = Clearance(body)
    axes = Axes(Lean(lean.lead), Access(body))
    try:
        return sum(len(wanted.passes(Rows(family, clearance, axes, body.mill, wanted.band_mm)).rows()) for family in wanted.families(body))
    except JobRefused:
        return None


def _reversed(curves):
    return [(knots[0] + knots[-1] - knots[::-1], poles[::-1]) for knots, poles in curves[::-1]]

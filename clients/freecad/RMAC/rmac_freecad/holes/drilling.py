"""Round holes of a part, drilled one after another, as a program."""

import math
from dataclasses import dataclass

import rmac
from rmac_freecad.jobs.drilling import drill
from rmac_freecad.jobs.mover import Mover
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.program import Program
from rmac_freecad.program.tool_number import is_tool_number

FITS_MM = 1e-3
ABOVE_MM = 1.0  # of the hole: from there on at its own feed


@dataclass(frozen=True)
class Drilling:
    """Heights are Z in the document's coordinates."""

    tool: int
    diameter_mm: float
    feed_mm_min: float
    spindle_rpm: float
    safe_mm: float  # where the tool crosses
    peck_mm: float = 0.0  # 0: down in one go
    beyond_mm: float = 0.0  # how far below a through hole's end the tip goes; as far as its point is long


@dataclass(frozen=True)
class HolePlace:
    label: str
    number: int  # of the hole, as they were given
    x: float
    y: float

    def __str__(self):
        return f"{self.label}, hole {self.number} at X {self.x:.4g} Y {self.y:.4g}"


def read_holes(label, holes, drilling, *, rapid_mm_min):
    """`holes` as `rmac_freecad.parts.recognise` finds them, in the order in which they are to be drilled. Raises `JobRefused`."""
    _check(drilling, holes)
    program = Program()
    first = HolePlace(label, 1, holes[0].x, holes[0].y)
    program.append(rmac.tool_change(drilling.tool), first)
    program.append(rmac.spindle(drilling.spindle_rpm), first)
    mover = Mover(program, rapid_mm_min)
    for number, hole in enumerate(holes, 1):
        place = HolePlace(label, number, hole.x, hole.y)
        if not abs(hole.diameter_mm - drilling.diameter_mm) < FITS_MM:
            raise JobRefused(f"it is {hole.diameter_mm:.4g} mm wide, and the drill {drilling.diameter_mm:.4g} mm; drill what is as wide, and clear the others as pockets", place)
        if drilling.safe_mm < hole.top + ABOVE_MM:
            raise JobRefused(f"the height to cross at, Z {drilling.safe_mm:g}, is at least {ABOVE_MM:g} mm above the hole's top, Z {hole.top:.4g}", place)
        mover.rapid({"X": hole.x, "Y": hole.y, "Z": drilling.safe_mm}, place)
        words = {"X": hole.x, "Y": hole.y, "Z": hole.bottom - (drilling.beyond_mm if hole.through else 0), "R": hole.top + ABOVE_MM}
        code, words = ("G83", {**words, "Q": drilling.peck_mm}) if drilling.peck_mm else ("G81", words)
        drill(mover, code, words, drilling.feed_mm_min, drilling.safe_mm, place)
    program.append(rmac.spindle(0), place)
    return program


def _check(drilling, holes):
    if not holes:
        raise JobRefused("there is no hole to be drilled")
    for name, least in (("diameter_mm", True), ("feed_mm_min", True), ("spindle_rpm", True), ("safe_mm", None), ("peck_mm", False), ("beyond_mm", False)):
        value = getattr(drilling, name)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or (least is not None and (value < 0 or (least and not value))):
            raise JobRefused(f"{name} is {value!r}; give a number{'' if least is None else ' that is more than 0' if least else ', 0 or more'}")
    if not is_tool_number(drilling.tool):
        raise JobRefused(f"the tool's number is {drilling.tool!r}; it is 1 or more")

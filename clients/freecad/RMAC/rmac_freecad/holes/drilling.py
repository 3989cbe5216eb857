"""Round holes of a part, drilled one after another, as a program."""

import math
from dataclasses import dataclass

import Part
from FreeCAD import Vector

import rmac
from rmac_freecad.jobs.drilling import drill
from rmac_freecad.jobs.mover import Mover
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.program import Program
from rmac_freecad.program.tool_number import is_tool_number

FITS_MM = 1e-3
AS_DRAWN, TIP, SHOULDER = ENDS = ("as drawn", "tip", "shoulder")
FLAT_DEG = 180.0
CLEAR = 0.001  # of the drill's radius, between a point and what it has room in


@dataclass(frozen=True)
class Drilling:
    """Heights are Z in the document's coordinates."""

    tool: int
    diameter_mm: float
    feed_mm_min: float
    spindle_rpm: float
    safe_mm: float  # where the tool crosses
    peck_mm: float = 0.0  # 0: down in one go
    beyond_mm: float = 0.0  # how far below a through hole's end it goes
    breaks_chips: bool = False  # pecks that stay in the hole
    dwell_s: float = 0.0  # at the bottom
    point_deg: float = FLAT_DEG
    end: str = AS_DRAWN  # what gets to the depth: the shoulder where the point has room below, else the tip; or either
    depth_mm: float = 0.0  # below the hole's top; 0: as deep as the hole is
    above_mm: float = 1.0  # of the hole: from there on at its own feed
    reach_mm: float = 0.0  # how far it goes into a hole; 0: nobody knows
    predrills: bool = False  # holes that are wider than it

    @property
    def point_mm(self):
        """From its tip up to where it is as wide as it gets."""
        return 0.0 if self.point_deg >= FLAT_DEG else self.diameter_mm / 2 / math.tan(math.radians(self.point_deg) / 2)

    def width_mm(self, above_tip_mm):
        return self.diameter_mm if above_tip_mm >= self.point_mm else self.diameter_mm * above_tip_mm / self.point_mm


@dataclass(frozen=True)
class HolePlace:
    label: str
    number: int  # of the hole, as they were given
    x: float
    y: float

    def __str__(self):
        return f"{self.label}, hole {self.number} at X {self.x:.4g} Y {self.y:.4g}"


class HoleRefused(Exception):
    """Why one hole is not drilled."""


def read_holes(label, holes, drilling, *, rapid_mm_min, room=None):
    """`holes` as `rmac_freecad.parts.recognise` finds them, in the order in which they are to be drilled; `room`, a `Room` of the part's faces,
    tells where points have room and which ways are free. Raises `JobRefused`."""
    check(drilling)
    if not holes:
        raise JobRefused("there is no hole to be drilled")
    tips = []
    for number, hole in enumerate(holes, 1):
        place = HolePlace(label, number, hole.x, hole.y)
        try:
            tips.append(tip_of(hole, drilling, room)[0])
        except HoleRefused as refused:
            raise JobRefused(str(refused), place) from None
        if drilling.safe_mm < hole.top + drilling.above_mm:
            raise JobRefused(f"the height to cross at, Z {drilling.safe_mm:g}, is at least {drilling.above_mm:g} mm above the hole's top, Z {hole.top:.4g}", place)
    return written(label, list(zip(holes, tips)), drilling, room, rapid_mm_min)


def tip_of(hole, drilling, room=None):
    """Z of the tip at the bottom, and what is to be said of that. Raises `HoleRefused`."""
    if hole.obstacle:
        raise HoleRefused(hole.obstacle)
    if drilling.depth_mm:
        tip, told = hole.top - drilling.depth_mm - (drilling.point_mm if drilling.end == SHOULDER else 0.0), []
        if hole.depth_mm and tip < _tip_as_drawn(hole, drilling, room)[0] - FITS_MM:
            raise HoleRefused(f"it is {hole.depth_mm:.4g} mm deep, and the tip would go {hole.top - tip:.4g} mm below its top; a depth of 0 is as deep as it is")
    elif not hole.depth_mm:
        raise HoleRefused("a circle or a point does not tell how deep; give the depth")
    else:
        tip, told = _tip_as_drawn(hole, drilling, room)
    _check_width(hole, drilling, hole.top - tip)
    if drilling.reach_mm and hole.top - tip > drilling.reach_mm + FITS_MM:
        raise HoleRefused(f"the tip goes {hole.top - tip:.4g} mm below its top, and the drill reaches {drilling.reach_mm:.4g} mm")
    wide = max(drilling.diameter_mm, hole.diameter_mm) / 2
    known = hole.faces and drilling.diameter_mm <= hole.diameter_mm + FITS_MM  # to be open above
    if room is not None and not known and not room.is_clear(hole.x, hole.y, wide, hole.top + drilling.above_mm / 2, max(room.top, hole.top) + drilling.above_mm + wide):
        raise HoleRefused("something of the part is above it")
    if hole.around_deg < 359:
        told.append(f"its wall goes round by {hole.around_deg:.0f}°")
    if hole.diameter_mm > drilling.diameter_mm + FITS_MM:
        told.append(f"{hole.diameter_mm - drilling.diameter_mm:.4g} mm narrower than it")
    return tip, told


def _tip_as_drawn(hole, drilling, room):
    point, beyond = drilling.point_mm, drilling.beyond_mm if hole.through else 0.0
    if drilling.end == TIP:
        return hole.bottom - beyond, ["the point does not come out"] if hole.through and beyond < point else []
    deep = hole.bottom - beyond - point
    has_room = not point + beyond or _has_room(hole, drilling, room, beyond)
    if drilling.end == SHOULDER or has_room:
        return deep, [] if has_room else [f"the point goes {hole.bottom - deep:.4g} mm into what is below"]
    return hole.bottom, ["the point has no room below, so its tip stops there"]


def _has_room(hole, drilling, room, beyond):
    """For the point below the end of the wall."""
    if room is None:
        return hole.through
    radius, point = (1 - CLEAR) * drilling.diameter_mm / 2, (1 - CLEAR) * drilling.point_mm
    down, end = Vector(0, 0, -1), Vector(hole.x, hole.y, hole.bottom)
    bodies = [Part.makeCylinder(radius, beyond, end, down)] if beyond else []
    bodies += [Part.makeCone(radius, 0, point, end + down * beyond, down)] if point else []
    return all(room.is_apart(body, CLEAR / 4 * min(radius, point or radius)) for body in bodies)


def _check_width(hole, drilling, depth):
    if not hole.diameter_mm:
        return
    wide = drilling.width_mm(depth)
    if wide > hole.diameter_mm + FITS_MM:
        raise HoleRefused(f"it is {hole.diameter_mm:.4g} mm wide, and the drill {drilling.diameter_mm:.4g} mm{'' if wide == drilling.diameter_mm else f', {wide:.4g} mm of it at the top'}; drill what is as wide, or take a drill that is")
    spots = drilling.depth_mm and hole.depth_mm
    if drilling.diameter_mm < hole.diameter_mm - FITS_MM and not spots and not drilling.predrills:
        raise HoleRefused(f"it is {hole.diameter_mm:.4g} mm wide, and the drill {drilling.diameter_mm:.4g} mm; drill what is as wide, predrill it, or clear it as a pocket")


def check(drilling):
    named = (
        ("drill's diameter", "diameter_mm", True), ("feed", "feed_mm_min", True), ("spindle speed", "spindle_rpm", True), ("height to cross at", "safe_mm", None),
        ("peck", "peck_mm", False), ("way beyond", "beyond_mm", False), ("dwell", "dwell_s", False), ("point's angle", "point_deg", True),
        ("depth", "depth_mm", False), ("height above the hole", "above_mm", True), ("reach", "reach_mm", False),
    )  # fmt: skip
    for what, name, least in named:
        value = getattr(drilling, name)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or (least is not None and (value < 0 or (least and not value))):
            raise JobRefused(f"the {what} ({name}) is {value!r}; give a number{'' if least is None else ' that is more than 0' if least else ', 0 or more'}")
    if not is_tool_number(drilling.tool):
        raise JobRefused(f"the tool's number is {drilling.tool!r}; it is 1 or more")
    if drilling.end not in ENDS:
        raise JobRefused(f"what gets to the depth is {drilling.end!r}; it is one of {', '.join(ENDS)}")
    if not 20 <= drilling.point_deg <= FLAT_DEG:
        raise JobRefused(f"the point's angle is {drilling.point_deg:g}°; it is 20 to 180°, and 180° is flat")
    if drilling.breaks_chips and not drilling.peck_mm:
        raise JobRefused("chips are broken in pecks; give how deep a peck is (peck_mm)")


def written(label, tipped, drilling, room, rapid_mm_min):
    """Pairs of a hole and the Z of the tip at its bottom, in their order. The tool comes and goes above all of the part."""
    program = Program()
    first = HolePlace(label, 1, tipped[0][0].x, tipped[0][0].y)
    program.append(rmac.tool_change(drilling.tool), first)
    program.append(rmac.spindle(drilling.spindle_rpm), first)
    mover = Mover(program, rapid_mm_min)
    holes = [hole for hole, _ in tipped]
    over = max([drilling.safe_mm, *(hole.top + drilling.above_mm for hole in holes)])
    over = over if room is None else max(over, room.top + drilling.above_mm)
    ups = [*(_height(one, other, drilling, room, over) for one, other in zip(holes, holes[1:])), over]
    before = over
    for number, ((hole, tip), up) in enumerate(zip(tipped, ups), 1):
        place = HolePlace(label, number, hole.x, hole.y)
        mover.rapid({"X": hole.x, "Y": hole.y, "Z": before}, place)
        words = {"X": hole.x, "Y": hole.y, "Z": tip, "R": hole.top + drilling.above_mm, "Q": drilling.peck_mm}
        drill(mover, _code(drilling), words, drilling.feed_mm_min, up, place, drilling.dwell_s)
        before = up
    program.append(rmac.spindle(0), place)
    return program


def _code(drilling):
    return "G81" if not drilling.peck_mm else "G73" if drilling.breaks_chips else "G83"


def _height(begin, end, drilling, room, over):
    """Where the tool crosses from one to the other: over the part where it is in the way."""
    low = max([drilling.safe_mm, *(hole.top + drilling.above_mm for hole in (begin, end))])
    if room is None or low >= room.top:
        return low
    way, radius = Vector(end.x - begin.x, end.y - begin.y, 0), drilling.diameter_mm / 2
    if way.Length < FITS_MM:
        return low
    aside = Vector(-way.y, way.x, 0).normalize() * radius
    start, tall = Vector(begin.x, begin.y, low), room.top - low + 1.0
    corners = [start + aside, start - aside, start - aside + way, start + aside + way, start + aside]
    wall = Part.Face(Part.makePolygon(corners)).extrude(Vector(0, 0, tall))
    ends = [Part.makeCylinder(radius, tall, place) for place in (start, start + way)]
    return low if all(room.is_apart(body, 0.0) for body in (wall, *ends)) else over

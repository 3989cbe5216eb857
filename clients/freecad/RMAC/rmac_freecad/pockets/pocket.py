"""A pocket, cleared in levels, as a program."""

import math
from dataclasses import dataclass, replace

import rmac
from rmac_freecad.pockets.area import unreached
from rmac_freecad.pockets.chains import chains_of, cleared, middles
from rmac_freecad.pockets.clash import check_part
from rmac_freecad.pockets.entries import circle_at, entry_of, is_short
from rmac_freecad.pockets.outline import Outline
from rmac_freecad.pockets.refusal import PocketRefused
from rmac_freecad.program import Program
from rmac_freecad.program.tool_number import is_tool_number

ENTRIES = ("helix", "ramp")
ORDERS = ("inside out", "outside in")
MOST_LEVELS = 10_000
OVER_MM = 0.5  # of what is cleared already: down to there as quick as may be
WIDEST = 0.95  # of the tool's diameter from loop to loop


@dataclass(frozen=True)
class Pocket:
    """Depths below `top_mm`, which is Z in the document's coordinates."""

    tool: int
    radius_mm: float
    top_mm: float
    depth_mm: float
    step_down_mm: float  # at most so deep a level
    step_over_mm: float  # from loop to loop
    safe_mm: float  # Z where the tool crosses
    feed_mm_min: float
    plunge_mm_min: float  # down slopes
    spindle_rpm: float
    entry: str = "helix"  # where it has room; ramp: along the first loop
    ramp_deg: float = 3.0  # so steep
    order: str = "inside out"
    climb: bool = True  # walls to the right of the tool


@dataclass(frozen=True)
class Cleared:
    program: Program
    area_mm2: float  # of the pocket
    unreached: tuple  # of Spot: what the tool does not get into, such as corners
    missed: tuple  # of Spot: what it would get to, and loops leave


@dataclass(frozen=True)
class Plan:
    """The way, before anybody knows the machine and its rapids."""

    outline: Outline
    pocket: Pocket
    chains: list
    entries: list
    unreached: tuple
    missed: tuple

    def program(self, label, rapid_mm_min):
        return _Clearing(label, self, rapid_mm_min).program


@dataclass(frozen=True)
class PocketPlace:
    label: str
    what: str
    z_mm: float  # where it ends

    def __str__(self):
        return f"{self.label}, {self.what}, Z {self.z_mm:.4g}"


def read_pocket(label, outline, pocket, *, rapid_mm_min):
    """`outline` as of `outline_of`. Raises `PocketRefused`."""
    plan = plan_pocket(outline, pocket)
    return Cleared(plan.program(label, rapid_mm_min), outline.wall.area(), plan.unreached, plan.missed)


def plan_pocket(outline, pocket):
    """Takes its time; touches no document."""
    check(pocket)
    levels, missed = cleared(outline, pocket.radius_mm, pocket.step_over_mm)
    check_part(outline, levels, pocket)
    chains = chains_of(outline, levels, lambda loop: _seam(outline, loop, pocket))
    if pocket.order == "outside in":
        chains = [chain[::-1] for chain in chains[::-1]]
    if not pocket.climb:
        chains = [[loop.turned() for loop in chain] for chain in chains]
    entries = [entry_of(outline, chain[0], pocket) for chain in chains]
    return Plan(outline, pocket, chains, entries, tuple(unreached(outline, levels[0], pocket.radius_mm)), tuple(missed))


def _seam(outline, loop, pocket):
    """Where a loop that nothing leads to begins: where a helix has room, in the middle of what is long."""
    there = middles(loop)
    if (pocket.entry == "helix" or is_short(loop, pocket)) and pocket.order == "inside out":
        found = (one for one in there if circle_at(outline, loop.tracks[one[0]], one[1], replace(pocket, climb=True)) is not None)
        return next(found, there[0])
    return there[0]


def check(pocket):
    named = (
        ("tool's radius", "radius_mm"), ("depth", "depth_mm"), ("step-down", "step_down_mm"), ("step-over", "step_over_mm"), ("feed", "feed_mm_min"),
        ("feed down", "plunge_mm_min"), ("spindle speed", "spindle_rpm"), ("top", "top_mm"), ("height to cross at", "safe_mm"), ("ramp", "ramp_deg"),
    )  # fmt: skip
    for what, name in named:
        value = getattr(pocket, name)
        signed = name in ("top_mm", "safe_mm")
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or not (signed or value > 0):
            given = "not given" if value is None else f"{value!r}"
            raise PocketRefused(f"the {what} ({name}) is {given}; give a number{'' if signed else ' that is more than 0'}")
    if not is_tool_number(pocket.tool):
        raise PocketRefused(f"the tool's number is {pocket.tool!r}; it is 1 or more")
    for what, value, known in (("entry", pocket.entry, ENTRIES), ("order", pocket.order, ORDERS)):
        if value not in known:
            raise PocketRefused(f"the {what} is {value!r}; it is one of {', '.join(known)}")
    if pocket.step_over_mm > WIDEST * 2 * pocket.radius_mm:
        raise PocketRefused(f"the step-over of {pocket.step_over_mm:g} mm is more than {WIDEST:.0%} of the tool's diameter; give at most {WIDEST * 2 * pocket.radius_mm:g} mm")
    if pocket.depth_mm / pocket.step_down_mm > MOST_LEVELS:
        raise PocketRefused(f"more than {MOST_LEVELS} levels of {pocket.step_down_mm:g} mm would be needed; give a larger step-down")
    if pocket.safe_mm < pocket.top_mm + OVER_MM:
        raise PocketRefused(f"the height to cross at, Z {pocket.safe_mm:g}, is at least {OVER_MM:g} mm above the top, Z {pocket.top_mm:g}")
    if pocket.ramp_deg > 45:
        raise PocketRefused(f"the ramp is {pocket.ramp_deg:g}° steep; it is at most 45°")


class _Clearing:
    def __init__(self, label, plan, rapid_mm_min):
        self.program = Program()
        self._label, self._pocket, self._rapid = label, plan.pocket, rapid_mm_min
        self._at = self._feed = None
        begin = PocketPlace(label, "begin", plan.pocket.safe_mm)
        self.program.append(rmac.tool_change(plan.pocket.tool), begin)
        self.program.append(rmac.spindle(plan.pocket.spindle_rpm), begin)
        above = plan.pocket.top_mm
        for z in self._levels():
            for chain, entry in zip(plan.chains, plan.entries):
                self._chain(chain, entry, above, z)
            above = z
        self.program.append(rmac.spindle(0), PocketPlace(label, "end", plan.pocket.safe_mm))

    def _levels(self):
        top, depth = self._pocket.top_mm, self._pocket.depth_mm
        count = math.ceil(depth / self._pocket.step_down_mm - 1e-9)
        return [top - depth * number / count for number in range(1, count + 1)]

    def _chain(self, chain, entry, above, z):
        way = entry.way(above - z)
        self._over(tuple(map(float, way[0].at(0.0))), above)
        self._along(way, z, self._pocket.plunge_mm_min, "entry", chain[0].seam)
        for loop in chain:
            if math.dist(loop.seam, self._at[:2]) > 1e-9:
                self._step(loop.seam, z)
            self._along(loop.loop.tracks, z, self._pocket.feed_mm_min, f"loop {loop.loop.distance:.4g} mm from the walls", loop.seam)
        self._rapidly((*self._at[:2], self._pocket.safe_mm), "retract")

    def _over(self, place, above):
        self._rapidly((*place, self._pocket.safe_mm), "cross")
        self._rapidly((*place, min(above + OVER_MM, self._pocket.safe_mm)), "cross")
        self._line((*place, above), self._pocket.plunge_mm_min, "entry")

    def _rapidly(self, end, what):
        if self._at is not None and math.dist(self._at, end) < 1e-9:
            return
        self._append(rmac.MoveTo(end), self._rapid, what, end)

    def _step(self, seam, z):
        self._line((*seam, z), self._pocket.feed_mm_min, "step")

    def _line(self, end, feed, what):
        self._append(rmac.Line(self._at, end), feed, what, end)

    def _along(self, tracks, z, feed, what, last=None):
        """From where the tool is, evenly to that depth."""
        begin_z, gone, total = self._at[2], 0.0, sum(track.length for track in tracks)
        for number, track in enumerate(tracks, 1):
            gone += track.length
            final = number == len(tracks)
            place = last if final and last is not None else tuple(map(float, track.at(1.0)))
            end = (*place, z if final else begin_z + (z - begin_z) * gone / total)
            self._append(track.move(self._at, end), feed, what if track.name == "" else f"{what}, {track.name}", end)

    def _append(self, move, feed, what, end):
        place = PocketPlace(self._label, what, end[2])
        if feed != self._feed:
            self.program.append(rmac.calls.RMAC_CAM.SetFeedrate(feed), place)
            self._feed = feed
        self.program.append(move, place)
        self._at = end

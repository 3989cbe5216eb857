"""Which holes are drilled, how deep, and why the others are not; before anybody knows the machine and its rapids."""

from dataclasses import dataclass

from rmac_freecad.holes.drilling import FITS_MM, Drilling, HoleRefused, check, tip_of, written
from rmac_freecad.holes.hole import Hole
from rmac_freecad.holes.order import short_order
from rmac_freecad.holes.room import Room
from rmac_freecad.jobs.refusal import JobRefused

TOLD = 4  # of those that are not drilled


@dataclass(frozen=True)
class HoleRow:
    hole: Hole
    is_chosen: bool
    tip: float | None  # Z of the drill's tip at the bottom; None where it is not drilled
    told: str

    @property
    def is_missing(self):
        """Chosen, and not drilled."""
        return self.is_chosen and self.tip is None


@dataclass(frozen=True)
class Plan:
    rows: tuple
    tipped: tuple  # holes with the Z of the tip, in their order
    drilling: Drilling
    room: Room

    def program(self, label, rapid_mm_min):
        if not self.tipped:
            raise JobRefused(self._none())
        return written(label, self.tipped, self.drilling, self.room, rapid_mm_min)

    @property
    def told(self):
        count = len(self.tipped)
        text = f"{count} hole{' is' if count == 1 else 's are'} drilled"
        missing = [row for row in self.rows if row.is_missing]
        return f"{text}; {len(missing)} chosen {'one is' if len(missing) == 1 else 'ones are'} not: {_named(missing)}." if missing else f"{text}."

    def _none(self):
        missing = [row for row in self.rows if row.is_missing]
        if missing:
            return f"no hole is drilled: {_named(missing)}"
        return "no hole is drilled: none is as wide as those that are chosen; tick a diameter"


def plan_holes(holes, drilling, room, diameters):
    """`diameters` of those that are drilled; 0 is points. Takes its time; touches no document."""
    check(drilling)
    rows = tuple(_row(hole, drilling, room, any(abs(hole.diameter_mm - one) < FITS_MM for one in diameters)) for hole in holes)
    drilled = [(row.hole, row.tip) for row in rows if row.tip is not None]
    return Plan(rows, tuple(drilled[number] for number in short_order([(hole.x, hole.y) for hole, _ in drilled])), drilling, room)


def _row(hole, drilling, room, is_chosen):
    if not is_chosen:
        return HoleRow(hole, False, None, hole.obstacle)
    try:
        tip, told = tip_of(hole, drilling, room)
    except HoleRefused as refused:
        return HoleRow(hole, True, None, str(refused))
    return HoleRow(hole, True, tip, "; ".join(told))


def _named(rows):
    told = "; ".join(f"{_of(row.hole)}: {row.told}" for row in rows[:TOLD])
    return f"{told}{f'; and {len(rows) - TOLD} more' if len(rows) > TOLD else ''}"


def _of(hole):
    return f"{f'Ø {hole.diameter_mm:.4g} mm' if hole.diameter_mm else 'the point'} at X {hole.x:.4g} Y {hole.y:.4g}"

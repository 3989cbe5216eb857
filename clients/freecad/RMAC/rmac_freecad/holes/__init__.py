"""Round holes found and drilled, without a Path job."""

from rmac_freecad.holes.chosen import Source, holes_of, room_of
from rmac_freecad.holes.drilling import ENDS, Drilling, HoleRefused, read_holes, tip_of
from rmac_freecad.holes.feature import drilling_of, drillings, is_drilling
from rmac_freecad.holes.finding import holes_in
from rmac_freecad.holes.hole import Hole
from rmac_freecad.holes.order import short_order
from rmac_freecad.holes.plan import HoleRow, Plan, plan_holes
from rmac_freecad.holes.room import Room

__all__ = ["ENDS", "Drilling", "Hole", "HoleRefused", "HoleRow", "Plan", "Room", "Source", "drilling_of", "drillings", "holes_in", "holes_of",
           "is_drilling", "plan_holes", "read_holes", "room_of", "short_order", "tip_of"]  # fmt: skip

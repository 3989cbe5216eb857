"""Pockets cleared on faces and sketches, without a Path job: by loops that are exactly beside the walls."""

from rmac_freecad.pockets.area import Spot
from rmac_freecad.pockets.feature import is_pocket, pocket_of, pockets
from rmac_freecad.pockets.outline import Outline, outline_of
from rmac_freecad.pockets.pocket import ENTRIES, ORDERS, Cleared, Pocket, Plan, PocketPlace, plan_pocket, read_pocket
from rmac_freecad.pockets.refusal import PocketRefused

__all__ = ["ENTRIES", "ORDERS", "Cleared", "Outline", "Plan", "Pocket", "PocketPlace", "PocketRefused", "Spot", "is_pocket",
           "outline_of", "plan_pocket", "pocket_of", "pockets", "read_pocket"]  # fmt: skip

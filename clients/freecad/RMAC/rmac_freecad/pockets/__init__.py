"""Pockets cleared on faces and sketches, without a Path job: by loops that are exactly beside the walls."""

from rmac_freecad.pockets.area import Spot
from rmac_freecad.pockets.outline import Outline, outline_of
from rmac_freecad.pockets.pocket import ENTRIES, ORDERS, Cleared, Pocket, PocketPlace, read_pocket
from rmac_freecad.pockets.refusal import PocketRefused

__all__ = ["ENTRIES", "ORDERS", "Cleared", "Outline", "Pocket", "PocketPlace", "PocketRefused", "Spot", "outline_of", "read_pocket"]

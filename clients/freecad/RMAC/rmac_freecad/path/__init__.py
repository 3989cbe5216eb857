"""A program as lines to be shown."""

from rmac_freecad.path.colours import DONE, LATER, LIMITS, colour_of_limit
from rmac_freecad.path.strokes import Stroke, strokes_of

__all__ = ["DONE", "LATER", "LIMITS", "Stroke", "colour_of_limit", "strokes_of"]

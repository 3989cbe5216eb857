"""Faces swept with five axes: the ball's centre goes as the face wants it, and the axis leans as it is told
or, of a bull nose or flat end, as the face is bent."""

from rmac_freecad.surfaces.five.lean import MATCHED, Lean, lean_of
from rmac_freecad.surfaces.five.sweep import Leaning, sweep

__all__ = ["MATCHED", "Lean", "Leaning", "lean_of", "sweep"]

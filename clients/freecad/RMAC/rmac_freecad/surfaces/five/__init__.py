"""Faces swept with five axes: the ball's centre goes as the face wants it, and the axis leans as it is told."""

from rmac_freecad.surfaces.five.leaning import Lean, lean_of
from rmac_freecad.surfaces.five.sweep import Leaning, sweep

__all__ = ["Lean", "Leaning", "lean_of", "sweep"]

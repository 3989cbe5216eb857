"""Faces of a part, swept with a mill on three axes, with no path of FreeCAD's between."""

from rmac_freecad.surfaces.machining import read_faces
from rmac_freecad.surfaces.mill import Mill, ball_end, bull_nose, flat_end, mill_of

__all__ = ["Mill", "ball_end", "bull_nose", "flat_end", "mill_of", "read_faces"]

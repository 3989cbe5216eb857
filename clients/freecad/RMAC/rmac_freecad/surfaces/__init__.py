"""Faces of a part, swept with a mill on three axes, with no path of FreeCAD's between."""

from rmac_freecad.surfaces.feature import is_sweep, sweep_of, sweeps
from rmac_freecad.surfaces.machining import plan_faces, read_faces
from rmac_freecad.surfaces.mill import Mill, ball_end, bull_nose, flat_end, mill_of

__all__ = ["Mill", "ball_end", "bull_nose", "flat_end", "is_sweep", "mill_of", "plan_faces", "read_faces", "sweep_of", "sweeps"]

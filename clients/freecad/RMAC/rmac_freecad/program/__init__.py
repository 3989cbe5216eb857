"""Programs for the appliance, made from jobs."""

from rmac_freecad.program.kept import keep
from rmac_freecad.program.place import Place
from rmac_freecad.program.program import Program

__all__ = ["Place", "Program", "keep"]

"""Machines that could cut a job."""

from rmac_freecad.machines.fitting import Fit, NoMachineFits, compare, fitting, programs_for
from rmac_freecad.machines.picture import NoPicture, draw
from rmac_freecad.machines.search import TYPES, Wanted

__all__ = ["TYPES", "Fit", "NoMachineFits", "NoPicture", "Wanted", "compare", "draw", "fitting", "programs_for"]

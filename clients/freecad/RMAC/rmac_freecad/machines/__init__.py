"""Machines that could cut a job."""

from rmac_freecad.machines.fitting import Fit, NoMachineFits, fitting

__all__ = ["Fit", "NoMachineFits", "fitting"]

"""The master model, held against what was measured, and corrected by it."""

from rmac_freecad.master.colours import show_deviations, update_deviations
from rmac_freecad.master.deviations import Deviations, deviations
from rmac_freecad.master.parameters import ParametersFit, correct_parameters, fit_parameters, lengths_of
from rmac_freecad.master.placement import PlacementFit, correct_placement, corrected_frame, fit_placement
from rmac_freecad.master.refusal import MasterRefused

__all__ = ["Deviations", "MasterRefused", "ParametersFit", "PlacementFit", "correct_parameters", "correct_placement", "corrected_frame",
           "deviations", "fit_parameters", "fit_placement", "lengths_of", "show_deviations", "update_deviations"]  # fmt: skip

"""A part measured by touch where it lies: places on its faces, and what the machine found there."""

from rmac_freecad.measuring.measuring import Touched, measure
from rmac_freecad.measuring.places import Place, places_on
from rmac_freecad.measuring.refusal import MeasuringRefused

__all__ = ["MeasuringRefused", "Place", "Touched", "measure", "places_on"]

"""A bull-nose or flat end whose lead goes with the face's curvature: its disc fits the face as widely as nothing is cut into."""

from rmac_freecad.surfaces.five.matched.distance import Distance
from rmac_freecad.surfaces.five.matched.leads import Leads

__all__ = ["Distance", "Leads"]

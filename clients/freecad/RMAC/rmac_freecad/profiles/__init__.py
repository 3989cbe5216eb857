"""Edges and sketches cut along, without a Path job: lines, arcs and splines as they are, on the curve or beside it."""

from rmac_freecad.profiles.contour import Contour, contour_of, edges_of
from rmac_freecad.profiles.feature import is_profile, profile_of, profiles, program_of
from rmac_freecad.profiles.offset import beside
from rmac_freecad.profiles.profile import EdgePlace, Profile, read_profile
from rmac_freecad.profiles.refusal import ProfileRefused

__all__ = [
    "Contour",
    "EdgePlace",
    "Profile",
    "ProfileRefused",
    "beside",
    "contour_of",
    "edges_of",
    "is_profile",
    "profile_of",
    "profiles",
    "program_of",
    "read_profile",
]

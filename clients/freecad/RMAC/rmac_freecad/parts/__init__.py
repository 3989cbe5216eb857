"""Parts that somebody else drew: opened, and what there is to machine found from their shape alone."""

from rmac_freecad.parts.opening import PartRefused, check_size, open_step
from rmac_freecad.parts.recognition import Found, Recess, recognise

__all__ = ["Found", "PartRefused", "Recess", "check_size", "open_step", "recognise"]

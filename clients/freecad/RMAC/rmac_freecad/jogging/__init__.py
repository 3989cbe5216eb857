"""The machine moved by hand, and the part frame set where the tool stands."""

from rmac_freecad.jogging.axis import Axis, axes_of
from rmac_freecad.jogging.hand import Hand
from rmac_freecad.jogging.held_jog import HeldJog
from rmac_freecad.jogging.part_frame import is_machine_frame, place_part
from rmac_freecad.jogging.steps import steps

__all__ = ["Axis", "Hand", "HeldJog", "axes_of", "is_machine_frame", "place_part", "steps"]

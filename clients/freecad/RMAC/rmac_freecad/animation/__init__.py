"""The machine in the document, which moves as the machine does."""

from rmac_freecad.animation.follower import Follower, answer_now
from rmac_freecad.animation.model import ABOUT_BASE, ABOUT_PART, MachineModel, draw_machine

__all__ = ["ABOUT_BASE", "ABOUT_PART", "Follower", "MachineModel", "answer_now", "draw_machine"]

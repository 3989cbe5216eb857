"""Programs machined by the appliance."""

from rmac_freecad.running.cutting import CutEnded, cut
from rmac_freecad.running.machining import Machining
from rmac_freecad.running.readiness import MachineNow, NotReady, check_part_zero, check_tools, look

__all__ = ["CutEnded", "MachineNow", "Machining", "NotReady", "check_part_zero", "check_tools", "cut", "look"]

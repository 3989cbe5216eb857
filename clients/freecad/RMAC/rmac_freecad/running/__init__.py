"""Programs machined by the appliance."""

from rmac_freecad.running.cutting import CutEnded, cut

__all__ = ["CutEnded", "cut"]

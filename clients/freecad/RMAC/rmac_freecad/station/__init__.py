"""This computer's place beside the appliance: where it is, one connection to it, and what is asked of it."""

from rmac_freecad.station.settings import Settings
from rmac_freecad.station.station import NotConnected, Station

__all__ = ["NotConnected", "Settings", "Station"]

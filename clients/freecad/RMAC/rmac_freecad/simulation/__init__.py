"""Programs planned faster than real time; nothing moves."""

from rmac_freecad.simulation.simulation import Found, SimulationRefused, simulate

__all__ = ["Found", "SimulationRefused", "simulate"]

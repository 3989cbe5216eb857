"""What a machine will make of a program, without moving one."""

from rmac_freecad.simulation.simulation import Found, SimulationRefused, simulate
from rmac_freecad.simulation.tool_length import simulate_telling_lengths

__all__ = ["Found", "SimulationRefused", "simulate", "simulate_telling_lengths"]

"""What a machine will make of a program, without moving one."""

from rmac_freecad.simulation.simulation import Found, NoProgram, SimulationRefused, WouldStop, simulate
from rmac_freecad.simulation.tool_length import simulate_telling_lengths

__all__ = ["Found", "NoProgram", "SimulationRefused", "WouldStop", "simulate", "simulate_telling_lengths"]

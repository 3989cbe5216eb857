"""What a machine will make of a program, without moving one."""

from rmac_freecad.simulation.simulation import Found, NoProgram, SimulationRefused, simulate
from rmac_freecad.simulation.tool_length import simulate_telling_lengths

__all__ = ["Found", "NoProgram", "SimulationRefused", "simulate", "simulate_telling_lengths"]

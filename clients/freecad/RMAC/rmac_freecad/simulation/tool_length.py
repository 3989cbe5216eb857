"""Whether it is a tool's length that keeps a program out of a machine's reach."""

import json

from rmac_freecad.simulation.simulation import SimulationRefused, simulate


def simulate_telling_lengths(program, machine, tools, rmac="rmac", part_frame=None):
    """As `simulate`. Where it is refused, it is simulated once more with tools as long as nothing: where that is not refused there, the
    tool is too long."""
    try:
        return simulate(program, machine, tools, rmac, part_frame=part_frame)
    except SimulationRefused as refused:
        tool = _tool_at(program, refused.index, tools)
        if tool is None or not tool["Length"] or not _reaches(program, machine, tools, rmac, part_frame, refused.index):
            raise
        raise SimulationRefused(
            f"tool {tool['ToolNumber']} is too long, {tool['Length']:g} mm in the tool table: without its length the machine would reach. "
            f"Take a shorter one, clamp it deeper, or set the part lower. ({refused.why})",
            refused.place, refused.index,
        ) from refused  # fmt: skip


def _tool_at(program, index, tools):
    """The tool table's entry of the tool that is in the spindle there; None where nobody knows it."""
    if index is None:
        return None
    number = tools["Mounted"]
    for move in program.moves[: index + 1]:
        if move.method == "RMAC_CAM.DoToolChange":
            number = json.loads(move.params(0))["ToolNumber"]
    return next((tool for tool in tools["Tools"] if tool["ToolNumber"] == number), None)


def _reaches(program, machine, tools, rmac, part_frame, index):
    short = {**tools, "Tools": [{**tool, "Length": 0} for tool in tools["Tools"]]}
    try:
        simulate(program, machine, short, rmac, part_frame=part_frame)
    except SimulationRefused as refused:
        return refused.index is not None and refused.index > index
    return True

"""What the program of a sweep begins with, whatever sweeps."""

import rmac
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.program import Place
from rmac_freecad.program.tool_number import is_tool_number


def check_tool(tool):
    """A number of a tool, or None. Raises `JobRefused`."""
    if tool is not None and not is_tool_number(tool):
        raise JobRefused(f"tool is {tool!r}: give a whole number of 1 or more")


def begin_program(program, label, tool, rpm):
    place = Place(label, 1, "begin")
    if tool is not None:
        program.append(rmac.tool_change(int(tool)), place)
    if rpm is not None:
        program.append(rmac.spindle(rpm), place)

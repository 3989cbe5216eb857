"""What the program of a sweep begins with, whatever sweeps."""

import rmac
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.program import Place


def begin_program(program, label, tool, rpm):
    place = Place(label, 1, "begin")
    if tool is not None:
        if isinstance(tool, bool) or tool != int(tool) or tool < 1:
            raise JobRefused(f"a tool's number is 1 or more, and whole; this is {tool!r}")
        program.append(rmac.tool_change(int(tool)), place)
    if rpm is not None:
        program.append(rmac.spindle(rpm), place)

"""What must be right before anything is cut, told before the machine moves."""

from dataclasses import dataclass

import rmac
from rmac_freecad.jobs import lacking
from rmac_freecad.jogging import is_machine_frame

SAME_RADIUS_MM = 0.01  # of a tool that is planned and the one of the table


class NotReady(Exception):
    """It says what to do."""


@dataclass(frozen=True)
class MachineNow:
    """How a machine stands: what simulating and cutting depend on."""

    machine: rmac.LoadedMachine
    tools: dict  # as client.cam.GetTools() gives them
    part_frame: dict


def look(client):
    """Waits; `NotReady` where no machine is loaded."""
    if not client.state()["mechanism"]:
        raise NotReady("No machine is loaded; choose one by Select machine.")
    return MachineNow(client.machine(), client.cam.GetTools(), client.cam.GetPartFrame())


def check_tools(tools, now):
    """The table has them all, as wide as they were planned; a radius of 0, in the table or of the tool, is not known."""
    missing = lacking(tools, now.tools)
    if missing:
        names = ", ".join(f"tool {tool.number} ({tool.label})" for tool in missing)
        raise NotReady(f"The tool table of {now.machine.name} lacks {names}. Give the length, from the spindle to the tip, and add it.")
    entries = {tool["ToolNumber"]: tool for tool in now.tools["Tools"]}
    for tool in tools:
        radius = entries[tool.number].get("Radius", 0)
        if radius and tool.radius_mm and abs(radius - tool.radius_mm) > SAME_RADIUS_MM:
            raise NotReady(
                f"Tool {tool.number} has a diameter of {2 * radius:g} mm in the tool table of {now.machine.name}, and of {2 * tool.radius_mm:g} mm in {tool.label}: "
                f"what is cut would be {abs(radius - tool.radius_mm):.3g} mm off at each wall. Give both the diameter of the tool that is there, or another number."
            )


def check_part_zero(now, is_machine_zero):
    """`is_machine_zero`: the user says that the part does stand at the machine's own zero."""
    if is_machine_frame(now.part_frame) and not is_machine_zero:
        raise NotReady(
            "The part's zero was not set. Jog the tool to the zero of the job and press Part zero here; or tick that the part stands at the machine's own zero."
        )

"""What must be right before anything is cut, told before the machine moves."""

from dataclasses import dataclass

import rmac
from rmac_freecad.jobs import lacking
from rmac_freecad.jogging import is_machine_frame


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
    missing = lacking(tools, now.tools)
    if missing:
        names = ", ".join(f"tool {tool.number} ({tool.label})" for tool in missing)
        raise NotReady(f"The tool table of {now.machine.name} lacks {names}. Give the length, from the spindle to the tip, and add it.")


def check_part_zero(now, is_machine_zero):
    """`is_machine_zero`: the user says that the part does stand at the machine's own zero."""
    if is_machine_frame(now.part_frame) and not is_machine_zero:
        raise NotReady(
            "The part's zero was not set. Jog the tool to the zero of the job and press Part zero here; or tick that the part stands at the machine's own zero."
        )

"""The buttons of the toolbar."""

import FreeCAD
import FreeCADGui

from rmac_freecad.window.icons import icon
from rmac_freecad.window.session import session


class Command:
    def __init__(self, name, text, tip, does, needs_document=False):
        self.name = f"RMAC_{name}"
        self._resources = {"Pixmap": icon(name.lower()), "MenuText": text, "ToolTip": tip}
        self._does = does
        self._needs_document = needs_document

    def GetResources(self):
        return self._resources

    def IsActive(self):
        return not self._needs_document or FreeCAD.ActiveDocument is not None

    def Activated(self, index=0):
        self._does()


def select_machine():
    from rmac_freecad.window.machines.search_dialog import show

    show(session())


def jog():
    from rmac_freecad.window.jogging.jog_dialog import show

    show(session())


def open_legacy():
    from rmac_freecad.window.legacy.open_dialog import show

    show(session())


def open_part():
    from rmac_freecad.window.parts.part_dialog import show

    show(session())


def cut_along():
    from rmac_freecad.window.profiles.command import cut_along_selection

    cut_along_selection()


def clear_pocket():
    from rmac_freecad.window.operations.operations import show_pocket

    show_pocket(session())


def drill_holes():
    from rmac_freecad.window.holes.drill_dialog import show

    show(session())


def sweep_faces():
    from rmac_freecad.window.operations.operations import show_sweep

    show_sweep(session())


def measure_part():
    from rmac_freecad.window.measuring.measure_dialog import show

    show(session())


def compare_part():
    from rmac_freecad.window.measuring.compare_dialog import show

    show(session())


def machine_job():
    from rmac_freecad.window.running.machining_dialog import show

    show(session())


def simulate():
    from rmac_freecad.window.running.machining_dialog import show

    show(session()).simulate()


def show_machine():
    from rmac_freecad.window.shown_machine import shown_machine

    shown_machine(session()).toggle()


def stop():
    here = session()
    here.station.stop(
        here.settings.address,
        failed=lambda error: FreeCAD.Console.PrintError(f"RMAC: the machine could not be told to stop: {error}\n"),
    )


COMMANDS = (
    Command("Select", "Select machine…", "Search machines, compare them, see which can cut the job, and load one", select_machine),
    Command("Jog", "Jog…", "Move the machine by hand, and set the part's zero where the tool stands", jog),
    Command("Legacy", "Open legacy code…", "A file of another control, RS274/NGC, Fanuc, Haas or APT, into the document, to be simulated and cut", open_legacy),
    Command("Part", "Open a STEP part…", "A part that somebody else drew, and what there is to machine on it", open_part),
    Command("Profile", "Cut along edges…", "Selected edges, or a sketch, as a profile without a Path job", cut_along, needs_document=True),
    Command("Pocket", "Clear a pocket…", "A level face with its islands, or a closed sketch, cleared without a Path job", clear_pocket, needs_document=True),
    Command("Drill", "Drill holes…", "Holes of a part, chosen by their diameter, or circles and points of a sketch, drilled without a Path job", drill_holes, needs_document=True),
    Command("Sweep", "Sweep faces…", "Selected faces of a part, with a ball, bull-nose or flat end, without a Path job", sweep_faces, needs_document=True),
    Command("Machine", "Machine a job…", "Send a Path job, a profile, pocket, sweep or holes, or a file of another control, to the machine as it is", machine_job, needs_document=True),
    Command("Simulate", "Simulate a job…", "How long a job takes, whether the machine can do it, and what limits it; moves nothing", simulate, needs_document=True),
    Command("Measure", "Measure a part…", "Has the machine touch selected faces of a part with its probe, and keeps what it found in the document", measure_part, needs_document=True),
    Command("Compare", "Compare with the model…", "What was measured against the part as it is drawn: in colours, and corrected by it", compare_part, needs_document=True),
    Command("Animate", "Show the machine", "The loaded machine about the part, moving as it does, be it real or virtual; once more: it is taken out", show_machine, needs_document=True),
    Command("Stop", "Stop the machine", "Stop at once, whoever moves it, and drop what is queued. This is no emergency stop", stop),
)


def register():
    """Gives the commands' names, in the toolbar's order."""
    for command in COMMANDS:
        FreeCADGui.addCommand(command.name, command)
    return [command.name for command in COMMANDS]

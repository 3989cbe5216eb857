"""A job of FreeCAD's Path workbench, made into a program for the appliance."""

from PathScripts import PathUtil

import rmac
from rmac_freecad.jobs.mover import Mover
from rmac_freecad.jobs.reader import Reader
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.jobs.tools import check_tools
from rmac_freecad.program import Place, Program

COOLANT_ON = {"Flood": "M8", "Mist": "M7"}


def read_job(job, *, rapid_mm_min):
    """`rapid_mm_min` is the fastest that the machine may go, `client.cam.GetMaxFeedrate()`; rapids of tool controllers
    hold where they are slower. Raises `JobRefused`."""
    if not hasattr(job, "Operations") or not hasattr(job, "Fixtures"):
        raise JobRefused(f"{getattr(job, 'Label', job)} is no job of the Path workbench; make one on the part")
    if len(job.Fixtures) > 1:
        raise JobRefused(f"{job.Label} has the fixtures {', '.join(job.Fixtures)}; the appliance has one part frame: make a job for each")
    operations = [operation for operation in job.Operations.Group if PathUtil.opProperty(operation, "Active") is not False]
    if not operations:
        raise JobRefused(f"{job.Label} has no operation that is switched on")
    check_tools(job.Label, [(operation.Label, PathUtil.toolControllerForOp(operation)) for operation in operations])
    program = Program()
    steps = _Steps(program, Mover(program, rapid_mm_min))
    for operation in operations:
        steps.add(operation)
    steps.end()
    return program


class _Steps:
    def __init__(self, program, mover):
        self._program = program
        self._mover = mover
        self._reader = Reader(program, mover)
        self._controller = None
        self._last = None

    def add(self, operation):
        if "Invalid" in operation.State:
            raise JobRefused(f"{operation.Label} could not be computed; repair it, or switch it off")
        if not operation.Placement.isIdentity():
            raise JobRefused(f"{operation.Label} has a placement of its own, which its path does not show; reset it")
        controller = PathUtil.toolControllerForOp(operation)
        if "Touched" in controller.State + operation.State:
            raise JobRefused(f"{operation.Label} or its tool controller was changed since its path was computed; recompute the document")
        if controller != self._controller:
            self._mover.set_rapids(controller.HorizRapid.Value * 60, controller.VertRapid.Value * 60)
            self._read(controller)
            if controller.SpindleDir == "None":
                self._program.append(rmac.spindle(0), self._last)
            self._controller = controller
        coolant = COOLANT_ON.get(PathUtil.opProperty(operation, "CoolantMode"))
        if coolant:
            self._reader.switch(coolant, Place(operation.Label, 0, coolant), {})
        self._reader.begin_operation()
        self._read(operation)
        written_by_hand = hasattr(operation, "Gcode")
        if not (self._reader.moved if written_by_hand else self._reader.cut):
            # FreeCAD's operations that found nothing to cut leave a rapid at most, and are up to date.
            raise JobRefused(f"{operation.Label} has no path that cuts; repair it, or switch it off")
        if coolant:
            self._reader.switch("M9", self._last, {})

    def end(self):
        self._program.append(rmac.spindle(0), self._last)

    def _read(self, feature):
        for number, command in enumerate(feature.Path.Commands, 1):
            self._last = Place(feature.Label, number, command.Name)
            self._reader.read(command, self._last)

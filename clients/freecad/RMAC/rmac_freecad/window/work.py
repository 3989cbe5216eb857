"""What is machined: a Path job, a profile of edges, a pocket, swept faces, holes, or a file of another control."""

import FreeCAD
import FreeCADGui

from rmac_freecad.holes import drillings
from rmac_freecad.jobs import JobRefused, read_job, tools_of
from rmac_freecad.legacy import codes, reading, tools_in
from rmac_freecad.path import strokes_of
from rmac_freecad.pockets import pockets
from rmac_freecad.profiles import profiles, program_of
from rmac_freecad.program import keep
from rmac_freecad.surfaces import sweeps
from rmac_freecad.window.jobs import jobs


class JobWork:
    def __init__(self, job):
        self._tools = tools_of(job)
        self._job, self._document = job, job.Document.Name
        self.label = job.Label

    def tools(self, program):
        """Of a program of this job; None before there is one."""
        return self._tools

    def reading(self, fastest_mm_min, rmac):
        """What a thread may call, for the program. The document is looked at now, by FreeCAD's own thread."""
        program = read_job(self._job, rapid_mm_min=fastest_mm_min)
        return lambda: program

    def strokes(self, program):
        return strokes_of(program)

    def keep(self, program):
        """What was cut; tells where it is kept."""
        try:
            kept = keep(FreeCAD.getDocument(self._document), program, self.label)
        except NameError:  # so FreeCAD says that there is none of that name
            return "Its document was closed meanwhile, so what was cut is not kept."
        return f"What was cut is kept in the document as {kept.Label}."

    def show_own_path(self, on):
        """FreeCAD's own stays: it has other lines, rapids among them."""


class ProfileWork(JobWork):
    def __init__(self, feature):
        self._tools = [feature.Proxy.tool(feature)]
        self._feature, self._document = feature, feature.Document.Name
        self.label = feature.Label

    def reading(self, fastest_mm_min, rmac):
        program = program_of(self._feature, fastest_mm_min)
        return lambda: program

    def show_own_path(self, on):
        _show_own_path(self._feature, on)


class PlannedWork(ProfileWork):
    """A pocket, faces that are swept, or holes: planned by a thread, where that was not done already."""

    def reading(self, fastest_mm_min, rmac):
        plan, label = self._feature.Proxy.planning(self._feature), self.label
        return lambda: plan().program(label, fastest_mm_min)


class CodeWork:
    def __init__(self, code):
        self._code = code
        self.label = code.Label

    def tools(self, program):
        program = program or (self._code.Proxy.last or (None, None))[1]
        return [] if program is None else tools_in(program)

    def reading(self, fastest_mm_min, rmac):
        return reading(self._code, fastest_mm_min, rmac)

    def strokes(self, program):
        return program.strokes

    def keep(self, program):
        return "The document keeps the file that it was made of."

    def show_own_path(self, on):
        _show_own_path(self._code, on)


def _show_own_path(feature, on):
    """The one that has colours lies upon it."""
    try:
        feature.ViewObject.Proxy.show_path(on)
    except ReferenceError:
        pass  # it was deleted meanwhile


def works(document):
    """Each object of it that can be machined, with what makes work of it."""
    return [*((job, JobWork) for job in jobs()), *((one, ProfileWork) for one in profiles(document)), *((code, CodeWork) for code in codes(document)),
            *((one, PlannedWork) for one in (*pockets(document), *sweeps(document), *drillings(document)))]  # fmt: skip


def work_in_question():
    """The one that is selected, or one of whose parts is; else the document's only one."""
    there = works(FreeCAD.ActiveDocument)
    for chosen in FreeCADGui.Selection.getSelection():
        for one in (chosen, *chosen.InListRecursive):
            for found, work in there:
                if one == found:
                    return work(found)
    if len(there) == 1:
        return there[0][1](there[0][0])
    raise JobRefused(
        "the document has several jobs, profiles, pockets, holes and files to machine; select one in the tree"
        if there
        else "the document has no Path job; make one with the Path workbench, cut along edges, clear a pocket, drill holes, sweep faces, or open a file of another control by Open legacy code"
    )

"""Which job is meant."""

import FreeCAD
import FreeCADGui
import PathScripts.PathJob as PathJob

from rmac_freecad.jobs import JobRefused


def jobs():
    document = FreeCAD.ActiveDocument
    return [] if document is None else [one for one in document.Objects if isinstance(getattr(one, "Proxy", None), PathJob.ObjectJob)]


def job_in_question():
    """The one that is selected, or one of whose parts is; else the document's only one."""
    there = jobs()
    for chosen in FreeCADGui.Selection.getSelection():
        for one in (chosen, *chosen.InListRecursive):
            if one in there:
                return one
    if len(there) == 1:
        return there[0]
    raise JobRefused("the document has several jobs; select one in the tree" if there else "the document has no Path job; make one with the Path workbench")

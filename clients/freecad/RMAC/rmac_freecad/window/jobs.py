"""Path jobs of the document."""

import FreeCAD
import PathScripts.PathJob as PathJob


def jobs():
    document = FreeCAD.ActiveDocument
    return [] if document is None else [one for one in document.Objects if isinstance(getattr(one, "Proxy", None), PathJob.ObjectJob)]

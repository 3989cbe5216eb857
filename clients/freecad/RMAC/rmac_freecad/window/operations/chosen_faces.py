"""Faces of one object, as they are selected."""

import FreeCADGui

from rmac_freecad.jobs import JobRefused


def chosen_faces():
    """The object, and the names of its faces."""
    chosen = FreeCADGui.Selection.getSelectionEx()
    if len(chosen) != 1:
        raise JobRefused("select faces of one object" if chosen else "nothing is selected; select faces of one object")
    names = [name for name in chosen[0].SubElementNames if name]
    other = next((name for name in names if not name.startswith("Face")), None)
    if other is not None or not names:
        raise JobRefused(f"{chosen[0].Object.Label}{'.' + other if other else ''} is no face; select faces")
    return chosen[0].Object, names

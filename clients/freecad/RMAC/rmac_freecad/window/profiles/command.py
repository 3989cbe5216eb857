"""What is selected becomes a profile; its values are changed in its dialog, or in FreeCAD's own editor."""

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

from rmac_freecad.profiles import ProfileRefused, is_profile, profile_of
from rmac_freecad.window.profiles.profile_view import ProfileView


def cut_along_selection():
    """A profile that is selected already is shown again."""
    from rmac_freecad.window.operations.operations import show_for

    feature = next((one for one in FreeCADGui.Selection.getSelection() if is_profile(one)), None)
    if feature is None:
        try:
            feature = profile_of(FreeCAD.ActiveDocument, chosen_edges())
        except Exception as error:
            return _tell(str(error))
        ProfileView(feature.ViewObject)
        feature.Document.recompute()
    show_for(feature)


def chosen_edges():
    chosen = []
    for one in FreeCADGui.Selection.getSelectionEx():
        names = [name for name in one.SubElementNames if name]
        other = next((name for name in names if not name.startswith("Edge")), None)
        if other is not None:
            raise ProfileRefused(f"{one.Object.Label}.{other} is no edge; select edges or a sketch")
        if not names and not one.Object.isDerivedFrom("Sketcher::SketchObject"):
            raise ProfileRefused(f"{one.Object.Label} is no sketch; select edges of it")
        chosen.append((one.Object, names))
    if not chosen:
        raise ProfileRefused("nothing is selected; select edges or a sketch")
    return chosen


def _tell(text):
    """Waits for nobody."""
    box = QtGui.QMessageBox(QtGui.QMessageBox.Warning, "Cut along edges", text, QtGui.QMessageBox.Ok, FreeCADGui.getMainWindow())
    box.setTextFormat(QtCore.Qt.PlainText)
    box.setAttribute(QtCore.Qt.WA_DeleteOnClose)
    box.setModal(False)
    box.show()

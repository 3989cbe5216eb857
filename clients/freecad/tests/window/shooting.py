"""What draws pictures of docs/freecad.md has in common."""

import os
import pathlib

import FreeCADGui
from PySide import QtCore, QtGui
from windowed import process_until

IMAGES = pathlib.Path(os.environ["RMAC_SOURCE"]) / "docs/images/freecad"


def hide_docks():
    """But for the tree."""
    for dock in FreeCADGui.getMainWindow().findChildren(QtGui.QDockWidget):
        dock.setVisible(dock.objectName() == "Combo View")


def shoot(name, dialog=None):
    """A dialog, or all of the screen but for what FreeCAD reports."""
    hide_docks()
    QtGui.QApplication.processEvents()
    picture = QtGui.QGuiApplication.primaryScreen().grabWindow(0) if dialog is None else dialog.grab()
    IMAGES.mkdir(exist_ok=True)
    if not picture.save(str(IMAGES / f"{name}.png")):
        raise AssertionError(f"{name}.png was not written")


class Shooting:
    """Of a WindowTest."""

    def begin(self):
        FreeCADGui.getMainWindow().setGeometry(0, 0, 1600, 1000)
        FreeCADGui.activateWorkbench("RmacWorkbench")

    def seen(self, further):
        """All that there is, from above, and so many steps away."""
        FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
        hide_docks()
        self.settle()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        for _ in range(further):
            FreeCADGui.runCommand("Std_ViewZoomOut")
        self.settle()

    def placed(self, dialog, x, y):
        dialog.move(x, y)
        return self.opened(dialog)

    def settle(self):
        """What is drawn by timers is drawn."""
        until = QtCore.QElapsedTimer()
        until.start()
        process_until(lambda: until.elapsed() > 1000, "a second")

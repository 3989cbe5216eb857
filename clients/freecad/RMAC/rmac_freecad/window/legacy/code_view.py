"""A file of another control in the tree and the 3D view."""

import FreeCAD
from pivy import coin
from PySide import QtCore

from rmac_freecad.legacy import reading
from rmac_freecad.window.icons import icon
from rmac_freecad.window.message import words_of
from rmac_freecad.window.running.path_view import PathView
from rmac_freecad.window.session import session

WATCHED = {"Source", "FileName", "Language", "Unit", "Rapid", "Approach", "AssumeG43", "BlockDelete", "Further"}
ALL_CHILDREN, NONE = coin.SO_SWITCH_ALL, coin.SO_SWITCH_NONE


class CodeView:
    """Of FreeCAD's view providers. Reads by a thread, when the object appears and whenever it was changed: also when a document is
    opened, which keeps the file and no program."""

    def __init__(self, view):
        self._begin()
        view.Proxy = self

    def _begin(self):
        self._feature = None
        self._asked = False
        self.path = None
        self.error = None

    def attach(self, view):
        self._feature = view.Object
        self._switch = coin.SoSwitch()
        self._switch.whichChild = ALL_CHILDREN
        view.addDisplayMode(self._switch, "Path")
        self._read_soon()

    def updateData(self, feature, name):
        if name in WATCHED and self._feature is not None:
            self._read_soon()

    def getDisplayModes(self, view):
        return ["Path"]

    def getDefaultDisplayMode(self):
        return "Path"

    def setDisplayMode(self, mode):
        return mode

    def getIcon(self):
        return icon("legacy")

    def doubleClicked(self, view):
        from rmac_freecad.window.running.machining_dialog import show

        show(session())
        return True

    def show_path(self, on):
        self._switch.whichChild = ALL_CHILDREN if on else NONE

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        self._begin()

    def _read_soon(self):
        """Once, though several properties change."""
        if not self._asked:
            self._asked = True
            QtCore.QTimer.singleShot(0, self._read)

    def _read(self):
        self._asked = False
        here = session()
        try:
            read = reading(self._feature, rmac=here.settings.rmac, unchanged=False)
        except ReferenceError:
            return  # it was deleted meanwhile
        here.station.ask(lambda: read().strokes, self._show, self._failed)

    def _show(self, strokes):
        self.error = None
        self._take_away()
        self.path = PathView(strokes, self._switch)

    def _failed(self, error):
        self.error = error
        self._take_away()
        FreeCAD.Console.PrintError(f"RMAC: {words_of(error)}\n")

    def _take_away(self):
        path, self.path = self.path, None
        if path is not None:
            path.remove()

"""An object of the document that has a path, in the tree and the 3D view."""

import FreeCAD
from pivy import coin
from PySide import QtCore

from rmac_freecad.window.icons import icon
from rmac_freecad.window.message import words_of
from rmac_freecad.window.running.path_view import PathView
from rmac_freecad.window.session import session

ALL_CHILDREN, NONE = coin.SO_SWITCH_ALL, coin.SO_SWITCH_NONE


class ObjectView:
    """Of FreeCAD's view providers. Reads by a thread, when the object appears and whenever it was changed: also when a document is
    opened, which keeps no program."""

    WATCHED: frozenset = frozenset()  # properties that its path depends on
    PICTURE = ""

    def reading(self, feature, rmac):
        """What a thread may call, for the strokes."""
        raise NotImplementedError

    def __init__(self, view):
        self._begin()
        view.Proxy = self

    def _begin(self):
        self._feature = None
        self._asked = False
        self.reads = 0  # those that have not come to their end
        self.path = None
        self.error = None

    @property
    def busy(self):
        return self._asked or self.reads > 0

    def attach(self, view):
        self._feature = view.Object
        self._switch = coin.SoSwitch()
        self._switch.whichChild = ALL_CHILDREN
        view.addDisplayMode(self._switch, "Path")
        self.read_soon()

    def updateData(self, feature, name):
        if name in self.WATCHED and self._feature is not None:
            self.read_soon()

    def getDisplayModes(self, view):
        return ["Path"]

    def getDefaultDisplayMode(self):
        return "Path"

    def setDisplayMode(self, mode):
        return mode

    def getIcon(self):
        return icon(self.PICTURE)

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

    def read_soon(self):
        """Once, though several properties change."""
        if not self._asked:
            self._asked = True
            QtCore.QTimer.singleShot(0, self._read)

    def _read(self):
        self._asked = False
        here = session()
        try:
            read = self.reading(self._feature, here.settings.rmac)
        except ReferenceError:
            return  # it was deleted meanwhile
        except Exception as error:
            return self._failed(error)
        self.reads += 1
        here.station.ask(read, self._read_well, self._read_badly)

    def _read_well(self, strokes):
        self.reads -= 1
        self._show(strokes)

    def _read_badly(self, error):
        self.reads -= 1
        self._failed(error)

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

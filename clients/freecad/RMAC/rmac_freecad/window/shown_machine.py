"""The machine in the document that is open, which moves as the appliance's does until the button is pressed again."""

import FreeCAD
import FreeCADGui
from PySide import QtCore

from rmac_freecad.animation import Follower
from rmac_freecad.window.message import words_of

EVERY_MS = 16  # 60 Hz


class ShownMachine:
    """One a FreeCAD. What it has to say goes to the report view."""

    def __init__(self, session):
        self._session = session
        self._follower = None
        self._told = ""
        # The window's own, as the session's is.
        self._timer = QtCore.QTimer(FreeCADGui.getMainWindow())
        self._timer.timeout.connect(self.update)

    @property
    def follower(self):
        return self._follower

    def toggle(self):
        if self._follower is None:
            self.show(FreeCAD.ActiveDocument)
        else:
            self.leave()

    def show(self, document):
        """Beside the part, which stands where it is drawn."""
        self._session.station.ask(lambda: self._begun(document), self._begin, self._fail)

    def leave(self):
        """It is taken out of the document."""
        self._timer.stop()
        follower, self._follower, self._told = self._follower, None, ""
        if follower is None:
            return
        if follower.model is not None:
            follower.model.remove()
        self._session.station.ask(follower.end)

    def update(self):
        follower = self._follower
        if follower is None:
            return
        follower.update()
        if follower.told != self._told:
            self._told = follower.told
            FreeCAD.Console.PrintMessage(f"RMAC: {self._told}\n")
        if follower.lost is not None or follower.gone:
            self.leave()

    def _begun(self, document):
        follower = Follower(self._session.client(), document, ask=self._session.station.ask)
        follower.begin()
        return follower

    def _begin(self, follower):
        self.leave()
        self._follower = follower
        self._timer.start(EVERY_MS)

    def _fail(self, error):
        FreeCAD.Console.PrintError(f"RMAC: the machine is not shown: {words_of(error)}\n")


_shown = None


def shown_machine(session):
    """The one of a session; made when it is asked for."""
    global _shown
    if _shown is None or _shown._session is not session:
        _shown = ShownMachine(session)
    return _shown

"""What the commands and dialogs of one FreeCAD share: the station, its settings, and the timer that brings the answers."""

import FreeCADGui
from PySide import QtCore

import rmac
from rmac_freecad.jogging import Hand
from rmac_freecad.measuring.under_way import Measuring
from rmac_freecad.running import Machining
from rmac_freecad.station import Settings, Station

TICK_MS = 50


class Session:
    def __init__(self, settings=None):
        self.settings = settings or Settings()
        self.station = Station()
        self.hand = Hand(self.client_unless_it_cuts)
        self.machining = Machining(self.station, self._client_for_a_cut)
        self.measuring = Measuring(self.station, self._client_for_measuring)
        self.machine = None  # the one that is loaded, a rmac.LoadedMachine, as far as is known here
        self._listeners = []
        # The window's own: Python may collect what it owns in any thread, and a timer must end in its own.
        self._timer = QtCore.QTimer(FreeCADGui.getMainWindow())
        self._timer.timeout.connect(self._tick)
        self._timer.start(TICK_MS)

    def on_tick(self, listener):
        """Twenty times a second, after answers came."""
        self._listeners.append(listener)

    def off_tick(self, listener):
        if listener in self._listeners:
            self._listeners.remove(listener)

    def close(self):
        """Nothing comes any more, and what this station moves stops."""
        self._timer.stop()
        self.station.disconnect()

    def client(self):
        """Connected, to the address of the preferences. Waits: for threads of the station."""
        return self.station.connect(self.settings.address)

    def client_unless_it_cuts(self):
        """For what needs authority beside a job, or a part that is measured: it would end that when it gives it back."""
        self._refuse_while(self.machining, "A job is being cut.")
        self._refuse_while(self.measuring, "A part is being measured.")
        return self.client()

    def _client_for_a_cut(self):
        """Whoever jogged gives the machine back first; giving it back in mid-cut would stop it."""
        self._refuse_while(self.measuring, "A part is being measured.")
        self.hand.leave()
        return self.client()

    def _client_for_measuring(self):
        self._refuse_while(self.machining, "A job is being cut.")
        self.hand.leave()
        return self.client()

    def _refuse_while(self, other, what):
        if other.running:
            raise rmac.RmacError(f"{what} Wait for its end, or stop it.")

    def _tick(self):
        self.station.deliver()
        for listener in list(self._listeners):
            listener()


_session = None


def session():
    """The one of this FreeCAD; made when it is asked for."""
    global _session
    if _session is None:
        _session = Session()
    return _session

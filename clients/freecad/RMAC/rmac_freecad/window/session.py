"""What the commands and dialogs of one FreeCAD share: the station, its settings, and the timer that brings the answers."""

from PySide import QtCore

from rmac_freecad.station import Settings, Station

TICK_MS = 50


class Session:
    def __init__(self, settings=None):
        self.settings = settings or Settings()
        self.station = Station()
        self.machine = None  # the one that is loaded, a rmac.LoadedMachine, as far as is known here
        self._listeners = []
        self._timer = QtCore.QTimer()
        self._timer.timeout.connect(self._tick)
        self._timer.start(TICK_MS)

    def on_tick(self, listener):
        """Twenty times a second, after answers came."""
        self._listeners.append(listener)

    def off_tick(self, listener):
        if listener in self._listeners:
            self._listeners.remove(listener)

    def client(self):
        """Connected, to the address of the preferences. Waits: for threads of the station."""
        return self.station.connect(self.settings.address)

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

"""A program under way on the machine, fed by a thread of its own; whoever watches it asks how far it is."""

import rmac
from rmac_freecad.running.cutting import CutEnded, cut_moves


class Machining:
    """One program at a time. `done` counts the moves that are done, `place` is that of the last one, and `running` tells whether
    a program is under way. Hold, resume and override are questions as others are: they wait, in a thread of the station."""

    def __init__(self, station, connect):
        """`connect()` gives the client, connected."""
        self._station = station
        self._connect = connect
        self._lost = None
        self.program = None
        self.done = 0
        self.place = None
        self.running = False

    @property
    def can_go_on(self):
        """The connection was lost in mid-cut, and the rest of the program is known."""
        return self._lost is not None and not self.running

    def start(self, program, ended, failed):
        """`ended()` or `failed(error)` by the station's `deliver`."""
        self.program, self._lost, self.done, self.place = program, None, 0, None
        self._begin(ended, failed)

    def go_on(self, ended, failed):
        """From where the machine stood when the connection was lost."""
        self._begin(ended, failed)

    def _begin(self, ended, failed):
        self.running = True

        def over(answer):
            self.running = False
            ended()

        def broken(error):
            self.running = False
            failed(error)

        self._station.ask(self._cut, over, broken)

    def _cut(self):
        client = self._connect()
        lost, self._lost = self._lost, None
        if lost is not None:
            self.done = lost.done
        try:
            with client.authority():
                for index in cut_moves(client, self.program, lost):
                    self.done = index + 1
                    self.place = self.program.place_of(index)
        except CutEnded as ended:
            self._lost = ended.lost
            raise
        except rmac.AuthorityHeld:
            self._lost = lost  # nothing was begun
            raise

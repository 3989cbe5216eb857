"""NMT slave, boot-up, heartbeat and guarding, by CiA 301, 7.2.8 and 7.3."""

from enum import Enum

START, STOP, PRE, RESET_NODE, RESET_COMMUNICATION = 1, 2, 0x80, 0x81, 0x82


class State(Enum):
    """With what a heartbeat says."""
    INITIALISING = 0x00
    STOPPED = 0x04
    OPERATIONAL = 0x05
    PRE_OPERATIONAL = 0x7F


class Nmt:
    def __init__(self, drive, manners):
        self._drive, self._manners = drive, manners
        self.state = State.INITIALISING
        self._started_early = False
        self._round = self._toggle = 0

    def boot(self, now):
        self.state, self._started_early, self._toggle = State.INITIALISING, False, 0
        self._round += 1
        self._drive.at(now + self._manners.boot_s, self._booted)

    def command(self, data, now):
        if len(data) != 2 or data[1] not in (0, self._drive.node):
            return
        if data[0] in (RESET_NODE, RESET_COMMUNICATION):
            self._drive.reset(data[0] == RESET_NODE, now, told=True)
        elif self.state == State.INITIALISING:
            self._started_early |= data[0] == START and self._manners.obeys_start_while_booting
        elif data[0] in (START, STOP, PRE):
            self.change({START: State.OPERATIONAL, STOP: State.STOPPED, PRE: State.PRE_OPERATIONAL}[data[0]])

    def change(self, state):
        before, self.state = self.state, state
        if State.OPERATIONAL not in (before, state) or before == state:
            return
        if state == State.OPERATIONAL:
            self._drive.started()
        else:
            self._drive.axis.drop()

    def guarded(self, identifier):
        """A remote request for the state (7.2.8.3.2.1): bit 7 toggles from answer to answer. Whether it is answered."""
        mine = self._manners.guarding_only and identifier == 0x700 + self._drive.node and self.state != State.INITIALISING
        if mine:
            self._drive.send(identifier, bytes([self.state.value | self._toggle]))
            self._toggle ^= 0x80
        return mine

    def heartbeat_changed(self):
        self._round += 1
        self._beat(self._round)

    def _booted(self, now):
        self.state = State.OPERATIONAL if self._started_early or self._manners.starts_itself else State.PRE_OPERATIONAL
        for again in range(1, self._manners.boot_ups):
            self._drive.at(now + again * self._manners.boot_up_gap_ms / 1000, lambda _: self._send_boot_up())
        self._send_boot_up()
        self._drive.booted(now)
        self._beat(self._round, now)

    def _send_boot_up(self):
        self._drive.send(0x700 + self._drive.node, b"\0")

    def _beat(self, round_, now=None):
        period = 0 if self._manners.guarding_only or (0x1017, 0) not in self._drive.d.values else self._drive.d.get(0x1017) / 1000
        if round_ != self._round or not period:
            return
        if now is None:
            self._drive.at(0.0, lambda then: self._beat(round_, then))
            return
        self._drive.at(now + period, lambda then: self._beat(round_, then))
        self._drive.send(0x700 + self._drive.node, bytes([self.state.value | self._toggle]))
        if self._manners.heartbeat_toggles:
            self._toggle ^= 0x80

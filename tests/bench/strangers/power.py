"""The power states of a drive, by CiA 402-2, 8.4: the finite state automaton behind controlword and statusword."""

from enum import Enum

FAULT_RESET, ENABLE_RAMP = 0x80, 0x10


class Power(Enum):
    """With the bits of the statusword that tell the state (table 30)."""
    NOT_READY = 0x00
    DISABLED = 0x40
    READY = 0x21
    ON = 0x23
    ENABLED = 0x27
    QUICK_STOP = 0x07
    FAULT = 0x08


REMOTE, VOLTAGE = 1 << 9, 1 << 4
POWERED = (Power.ENABLED, Power.QUICK_STOP)


def command(controlword):
    """Table 28. None: no command, as while bit 7 is set."""
    if controlword & 0x82 == 0:
        return "disable voltage"
    if controlword & 0x86 == 0x02:
        return "quick stop"
    if controlword & 0x87 == 0x06:
        return "shutdown"
    if controlword & 0x8F == 0x07:
        return "switch on"
    if controlword & 0x8F == 0x0F:
        return "enable operation"
    return None


# (state, command): the state that follows, by the numbers of figure 6.
TRANSITIONS = {
    (Power.DISABLED, "shutdown"): Power.READY,  # 2
    (Power.READY, "switch on"): Power.ON,  # 3
    (Power.READY, "enable operation"): Power.ON,  # 3, and 4 with the next look
    (Power.ON, "enable operation"): Power.ENABLED,  # 4
    (Power.ENABLED, "switch on"): Power.ON,  # 5
    (Power.ON, "shutdown"): Power.READY,  # 6
    (Power.READY, "disable voltage"): Power.DISABLED, (Power.READY, "quick stop"): Power.DISABLED,  # 7
    (Power.ENABLED, "shutdown"): Power.READY,  # 8
    (Power.ENABLED, "disable voltage"): Power.DISABLED,  # 9
    (Power.ON, "disable voltage"): Power.DISABLED, (Power.ON, "quick stop"): Power.DISABLED,  # 10
    (Power.ENABLED, "quick stop"): Power.QUICK_STOP,  # 11
    (Power.QUICK_STOP, "disable voltage"): Power.DISABLED,  # 12
}


class Automaton:
    """`enable_s`: how long the drive takes from Switched on to Operation enabled, as one with a brake does. `reset_s`: the same from a reset
    to the end of a fault."""

    def __init__(self, enable_s=0.0, reset_s=0.0):
        self._enable_s, self._reset_s = enable_s, reset_s
        self.state = Power.NOT_READY
        self.error = 0  # 603Fh
        self.stays = False  # in a quick stop that is over, as by option codes 5 to 8
        self._before = 0
        self._due = None

    def initialised(self):
        if self.state == Power.NOT_READY:
            self.state = Power.DISABLED  # 1

    def stop_and_stay(self):
        self.state, self.stays = Power.QUICK_STOP, True

    def fail(self, code):
        self.state, self.error, self._due = Power.FAULT, code, None

    def drop(self, option):
        """What 6007h has it do when its master is gone; of use in Operation enabled alone."""
        if self.state != Power.ENABLED:
            return
        if option == 1:
            self.fail(0x8130)
        elif option == 2:
            self.state = Power.DISABLED
        elif option == 3:
            self.state = Power.QUICK_STOP

    def obey(self, controlword, now):
        rising = controlword & ~self._before & FAULT_RESET
        self._before = controlword
        if self.state == Power.FAULT:
            if rising and self._due is None:
                self._due = now + self._reset_s
            if self._due is not None and now >= self._due:
                self.state, self.error, self._due = Power.DISABLED, 0, None  # 15
            return
        wanted = TRANSITIONS.get((self.state, command(controlword)))
        if wanted != Power.ENABLED:
            self._due = None
        elif self._due is None:
            self._due = now + self._enable_s
        if wanted and (wanted != Power.ENABLED or now >= self._due):
            self.state, self._due, self.stays = wanted, None, False

    def at_rest(self):
        """A quick stop that is over, of option codes 1 to 3 where it does not stay."""
        if self.state == Power.QUICK_STOP and not self.stays:
            self.state = Power.DISABLED

    def statusword(self):
        voltage = VOLTAGE if self.state in (Power.READY, Power.ON, *POWERED) else 0
        return self.state.value | REMOTE | voltage

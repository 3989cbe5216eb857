"""What controlword and set-points make of the motor, and what the drive tells of it: the objects of CiA 402."""

import collections

import motor as motors
from power import Automaton, Power

SETPOINTS = {motors.POSITION: 0x607A, motors.VELOCITY: 0x60FF, motors.TORQUE: 0x6071}
FOLLOWS = 1 << 12  # bit 12 of the statusword in the cyclic synchronous modes


class Axis:
    def __init__(self, dictionary, manners):
        self._d, self._manners = dictionary, manners
        self._has_fault = bool(manners.fault_at_boot)
        self._set, self._clear = int(manners.status_set, 16), int(manners.status_clear, 16)
        self.motor = motors.Motor()
        self.reset(True)

    def reset(self, application):
        """`application`: the power states begin anew, too. The motor stands where it stands."""
        self._commanded = False
        self._statuses = collections.deque(maxlen=self._manners.status_delay + 1)
        self._positions = collections.deque(maxlen=self._manners.position_delay + 1)
        if application:
            self.power = Automaton(self._manners.enable_s, self._manners.fault_reset_s)

    def initialise(self):
        if self.power.state != Power.NOT_READY:
            return
        self.power.initialised()
        if self._has_fault:
            self.power.fail(int(self._manners.fault_at_boot, 16))
        if self._manners.quick_stop_at_boot:
            self.power.stop_and_stay()

    def drop(self):
        """There is no master any more."""
        self.power.drop(self._d.get(0x6007) if (0x6007, 0) in self._d.values else 0)

    def command(self, values):
        self._commanded |= (0x6040, 0) in values
        self._d.values.update(values)

    def controlword_written(self, now):
        self._commanded = True
        self.obey(now)

    def obey(self, now):
        if self._commanded:  # the controlword of power-on is no command
            self.power.obey(self._d.get(0x6040), now)
            self._has_fault &= self.power.state in (Power.FAULT, Power.NOT_READY)

    def step(self, measured_s):
        """The motor has had its set-point for a cycle: by 60C2h where somebody said how long that is, else as the SYNCs came; 0: not yet."""
        mode, state = self._d.get(0x6060), self.power.state
        setpoint = self._d.get_signed(SETPOINTS.get(mode, 0x6071))
        self.motor.step((self._cycle_s() or measured_s) if measured_s else 0, state, mode, setpoint)
        if self.motor.velocity == 0:
            self.power.at_rest()
        self._publish(mode, setpoint if state == Power.ENABLED and mode == motors.TORQUE else 0)

    def _cycle_s(self):
        d = self._d
        told = (0x60C2, 1) in d.values and not {0x60C2} & (d.refuses.keys() | d.refuses_write.keys())
        return d.get(0x60C2, 1) * 10.0 ** d.get_signed(0x60C2, 2) if told else 0

    def _statusword(self):
        word = self.power.statusword()
        if self.power.state == Power.ENABLED and self._d.get(0x6060) in SETPOINTS:
            word |= FOLLOWS
        return (word | self._set) & ~self._clear

    def _publish(self, mode, torque):
        d = self._d
        self._statuses.append(self._statusword())
        d.set(0x6041, self._statuses[0])
        d.set(0x603F, self.power.error)
        d.set(0x6061, mode)
        self._positions.append(round(self.motor.position))
        d.set(0x6064, self._positions[0])
        d.set(0x606C, round(self.motor.velocity))
        d.set(0x6077, torque)

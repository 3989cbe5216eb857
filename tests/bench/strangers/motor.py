"""A motor with its load, in counts and seconds: what a drive of CiA 402 makes of its set-points in the cyclic synchronous modes."""

from power import Power

POSITION, VELOCITY, TORQUE = 8, 9, 10
# 0.318 Nm at 1000, on 131072 counts, with 20 kg on a screw of 5 mm; 19 N of friction.
ACCELERATION_PER_UNIT = 0.318e-3 / 1.64e-5 * 131072 / 6.2831853
FRICTION_UNITS = 48
QUICK_STOP_COUNTS_S2 = 2.6e6  # 100 mm/s^2 on that screw


class Motor:
    def __init__(self, position=0.0):
        self.position, self.velocity = position, 0.0

    def step(self, seconds, state, mode, setpoint):
        """As long as that with this set-point."""
        if seconds <= 0:
            return
        if state == Power.ENABLED and mode == POSITION:
            self.velocity, self.position = (setpoint - self.position) / seconds, setpoint
        elif state == Power.ENABLED and mode == VELOCITY:
            self.velocity = setpoint
            self.position += setpoint * seconds
        else:
            torque = setpoint if state == Power.ENABLED and mode == TORQUE else 0
            self._accelerate(torque, QUICK_STOP_COUNTS_S2 if state == Power.QUICK_STOP else 0, seconds)

    def _accelerate(self, torque, braking, seconds):
        drag = FRICTION_UNITS * ACCELERATION_PER_UNIT + braking
        push = torque * ACCELERATION_PER_UNIT
        if self.velocity == 0 and abs(push) <= drag:
            return
        against = drag if (self.velocity or push) > 0 else -drag
        before = self.velocity
        self.velocity += (push - against) * seconds
        if before * self.velocity < 0 and abs(push) <= drag:
            self.velocity = 0.0
        self.position += (before + self.velocity) / 2 * seconds

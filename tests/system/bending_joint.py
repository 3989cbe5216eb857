"""A joint of two masses with a spring between them and its loop, written for tests apart from what they test: exact in
time, by matrix exponentials. No friction but the viscous one; a quantised, noisy encoder at the motor."""

import math
import random
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg, signal

PERIOD = 0.001


@dataclass
class BendingJoint:
    motor: float  # N·s²/mm
    load: float
    resonance_hz: float
    damping: float
    viscous: float
    lag_s: float  # of the current loop
    cycles: int  # before an effort acts: to the drive, and one more where answers are late
    count: float  # mm
    noise: float  # counts

    @classmethod
    def of(cls, seed):
        """A table axis of 7 to 80 kg that swings at 120 to 600 Hz."""
        chance = random.Random(seed)
        mass = 10 ** chance.uniform(math.log10(0.007), math.log10(0.08))
        share = chance.uniform(0.3, 0.7)
        return cls(motor=mass * (1 - share), load=mass * share, resonance_hz=chance.uniform(120, 600),
                   damping=chance.uniform(0.01, 0.05), viscous=mass * chance.uniform(0.2, 4),
                   lag_s=chance.uniform(0.0001, 0.0004), cycles=chance.choice([1, 1, 2]),
                   count=5 / 2 ** chance.choice([16, 17, 20]), noise=chance.uniform(0, 1))

    @property
    def mass(self):
        return self.motor + self.load

    def elsewhere(self, factor):
        """The same with another stiffness."""
        return replace(self, resonance_hz=self.resonance_hz * factor)

    def sampled(self):
        """Matrices of x[k+1] = A x[k] + b u[k], for an effort that acts at once; the position is C x."""
        both = self.motor * self.load / self.mass
        stiffness = both * (2 * math.pi * self.resonance_hz) ** 2
        damper = 2 * self.damping * both * 2 * math.pi * self.resonance_hz
        a = np.array([[0, 1, 0, 0, 0],
                      [-stiffness / self.motor, -(damper + self.viscous) / self.motor, stiffness / self.motor,
                       damper / self.motor, 1 / self.motor],
                      [0, 0, 0, 1, 0],
                      [stiffness / self.load, damper / self.load, -stiffness / self.load, -damper / self.load, 0],
                      [0, 0, 0, 0, -1 / self.lag_s]])
        b = np.array([[0], [0], [0], [0], [1 / self.lag_s]])
        whole = linalg.expm(np.block([[a, b], [np.zeros((1, 6))]]) * PERIOD)
        return whole[:5, :5], whole[:5, 5:], np.array([[1.0, 0, 0, 0, 0]])

    def run(self, setpoints, gains, added):
        """Measured positions and efforts of every cycle: the PID of docs/servo.md follows `setpoints` (position,
        velocity), and `added` is put on top of it."""
        a, b, _ = self.sampled()
        chance = np.random.default_rng(1)
        kp, ki, kd = gains
        x, integral, shown = np.zeros(5), 0.0, [0.0, 0.0, 0.0]
        waiting = [0.0] * self.cycles
        positions, efforts = [], []
        for (wanted, speed), more in zip(setpoints, added):
            measured = self.count * round(x[0] / self.count + self.noise * chance.standard_normal())
            shown = [measured, shown[0], shown[1]]
            velocity = (3 * shown[0] - 4 * shown[1] + shown[2]) / (2 * PERIOD)
            integral += ki * (wanted - measured) * PERIOD
            effort = kp * (wanted - measured) + kd * (speed - velocity) + integral + more
            positions.append(measured)
            efforts.append(effort)
            waiting.append(effort)
            x = a @ x + b[:, 0] * waiting.pop(0)
        return np.array(positions), np.array(efforts)


def strokes(distance, speed, count=2):
    """Setpoints (position, velocity, acceleration) there and back, from rest to rest."""
    ramp = 50
    cruise = int(distance / speed / PERIOD)
    position = 0.0
    for index in range(count):
        sign = 1 if index % 2 == 0 else -1
        shape = [*np.linspace(0, speed, ramp, endpoint=False), *([speed] * cruise), *np.linspace(speed, 0, ramp)]
        for now, after in zip(shape, [*shape[1:], 0.0]):
            yield position, sign * now, sign * (after - now) / PERIOD
            position += sign * (now + after) / 2 * PERIOD
        for _ in range(100):
            yield position, 0.0, 0.0


def swept_sine(effort, from_hz, to_hz, full_hz, period_s, sweeps):
    """Of one steady stretch, as drivers/modules/README.md has it."""
    t = np.arange(int(round(period_s / PERIOD))) * PERIOD
    rate = (to_hz - from_hz) / period_s
    share = np.minimum((from_hz + rate * t) / full_hz, 1) if full_hz > 0 else 1
    one = effort * share * np.sin(2 * np.pi * (from_hz * t + rate * t**2 / 2))
    return np.concatenate([one * (1 if index % 2 == 0 else -1) for index in range(sweeps)])


class ClosedLoop:
    """A joint with law and filters, as polynomials in z; `filters` as device.json has them."""

    def __init__(self, joint, gains, filters):
        kp, ki, kd = gains
        # Law: kp + ki T z/(z-1) + kd (3z² - 4z + 1)/(2 T z²), over z² (z - 1).
        law = np.polyadd(np.polyadd(kp * np.array([1, -1, 0, 0.0]), ki * PERIOD * np.array([1, 0, 0, 0.0])),
                         np.polymul([3, -4, 1], [1, -1]) * kd / (2 * PERIOD))
        self.over, self.under = law, np.array([1, -1, 0, 0.0])
        for notch in filters["Resonances"]:
            corner = 2 / PERIOD * math.tan(math.pi * notch["Frequency"] * PERIOD)
            self._through(*signal.bilinear([1, 2 * notch["Damping"] * corner, corner**2],
                                           [1, 2 * notch["Width"] * corner, corner**2], 1 / PERIOD))
        if filters["LowPass"] > 0:
            self._through(*signal.butter(2, filters["LowPass"], fs=1 / PERIOD))
        over, under = signal.ss2tf(*joint.sampled(), np.zeros((1, 1)))
        self._through(over[0], np.polymul(under, [1, *[0] * joint.cycles]))

    def _through(self, over, under):
        self.over, self.under = np.polymul(self.over, over), np.polymul(self.under, under)

    def stable(self, gain=1.0):
        """With all of it `gain` times as large."""
        return bool(np.all(np.abs(np.roots(np.polyadd(self.under, gain * self.over))) < 1))

    def phase_margin(self):
        """The least of all crossovers, in degrees."""
        angle = np.linspace(1e-3, 0.9999 * np.pi, 200000)
        z = np.exp(1j * angle)
        value = np.polyval(self.over, z) / np.polyval(self.under, z)
        crossings = np.flatnonzero(np.diff(np.abs(value) > 1))
        return float(np.min(np.abs(np.degrees(np.angle(-value[crossings])))))

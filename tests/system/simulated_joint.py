"""A joint and its loop, written for tests apart from what they test: mass, friction that sticks, a hanging load, cogging, a
current loop, a quantised encoder, and the PID of docs/servo.md at 1 kHz."""

import math
import random
from dataclasses import dataclass

PERIOD = 0.001
STEPS = 10


@dataclass
class Joint:
    mass: float
    viscous: float
    friction: float
    load: float
    lag_s: float
    count: float
    cogs: float = 0.0  # N, a sine of the place
    pitch: float = 1.0  # mm

    @classmethod
    def of(cls, seed):
        """A table axis of 5 to 80 kg, N·s²/mm and N."""
        chance = random.Random(seed)
        mass = 10 ** chance.uniform(math.log10(0.005), math.log10(0.08))
        return cls(mass=mass, viscous=mass * chance.uniform(0.2, 4), friction=1000 * mass * chance.uniform(0.1, 1.2),
                   load=1000 * mass * chance.choice([0, 0, chance.uniform(-9.8, 9.8)]),
                   lag_s=chance.uniform(0.0001, 0.0008), count=5 / 2 ** chance.choice([16, 17, 20]))

    @property
    def delay_s(self):
        """Of the effort: a cycle to the drive, half a cycle of hold, the current loop."""
        return 1.5 * PERIOD + self.lag_s

    def follow(self, setpoints, gains):
        """Measured positions and efforts of every cycle, from rest under the load's own effort."""
        kp, ki, kd = gains
        x = v = integral = 0.0
        integral = motor = acting = waiting = self.load
        shown = [0.0, 0.0, 0.0]
        positions, efforts = [], []
        dt = PERIOD / STEPS
        follows = 1 - math.exp(-dt / self.lag_s)
        for wanted, speed in setpoints:
            measured = math.floor(x / self.count) * self.count
            shown = [measured, shown[0], shown[1]]
            velocity = (3 * shown[0] - 4 * shown[1] + shown[2]) / (2 * PERIOD)
            integral += ki * (wanted - measured) * PERIOD
            effort = kp * (wanted - measured) + kd * (speed - velocity) + integral
            positions.append(measured)
            efforts.append(effort)
            acting, waiting = waiting, effort
            for _ in range(STEPS):
                motor += (acting - motor) * follows
                driving = motor - self.load - (self.cogs and self.cogs * math.sin(2 * math.pi * x / self.pitch))
                if v == 0 and abs(driving) <= 1.2 * self.friction:
                    continue
                pushed = v + driving / self.mass * dt
                slowed = math.copysign(max(abs(pushed) - self.friction / self.mass * dt, 0), pushed)
                after = slowed / (1 + self.viscous / self.mass * dt)
                v = 0.0 if v * after < 0 and abs(driving) <= 1.2 * self.friction else after
                x += v * dt
        return positions, efforts


def rest_to_rest(distance, speed, acceleration, jerk):
    """Setpoints (position, velocity) of a move with bounded jerk, every cycle, and a rest after it."""
    jerk_s = min(acceleration / jerk, math.sqrt(speed / jerk))
    ramp_s = max(speed / (jerk * jerk_s) - jerk_s, 0)
    cruise_s = max(abs(distance) / speed - 2 * jerk_s - ramp_s, 0)
    phases = [(jerk_s, jerk), (ramp_s, 0), (jerk_s, -jerk), (cruise_s, 0), (jerk_s, -jerk), (ramp_s, 0), (jerk_s, jerk)]
    x = v = a = 0.0
    for duration, j in phases:
        for _ in range(int(round(duration / PERIOD))):
            a += j * PERIOD
            v += a * PERIOD
            x += v * PERIOD
            yield math.copysign(x, distance), math.copysign(v, distance)
    for _ in range(80):
        yield math.copysign(x, distance), 0.0


def excitation(travel, max_speed, acceleration, jerk):
    """There and back at several speeds, as `rmac tune` moves an axis."""
    at = 0.0
    for share in (1.0, 0.5, 0.25, 0.1):
        distance = travel * min(1.0, math.sqrt(share))
        for sign in (1, -1):
            for x, v in rest_to_rest(sign * distance, share * max_speed, acceleration, jerk):
                yield at + x, v
            at += x

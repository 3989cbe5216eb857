"""One joint as its servo loop sees it: identification from a flight record, gains, and the loop's frequency response.

    M·a + B·v + C·sign(v) + L = u, delayed by d

M moving mass, B viscous and C sliding friction, L hanging load, u the effort, d from the cycle in which an effort is
worked out until it acts: one cycle to the drive, half a cycle of hold, and the current loop. mm, deg, s, N, N·m, as in
docs/servo.md ("What rmac tune does")."""

import json
from dataclasses import asdict, dataclass

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.signal import savgol_filter

# Window of the polynomials that smooth and differentiate: longer than an encoder's noise, shorter than a jerk phase.
WINDOW_S = 0.015
# Below this share of the fastest speed of the record friction is not what it is at speed.
SLOW_SHARE = 0.02
LONGEST_DELAY_S = 0.01
# A proportional and derivative law cannot lead by more than this (degrees) without gains that only amplify noise.
LARGEST_LEAD = 75.0
# Integral time in units of the inverse crossover frequency.
INTEGRAL_RATIO = 4.0


@dataclass
class Plant:
    """What was found, and how well it explains the record."""

    mass: float
    viscous: float
    friction: float
    load: float
    delay_s: float
    explained: float = 1.0

    def response(self, omega):
        """From effort to position, without friction, the delay included."""
        s = 1j * omega
        return np.exp(-s * self.delay_s) / (s * (self.mass * s + self.viscous))


class Unidentifiable(Exception):
    """The record does not say what the joint is made of."""


def read_record(path, begin):
    """Head and columns of numbers of a flight record, from `begin` (t_s) on: what the machine did before that may have
    been a cut, or a test under other gains."""
    with open(path, encoding="utf-8") as file:
        head = json.loads(file.readline())
        names = file.readline().strip().split(",")
        words = {"state", "servo_state", "fault", "horizon_limit"}
        wanted = [index for index, name in enumerate(names) if name not in words]
        table = np.loadtxt(file, delimiter=",", usecols=wanted, ndmin=2)
    columns = {names[index]: table[:, column] for column, index in enumerate(wanted)}
    return head, {name: values[columns["t_s"] > begin] for name, values in columns.items()}


def identify(time, position, effort, period=None):
    """The plant behind measured positions and efforts of every cycle. Efforts and motion pass the same filter, so that
    it changes neither their ratio nor their delay; of all delays that one is right which leaves the least."""
    period = period or float(np.median(np.diff(time)))
    window = max(5, int(round(WINDOW_S / period)) | 1)
    if len(position) < 20 * window:
        raise Unidentifiable(f"{len(position)} cycles are too few")
    smooth = dict(window_length=window, polyorder=3)
    velocity = savgol_filter(position, deriv=1, delta=period, **smooth)
    acceleration = savgol_filter(position, deriv=2, delta=period, **smooth)
    filtered = savgol_filter(effort, **smooth)
    fast = np.max(np.abs(velocity))
    if not fast > 0:
        raise Unidentifiable("the joint did not move")
    moving = np.abs(velocity) > SLOW_SHARE * fast
    # Friction turns round within the window of the filter: what is near standstill says nothing of it.
    near = np.convolve(~moving, np.ones(window), mode="same") > 0
    edge = np.zeros(len(position), dtype=bool)
    margin = window + int(LONGEST_DELAY_S / period) + 1
    edge[:margin] = edge[-margin:] = True
    used = moving & ~near & ~edge
    if used.sum() < 10 * window:
        raise Unidentifiable("it was hardly ever at speed; give it more travel")
    matrix = np.column_stack([acceleration, velocity, np.sign(velocity), np.ones(len(position))])[used]
    index = np.arange(len(position), dtype=float)

    def solve(delay):
        right = np.interp(index - delay / period, index, filtered)[used]
        found, *_ = np.linalg.lstsq(matrix, right, rcond=None)
        return found, float(np.sum((matrix @ found - right) ** 2)), float(np.sum((right - right.mean()) ** 2))

    grid = np.arange(0, LONGEST_DELAY_S, period / 2)
    best = min(grid, key=lambda delay: solve(delay)[1])
    delay = minimize_scalar(lambda d: solve(d)[1], bounds=(max(0, best - period), best + period), method="bounded").x
    (mass, viscous, friction, load), left, total = solve(delay)
    if not mass > 0:
        raise Unidentifiable("the accelerations do not tell its mass; give it more travel")
    return Plant(float(mass), max(float(viscous), 0.0), max(float(friction), 0.0), float(load), float(delay),
                 1 - left / total)


def largest_bandwidth_hz(plant, margin_deg):
    """Beyond it the phase margin asks for more lead than a derivative gives."""
    lead = np.radians(LARGEST_LEAD - margin_deg)
    return float(lead / plant.delay_s / (2 * np.pi)) if plant.delay_s > 0 else np.inf


def gains_for(plant, bandwidth_hz, margin_deg):
    """Kp, Ki, Kd with which the loop crosses 1 at `bandwidth_hz` with `margin_deg` of phase left:
    C(jw) P(jw) = exp(j (margin - 180°)), C(s) = Kp + Ki/s + Kd s."""
    omega = 2 * np.pi * bandwidth_hz
    wanted = -np.exp(1j * np.radians(margin_deg)) / plant.response(omega)
    # Not the angle of `wanted`, which is the same again after a whole turn of delay.
    lead = margin_deg - 90 + np.degrees(omega * plant.delay_s + np.arctan2(omega * plant.mass, plant.viscous))
    if not -90 < lead <= LARGEST_LEAD + 1e-9:
        raise ValueError(f"a bandwidth of {bandwidth_hz:.4g} Hz with a phase margin of {margin_deg:.4g}° is out of reach "
                         f"for a delay of {1e3 * plant.delay_s:.2f} ms; at most "
                         f"{largest_bandwidth_hz(plant, margin_deg):.4g} Hz")
    kp = wanted.real
    ki = kp * omega / INTEGRAL_RATIO
    kd = max((wanted.imag + ki / omega) / omega, 0.0)  # where viscous friction alone leaves more phase than is asked for
    return float(kp), float(ki), float(kd)


def open_loop(plant, gains, omega):
    """Of position, law and plant."""
    kp, ki, kd = gains
    s = 1j * omega
    return (kp + ki / s + kd * s) * plant.response(omega)


def bode(plant, gains, frequency):
    """Magnitude of the open loop, and its phase in degrees, which begins between -360 and 0."""
    response = open_loop(plant, gains, 2 * np.pi * frequency)
    phase = np.degrees(np.unwrap(np.angle(response)))
    return np.abs(response), phase - 360 * np.ceil(phase[0] / 360)


def margins(plant, gains):
    """Crossover (Hz), phase margin (degrees) and the peak of the sensitivity function."""
    omega = 2 * np.pi * np.geomspace(0.5, 500, 40000)
    loop = open_loop(plant, gains, omega)
    above = np.flatnonzero((np.abs(loop[:-1]) >= 1) & (np.abs(loop[1:]) < 1))
    if len(above) == 0:
        return 0.0, 0.0, float("inf")
    at = above[-1]
    phase = float(np.degrees(np.angle(-loop[at])))
    return float(omega[at] / (2 * np.pi)), phase, float(np.max(1 / np.abs(1 + loop)))


def step_response(plant, gains, period, duration_s=0.15):
    """The joint's answer to a step of its setpoint by 1, cycle by cycle: the discrete law of docs/servo.md on the exact
    plant, friction left out."""
    kp, ki, kd = gains
    steps = 20
    dt = period / steps
    count = int(duration_s / period)
    late = plant.delay_s - period / 2  # the hold is half a cycle of it
    queue = np.zeros(count * steps + int(late / dt) + steps + 2)
    x = v = integral = 0.0
    past = [0.0, 0.0]
    out = np.zeros(count)
    for k in range(count):
        out[k] = x
        speed = (3 * x - 4 * past[0] + past[1]) / (2 * period)
        past = [x, past[0]]
        integral += ki * (1 - x) * period
        begin = k * steps + int(round(late / dt))
        queue[begin:begin + steps] = kp * (1 - x) - kd * speed + integral
        for i in range(steps):
            v += (queue[k * steps + i] - plant.viscous * v) / plant.mass * dt
            x += v * dt
    return np.arange(count) * period, out


def as_json(plant):
    """For programs."""
    return asdict(plant)

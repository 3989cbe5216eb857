"""What a joint answers to its effort: measured in a flight record of swept sines, and a model of it.

The record is of joints that went at steady speeds under SweptSineServoControlLaw, whose sine has the other sign in
every second period. Of two periods one after the other, only odd lines are the answer to it (Pintelon and Schoukens,
System Identification, 2nd ed., 5.2). Each pair fades in and out by the window of Hann, which leaves to an odd line half
of itself and takes a quarter of its neighbours, that hold no answer. How much is noise tells how pairs differ, line by
line.

mm, deg, s, N, N·m, Hz, as in docs/servo.md."""

from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import least_squares
from servo_model import period_of

# A line whose answer is known no better than this (standard deviation over size) says nothing.
WORST_LINE = 0.5
# Of the model: a line is never believed to better than this, because friction and cogging are not linear.
LINE_SPREAD = 0.05
# A further mode has to take so much of what the model leaves, and more than the best of its five numbers would take of
# noise alone, in squares of the lines' spread: 26 once in 10 000 places.
WORTH_A_MODE = 0.6
NOISE_OF_A_MODE = 30
MOST_MODES = 3
FEWEST_LINES = 40
# What is damped more is friction, not a mode.
MOST_DAMPING = 0.15


class Unmeasured(Exception):
    """The record does not say what the joint answers."""


class Unheard(Unmeasured):
    """More sines may say it."""


@dataclass
class Response:
    """Position over effort at `frequency`, delay of drive and bus included, as the loop's samples show it."""

    frequency: np.ndarray
    value: np.ndarray
    spread: np.ndarray  # standard deviation of `value` over its size

    @property
    def coherence(self):
        """Share of the answer's power that the sine explains."""
        return 1 / (1 + self.spread**2)


@dataclass
class Mode:
    """A resonance as a pair of poles of sampled data, and what it adds to the rigid joint's answer: `over` (z², z, 1) over
    z and its poles. What swings faster than half the sampling rate is such a pair as well, at its image."""

    resonance: float  # rad a cycle
    damping: float
    over: tuple = (0.0, 0.0, 0.0)

    def shifted(self, factor, folded):
        """As on a machine whose resonance is elsewhere because it is stiffer: 1/factor² as compliant. `folded`: it is
        the image of one beyond half the sampling rate, and goes the other way."""
        angle = 2 * np.pi - factor * (2 * np.pi - self.resonance) if folded else factor * self.resonance
        angle = abs((angle + np.pi) % (2 * np.pi) - np.pi)
        moved = Mode(float(np.clip(angle, 0.05, 0.995 * np.pi)), self.damping)
        one = np.zeros(1)
        gain = self.poles(one).real[0] / moved.poles(one).real[0] / factor**2
        return Mode(moved.resonance, moved.damping, tuple(gain * share for share in self.over))

    def may_be_an_image(self):
        """Of a resonance that still moves metal: at most 0.7 of the sampling rate."""
        return self.resonance > 0.6 * np.pi

    def poles(self, angle):
        """1 over them, at `angle` rad a cycle."""
        z = np.exp(1j * angle)
        radius = np.exp(-self.damping * self.resonance)
        turn = 2 * radius * np.cos(self.resonance * np.sqrt(1 - self.damping**2))
        return 1 / (z**2 - turn * z + radius**2)

    def parts(self, angle):
        """Answers to each of `over`."""
        z = np.exp(1j * angle)
        return [power * self.poles(angle) for power in (z, np.ones_like(z), 1 / z)]

    def response(self, angle):
        """At `angle` rad a cycle."""
        return sum(share * part for share, part in zip(self.over, self.parts(angle)))


@dataclass
class Model:
    """mass·a = effort and modes beside it, `delay_s` late and behind a lag (the current loop). Beside, not behind: a
    sampled joint is the sum of its modes exactly, wherever they are."""

    period: float
    mass: float
    delay_s: float
    lag_s: float = 0.0
    modes: list = field(default_factory=list)
    misfit: float = 0.0  # rms of the relative deviation from the measured lines, each weighted by how well it is known

    def response(self, frequency):
        """Position over effort."""
        angle = 2 * np.pi * frequency * self.period
        answer = _rigid(angle, self.delay_s / self.period) * self.period**2 / self.mass
        answer = answer + _late(angle, self.delay_s / self.period) * sum(mode.response(angle) for mode in self.modes)
        return answer / (1 + 2j * np.pi * frequency * self.lag_s)

    def resonances(self):
        """Frequency (Hz) and damping of each mode."""
        return [(mode.resonance / (2 * np.pi * self.period), mode.damping) for mode in self.modes]

    def shifted(self, factor, folded=False):
        """With all modes elsewhere by `factor`."""
        modes = [mode.shifted(factor, folded and mode.may_be_an_image()) for mode in self.modes]
        return Model(self.period, self.mass, self.delay_s, self.lag_s, modes)


def _late(angle, cycles):
    """The whole cycles of a delay of `cycles`, of which half a cycle is the hold's."""
    return np.exp(-1j * angle * np.floor(max(cycles - 0.5, 0)))


def _rigid(angle, cycles):
    """A double integrator behind a hold and a delay, of which a part of a cycle is left: exact, because near half the
    sampling rate little else is left of a rigid joint. 1 for a mass of 1 and a cycle of 1."""
    z = np.exp(1j * angle)
    part = max(cycles - 0.5, 0) % 1
    shape = (1 - part) ** 2 * z**2 + (1 + 2 * part - 2 * part**2) * z + part**2
    return _late(angle, cycles) * shape / (2 * z * (z - 1) ** 2)


def steady_stretches(velocity, acceleration, period):
    """Begin and end of each, as SweptSine::is_steady has them."""
    speed = np.abs(velocity)
    steady = (speed > 1e-6) & (np.abs(acceleration) * period <= 1e-3 * speed)
    edges = np.flatnonzero(np.diff(np.concatenate(([False], steady, [False])).astype(int)))
    return [(int(begin), int(end)) for begin, end in zip(edges[::2], edges[1::2])]


def sines_of(columns, joint, sweep_s, sweeps):
    """Rows of each pair of sines in the record's `columns` of joint `joint` (from 1): in each steady stretch `sweeps` of `sweep_s`, of
    which the first is how the joint gets into its periodic state."""
    half = int(round(sweep_s / period_of(columns)))
    for begin, end in steady_stretches(columns[f"qd{joint}"], columns[f"qdd{joint}"], period_of(columns)):
        for first in range(begin + half, min(end, begin + sweeps * half) - 2 * half + 1, 2 * half):
            yield slice(first, first + 2 * half)


def measure(records, joint, sweep_s, sweeps, band):
    """The response of joint `joint` (from 1) in the columns of these records together, over `band` (Hz). Pairs of sines fade in and
    out: what drifts meanwhile, as a joint that cogs or rings in front of a soft loop, would be in every line otherwise."""
    period = period_of(records[0])
    half = int(round(sweep_s / period))
    pairs = [[_level(values[part]) for values in (columns[f"a{joint}"] - columns[f"q{joint}"], columns[f"effort{joint}"])]
             for columns in records for part in sines_of(columns, joint, sweep_s, sweeps)]
    if len(pairs) < 2:
        raise Unmeasured("the joint was at a steady speed for too short a time; give it more travel")
    frequency = np.fft.rfftfreq(2 * half, period)
    odd = np.arange(1, len(frequency) - 1, 2)
    odd = odd[(frequency[odd] >= band[0]) & (frequency[odd] <= band[1])]
    # The window of Hann adds to an odd line its neighbours, which are even, and hold no answer.
    lines = np.fft.rfft(np.array(pairs) * np.hanning(2 * half + 1)[:-1])[:, :, odd]
    return _answer(lines, frequency[odd])


def _answer(lines, frequency):
    """Of lines of position and effort, pair by pair."""
    answers, efforts = lines[:, 0], lines[:, 1]
    effort = efforts.mean(axis=0)
    value = answers.mean(axis=0) / effort
    # Noise gets into the effort, too, by the loop: what counts is what no effort explains.
    unexplained = np.var(answers - value * efforts, axis=0, ddof=1) / len(answers)
    return Response(frequency, value, np.sqrt(unexplained) / np.abs(value * effort))


def _level(values):
    """Without what a sine does not explain: the straight line between the ends' means."""
    index = np.arange(len(values))
    return values - np.polyval(np.polyfit(index, values, 1), index)


def fit(response, period):
    """The model that is nearest to the lines of `response`, with as few modes as explain them."""
    good = response.spread < WORST_LINE
    if good.sum() < FEWEST_LINES:
        raise Unheard(f"only {good.sum()} of {len(good)} frequencies rise above noise; a larger sweep says more")
    lines = _Lines(2 * np.pi * response.frequency[good] * period, response.value[good], response.spread[good])
    best, left = None, np.inf
    for count in range(MOST_MODES + 1):
        found = lines.refine(lines.best_start(best[2:] if best is not None else [], with_mode=count > 0))
        cost = np.sum(lines.deviation(found) ** 2)
        if cost > min(WORTH_A_MODE * left, left - NOISE_OF_A_MODE) or lines.at_a_bound(found):
            break
        best, left = found, cost
    shares = lines.shares(best)
    if shares[0] <= 0:
        raise Unmeasured("the answer is not that of a mass")
    modes = [Mode(best[2 + 2 * i], best[3 + 2 * i], tuple(shares[1 + 3 * i:4 + 3 * i])) for i in range(len(best) // 2 - 1)]
    rms = np.sqrt(left / np.sum(lines.weight**2))
    return Model(period, float(period**2 / shares[0]), float(best[0] * period), float(best[1] * period), modes, float(rms))


class _Lines:
    """Measured lines, and how far models are from them. A model is its numbers: delay and lag in cycles, and of each mode
    its angle and damping. What a model is linear in, 1/mass and `over` of each mode, is the best for these numbers
    (variable projection: Golub and Pereyra, 1973)."""

    def __init__(self, angle, value, spread):
        self.angle, self.value = angle, value
        self.weight = 1 / np.sqrt(spread**2 + LINE_SPREAD**2)

    def _columns(self, numbers):
        late = _late(self.angle, numbers[0]) / (1 + 1j * self.angle * numbers[1])
        columns = [_rigid(self.angle, numbers[0]) / (1 + 1j * self.angle * numbers[1])]
        for resonance, damping in np.reshape(numbers[2:], (-1, 2)):
            columns += [late * part for part in Mode(resonance, damping).parts(self.angle)]
        relative = np.array(columns).T * (self.weight / self.value)[:, None]
        return np.concatenate([relative.real, relative.imag])

    def _solved(self, numbers):
        columns = self._columns(numbers)
        scale = np.linalg.norm(columns, axis=0)
        wanted = np.concatenate([self.weight, np.zeros(len(self.weight))])
        shares = np.linalg.lstsq(columns / scale, wanted, rcond=None)[0]
        return shares / scale, wanted - columns @ (shares / scale)

    def shares(self, numbers):
        """1/mass, in cycles, and `over` of each mode."""
        return self._solved(numbers)[0]

    def deviation(self, numbers):
        """Relative and weighted, real and imaginary parts."""
        return self._solved(numbers)[1]

    def best_start(self, modes, with_mode):
        """Of a grid of delays, and of places of a further mode beside `modes`."""
        places = [None]
        if with_mode:
            places = np.concatenate([self.angle[self.angle > 1.3 * self.angle[0]][::3], [0.97 * np.pi, 0.985 * np.pi]])
        starts = []
        for delay in np.arange(0.75, 5, 0.25):
            for place in places:
                starts += [[delay, 0.1, *modes, *([place, damping] if with_mode else [])]
                           for damping in ((0.01, 0.04) if with_mode else (0,))]
        return min(starts, key=lambda numbers: np.sum(self.deviation(numbers) ** 2))

    def _bounds(self, numbers):
        modes = (len(numbers) - 2) // 2
        return (np.array([0.5, 0.0] + modes * [1.2 * self.angle[0], 0.001]),
                np.array([10.0, 3.0] + modes * [0.995 * np.pi, MOST_DAMPING]))

    def at_a_bound(self, numbers):
        """Whether a mode's place or damping would go on beyond what is searched: it stands for something that is no mode."""
        low, high = self._bounds(numbers)
        near = 1e-3 * (high - low)
        places, dampings = numbers[2::2], numbers[3::2]
        return bool(np.any(places < (low + near)[2::2]) or np.any(places > (high - near)[2::2]) or np.any(dampings > (high - near)[3::2]))

    def refine(self, numbers):
        """The nearest best."""
        low, high = self._bounds(numbers)
        start = np.clip(numbers, low + 1e-6, high - 1e-6)
        return least_squares(self.deviation, start, bounds=(low, high), x_scale="jac", max_nfev=100).x

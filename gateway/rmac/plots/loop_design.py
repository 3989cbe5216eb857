"""Gains and filters for a joint of which frequency_response.py has a model: the loop as the appliance samples it, its
margins, and the search for the quickest one that keeps them also where the resonances are elsewhere.

The law is PIDServoControlLaw of docs/servo.md, the filters are `Resonances` and `LowPass` of device.json."""

from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

# A proportional and derivative law cannot lead by more than this (degrees) without gains that only amplify noise.
LARGEST_LEAD = 75.0
# Integral time in units of the inverse crossover frequency.
INTEGRAL_RATIO = 4.0
# By how much each resonance may be elsewhere than it was measured (other load, other place, other temperature), and
# whether it is the image of one beyond half the sampling rate.
ELSEWHERE = ((1.0, False), (0.85, False), (0.925, False), (1.075, False), (1.15, False), (0.85, True), (0.925, True),
             (1.075, True), (1.15, True))
# Least distance of the open loop from -1: the gain may then double (6 dB), and the phase fall behind by 30°.
LEAST_DISTANCE = 0.53
# Of the largest bandwidth that keeps that distance on the model, what is proposed: a model is not the joint itself.
OF_THE_QUICKEST = 0.92
# By so much bandwidth a filter more, or a wider one, has to be worth it.
WORTH_FILTERS = 1.1
# How near the largest bandwidth is found. Steps that show would turn noise, which moves it a little, into other gains.
NEAR = 1.003
# Of the sampling rate, as device.json takes it.
HIGHEST_NOTCH = 0.4
# Of notches and low-passes that are tried.
WIDTHS = (0.3, 0.5, 0.7, 1.0, 1.4)
DEPTHS = (0.05, 0.2)
CORNERS = (0.0, 0.35, 0.25, 0.18, 0.12)  # of the low-pass, as shares of the sampling rate; 0: none


class Undesignable(Exception):
    """No loop keeps its margins."""


@dataclass
class Notch:
    """(s² + 2·damping·ω·s + ω²) / (s² + 2·width·ω·s + ω²)."""

    frequency: float
    damping: float
    width: float


@dataclass
class Filters:
    """What is between law and drive."""

    notches: list = field(default_factory=list)
    low_pass: float = 0.0

    def response(self, frequency, period):
        """Each as EffortFilter has it: exact at its own frequency, by the bilinear rule."""
        total = np.ones(len(frequency), dtype=complex)
        for notch in self.notches:
            w = _warped(frequency, notch.frequency, period)
            total *= (1 - w**2 + 2j * notch.damping * w) / (1 - w**2 + 2j * notch.width * w)
        if self.low_pass > 0:
            w = _warped(frequency, self.low_pass, period)
            total *= 1 / (1 - w**2 + 2j * np.sqrt(0.5) * w)
        return total


    def delay_s(self):
        """Of what is far slower than the filters."""
        notches = sum((notch.width - notch.damping) / (np.pi * notch.frequency) for notch in self.notches)
        return notches + (np.sqrt(2) / (2 * np.pi * self.low_pass) if self.low_pass > 0 else 0)


@dataclass
class Loop:
    """What closes around a joint."""

    gains: tuple  # Kp, Ki, Kd
    filters: Filters = field(default_factory=Filters)
    derivative_filter_s: float = 0.0


@dataclass
class Margins:
    """Of a loop; `stable` false: the rest means nothing."""

    stable: bool
    bandwidth_hz: float
    phase_margin_deg: float
    gain_margin_db: float
    sensitivity_peak: float


def _warped(frequency, corner, period):
    """Frequency over `corner`, as the bilinear rule bends both."""
    return np.tan(np.pi * frequency * period) / np.tan(np.pi * corner * period)


def law_response(loop, frequency, period):
    """Of effort over error."""
    kp, ki, kd = loop.gains
    back = np.exp(-2j * np.pi * frequency * period)
    speed = (3 - 4 * back + back**2) / (2 * period)
    share = period / (period + loop.derivative_filter_s)
    speed = speed * share / (1 - (1 - share) * back)
    return kp + ki * period / (1 - back) + kd * speed


def open_loop(loop, model, frequency):
    """Of position, law, filters and joint."""
    period = model.period
    return (law_response(loop, frequency, period) * loop.filters.response(frequency, period)
            * model.response(frequency))


def grid(model):
    """Frequencies at which nothing of `model` is missed."""
    end = 0.5 / model.period
    parts = [np.geomspace(0.3, 0.999 * end, 600)]
    for mode in model.modes:
        at = mode.resonance / (2 * np.pi * model.period)
        parts.append(at * (1 + max(mode.damping, 0.003) * np.linspace(-5, 5, 101)))
    points = np.unique(np.concatenate(parts))
    return points[(points > 0.3) & (points < 0.999 * end)]


def margins(response, frequency):
    """Of an open loop `response` over `frequency`, which begins far below the crossover: Nyquist's criterion for a loop
    whose only poles that are not stable are those of integrators."""
    distance = 1 + response
    turned = np.unwrap(np.angle(distance))
    begin = turned[0] - 2 * np.pi * np.ceil(turned[0] / (2 * np.pi) - 1e-9)  # in (-360°, 0]
    stable = abs(begin + turned[-1] - turned[0]) < np.pi
    size = np.abs(response)
    above = np.flatnonzero((size[:-1] >= 1) & (size[1:] < 1))
    if len(above) == 0:
        return Margins(False, 0, 0, 0, np.inf)
    # The first crossover is the loop's; the margin is the least of all.
    phases = np.degrees(np.angle(-response[np.concatenate([above, np.flatnonzero((size[:-1] < 1) & (size[1:] >= 1))])]))
    behind = np.flatnonzero(np.diff(np.sign(response.imag)) != 0)
    behind = behind[response.real[behind] < 0]
    excess = size[behind]
    gain = 20 * np.log10(1 / excess[excess < 1].max()) if np.any(excess < 1) else np.inf
    return Margins(bool(stable), float(frequency[above[0]]), float(np.abs(phases).min()), float(gain),
                   float(1 / np.abs(distance).min()))


def gains_for(model, filters, bandwidth_hz, margin_deg):
    """Kp, Ki, Kd with which the loop crosses 1 at `bandwidth_hz` with `margin_deg` of phase left; None where a law
    cannot lead so far."""
    at = np.array([bandwidth_hz])
    joint = complex((filters.response(at, model.period) * model.response(at))[0])
    wanted = -np.exp(1j * np.radians(margin_deg)) / joint
    lead = np.degrees(np.angle(wanted))
    if not -90 < lead <= LARGEST_LEAD:
        return None
    omega = 2 * np.pi * bandwidth_hz
    # The sampled derivative is not quite jω, nor the sampled integral 1/jω: solved for the law as it is.
    parts = [law_response(Loop(unit), at, model.period)[0] for unit in ((1, omega / INTEGRAL_RATIO, 0), (0, 0, 1))]
    kp, kd = np.linalg.solve([[part.real for part in parts], [part.imag for part in parts]],
                             [wanted.real, wanted.imag])
    if kp <= 0:
        return None
    return float(kp), float(kp * omega / INTEGRAL_RATIO), float(max(kd, 0))


def margins_of(loop, model):
    """Of `loop` on the joint as it was measured."""
    frequency = grid(model)
    return margins(open_loop(loop, model, frequency), frequency)


def judge(loop, model):
    """The worst of `loop` on `model` and with its modes elsewhere."""
    worst = None
    places = ELSEWHERE if model.modes else ELSEWHERE[:1]
    for shift, folded in places:
        if folded and not any(mode.may_be_an_image() for mode in model.modes):
            continue
        found = margins_of(loop, model.shifted(shift, folded))
        if worst is None or found.sensitivity_peak > worst.sensitivity_peak or not found.stable:
            worst = found
        if not worst.stable:
            break
    return worst


def holds(loop, model):
    """Whether its margins are kept wherever the modes are."""
    worst = judge(loop, model)
    return worst.stable and worst.sensitivity_peak * LEAST_DISTANCE <= 1


def quickest(model, filters, margin_deg, most_hz):
    """The largest bandwidth with which a loop behind these filters holds; None where none does."""
    def held(bandwidth):
        gains = gains_for(model, filters, bandwidth, margin_deg)
        return bool(gains) and holds(Loop(gains, filters), model)

    steps = np.geomspace(2, most_hz, 40)
    index = next((index for index in reversed(range(len(steps))) if held(steps[index])), None)
    if index is None or index + 1 == len(steps):
        return None if index is None else float(steps[index])
    low, high = steps[index], steps[index + 1]
    while high > NEAR * low:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if held(middle) else (low, middle)
    return float(low)


def candidates(model):
    """Filters that are worth a try, the fewest first."""
    places = [round(frequency, 2) for frequency, _ in model.resonances() if frequency <= HIGHEST_NOTCH / model.period]
    for count in range(len(places) + 1):
        for notched in combinations(places, count):
            for width in WIDTHS if notched else (0,):
                for depth in DEPTHS if notched else (0,):
                    for corner in CORNERS:
                        yield Filters([Notch(place, depth, width) for place in notched],
                                      round(corner / model.period, 2))


def loop_at(model, filters, bandwidth_hz, margin_deg):
    """The loop of this bandwidth, None where it does not keep its margins."""
    gains = gains_for(model, filters, bandwidth_hz, margin_deg)
    return Loop(gains, filters) if gains and holds(Loop(gains, filters), model) else None


def design(model, margin_deg, bandwidth_hz=0.0):
    """The loop with nearly the largest bandwidth, or with `bandwidth_hz`, that keeps its margins."""
    if bandwidth_hz > 0:
        for filters in candidates(model):
            if loop := loop_at(model, filters, bandwidth_hz, margin_deg):
                return loop
        most = margins_of(design(model, margin_deg), model).bandwidth_hz / OF_THE_QUICKEST
        raise Undesignable(
            f"a bandwidth of {bandwidth_hz:.4g} Hz with a phase margin of {margin_deg:.4g}° is out of reach for a delay of "
            f"{1e3 * model.delay_s:.2f} ms" + (" and the resonances that were found" if model.modes else "")
            + f"; at most about {most:.4g} Hz")
    tried = [(filters, quickest(model, filters, margin_deg, 0.25 / model.period)) for filters in candidates(model)]
    most = max((found for _, found in tried if found), default=0.0)
    for filters, found in tried:
        # Somewhat slower than the edge is not always within it.
        if found and found * WORTH_FILTERS >= most and (loop := loop_at(model, filters, OF_THE_QUICKEST * found, margin_deg)):
            return loop
    raise Undesignable(f"no loop with a phase margin of {margin_deg:.4g}° keeps its distance from what was measured")


def step_response(loop, model, duration_s=0.15):
    """The joint's answer to a step of its setpoint by 1, cycle by cycle, from the closed loop's frequency response: a
    square wave's, slow enough to settle between."""
    count = int(4 * duration_s / model.period)
    frequency = np.fft.rfftfreq(count, model.period)[1:]
    frequency[-1] = 0.4999 / model.period
    closed = open_loop(loop, model, frequency)
    closed = closed / (1 + closed)
    # A step of the position wanted has no rate: the derivative sees the joint alone.
    kp, ki, _ = loop.gains
    closed *= law_response(Loop((kp, ki, 0)), frequency, model.period) / law_response(loop, frequency, model.period)
    square = np.where(np.arange(count) < count // 2, 0.5, -0.5)
    answer = np.fft.irfft(np.fft.rfft(square) * np.concatenate([[1], closed]), count)
    shown = int(duration_s / model.period)
    return np.arange(shown) * model.period, answer[:shown] + 0.5

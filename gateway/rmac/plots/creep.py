"""What a joint's effort shows where it creeps: how friction builds up before it slides, and its motor's cogging.

    M·a + B·v + C·f + L = u + u_cog(φ), delayed by d

M, B and d are those of the joint's swings (servo_model). f is the friction of bristles that bend by the presliding way
before they slide, as the laws with feedforward work it out (drivers/modules, FeedforwardModel); φ is the encoder's angle
of the motor, and u_cog a few harmonics of it. Two records: strokes of some turns at a steady speed, for cogging, and
short slow ones, for friction."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize
from scipy.signal import savgol_filter
from servo_model import Unidentifiable

# Longer than an encoder's noise, shorter than a period of cogging at creep speed.
WINDOW_S = 0.009
ELASTIC = 0.3  # share of friction below which bristles only bend, as FeedforwardModel has it
# Lower orders may be the guide's, which do not come again in the next turn: those of the motor do, in both directions, within a share.
LOWEST_ORDER = 6
REPEATS = 0.25
HIGHEST_ORDER = 240
MOST_HARMONICS = 6
LEAST_SHARE = 0.001  # of the rated torque; less is not worth a harmonic
# Of what a rigid joint shows of a harmonic: where a soft one shows more than so many times as much, or as little, what it shows says
# more about how it bends and sticks than about the motor.
MOST_BENT = 1.5
LEAST_EXPLAINED = 0.5  # of what creeping takes: less, and what was found is not what the joint does
# Of the rated torque: swings of a motor that cogs show so much friction where there is none.
MOST_FALSE_FRICTION = 0.1
MOST_OF_MAP = 16  # harmonics, as device.json takes them
# Presliding, breakaway and Stribeck's speed as the laws with feedforward take them.
SHAPES = ((1e-6, 1.0), (1.0, 3.0), (0.001, 100.0))


@dataclass
class Motor:
    """The one that moves the joint, or the first of several that do so together."""

    actuators: list  # all of them
    turn: float  # mm or deg of the joint for a turn in the drive's sense
    counts_per_turn: float
    rated_torque: float  # N·m
    known: dict  # N·m of harmonics that are taken away already: cosine + j·sine by order

    def angle(self, columns):
        """rad, of each row."""
        return unwrapped(columns[f"counts{self.actuators[0] + 1}"]) * (2 * math.pi / self.counts_per_turn)

    def torque_of(self, effort, unit):
        """N·m at the motor, in the drive's sense, of an effort at the joint."""
        way = self.turn / (2 * math.pi) * (math.pi / 180 if unit == "deg" else 1e-3)
        return effort * way


@dataclass
class Friction:
    """Of a joint that slides, and how it builds up."""

    sliding: float
    presliding: float
    breakaway: float
    stribeck_speed: float


NO_FRICTION = Friction(0.0, 0.0, 1.0, 1.0)


@dataclass
class Creep:
    """What was found. `explained`: of what the joint of the swings leaves open in these records. `hidden`: harmonics that are there,
    and of which the joint shows too little, or too much, to tell them."""

    friction: Friction
    load: float
    harmonics: list  # (order, cosine, sine) of the motor's own torque, N·m
    explained: float
    hidden: list  # (order, Hz at which it passed)


def unwrapped(counts):
    """Counts of a word that wraps at 32 bits, from its first value on."""
    steps = (np.diff(counts) + 2.0 ** 31) % 2.0 ** 32 - 2.0 ** 31
    return counts[0] + np.concatenate([[0.0], np.cumsum(steps)])


def motor_of(head, columns, joint):
    """The motor that moved with the joint, and the joint's way for a turn of it; of several, which turn alike, the first."""
    place = columns[f"a{joint + 1}"]
    moved = []
    for index, scale in enumerate(head.get("actuators", [])):
        turns = unwrapped(columns[f"counts{index + 1}"]) / scale["counts_per_revolution"]
        if np.ptp(turns) > 0.05:
            moved.append((index, scale, turns))
    if not moved:
        raise Unidentifiable("no motor moved with the joint")
    ways = []
    for _, _, turns in moved:
        turn, offset = np.polyfit(turns, place, 1)
        if np.max(np.abs(turn * turns + offset - place)) > 0.005 * np.ptp(place):
            raise Unidentifiable("the joint does not go in proportion to its motors, so that neither friction nor cogging is found")
        ways.append(abs(turn))
    if max(ways) > 1.01 * min(ways):
        raise Unidentifiable(f"its {len(moved)} motors do not turn alike, so that neither friction nor cogging is found")
    index, scale, turns = moved[0]
    return Motor([index for index, _, _ in moved], float(np.polyfit(turns, place, 1)[0]), scale["counts_per_revolution"],
                 scale["rated_torque"],
                 {one["order"]: complex(one["cosine"], one["sine"]) for one in scale.get("cogging", {}).get("harmonics", [])})


def apart(motor, head, columns):
    """mm or deg of the joint by which its motors, which turn alike, went out of step at most, beside how they stood before."""
    turns = np.array([unwrapped(columns[f"counts{index + 1}"]) / head["actuators"][index]["counts_per_revolution"] for index in motor.actuators])
    gone = turns - turns[:, :1]
    same = np.sign(gone @ gone[0])  # of two that face each other, one turns the other way
    return float(np.ptp(abs(motor.turn) * same[:, None] * gone, axis=0).max())


def no_cogging(motor):
    """Why the motor's own torque is not told; None where it is. What the joint shows is the sum of its motors', by an angle that they
    all share: how much of it is whose cannot be seen, nor with which phase."""
    if len(motor.actuators) == 1:
        return None
    return f"its {len(motor.actuators)} motors turn alike, and the joint shows the sum of their cogging, not whose it is"


def bent(way, speed, breakaway, stribeck_speed):
    """Friction in shares of sliding friction, for ways in presliding ways: FeedforwardModel::bent, row after row."""
    bounds = 1 + (breakaway - 1) * np.exp(-(speed / stribeck_speed) ** 2)
    friction, result = 0.0, []
    for step, bound in zip(way.tolist(), bounds.tolist()):
        end = math.copysign(bound, step)
        slides = min(max(((friction + step / 2) / end - ELASTIC) / (1 - ELASTIC), 0.0), 1.0)
        gone = slides * abs(step) / bound
        share = -math.expm1(-gone) / gone if gone > 1e-9 else 1.0
        friction = min(max(friction + step * share * (1 - slides * friction / end), -bound), bound)
        result.append(friction)
    return np.array(result)


class Strokes:
    """One record, smoothed alike: effort and motion, so that it changes nothing between them."""

    def __init__(self, columns, joint, motor, plant, period):
        window = max(5, int(round(WINDOW_S / period)) | 1)
        self._smooth = lambda values: savgol_filter(values, window, 2)
        place = columns[f"a{joint + 1}"]
        speed = np.gradient(place, period)
        acceleration = np.zeros(len(place))
        acceleration[1:-1] = np.diff(place, 2) / period ** 2
        index = np.arange(len(place), dtype=float)
        effort = np.interp(index - plant.delay_s / period, index, columns[f"effort{joint + 1}"])
        self.left = self._smooth(effort - plant.mass * acceleration - plant.viscous * speed)
        self.speed = self._smooth(speed)
        self.way = np.diff(self._smooth(place), prepend=place[0])
        self.way[0] = 0
        self.angle = motor.angle(columns)
        wanted = np.abs(columns[f"qd{joint + 1}"])
        edge = window + int(plant.delay_s / period) + 2
        self.used = np.zeros(len(place), dtype=bool)
        self.used[edge:-edge] = True
        self.steady = self.used & (wanted > 0.98 * np.max(wanted))

    def friction(self, presliding, breakaway, stribeck_speed):
        """Its share in each row."""
        return self._smooth(bent(self.way / presliding, self.speed, breakaway, stribeck_speed))

    def harmonics(self, orders):
        """cos and sin of each."""
        waves = [wave(order * self.angle) for order in orders for wave in (np.cos, np.sin)]
        return [self._smooth(values) for values in waves]


def solve(strokes, shape, orders):
    """Sliding friction, load and amplitudes that leave the least, and what they leave, in all records together."""
    rows, right = [], []
    for one in strokes:
        columns = [one.friction(*shape), np.ones(len(one.left)), *one.harmonics(orders)]
        rows.append(np.column_stack(columns)[one.used])
        right.append(one.left[one.used])
    matrix, wanted = np.vstack(rows), np.concatenate(right)
    found, *_ = np.linalg.lstsq(matrix, wanted, rcond=None)
    return found, wanted - matrix @ found, wanted


def stretches_of(turning):
    """Rows of each stretch at a steady speed."""
    used = np.flatnonzero(turning.steady)
    return [part for part in np.split(used, np.flatnonzero(np.diff(used) > 1) + 1) if len(part) > 200]


def spectrum(turning, left, orders):
    """Amplitude of each order in what is left of the steady stretches: what changes slowly is taken out of each, and it is
    faded in and out, so that a strong order does not hide a weak one."""
    total, weight = np.zeros(len(orders), dtype=complex), 0.0
    for part in stretches_of(turning):
        angle, values, fade = turning.angle[part], left[part], np.hanning(len(part))
        values = values - np.polyval(np.polyfit(angle, values, 3), angle)
        total += np.exp(-1j * np.outer(orders, angle)) @ (values * fade)
        weight += fade.sum()
    return 2 * np.abs(total) / max(weight, 1e-9)


def low_orders(turning, left, least):
    """Those below LOWEST_ORDER that come again, in each turn and both directions, in what is left of the steady stretches."""
    low = range(1, LOWEST_ORDER)
    told = []
    for part in stretches_of(turning):
        begin = turning.angle[part[0]]
        for one in np.array_split(part, max(1, round(np.ptp(turning.angle[part]) / (2 * np.pi)))):
            waves = [wave(order * turning.angle[one]) for order in low for wave in (np.cos, np.sin)]
            columns = np.column_stack([np.ones(len(one)), turning.angle[one] - begin, *waves])
            found, *_ = np.linalg.lstsq(columns, left[one], rcond=None)
            told.append(found[2::2] + 1j * found[3::2])
    if len(told) < 4:
        return []
    mean = np.mean(told, axis=0)
    again = np.abs(np.array(told) - mean).max(axis=0) <= REPEATS * np.abs(mean)
    return [order for order, size, repeats in zip(low, np.abs(mean), again) if repeats and size >= least]


def orders_of(turning, shape, known, least):
    """Orders of cogging in what strokes at a steady speed leave, strongest first."""
    orders = list(known)
    found, _, _ = solve([turning], shape, orders)
    columns = [turning.friction(*shape), np.ones(len(turning.left)), *turning.harmonics(orders)]
    low = low_orders(turning, turning.left - np.column_stack(columns) @ found, least)
    orders += [order for order in low if order not in orders]
    per_row = np.quantile(np.abs(np.diff(turning.angle[turning.steady])), 0.9)
    tried = np.arange(LOWEST_ORDER, int(min(HIGHEST_ORDER, np.pi / (3 * per_row))) + 1)
    most = max(MOST_HARMONICS, len(known)) + len(low)
    while len(orders) < most and len(tried):
        found, _, _ = solve([turning], shape, orders)
        columns = [turning.friction(*shape), np.ones(len(turning.left)), *turning.harmonics(orders)]
        sizes = spectrum(turning, turning.left - np.column_stack(columns) @ found, tried)
        sizes[np.isin(tried, orders)] = 0
        if sizes.max() < max(least, 5 * np.median(sizes)):
            break
        orders.append(int(tried[np.argmax(sizes)]))
    return orders


def stiffer(joint_model, plant, hz):
    """How much more effort a rigid joint takes for the same motion: the harmonics are found as of one, and the joint is `joint_model`."""
    rigid = type(joint_model)(joint_model.period, joint_model.mass, plant.delay_s)
    return abs(rigid.response(hz)) / abs(joint_model.response(hz))


def find(head, records, joint, plant, joint_model):
    """`records`: columns of the strokes at a steady speed, and of the short ones; `joint_model`: what the joint answers to an effort
    (frequency_response.Model)."""
    period = joint_model.period
    motor = motor_of(head, records[0], joint)
    unit = head["joints"][joint]["unit"]
    turning, short = (Strokes(columns, joint, motor, plant, period) for columns in records)
    least = LEAST_SHARE * motor.rated_torque / abs(motor.torque_of(1.0, unit))
    turn = abs(motor.turn)

    def shape_of(logarithms):
        presliding, beyond, stribeck = logarithms
        shape = turn * np.exp(presliding), 1 + np.exp(beyond), np.median(np.abs(turning.speed)) * np.exp(stribeck)
        return tuple(float(np.clip(value, *bounds)) for value, bounds in zip(shape, SHAPES))

    start = np.log([0.001, 0.1, 0.5])
    known = list(motor.known)
    orders = orders_of(turning, shape_of(start), known, least)
    best = start
    for _ in range(2):
        def misses(logarithms):
            # Weakly towards where it began: what the records do not tell is to stay a number.
            wander = 2e-6 * float(np.sum((logarithms - start) ** 2))
            _, left, wanted = solve([turning, short], shape_of(logarithms), orders)
            return float(np.mean(left ** 2) / np.mean((wanted - wanted.mean()) ** 2)) + wander
        best = minimize(misses, best, method="Nelder-Mead", options={"maxfev": 60, "xatol": 0.02, "fatol": 1e-6}).x
        orders = orders_of(turning, shape_of(best), known, least)
    shape = shape_of(best)
    found, left, wanted = solve([turning, short], shape, orders)
    if not found[0] > 0 and not orders:
        raise Unidentifiable("the strokes show no friction; give more --travel, or leave out --creep")
    passing = float(np.median(np.abs(turning.speed[turning.steady]))) / turn  # turns a second
    # Low ones pass so slowly that the loop's effort shows them whole.
    bent_by = {order: 1.0 if order < LOWEST_ORDER else stiffer(joint_model, plant, order * passing) for order in orders}
    amplitudes = [motor.torque_of(-value, unit) for value in found[2:]]
    left_over = {order: bent_by[order] * complex(amplitudes[2 * i], amplitudes[2 * i + 1]) for i, order in enumerate(orders)}
    hidden = [order for order, share in bent_by.items() if not 1 / MOST_BENT <= share <= MOST_BENT]
    # Of what is above noise as it is seen and as it would be told.
    seen = {order: abs(left_over.pop(order)) / max(1.0, bent_by[order]) for order in hidden}
    hidden = [order for order, size in seen.items() if size > LEAST_SHARE * motor.rated_torque]
    if no_cogging(motor):
        left_over = {}
    rated = least / LEAST_SHARE
    if not found[0] > least and plant.friction > MOST_FALSE_FRICTION * rated:
        raise Unidentifiable(f"the strokes show no friction, and the swings {plant.friction:.3g}; give more --travel, or leave out --creep")
    friction = Friction(float(found[0]), *shape) if found[0] > least else NO_FRICTION
    whole = {**motor.known, **{order: size + motor.known.get(order, 0) for order, size in left_over.items()}}
    harmonics = [(order, size.real, size.imag) for order, size in whole.items()
                 if abs(size) > LEAST_SHARE * motor.rated_torque]
    harmonics = sorted(harmonics, key=lambda one: -math.hypot(*one[1:]))[:MOST_OF_MAP]
    explained = 1 - float(np.mean(left ** 2) / np.mean((wanted - wanted.mean()) ** 2))
    if explained < LEAST_EXPLAINED and (friction is not NO_FRICTION or harmonics):
        raise Unidentifiable(f"what was found explains {100 * explained:.0f} % of what creeping takes: it is something else; give more "
                             "--travel, of two turns of the motor or more, or leave out --creep")
    return motor, Creep(friction, float(found[1]), harmonics, explained,
                        [] if no_cogging(motor) else [(order, order * passing) for order in hidden])

"""One rigid joint as its servo loop sees it, identified from a flight record of swings.

    M·a + B·v + C·sign(v) + L = u, delayed by d

M moving mass, B viscous and C sliding friction, L hanging load, u the effort, d from the cycle in which an effort is
worked out until it acts: one cycle to the drive, half a cycle of hold, and the current loop. mm, deg, s, N, N·m, as in
docs/servo.md ("What rmac tune does")."""

import json
from dataclasses import asdict, dataclass

import numpy as np
from scipy.optimize import minimize_scalar
from scipy.signal import savgol_coeffs, savgol_filter
from scipy.sparse import csr_matrix

# Window of the polynomials that smooth and differentiate: longer than an encoder's noise, shorter than a jerk phase.
WINDOW_S = 0.015
POLYNOMIAL = 3
# Below this share of the fastest speed of the record friction is not what it is at speed.
SLOW_SHARE = 0.02
LONGEST_DELAY_S = 0.01
# Where less than this is explained, something pulls by where the joint stands, as a motor's magnets and cables do, and a soft loop goes
# along with it. The joint comes by each place several times, at other speeds and both ways: what is the same there each time is left
# out. So is what shakes motion and effort alike by way of the loop.
LITTLE_EXPLAINED = 0.999
PLACES = 200  # along the way
# A joint that rings explains itself as well a period of its resonance later: the earliest delay that leaves at most so
# many times what the best one does.
AS_GOOD = 1.5


@dataclass
class Plant:
    """What was found, and how much of the efforts' variance it explains; `by_place`: how much more what is the same at each place does."""

    mass: float
    viscous: float
    friction: float
    load: float
    delay_s: float
    explained: float = 1.0
    by_place: float = 0.0


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


def period_of(columns):
    """Of the cycle, in s. Records round times to a digit that a cycle's length does not have."""
    return round(float(np.median(np.diff(columns["t_s"]))), 9)


def identify(time, position, effort, period=None, delay=None, window_s=WINDOW_S, wanted=None):
    """The plant behind measured positions and efforts of every cycle. Efforts and motion pass the same filter, of
    `window_s`, so that it changes neither their ratio nor their delay; of all delays that one is right which leaves the
    least, unless it is known. `wanted`: where the joint was sent, in every cycle."""
    period = period or float(np.median(np.diff(time)))
    window = max(5, int(round(window_s / period)) | 1)
    if len(position) < 20 * window:
        raise Unidentifiable(f"{len(position)} cycles are too few")
    smooth = dict(window_length=window, polyorder=POLYNOMIAL)
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

    def effort_at(delay):
        return np.interp(index - delay / period, index, filtered)[used]

    def at_best(delay, beside):
        columns = _each(beside, matrix)

        def solved(delay):
            return _solve(columns, beside(effort_at(delay)))

        if delay is None:
            grid = np.arange(0, LONGEST_DELAY_S, period)  # between two cycles noise is less, which makes valleys of its own
            best = grid[_earliest_valley([solved(at)[1] for at in grid])]
            delay = minimize_scalar(lambda d: solved(d)[1], bounds=(max(0, best - period), best + period), method="bounded").x
        return float(delay), *solved(delay)

    def beside(values):
        return values

    best, (mass, viscous, friction, load), left = at_best(delay, beside)
    total = float(np.sum((effort_at(best) - effort_at(best).mean()) ** 2))
    if left > (1 - LITTLE_EXPLAINED) * total:
        beside = _beside_places(position, window, used)
        best, (mass, viscous, friction, _), _ = at_best(delay, beside)
        if wanted is not None:
            mass, viscous, friction = _as_sent(matrix, effort_at(best), savgol_filter(wanted, deriv=1, delta=period, **smooth)[used],
                                               savgol_filter(wanted, deriv=2, delta=period, **smooth)[used], beside)
        load = float(np.mean(effort_at(best) - matrix[:, :3] @ (mass, viscous, friction)))
    if not mass > 0:
        raise Unidentifiable("the accelerations do not tell its mass; give it more travel")
    plant = Plant(float(mass), max(float(viscous), 0.0), max(float(friction), 0.0), float(load), best)
    left = effort_at(best) - matrix @ (plant.mass, plant.viscous, plant.friction, plant.load)
    total = float(np.sum((effort_at(best) - effort_at(best).mean()) ** 2))
    plant.explained = 1 - float(left @ left) / total
    plant.by_place = float(left @ left - np.sum(beside(left) ** 2)) / total
    return plant


def _each(beside, columns):
    return np.column_stack([beside(column) for column in columns.T])


def _solve(columns, right):
    """Numbers that leave the least of `right`, and how much."""
    found, *_ = np.linalg.lstsq(columns, right, rcond=None)
    return found, float(np.sum((columns @ found - right) ** 2))


def _as_sent(matrix, right, speed, acceleration, beside):
    """Mass, viscous and sliding friction by what the joint was sent: what an encoder's error, or whatever shakes the joint, does to
    motion and effort alike by way of the loop has no part in that (instrumental variables; Söderström and Stoica, System Identification,
    1989, chapter 8)."""
    instruments = _each(beside, np.column_stack([acceleration, speed, np.sign(speed)]))
    columns = _each(beside, matrix[:, :3])
    return np.linalg.lstsq(instruments.T @ columns, instruments.T @ beside(right), rcond=None)[0]


def _beside_places(position, window, used):
    """What takes away all that goes by the place: a polygon over the way, which passes the filter as efforts do. A joint is near few of
    its corners at a time, so most of the numbers are 0."""
    place = (position - position.min()) / np.ptp(position) * PLACES
    below = np.minimum(place.astype(int), PLACES - 1)
    rows, beyond = np.arange(len(position)), place - below
    hats = csr_matrix((np.concatenate([1 - beyond, beyond]), (np.tile(rows, 2), np.concatenate([below, below + 1]))),
                      shape=(len(position), PLACES + 1))
    weights, cycles = savgol_coeffs(window, POLYNOMIAL), np.flatnonzero(used).astype(np.int32)
    near = cycles[:, None] + (np.arange(window, dtype=np.int32) - window // 2)
    smoothing = csr_matrix((np.tile(weights, len(cycles)), near.ravel(), np.arange(len(cycles) + 1, dtype=np.int32) * np.int32(window)),
                           shape=(len(cycles), len(position)))
    places = smoothing @ hats
    size, corners = np.linalg.eigh((places.T @ places).toarray())
    kept = size > 1e-6 * size[-1]
    corners = corners[:, kept] / np.sqrt(size[kept])
    return lambda values: values - places @ (corners @ (corners.T @ (places.T @ values)))


def _earliest_valley(left):
    """Where `left` is about as small as anywhere, and larger on either side."""
    walls = [np.inf, *left, np.inf]
    valleys = [index for index in range(len(left)) if walls[index] >= left[index] <= walls[index + 2]]
    return next(index for index in valleys if left[index] <= AS_GOOD * min(left))


def as_json(plant):
    """For programs."""
    return asdict(plant)

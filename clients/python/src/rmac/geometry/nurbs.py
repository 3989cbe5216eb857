"""NURBS as CAD kernels and scipy have them, brought to the form that the appliance takes: clamped, with flat knots."""

from __future__ import annotations

import itertools
from typing import Any

from rmac.errors import InvalidValue
from rmac.geometry import splines
from rmac.geometry.numbers import finite, text, vector, whole

_MOST_DEGREE = 25


class NurbsCurve:
    """A curve in any number of coordinates. `knots` are flat, or distinct with `multiplicities`; a `periodic` one has the
    knots and poles of OpenCASCADE's, which do not repeat. What is not clamped is clamped, exactly. Not to be changed."""

    __slots__ = ("degree", "knots", "points", "weights")

    def __init__(self, degree: int, knots: Any, points: Any, weights: Any = None, *, multiplicities: Any = None, periodic: bool = False) -> None:
        self.degree = _degree(degree)
        places = [finite(point, f"control point {number}") for number, point in enumerate(_listed(points))]
        if not places or any(len(place) != len(places[0]) for place in places):
            raise InvalidValue("control points must all have as many coordinates, and there must be some")
        weight = (1.0,) * len(places) if weights is None else vector(weights, "weights", len(places))
        if min(weight) <= 0:
            raise InvalidValue(f"weight {weight.index(min(weight))} is {min(weight)}: weights must be positive")
        flat = _flat(finite(knots, "knots"), multiplicities)
        homogeneous = [(*(w * x for x in place), w) for place, w in zip(places, weight)]
        if periodic:
            flat, homogeneous = _unrolled(self.degree, flat, multiplicities, homogeneous)
        _check(self.degree, flat, len(homogeneous))
        begin, end = flat[self.degree], flat[len(homogeneous)]
        flat, homogeneous = splines.piece(self.degree, flat, homogeneous, begin, end)
        self._keep(flat, homogeneous)

    @classmethod
    def from_scipy(cls, spline: Any) -> NurbsCurve:
        """Of a `scipy.interpolate.BSpline`, periodic ones too, or of what `splprep` gives (knots, coordinates, degree)."""
        if isinstance(spline, (tuple, list)):
            if len(spline) == 2 and isinstance(spline[0], (tuple, list)):
                spline = spline[0]  # splprep gives the parameters beside it
            knots, coordinates, degree = spline
            points = list(zip(*coordinates))
        elif hasattr(spline, "t") and hasattr(spline, "c") and hasattr(spline, "k"):
            if getattr(spline, "axis", 0) != 0:
                raise InvalidValue("this BSpline runs along another axis of its coefficients than the first: make it with axis=0")
            knots, degree = spline.t, spline.k
            points = list(spline.c)
        else:
            raise InvalidValue(f"{type(spline).__name__} is no BSpline of scipy")
        if points and not hasattr(points[0], "__len__"):
            raise InvalidValue("this BSpline has one coordinate, a function rather than a curve: its coefficients need x, y and z")
        number = whole(degree, "degree", 1)
        return cls(number, knots, points[: len(knots) - number - 1])

    @property
    def dimension(self) -> int:
        return len(self.points[0])

    def rest(self, length: float, space: int) -> NurbsCurve | None:
        """What is left of it behind so much of its arc length, in its first `space` coordinates; None: nothing."""
        homogeneous = [(*(w * x for x in place), w) for place, w in zip(self.points, self.weights or (1.0,) * len(self.points))]
        knots = list(self.knots)
        begin = splines.Measure(self.degree, knots, homogeneous, space).parameter(length)
        if begin >= knots[-1]:
            return None
        left = object.__new__(NurbsCurve)
        left.degree = self.degree
        left._keep(*splines.piece(self.degree, knots, homogeneous, begin, knots[-1]))
        return left

    def wire(self) -> dict[str, object]:
        curve: dict[str, object] = {"degree": self.degree, "knots": self.knots, "points": self.points}
        return curve if self.weights is None else curve | {"weights": self.weights}

    def text(self) -> str:
        weights = "" if self.weights is None else f',"weights":{text(self.weights)}'
        points = ",".join(map(text, self.points))
        return f'"degree":{self.degree},"knots":{text(self.knots)},"points":[{points}]{weights}'

    def _keep(self, knots: list[float], homogeneous: splines.Points) -> None:
        self.knots = tuple(knots)
        self.points = tuple(tuple(x / point[-1] for x in point[:-1]) for point in homogeneous)
        weights = tuple(point[-1] for point in homogeneous)
        self.weights = None if all(weight == 1 for weight in weights) else weights

    def __eq__(self, other: object) -> bool:
        return isinstance(other, NurbsCurve) and self._all() == other._all()

    def __hash__(self) -> int:
        return hash(self._all())

    def _all(self) -> tuple[object, ...]:
        return self.degree, self.knots, self.points, self.weights

    def __repr__(self) -> str:
        return f"NurbsCurve(degree {self.degree}, {len(self.points)} points of {self.dimension} coordinates)"


def _listed(points: Any) -> list[Any]:
    try:
        return list(points)
    except TypeError:
        raise InvalidValue(f"control points are {points!r:.80}: give a list of them") from None


def _degree(degree: Any) -> int:
    number = whole(degree, "degree", 1)
    if number > _MOST_DEGREE:
        raise InvalidValue(f"a degree is 1 to {_MOST_DEGREE}, not {degree!r}")
    return number


def _flat(knots: tuple[float, ...], multiplicities: Any) -> list[float]:
    if multiplicities is None:
        return list(knots)
    counts = [whole(count, "a knot's multiplicity", 1) for count in vector(multiplicities, "multiplicities", len(knots))]
    if max(counts, default=0) > _MOST_DEGREE + 1:
        raise InvalidValue(f"a knot's multiplicity is {max(counts)}: no degree takes more than {_MOST_DEGREE + 1}")
    return list(itertools.chain.from_iterable([knot] * count for knot, count in zip(knots, counts)))


def _unrolled(degree: int, flat: list[float], multiplicities: Any, points: splines.Points) -> tuple[list[float], splines.Points]:
    """A periodic curve over one period, with the knots and points that its turns before and after share with it."""
    if multiplicities is None or len(flat) < 2:
        raise InvalidValue("a periodic curve needs its distinct knots with their multiplicities, as OpenCASCADE gives them")
    period = flat[-1] - flat[0]
    turn = flat[: len(flat) - int(multiplicities[-1])]  # the last knot is the first one of the next turn
    if len(turn) != len(points):
        raise InvalidValue(f"a periodic curve with these knots has {len(turn)} control points, not {len(points)}")
    # Point i acts from knot i to knot i + degree + 1 (OpenCASCADE counts from the last of the first knot's multiplicity).
    first = int(multiplicities[0]) - 1
    count = len(turn)

    def knot(i: int) -> float:
        turns, place = divmod(i + first, count)
        return turn[place] + turns * period

    knots = [knot(i) for i in range(-degree, count + degree + 1)]
    return knots, [points[i % count] for i in range(count + degree)]


def _check(degree: int, knots: list[float], points: int) -> None:
    if len(knots) != points + degree + 1:
        raise InvalidValue(
            f"{len(knots)} knots do not fit {points} control points of degree {degree}: {points + degree + 1} do, counted with their multiplicities"
        )
    for number, (a, b) in enumerate(zip(knots, knots[1:])):
        if b < a:
            raise InvalidValue(f"knot {number + 1} is {b}, less than the one before, {a}")
    if knots[degree] == knots[points]:
        raise InvalidValue("all knots are one: the curve has no length")

"""Splines as lists of numbers: knots are inserted, ends clamped, pieces cut off, lengths measured.

Control points are homogeneous (w·x, w·y, …, w), so that all of it is exact for rational curves too (The NURBS Book, 5.2).
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Sequence

Points = list[tuple[float, ...]]
# Gauss-Legendre, 5 points.
_NODES = (0.0, 0.5384693101056831, -0.5384693101056831, 0.906179845938664, -0.906179845938664)
_WEIGHTS = (0.5688888888888889, 0.47862867049936647, 0.47862867049936647, 0.23692688505618908, 0.23692688505618908)
_EXACT = 1e-10  # of a length of 1
_DEPTH = 14


def between(a: Sequence[float], b: Sequence[float], t: float) -> tuple[float, ...]:
    return tuple((1 - t) * x + t * y for x, y in zip(a, b))


def insert(degree: int, knots: list[float], points: Points, u: float) -> tuple[list[float], Points]:
    """One more knot at u, which the domain holds; the curve stays."""
    span = min(bisect.bisect_right(knots, u), len(points)) - 1
    fresh: Points = points[: span - degree + 1]
    for i in range(span - degree + 1, span + 1):
        width = knots[i + degree] - knots[i]
        fresh.append(between(points[i - 1], points[i], (u - knots[i]) / width if width > 0 else 0.0))
    return [*knots[: span + 1], u, *knots[span + 1 :]], fresh + points[span:]


def piece(degree: int, knots: list[float], points: Points, begin: float, end: float) -> tuple[list[float], Points]:
    """The curve from one parameter to another, clamped."""
    for u in (begin, end):
        while knots.count(u) < degree:
            knots, points = insert(degree, knots, points, u)
    first = bisect.bisect_right(knots, begin) - 1 - degree  # of the points
    last = bisect.bisect_left(knots, end) - 1
    inner = knots[first + degree + 1 : last + 1]
    return [begin] * (degree + 1) + inner + [end] * (degree + 1), points[max(first, 0) : last + 1]


def value(degree: int, knots: Sequence[float], points: Points, u: float) -> tuple[float, ...]:
    """The homogeneous point at u (de Boor)."""
    span = min(max(bisect.bisect_right(knots, u) - 1, degree), len(points) - 1)
    work = list(points[span - degree : span + 1])
    for level in range(1, degree + 1):
        for j in range(degree, level - 1, -1):
            i = span - degree + j
            width = knots[i + degree - level + 1] - knots[i]
            work[j] = between(work[j - 1], work[j], (u - knots[i]) / width if width > 0 else 0.0)
    return work[degree]


def derivative(degree: int, knots: Sequence[float], points: Points) -> tuple[int, list[float], Points]:
    """The derivative of the homogeneous curve, as a spline one degree lower."""
    fresh: Points = []
    for i in range(len(points) - 1):
        width = knots[i + degree + 1] - knots[i + 1]
        factor = degree / width if width > 0 else 0.0
        fresh.append(tuple(factor * (b - a) for a, b in zip(points[i], points[i + 1])))
    return degree - 1, list(knots[1:-1]), fresh


class Measure:
    """Arc length along the first `space` coordinates of a clamped curve."""

    def __init__(self, degree: int, knots: list[float], points: Points, space: int) -> None:
        self._curve = degree, knots, points
        self._slope = derivative(degree, knots, points)
        self._space = space
        self._breaks = sorted(set(knots))

    def parameter(self, length: float) -> float:
        """Where so much of it is behind; the end where it is shorter."""
        for a, b in zip(self._breaks, self._breaks[1:]):
            within = self.length(a, b)
            if length <= within:
                return self._within(a, b, length)
            length -= within
        return self._breaks[-1]

    def length(self, a: float, b: float, depth: int = _DEPTH) -> float:
        """Halved where one rule and two of half the width differ: where the curve bends much, or stands nearly."""
        middle = (a + b) / 2
        one, two = self._rule(a, b), self._rule(a, middle) + self._rule(middle, b)
        if depth == 0 or abs(one - two) <= _EXACT * max(1, two):
            return two
        return self.length(a, middle, depth - 1) + self.length(middle, b, depth - 1)

    def _within(self, low: float, high: float, length: float) -> float:
        """Halves, each time measuring what is new only."""
        behind = 0.0
        for _ in range(50):
            middle = (low + high) / 2
            step = self.length(low, middle)
            if behind + step < length:
                low, behind = middle, behind + step
            else:
                high = middle
        return (low + high) / 2

    def _rule(self, a: float, b: float) -> float:
        half = (b - a) / 2
        return half * sum(weight * self._speed((a + b) / 2 + half * node) for node, weight in zip(_NODES, _WEIGHTS))

    def _speed(self, u: float) -> float:
        *at, w = value(*self._curve, u)
        *slope, dw = value(*self._slope, u)
        return math.hypot(*((d - dw * x / w) / w for d, x in zip(slope[: self._space], at[: self._space])))

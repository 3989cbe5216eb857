"""What a contour consists of, in the plane: each piece knows its begin, its end and which way it goes there. Lengths in mm."""

import math
from dataclasses import dataclass, replace

import rmac
from rmac.geometry.nurbs import NurbsCurve

FULL = 2 * math.pi


def plus(a, b, t=1.0):
    return a[0] + t * b[0], a[1] + t * b[1]


def left_of(direction):
    return -direction[1], direction[0]


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1]


def unit(a):
    size = math.hypot(*a)
    return a[0] / size, a[1] / size


@dataclass(frozen=True)
class Straight:
    name: str  # of the edge
    start: tuple
    end: tuple

    @property
    def length(self):
        return math.dist(self.start, self.end)

    @property
    def tangents(self):
        """At its start and at its end."""
        along = unit(plus(self.end, self.start, -1))
        return along, along

    def turned(self):
        return replace(self, start=self.end, end=self.start)

    def move(self, begin, end):
        """From there to there: x y as its own but for rounding, z as it is wanted."""
        return rmac.Line(begin, end)


@dataclass(frozen=True)
class Bow:
    """An arc: `sweep` in rad from `angle`, counter-clockwise where it is more than 0."""

    name: str
    centre: tuple
    radius: float
    angle: float
    sweep: float

    @property
    def start(self):
        return self.at(0)

    @property
    def end(self):
        return self.at(1)

    def at(self, part):
        way = self.angle + part * self.sweep
        return plus(self.centre, (math.cos(way), math.sin(way)), self.radius)

    @property
    def length(self):
        return self.radius * abs(self.sweep)

    @property
    def tangents(self):
        sense = math.copysign(1, self.sweep)
        return tuple((-sense * math.sin(way), sense * math.cos(way)) for way in (self.angle, self.angle + self.sweep))

    def turned(self):
        return replace(self, angle=self.angle + self.sweep, sweep=-self.sweep)

    def move(self, begin, end):
        """Where the ends differ in z, a helix."""
        closed = abs(abs(self.sweep) - FULL) < 1e-12
        return rmac.Arc(begin, end, (*self.centre, begin[2]), clockwise=self.sweep < 0, closed=closed)


@dataclass(frozen=True)
class Spline:
    """`curve` in x y."""

    name: str
    curve: NurbsCurve
    length: float

    @property
    def start(self):
        return self.curve.points[0]

    @property
    def end(self):
        return self.curve.points[-1]

    @property
    def tangents(self):
        points = self.curve.points
        begin = next(unit(plus(p, points[0], -1)) for p in points if math.dist(p, points[0]) > 1e-12)
        end = next(unit(plus(points[-1], p, -1)) for p in reversed(points) if math.dist(p, points[-1]) > 1e-12)
        return begin, end

    def turned(self):
        curve = self.curve
        knots = [curve.knots[0] + curve.knots[-1] - knot for knot in reversed(curve.knots)]
        weights = None if curve.weights is None else curve.weights[::-1]
        return replace(self, curve=NurbsCurve(curve.degree, knots, curve.points[::-1], weights))

    def move(self, begin, end):
        """Down a slope z is linear in the parameter where the curve has no weights; elsewhere it goes down steadily, too. In x and y
        it stays the same curve."""
        curve, degree = self.curve, self.curve.degree
        places = [sum(curve.knots[i + 1 : i + degree + 1]) / degree for i in range(len(curve.points))]  # Greville's
        first, last = curve.knots[0], curve.knots[-1]
        points = [(*p, begin[2] + (end[2] - begin[2]) * (place - first) / (last - first)) for p, place in zip(curve.points, places)]
        points[0], points[-1] = begin, end
        return rmac.Nurbs(NurbsCurve(degree, curve.knots, points, curve.weights))

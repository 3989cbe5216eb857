"""A smooth plane spline over whole arrays of parameters: its places, its bend, and its nearest places."""

import itertools
import math

import numpy as np

from rmac.geometry import splines
from rmac.geometry.nurbs import NurbsCurve
from rmac_freecad.surfaces import bspline

A_SPAN, AT_LEAST = 48, 256  # samples
STEPS = 8  # of Newton's method, from a sample beside the place
GAUSS = np.polynomial.legendre.leggauss(5)


class SmoothSpline:
    def __init__(self, curve):
        """`curve`: a NurbsCurve in x y, whose tangent does not leap."""
        knots, degree = np.array(curve.knots), curve.degree
        weights = np.ones(len(curve.points)) if curve.weights is None else np.array(curve.weights)
        poles = np.column_stack([np.array(curve.points) * weights[:, None], weights])
        self._breaks = breaks = np.unique(knots)
        self._powers = _powers(knots, degree, poles, breaks)
        count = max(A_SPAN, AT_LEAST // (len(breaks) - 1))
        self.t = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(count) / count).ravel(), breaks[-1])
        self.samples = self.at(self.t)

    def at(self, t):
        return self._derivatives(t, 0)[0]

    def bend(self, t):
        """Place, tangent of length 1, speed, and curvature, which is more than 0 where it turns left."""
        place, first, second = self._derivatives(t, 2)
        speed = np.hypot(*first.T)
        speed = np.where(speed > 0, speed, 1e-300)
        turn = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
        return place, first / speed[:, None], speed, turn / speed**3

    def area(self):
        """Half the integral of x dy - y dx."""
        t = self.t
        inner = (t[:-1, None] + t[1:, None]) / 2 + (t[1:, None] - t[:-1, None]) / 2 * GAUSS[0]
        place, slope = self._derivatives(inner.ravel(), 1)
        turned = (place[:, 0] * slope[:, 1] - place[:, 1] * slope[:, 0]).reshape(inner.shape)
        return float(((t[1:] - t[:-1]) / 4 * (turned @ GAUSS[1])).sum())

    def nearest(self, places):
        """Parameters of the nearest places."""
        found = np.empty(len(places))
        for begin in range(0, len(places), 2000):
            part = places[begin : begin + 2000]
            off = ((part[:, None, :] - self.samples) ** 2).sum(2)
            t = self._nearest_from(part, off.argmin(1))
            ends = off[:, [0, -1]].min(1) <= off.min(1) + 1e-9
            if ends.any():  # of a closed one both are the same place, and the nearest one may be on either side
                tried = np.array([self._nearest_from(part[ends], np.full(ends.sum(), at)) for at in (0, len(self.t) - 1)] + [t[ends]])
                away = [np.hypot(*(self.at(one) - part[ends]).T) for one in tried]
                t[ends] = tried[np.argmin(away, 0), np.arange(tried.shape[1])]
            found[begin : begin + 2000] = t
        return found

    def _nearest_from(self, places, at):
        """Between the samples beside those of these numbers."""
        low, high = self.t[np.maximum(at - 1, 0)], self.t[np.minimum(at + 1, len(self.t) - 1)]
        t = self.t[at]
        for _ in range(STEPS):
            place, first, second = self._derivatives(t, 2)
            away = place - places
            square = (first**2).sum(1)
            slope = square + (away * second).sum(1)
            t = np.clip(t - (away * first).sum(1) / np.where(slope > 0.05 * square, slope, square + 1e-300), low, high)
        return t

    def _derivatives(self, t, order):
        span = np.clip(np.searchsorted(self._breaks, t, side="right") - 1, 0, len(self._breaks) - 2)
        half = (self._breaks[span + 1] - self._breaks[span]) / 2
        x = (t - self._breaks[span]) / half - 1
        h = []
        for powers in self._powers[: order + 1]:
            near, found = powers[span], np.zeros((len(t), 3))
            for k in range(powers.shape[1] - 1, -1, -1):
                found = found * x[:, None] + near[:, k]
            h.append(found)
        weight = h[0][:, 2:]
        found = [h[0][:, :2] / weight]
        if order:
            found.append((h[1][:, :2] - h[1][:, 2:] * found[0]) / weight)
        if order > 1:
            found.append((h[2][:, :2] - 2 * h[1][:, 2:] * found[1] - h[2][:, 2:] * found[0]) / weight)
        return found


def _powers(knots, degree, poles, breaks):
    """Coefficients of each span, from -1 at its begin to 1 at its end, and of its first and second derivatives by the parameter."""
    nodes = np.cos(math.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    half, middle = np.diff(breaks) / 2, (breaks[1:] + breaks[:-1]) / 2
    values = bspline.value(knots, degree, poles, (middle[:, None] + half[:, None] * nodes).ravel()).reshape(len(half), degree + 1, 3)
    found = [np.linalg.solve(np.vander(nodes, increasing=True), values)]
    for _ in range(2):
        last = found[-1]
        slope = last[:, 1:] * np.arange(1, last.shape[1])[:, None] / half[:, None, None]
        found.append(slope if slope.shape[1] else np.zeros((len(half), 1, 3)))
    return found


def smooth_parts(curve):
    """Of a NurbsCurve: cut where its tangent may leap, exactly."""
    knots = list(curve.knots)
    leaps = [knot for knot, group in itertools.groupby(knots) if knots[0] < knot < knots[-1] and len(list(group)) >= curve.degree]
    weights = curve.weights or (1.0,) * len(curve.points)
    homogeneous = [(*(w * x for x in point), w) for point, w in zip(curve.points, weights)]
    parts = []
    for begin, end in itertools.pairwise([knots[0], *leaps, knots[-1]]):
        flat, points = splines.piece(curve.degree, knots, homogeneous, begin, end)
        rational = curve.weights is not None
        parts.append(NurbsCurve(curve.degree, flat, [tuple(x / p[-1] for x in p[:-1]) for p in points], [p[-1] for p in points] if rational else None))
    return parts


def ranges(spline, distance):
    """Where its parallel so far to the left goes forward: pairs of parameters, each without a cusp and turning by less than a right angle."""
    _, tangent, _, bend = spline.bend(spline.t)
    forward = 1 - distance * bend > 0
    turned = np.cumsum(np.abs(np.append(0, _turns(tangent))))
    cells = np.floor(turned / math.radians(60)).astype(int)
    cuts = [spline.t[0]]
    for i in range(len(spline.t) - 1):
        if forward[i] != forward[i + 1]:
            cuts.append(_border(spline, distance, spline.t[i], spline.t[i + 1], forward[i]))
        elif cells[i] != cells[i + 1]:
            cuts.append(spline.t[i + 1])
    cuts.append(spline.t[-1])
    return [(a, b) for a, b in itertools.pairwise(cuts) if b > a and 1 - distance * spline.bend(np.array([(a + b) / 2]))[3][0] > 0]


def _turns(tangent):
    a, b = tangent[:-1], tangent[1:]
    return np.arctan2(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], (a * b).sum(1))


def _border(spline, distance, low, high, forward):
    for _ in range(8):
        t = np.linspace(low, high, 65)
        at = int(np.argmax((1 - distance * spline.bend(t)[3] > 0) != forward))
        low, high = t[max(at - 1, 0)], t[max(at, 1)]
    return (low + high) / 2

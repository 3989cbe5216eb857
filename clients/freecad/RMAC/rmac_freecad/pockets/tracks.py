"""What the tool's centre goes along, in the plane: lines, arcs, and parallels of splines. Each has places at a share of it from 0 to 1."""

import math
from dataclasses import dataclass, replace

import numpy as np

import rmac
from rmac.geometry.nurbs import NurbsCurve
from rmac_freecad.pockets.spline import GAUSS, SmoothSpline
from rmac_freecad.profiles.pieces import FULL, Bow, Straight
from rmac_freecad.surfaces import bspline

FIT_MM = 2e-5  # that a fitted parallel of a spline may be off
DEGREE = 5
CHORD_RAD = math.radians(3)


@dataclass(frozen=True)
class PieceTrack:
    """Along a piece of a contour, evenly."""

    piece: object

    @property
    def name(self):
        return self.piece.name

    @property
    def length(self):
        return self.piece.length

    def share_behind(self, length):
        """So far from its start."""
        return length / self.length

    def turned(self):
        return type(self)(self.piece.turned())

    def move(self, begin, end):
        return self.piece.move(begin, end)


@dataclass(frozen=True)
class LineTrack(PieceTrack):
    piece: Straight
    straight = True

    def at(self, part):
        a, b = np.array(self.piece.start), np.array(self.piece.end)
        return a + np.asarray(part, float)[..., None] * (b - a)

    def tangent(self, part):
        return np.array(self.piece.tangents[0])

    def course(self, part):
        return self.at(part), np.array(self.piece.end) - np.array(self.piece.start)

    def share_at(self, place):
        a, along = np.array(self.piece.start), np.array(self.piece.end) - np.array(self.piece.start)
        return float(np.clip((np.asarray(place) - a) @ along / (along @ along), 0, 1))

    def between(self, first, last):
        return LineTrack(replace(self.piece, start=tuple(self.at(first)), end=tuple(self.at(last))))

    def chords(self):
        return np.array([self.piece.start, self.piece.end])


@dataclass(frozen=True)
class ArcTrack(PieceTrack):
    piece: Bow
    straight = False

    def at(self, part):
        way = self.piece.angle + np.asarray(part, float) * self.piece.sweep
        return np.array(self.piece.centre) + self.piece.radius * np.stack([np.cos(way), np.sin(way)], -1)

    def tangent(self, part):
        way, sense = self.piece.angle + part * self.piece.sweep, math.copysign(1, self.piece.sweep)
        return np.array([-sense * math.sin(way), sense * math.cos(way)])

    def course(self, part):
        return self.at(part), self.tangent(part) * self.length

    def share_at(self, place):
        x, y = np.asarray(place) - np.array(self.piece.centre)
        sense = math.copysign(1, self.piece.sweep)
        part = sense * (math.atan2(y, x) - self.piece.angle) % FULL / abs(self.piece.sweep)
        over = FULL / abs(self.piece.sweep)
        return 1.0 if 1 < part <= (1 + over) / 2 else 0.0 if part > 1 else part

    def between(self, first, last):
        return ArcTrack(replace(self.piece, angle=self.piece.angle + first * self.piece.sweep, sweep=(last - first) * self.piece.sweep))

    def chords(self):
        return self.at(np.linspace(0, 1, max(int(abs(self.piece.sweep) / CHORD_RAD), 2) + 1))


@dataclass(frozen=True)
class SideTrack:
    """Beside a spline, so far to the left of it; from one of its parameters to another, which may be less."""

    name: str
    spline: SmoothSpline
    first: float
    last: float
    distance: float
    straight = False

    def at(self, part):
        part = np.asarray(part, float)
        place, tangent, _, _ = self.spline.bend(np.atleast_1d(self.first + part * (self.last - self.first)))
        found = place + self.distance * np.column_stack([-tangent[:, 1], tangent[:, 0]])
        return found if part.ndim else found[0]

    def course(self, part):
        """Place, and derivative by the share."""
        place, tangent, speed, bend = self.spline.bend(np.array([self.first + part * (self.last - self.first)]))
        across = np.array([-tangent[0, 1], tangent[0, 0]])
        return place[0] + self.distance * across, tangent[0] * (1 - self.distance * bend[0]) * speed[0] * (self.last - self.first)

    def tangent(self, part):
        tangent = self.spline.bend(np.array([self.first + part * (self.last - self.first)]))[1][0]
        return tangent if self.last > self.first else -tangent

    def share_at(self, place):
        parts = np.linspace(0, 1, 65)
        off = np.hypot(*(self.at(parts) - place).T)
        low, high = parts[max(off.argmin() - 1, 0)], parts[min(off.argmin() + 1, 64)]
        part = (low + high) / 2
        for _ in range(12):
            here, along = self.course(part)
            square = along @ along
            part = float(np.clip(part - (here - place) @ along / square, low, high)) if square else part
        return part

    @property
    def length(self):
        return self._lengths()[1][-1]

    def share_behind(self, length):
        parts, gone = self._lengths()
        return float(np.interp(length, gone, parts))

    def between(self, first, last):
        whole = self.last - self.first
        return replace(self, first=self.first + first * whole, last=self.first + last * whole)

    def turned(self):
        return replace(self, first=self.last, last=self.first)

    def chords(self):
        """Denser towards its ends, which may be cusps that cross."""
        return self.at((1 - np.cos(np.linspace(0, math.pi, 65))) / 2)

    def _speed(self, t):
        _, _, speed, bend = self.spline.bend(t)
        return np.abs(1 - self.distance * bend) * speed

    def _lengths(self, pieces=256):
        """Shares, and how long it is up to each."""
        parts = np.linspace(0, 1, pieces + 1)
        t = self.first + parts * (self.last - self.first)
        inner = (t[:-1, None] + t[1:, None]) / 2 + (t[1:, None] - t[:-1, None]) / 2 * GAUSS[0]
        speed = self._speed(inner.ravel()).reshape(inner.shape)
        return parts, np.append(0, np.cumsum(np.abs(t[1:] - t[:-1]) / 2 * (speed @ GAUSS[1])))

    def move(self, begin, end):
        """A quintic that goes on evenly: its slope is the same everywhere."""
        parts, gone = self._lengths()
        total, count = gone[-1], 2
        while True:
            breaks = np.linspace(0, total, count + 1)
            s = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * np.arange(12) / 12).ravel(), total)
            shares = np.interp(s, gone, parts)
            for _ in range(4):
                shares = self._nearer(shares, s, parts, gone)
            places = self.at(shares)
            places[0], places[-1] = begin[:2], end[:2]
            knots = bspline.clamped(breaks, DEGREE)
            poles = bspline.fitted(knots, DEGREE, s, places)
            worst = np.hypot(*(bspline.value(knots, DEGREE, poles, s) - places).T).max()
            if worst < FIT_MM or count >= 256:
                break
            count *= 2
        greville = np.array([knots[i + 1 : i + DEGREE + 1].mean() for i in range(len(poles))])
        z = begin[2] + (end[2] - begin[2]) * greville / total
        points = [(*map(float, pole), float(height)) for pole, height in zip(poles, z)]
        points[0], points[-1] = tuple(begin), tuple(end)
        return rmac.Nurbs(NurbsCurve(DEGREE, knots.tolist(), points))

    def _nearer(self, shares, s, parts, gone):
        """One step towards the shares that are so far along it."""
        base = np.clip(np.searchsorted(parts, shares, side="right") - 1, 0, len(parts) - 2)
        whole = self.last - self.first
        a, b = self.first + parts[base] * whole, self.first + shares * whole
        inner = (a[:, None] + b[:, None]) / 2 + (b[:, None] - a[:, None]) / 2 * GAUSS[0]
        here = gone[base] + np.abs(b - a) / 2 * (self._speed(inner.ravel()).reshape(inner.shape) @ GAUSS[1])
        speed = self._speed(b) * abs(whole)
        return np.clip(shares - (here - s) / np.where(speed > 0, speed, 1e-300), 0, 1)

"""Walls as the tool sees them: how far away they are, exactly, and on which side one is."""

import math

import numpy as np

from rmac_freecad.pockets.spline import SmoothSpline
from rmac_freecad.profiles.pieces import Bow, Spline, Straight

AT_ONCE = 4000  # places
SAG_MM = 1e-3  # of chords that tell on which side one is
ASIDE_MM = 1.37e-7  # so that no place is as high as an end of a wall, where two ends that are the same differ by rounding


class Wall:
    """Of the pieces of closed contours that have the pocket to their left."""

    def __init__(self, pieces):
        self._pieces = tuple(pieces)
        lines = [piece for piece in pieces if isinstance(piece, Straight)]
        self._a = np.array([line.start for line in lines]).reshape(-1, 2)
        self._b = np.array([line.end for line in lines]).reshape(-1, 2)
        bows = [piece for piece in pieces if isinstance(piece, Bow)]
        self._centre = np.array([bow.centre for bow in bows]).reshape(-1, 2)
        self._radius = np.array([bow.radius for bow in bows])
        self._middle = np.array([bow.angle + bow.sweep / 2 for bow in bows])
        self._half = np.array([abs(bow.sweep) / 2 for bow in bows])
        self.splines = {id(piece): SmoothSpline(piece.curve) for piece in pieces if isinstance(piece, Spline)}
        self._chords = [self._chord(piece) for piece in pieces]

    def nearest(self, places):
        """The nearest place of the wall to each, and how far that is."""
        places = np.asarray(places, float).reshape(-1, 2)
        feet = np.empty_like(places)
        for begin in range(0, len(places), AT_ONCE):
            feet[begin : begin + AT_ONCE] = self._feet(places[begin : begin + AT_ONCE])
        return feet, np.hypot(*(places - feet).T)

    def inside(self, places):
        """Whether they are in the pocket; by chords, next to the wall not exactly."""
        x, y = np.asarray(places).T + ASIDE_MM
        odd = np.zeros(len(x), bool)
        for chord in self._chords:
            for (ax, ay), (bx, by) in zip(chord, chord[1:]):
                if ay != by:
                    crossed = (y < ay) != (y < by)
                    odd ^= crossed & (x < ax + (y - ay) * (bx - ax) / (by - ay))
        return odd

    def area(self):
        return sum(self._under(piece) for piece in self._pieces)

    def _under(self, piece):
        """Its share of the area, by Green's theorem."""
        (ax, ay), (bx, by) = piece.start, piece.end
        if isinstance(piece, Straight):
            return (ax * by - ay * bx) / 2
        if isinstance(piece, Bow):
            x, y = piece.centre
            return (x * (by - ay) - y * (bx - ax) + piece.radius**2 * piece.sweep) / 2
        return self.splines[id(piece)].area()

    @property
    def box(self):
        points = np.concatenate(self._chords)
        return points.min(0), points.max(0)

    def _chord(self, piece):
        if isinstance(piece, Straight):
            return np.array([piece.start, piece.end])
        if isinstance(piece, Bow):
            count = max(int(abs(piece.sweep) / math.sqrt(8 * min(SAG_MM / piece.radius, 0.1))) + 1, 4)
            points = np.array([piece.at(number / count) for number in range(count + 1)])
        else:
            points = self.splines[id(piece)].samples.copy()
        points[0], points[-1] = piece.start, piece.end
        return points

    def _feet(self, places):
        found, least = np.empty_like(places), np.full(len(places), np.inf)

        def keep(feet):
            off = np.hypot(*(places - feet).T)
            better = off < least
            found[better], least[better] = feet[better], off[better]

        for a, b in zip(self._a, self._b):
            along = b - a
            part = np.clip((places - a) @ along / (along @ along), 0, 1)
            keep(a + part[:, None] * along)
        for centre, radius, middle, half in zip(self._centre, self._radius, self._middle, self._half):
            arm = places - centre
            way = np.arctan2(arm[:, 1], arm[:, 0]) - middle
            way = np.clip(np.mod(way + math.pi, 2 * math.pi) - math.pi, -half, half) + middle
            keep(centre + radius * np.column_stack([np.cos(way), np.sin(way)]))
        for spline in self.splines.values():
            keep(spline.at(spline.nearest(places)))
        return found

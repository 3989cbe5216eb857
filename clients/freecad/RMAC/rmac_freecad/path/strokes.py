"""The tool tip's way, move by move, in mm."""

import math
from dataclasses import dataclass

import rmac
from rmac.geometry import splines

CHORD_DEG = 5
CHORDS_PER_SPAN = 16  # of a spline, between two of its knots


@dataclass(frozen=True, slots=True)  # there may be a million of them
class Stroke:
    index: int  # of the move in the program
    points: tuple


def strokes_of(program):
    """Of moves whose begin is known: the first one comes from wherever the tool is."""
    strokes, at = [], None
    for index, way in enumerate(program.ways()):
        if isinstance(way, rmac.Move):
            points = _arc_points(way) if isinstance(way, rmac.Arc) else _spline_points(way.curve)
            strokes.append(Stroke(index, points))
            at = tuple(way.end)
        elif way is not None:
            if at is not None:
                strokes.append(Stroke(index, (at, way)))
            at = way
    return strokes


def _spline_points(curve):
    weights = curve.weights or (1.0,) * len(curve.points)
    homogeneous = [(*(w * x for x in point), w) for point, w in zip(curve.points, weights)]
    breaks = sorted(set(curve.knots))
    count = CHORDS_PER_SPAN if curve.degree > 1 else 1
    places = [a + (b - a) * number / count for a, b in zip(breaks, breaks[1:]) for number in range(count)]
    values = (splines.value(curve.degree, curve.knots, homogeneous, u) for u in (*places, breaks[-1]))
    return tuple((x / w, y / w, z / w) for x, y, z, *_, w in values)


def _arc_points(arc):
    """Chords of few degrees; helices rise evenly."""
    center, normal = arc.center.p, arc.center.axis
    arm = [a - c for a, c in zip(arc.start, center)]
    off = [b - c for b, c in zip(arc.end, center)]
    begin, end = _dot(arm, normal), _dot(off, normal)
    u = [a - begin * n for a, n in zip(arm, normal)]
    v = _cross(normal, u)
    sense = -1 if arc.clockwise else 1
    angle = 2 * math.pi if arc.closed else sense * math.atan2(_dot(off, v), _dot(off, u)) % (2 * math.pi)
    angle += 2 * math.pi * arc.turns
    count = max(2, math.ceil(math.degrees(angle) / CHORD_DEG))
    points = []
    for number in range(count + 1):
        part = number / count
        c, s = math.cos(sense * angle * part), math.sin(sense * angle * part)
        height = begin + (end - begin) * part
        points.append(tuple(o + c * a + s * b + height * n for o, a, b, n in zip(center, u, v, normal)))
    return tuple(points)


def _dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

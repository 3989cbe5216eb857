"""Edges of FreeCAD, in one plane, joined to one contour."""

import math
from dataclasses import dataclass

import Part
from rmac.geometry.nurbs import NurbsCurve
from rmac_freecad.profiles.pieces import FULL, Bow, Spline, Straight, cross
from rmac_freecad.profiles.refusal import ProfileRefused

JOINED_MM = 1e-6  # more is a gap; less is rounding, and the next piece begins where the one before ends
FLAT_MM = 1e-6
EXACTLY_SPLINES = (Part.BezierCurve, Part.Ellipse, Part.Parabola, Part.Hyperbola)


@dataclass(frozen=True)
class Contour:
    pieces: tuple
    z: float
    closed: bool

    @property
    def length(self):
        return sum(piece.length for piece in self.pieces)

    def turned(self):
        return Contour(tuple(piece.turned() for piece in reversed(self.pieces)), self.z, self.closed)


def contour_of(edges):
    """`edges`: pairs of a name and a Part.Edge, in any order and direction. A closed contour goes counter-clockwise, from the first
    edge's start; an open one the way of its first edge."""
    if not edges:
        raise ProfileRefused("there is no edge; select edges or a sketch")
    z = edges[0][1].valueAt(edges[0][1].FirstParameter).z
    pieces = _chained([_piece(name, edge, z) for name, edge in edges])
    closed = math.dist(pieces[0].start, pieces[-1].end) <= JOINED_MM
    contour = Contour(tuple(pieces), z, closed)
    return contour.turned() if closed and _area(pieces) < 0 else contour


def _piece(name, edge, z):
    curve, first, last = edge.Curve, edge.FirstParameter, edge.LastParameter
    box = edge.BoundBox
    if max(abs(box.ZMin - z), abs(box.ZMax - z)) > max(FLAT_MM, 2e-7 + box.DiagonalLength * 1e-7) and not _lies_flat(edge, z):
        raise ProfileRefused(f"it does not lie in the plane Z {z:.4g} of the first one; a contour is flat and level", edge=name)
    if edge.Length < JOINED_MM:
        raise ProfileRefused("it has hardly any length", edge=name)
    if isinstance(curve, (Part.Line, Part.LineSegment)):
        return Straight(name, _flat(edge.valueAt(first)), _flat(edge.valueAt(last)))
    if isinstance(curve, (Part.Circle, Part.ArcOfCircle)):
        start, centre = _flat(edge.valueAt(first)), _flat(curve.Center)
        sweep = math.copysign(min(last - first, FULL), curve.Axis.z)
        return Bow(name, centre, curve.Radius, math.atan2(start[1] - centre[1], start[0] - centre[0]), sweep)
    if isinstance(curve, Part.BSplineCurve):
        spline = curve.copy()
        spline.segment(first, last)
    elif isinstance(curve, EXACTLY_SPLINES):
        spline = curve.toBSpline(first, last)
    else:
        raise ProfileRefused(f"a {type(curve).__name__} is no line, arc or spline, and would be approximated; draw it as a spline", edge=name)
    points = [_flat(pole) for pole in spline.getPoles()]
    made = NurbsCurve(spline.Degree, spline.getKnots(), points, spline.getWeights() if spline.isRational() else None,
                      multiplicities=spline.getMultiplicities(), periodic=spline.isPeriodic())  # fmt: skip
    return Spline(name, made, edge.Length)


def _lies_flat(edge, z):
    """Boxes of splines are larger than they are."""
    return all(abs(point.z - z) <= FLAT_MM for point in edge.discretize(50))


def _flat(point):
    return point.x, point.y


def _chained(pieces):
    rest = list(pieces)
    chain = [rest.pop(0)]
    while rest:
        end, start = chain[-1].end, chain[0].start
        if math.dist(start, end) <= JOINED_MM:
            raise ProfileRefused("the contour closes before this edge; make a profile of each contour", rest[0].start, rest[0].name)
        after, before = _at(rest, end), _at(rest, start)
        for found, place in ((after, end), (before, start)):
            if len(found) > 1:
                raise ProfileRefused(f"{found[0].name} and {found[1].name} both begin there; a contour has no branches", place, chain[-1].name)
        if after:
            rest.remove(after[0])
            chain.append(after[0] if math.dist(after[0].start, end) <= JOINED_MM else after[0].turned())
        elif before:
            rest.remove(before[0])
            chain.insert(0, before[0] if math.dist(before[0].end, start) <= JOINED_MM else before[0].turned())
        else:
            gap, other = min((math.dist(place, end), piece.name) for piece in rest for place in (piece.start, piece.end))
            raise ProfileRefused(f"a gap of {gap:.4g} mm to {other}; join them", end, chain[-1].name)
    return chain


def _at(pieces, place):
    return [piece for piece in pieces if min(math.dist(piece.start, place), math.dist(piece.end, place)) <= JOINED_MM]


def _area(pieces):
    """Twice the area, of chords that are short enough to tell its sign."""
    points = [point for piece in pieces for point in _some_of(piece)]
    return sum(cross(a, b) for a, b in zip(points, [*points[1:], points[0]]))


def _some_of(piece):
    if isinstance(piece, Bow):
        return [piece.at(number / 16) for number in range(16)]
    if isinstance(piece, Spline):
        return piece.curve.points[:-1]
    return [piece.start]


def edges_of(feature, names=()):
    """Of a sketch or any shape, where it stands in the document: those of that name (`Edge3`), or all. Construction lines of a sketch are
    none."""
    shape = feature.Shape.copy()
    shape.Placement = feature.getGlobalPlacement()
    every = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, 1)}
    for name in names:
        if name not in every:
            raise ProfileRefused(f"{feature.Label} has no {name}; select edges")
    return [(name, every[name]) for name in names or every]

"""The way of a tool's centre beside a contour of lines and arcs, exactly: lines and arcs again, and arcs around outside corners."""

import math
from dataclasses import replace

import FreeCAD
import Part

from rmac_freecad.profiles.contour import Contour
from rmac_freecad.profiles.pieces import FULL, Bow, Spline, Straight, cross, dot, left_of, plus, unit
from rmac_freecad.profiles.refusal import ProfileRefused

TANGENT_RAD = 1e-7
SHORTEST_MM = 1e-6


def beside(contour, distance):
    """So far to the left; to the right where it is less than 0. What the tool does not get into is refused: an arc, a corner, and any place
    where its centre would come nearer to another part of the contour."""
    shifted = [_shifted(piece, distance) for piece in contour.pieces]
    joints = len(shifted) if contour.closed else len(shifted) - 1
    corners = [_corner(contour.pieces, shifted, number, distance) if number < joints else None for number in range(len(shifted))]
    made = []
    for number, piece in enumerate(shifted):
        before, after = corners[number - 1] if number or contour.closed else None, corners[number]
        begin = before if isinstance(before, tuple) else None
        end = after if isinstance(after, tuple) else None
        made.append(_between(piece, begin, end))
        if isinstance(after, Bow):
            made.append(after)
    check_clear(contour, made, abs(distance))
    return Contour(tuple(made), contour.z, contour.closed)


def _shifted(piece, distance):
    if isinstance(piece, Spline):
        raise ProfileRefused("a way beside a spline is not built yet; cut on the curve, or draw the way of the tool's centre", piece.start, piece.name)
    if isinstance(piece, Straight):
        across = left_of(piece.tangents[0])
        return replace(piece, start=plus(piece.start, across, distance), end=plus(piece.end, across, distance))
    radius = piece.radius - math.copysign(distance, distance * piece.sweep)
    if radius < SHORTEST_MM:
        raise ProfileRefused(f"the tool's radius of {abs(distance):g} mm does not get into the arc's, {piece.radius:g} mm", piece.at(0.5), piece.name)
    return replace(piece, radius=radius)


def _corner(pieces, shifted, number, distance):
    """Behind that piece: the arc around an outside corner, the place where an inside one ends both, or None where they are tangent."""
    first, second = pieces[number], pieces[(number + 1) % len(pieces)]
    if len(pieces) == 1 and isinstance(first, Bow):
        return None  # a full circle
    into, out = first.tangents[1], second.tangents[0]
    turn = math.atan2(cross(into, out), dot(into, out))
    if abs(turn) < TANGENT_RAD:
        return None
    if math.pi - abs(turn) < TANGENT_RAD:
        raise ProfileRefused(f"the contour turns back on itself towards {second.name}", first.end, first.name)
    a, b = shifted[number], shifted[(number + 1) % len(pieces)]
    if turn * distance < 0:
        arm = plus(a.end, first.end, -1)
        return Bow(first.name, first.end, abs(distance), math.atan2(arm[1], arm[0]), turn)
    crossings = [place for place in _crossings(a, b) if _part(a, place) is not None and _part(b, place) is not None]
    if not crossings:
        raise ProfileRefused(f"the tool does not reach the corner to {second.name}; take a smaller one", first.end, first.name)
    return max(crossings, key=lambda place: _part(a, place))


def _between(piece, begin, end):
    """What is left of it between two corners."""
    first = 0.0 if begin is None else _part(piece, begin)
    last = 1.0 if end is None else _part(piece, end)
    if (last - first) * piece.length < SHORTEST_MM:
        raise ProfileRefused("nothing is left of it between its corners; take a smaller tool", piece.start, piece.name)
    if isinstance(piece, Straight):
        return replace(piece, start=begin or piece.start, end=end or piece.end)
    return replace(piece, angle=piece.angle + first * piece.sweep, sweep=(last - first) * piece.sweep)


def _part(piece, place):
    """How far along it that is, from 0 to 1; None beyond its ends."""
    if isinstance(piece, Straight):
        part = dot(plus(place, piece.start, -1), piece.tangents[0]) / piece.length
    else:
        arm = plus(place, piece.centre, -1)
        sense = math.copysign(1, piece.sweep)
        way = sense * (math.atan2(arm[1], arm[0]) - piece.angle) % FULL
        part = (way if way < FULL - 1e-9 else way - FULL) / abs(piece.sweep)
    slack = SHORTEST_MM / piece.length
    return min(max(part, 0.0), 1.0) if -slack <= part <= 1 + slack else None


def _crossings(a, b):
    """Of the whole lines and circles."""
    if isinstance(a, Straight) and isinstance(b, Straight):
        u, v = a.tangents[0], b.tangents[0]
        return [plus(a.start, u, cross(plus(b.start, a.start, -1), v) / cross(u, v))]
    if isinstance(a, Straight):
        return _line_circle(a, b)
    return _line_circle(b, a) if isinstance(b, Straight) else _circle_circle(a, b)


def _line_circle(line, circle):
    along = line.tangents[0]
    to_centre = plus(circle.centre, line.start, -1)
    foot = dot(to_centre, along)
    return _both_sides(plus(line.start, along, foot), along, circle.radius**2 - cross(along, to_centre) ** 2)


def _circle_circle(a, b):
    between = plus(b.centre, a.centre, -1)
    distance = math.hypot(*between)
    if distance < SHORTEST_MM:
        return []
    along = unit(between)
    foot = (distance**2 + a.radius**2 - b.radius**2) / (2 * distance)
    return _both_sides(plus(a.centre, along, foot), left_of(along), a.radius**2 - foot**2)


def _both_sides(foot, along, square):
    if square < 0:
        return []
    half = math.sqrt(square)
    return [plus(foot, along, half), plus(foot, along, -half)]


def check_clear(contour, made, radius):
    """No part of the way comes nearer to the contour than the tool's radius, by FreeCAD's own distances."""
    wall = [(piece.name, _edge(piece)) for piece in contour.pieces]
    for piece in made:
        way = _edge(piece)
        around = way.BoundBox
        around.enlarge(radius)
        for name, edge in wall:
            if not around.intersect(edge.BoundBox):
                continue
            nearest, places, _ = way.distToShape(edge)
            if nearest < radius - 1e-5:
                at = places[0][0]
                raise ProfileRefused(f"there the tool would cut into {name}, {radius - nearest:.4g} mm deep; take a smaller one", (at.x, at.y), piece.name)


def _edge(piece):
    def point(place):
        return FreeCAD.Vector(*place, 0)

    if isinstance(piece, Straight):
        return Part.makeLine(point(piece.start), point(piece.end))
    if abs(piece.sweep) > FULL - 1e-9:
        return Part.Circle(point(piece.centre), FreeCAD.Vector(0, 0, 1), piece.radius).toShape()
    return Part.Arc(point(piece.at(0)), point(piece.at(0.5)), point(piece.at(1))).toShape()

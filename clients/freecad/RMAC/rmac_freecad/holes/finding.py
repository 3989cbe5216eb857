"""Round holes of a part, from its faces: whichever way they go, and why those that cannot be drilled from above cannot."""

import math
from dataclasses import dataclass, replace

import numpy as np
import Part
from FreeCAD import Vector

from rmac_freecad.holes.hole import ALL_ROUND_DEG, SAME_MM, Hole
from rmac_freecad.holes.room import Room

LEVEL = 1e-7  # of a direction of length 1
UPRIGHT = 1e-5  # sideways, of an axis: a micrometre in 100 mm
HELD_DEG = 280.0  # more of a wall than that is a hole with a keyway; less is a rounding, the end of a slot, or a corner that was drilled out
POINTS = 64  # along an edge
ROUND = (Part.Cylinder, Part.Cone, Part.Toroid)


def holes_in(shape, room=None):
    """All that are open at an end at least, of a shape as it stands in the document, by diameter and place."""
    return _Finding(shape, room or Room(shape.Faces)).holes()


def bores_of_shape(shape):
    """That go round as holes do, the halves of one each."""
    return [bore for group in _grouped(_bores(_round(shape))) for stack in stacked(group) if _Wall(stack).around_deg > HELD_DEG for bore in stack]


def _round(shape):
    """Hollow ones, with their numbers from 0."""
    return [(number, face) for number, face in enumerate(shape.Faces) if isinstance(face.Surface, ROUND) and is_hollow(face)]


def _bores(faces):
    return [bore_of(number, face) for number, face in faces if isinstance(face.Surface, Part.Cylinder)]


@dataclass(frozen=True)
class Bore:
    """A hollow cylinder. Heights are along the axis, from the plane through the document's origin."""

    number: int  # of its face, from 0
    axis: np.ndarray
    foot: np.ndarray  # where the axis crosses that plane
    radius: float
    low: float
    high: float
    around: float  # rad


class _Finding:
    def __init__(self, shape, room):
        self._room = room
        self._length = shape.BoundBox.DiagonalLength
        faces = _round(shape)
        self._bores = _bores(faces)
        self._upright = [face for _, face in faces if is_upright(face)]
        self._centres = np.array([tuple(face.Surface.Center)[:2] for face in self._upright]).reshape(-1, 2)

    def holes(self):
        found = [hole for group in _grouped(self._bores) for hole in self._of(group)]
        return tuple(sorted(found, key=lambda hole: (hole.diameter_mm, hole.x, hole.y, hole.top)))

    def _of(self, group):
        """Those of one axis and radius. What is open above, groove or not between, is drilled as one."""
        first = group[0]
        upright = first.axis[2] == 1
        stacks = [_Wall(stack) for stack in stacked(group)]
        stacks = [one for one in stacks if one.around_deg > HELD_DEG]
        open_above = [one for one in stacks if self._is_open(one, 1)] if upright else []
        whole = [one for one in open_above if one.is_whole]
        holes = []
        if whole:
            holes.append(self._drilled(first, whole))
        holes += [self._drilled(first, [one]) for one in open_above if not one.is_whole and not (whole and one.low > min(other.low for other in whole))]
        holes += [hole for one in stacks if one not in open_above and (hole := self._other(first, one, upright)) is not None]
        return holes

    def _drilled(self, first, walls):
        x, y, radius = *map(float, first.foot[:2]), first.radius
        bottom, top = min(one.low for one in walls), max(one.high for one in walls)
        through = self._room.is_clear(x, y, radius, bottom - 0.1 * radius, bottom, set().union(*(one.numbers for one in walls)))  # neither a floor nor a ledge nor a drill's point
        top = max([top, *self._mouths(x, y, top)])
        return Hole(x, y, 2 * radius, top, top - bottom, through, tuple(name for one in walls for name in one.names), around_deg=min(one.around_deg for one in walls))

    def _other(self, first, wall, upright):
        """One that is not drilled from above, out where it is open; None where that is nowhere, as in a hollow."""
        out = next((sign for sign in (1, -1) if self._is_open(wall, sign)), 0)
        if not out:
            return None
        axis = out * first.axis
        begin, end = (wall.high, wall.low) if out > 0 else (wall.low, wall.high)
        mouth, foot = first.foot + begin * first.axis, first.foot + end * first.axis
        through = self._room.is_free(Vector(*(foot - 0.1 * first.radius * axis)), Vector(*axis), first.radius, 0.1 * first.radius, wall.numbers)
        x, y, z = map(float, mouth)
        hole = Hole(x, y, 2 * first.radius, z, abs(begin - end), through, wall.names, tuple(map(float, axis)), wall.around_deg)
        return replace(hole, obstacle="it opens below; turn the part over") if upright else hole.leaning()

    def _is_open(self, wall, sign):
        """As wide as it is, from its middle out of the part."""
        first = wall.bores[0]
        middle = first.foot + (wall.low + wall.high) / 2 * first.axis
        far = self._room.top + first.radius - middle[2] if sign * first.axis[2] == 1 else self._length + first.radius
        return self._room.is_free(Vector(*middle), Vector(*(sign * first.axis)), first.radius, far, wall.numbers)

    def _mouths(self, x, y, top):
        """Up to where countersinks, roundings and wider bores go, which may not have been cut when the hole is."""
        around = np.nonzero(np.hypot(*(self._centres - (x, y)).T) < SAME_MM)[0]
        return [face.BoundBox.ZMax for number in around if (face := self._upright[number]).CenterOfMass.z > top]


class _Wall:
    def __init__(self, bores):
        self.bores = bores
        self.low, self.high = min(bore.low for bore in bores), max(bore.high for bore in bores)
        around = sum(bore.around for bore in bores)
        self.is_whole = around > 2 * math.pi - 1e-6
        self.around_deg = ALL_ROUND_DEG if self.is_whole else math.degrees(around)
        self.names = tuple(f"Face{bore.number + 1}" for bore in bores)
        self.numbers = {bore.number for bore in bores}


def bore_of(number, face):
    surface, (u0, u1, v0, v1) = face.Surface, face.ParameterRange
    along, centre = np.array(surface.Axis), np.array(surface.Center)
    axis = along * next(np.sign(along[i]) for i in (2, 0, 1) if abs(along[i]) > LEVEL)
    if math.hypot(*axis[:2]) < UPRIGHT:
        axis = np.array([0.0, 0.0, 1.0])
    base = centre @ axis
    if all(isinstance(edge.Curve, (Part.Line, Part.Circle)) for edge in face.Edges):
        ends = sorted(base + v * (1 if along @ axis > 0 else -1) for v in (v0, v1))
    else:  # the range is wider than a wall that ends at something bent
        there = [np.array(point) @ axis for edge in face.Edges for point in edge.discretize(POINTS)]
        ends = min(there), max(there)
    return Bore(number, axis, centre - base * axis, surface.Radius, *ends, u1 - u0)


def _grouped(bores):
    """Those of one axis and radius together."""
    left = np.array([[*bore.axis, *bore.foot, bore.radius] for bore in bores]).reshape(-1, 7)
    tolerance, taken, groups = np.array([LEVEL] * 3 + [SAME_MM] * 4), np.zeros(len(bores), bool), []
    for number in range(len(bores)):
        if not taken[number]:
            same = np.nonzero((np.abs(left - left[number]) < tolerance).all(1) & ~taken)[0]
            taken[same] = True
            groups.append([bores[i] for i in same])
    return groups


def stacked(bores):
    """Those that are beside each other together, and apart from those above and below."""
    stacks = []
    for bore in sorted(bores, key=lambda one: one.low):
        if stacks and bore.low < max(one.high for one in stacks[-1]) - SAME_MM:
            stacks[-1].append(bore)
        else:
            stacks.append([bore])
    return stacks


def is_upright(face):
    return abs(abs(face.Surface.Axis.z) - 1) < LEVEL


def is_hollow(face):
    """Whether its material is outside of it."""
    place = places_on(face, 5)
    u, v = place[0] if place else (face.ParameterRange[0], face.ParameterRange[2])
    point, normal, axis = face.valueAt(u, v), face.normalAt(u, v), face.Surface.Axis
    away = point - face.Surface.Center
    away -= axis * (away * axis)
    return normal * away < 0


def places_on(face, count):
    """So many along each parameter, as far as they are on it."""
    a, b, c, d = face.ParameterRange
    steps = [(number + 0.5) / count for number in range(count)]
    return [(a + s * (b - a), c + t * (d - c)) for s in steps for t in steps if face.isPartOfDomain(a + s * (b - a), c + t * (d - c))]

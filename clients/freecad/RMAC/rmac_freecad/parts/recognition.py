"""What there is to machine from above: found from faces and edges, with no memory of who drew them."""

import math
from dataclasses import dataclass

import Part
from FreeCAD import Vector

from rmac_freecad.holes.finding import LEVEL, holes_in, is_upright, places_on
from rmac_freecad.holes.hole import ALL_ROUND_DEG, SAME_MM
from rmac_freecad.holes.room import Room

CLEAR_MM = 1e-3  # beside what stands straight up
WALKED = 5  # places along each parameter of a face that are looked at


@dataclass(frozen=True)
class Recess:
    """A level floor with walls all around, open above. That of a round hole is none: it is drilled with its hole."""

    floor: str
    z: float
    top: float  # of its lowest wall, with fillets and chamfers
    islands: int
    walls: tuple  # names of faces


@dataclass(frozen=True)
class Found:
    free_form: tuple  # names of faces that look up and are neither planes nor cylinders
    recesses: tuple
    holes: tuple
    tops: tuple  # level faces at the highest place
    outline: tuple  # names of the edges round the underside; empty where it has none that is level
    sides: tuple  # upright faces around that

    def __str__(self):
        parts = [f"{len(self.free_form)} free-form", f"{len(self.recesses)} pocket{'' if len(self.recesses) == 1 else 's'}", f"{len(self.holes)} hole{'' if len(self.holes) == 1 else 's'}"]
        return ", ".join(parts)


def recognise(shape):
    """`shape` as it stands in the document, its tool axis along Z."""
    return _Looking(shape).found()


class _Looking:
    def __init__(self, shape):
        self._shape = shape
        self._room = Room(shape.Faces)
        self._faces = {f"Face{number}": face for number, face in enumerate(shape.Faces, 1)}
        self._edges = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, 1)}
        self._of_edge = {}
        for name, face in self._faces.items():
            for edge in face.Edges:
                self._of_edge.setdefault(edge.hashCode(), []).append((edge, name))

    def found(self):
        box = self._shape.BoundBox
        outline, sides = self._outline(box.ZMin)
        holes = tuple(hole for hole in holes_in(self._shape, self._room) if not hole.obstacle and hole.around_deg == ALL_ROUND_DEG)
        round_ones = [set(hole.faces) for hole in holes]
        recesses = [recess for name in self._faces if (recess := self._recess(name)) is not None]
        return Found(
            tuple(name for name, face in self._faces.items() if _is_free_form(face) and not self._is_point(face, holes)),
            tuple(recess for recess in recesses if not any(set(recess.walls) <= one for one in round_ones) and self._is_open_above(self._faces[recess.floor], recess.z)),
            holes,
            tuple(name for name, face in self._faces.items() if _level(face) == 1 and abs(face.CenterOfMass.z - box.ZMax) < SAME_MM),
            outline, sides,
        )  # fmt: skip

    def _beside(self, edge, name):
        """The faces on the other side of an edge."""
        return [other for one, other in self._of_edge.get(edge.hashCode(), ()) if one.isSame(edge) and other != name]

    def _recess(self, name):
        face = self._faces[name]
        if _level(face) != 1:
            return None
        z = face.CenterOfMass.z
        walls = [other for edge in face.OuterWire.Edges for other in self._beside(edge, name)]
        if not walls or any(not self._rises(other, z) for other in walls):
            return None
        inner = [wire for wire in face.Wires if not wire.isSame(face.OuterWire)]
        islands = [wire for wire in inner if all(self._rises(other, z) for edge in wire.Edges for other in self._beside(edge, name))]
        around = [other for wire in islands for edge in wire.Edges for other in self._beside(edge, name)]
        top = min(self._top_of(other) for other in walls)
        return Recess(name, z, top, len(islands), tuple(dict.fromkeys([*walls, *around])))

    def _is_open_above(self, face, z):
        up = Vector(0, 0, self._shape.BoundBox.ZMax + 1 - z)
        places = [face.valueAt(*place) for place in places_on(face, WALKED)]
        feet = [foot + Vector(0, 0, 2 * CLEAR_MM) for foot in places if all(edge.distToShape(Part.Vertex(foot))[0] > 2 * CLEAR_MM for edge in face.Edges)]
        return all(self._room.is_apart(Part.makeLine(foot, foot + up), CLEAR_MM) for foot in feet)

    def _top_of(self, name):
        """Of a wall, with what goes on above it, as above a fillet."""
        _, top = _heights(self._faces[name])
        above = [other for edge in self._faces[name].Edges for other in self._beside(edge, name) if self._rises(other, top)]
        return max((self._top_of(other) for other in set(above)), default=top)

    def _rises(self, name, z):
        bottom, top = _heights(self._faces[name])
        return bottom > z - 1e-3 and top > z + 1e-3 and not _level(self._faces[name])

    def _is_point(self, face, holes):
        """Of a drill, at the end of one of the holes."""
        return isinstance(face.Surface, Part.Cone) and is_upright(face) and any(_is_around(face, hole.x, hole.y) and abs(face.BoundBox.ZMax - hole.bottom) < 1e-3 for hole in holes)

    def _outline(self, z):
        under = [name for name, face in self._faces.items() if _level(face) == -1 and abs(face.CenterOfMass.z - z) < SAME_MM]
        if len(under) != 1:
            return (), ()
        edges = self._faces[under[0]].OuterWire.Edges
        names = tuple(next(name for name, one in self._edges.items() if one.isSame(edge)) for edge in edges)
        return names, tuple(dict.fromkeys(other for edge in edges for other in self._beside(edge, under[0])))


def _level(face):
    """1 where it is planar, level, and looks up; -1 where it looks down; else 0."""
    plane = face.Surface if isinstance(face.Surface, Part.Plane) else face.findPlane() if face.Surface.isPlanar(1e-7) else None
    if plane is None or abs(abs(plane.Axis.z) - 1) > LEVEL:
        return 0
    places = places_on(face, WALKED) or [(sum(face.ParameterRange[:2]) / 2, sum(face.ParameterRange[2:]) / 2)]
    return 1 if face.normalAt(*places[0]).z > 0 else -1


def _is_free_form(face):
    if isinstance(face.Surface, (Part.Plane, Part.Cylinder)) or face.Surface.isPlanar(1e-7):
        return False
    places = places_on(face, WALKED)
    return bool(places) and all(face.normalAt(*place).z > 0.01 for place in places)


def _heights(face):
    """Of a wall: it ends at its edges, and a box round the whole of it is wider than a rounding is."""
    boxes = [edge.BoundBox for edge in face.Edges if not edge.Degenerated]
    return min(box.ZMin for box in boxes), max(box.ZMax for box in boxes)


def _is_around(face, x, y):
    return math.hypot(face.Surface.Center.x - x, face.Surface.Center.y - y) < SAME_MM

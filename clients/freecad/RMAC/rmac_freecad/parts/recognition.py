"""What there is to machine from above: found from faces and edges, with no memory of who drew them."""

import math
from dataclasses import dataclass

import Part

LEVEL = 1e-7  # of a normal of length 1
SAME_MM = 1e-5
WALKED = 5  # places along each parameter of a face that are looked at


@dataclass(frozen=True)
class Hole:
    """Round, along Z."""

    x: float
    y: float
    diameter_mm: float
    top: float
    bottom: float
    through: bool
    faces: tuple  # names of its wall


@dataclass(frozen=True)
class Recess:
    """A level floor with walls all around. That of a round hole is none: it is drilled with its hole."""

    floor: str
    z: float
    top: float  # of its lowest wall
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
        self._faces = {f"Face{number}": face for number, face in enumerate(shape.Faces, 1)}
        self._edges = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, 1)}
        self._of_edge = {}
        for name, face in self._faces.items():
            for edge in face.Edges:
                self._of_edge.setdefault(edge.hashCode(), []).append((edge, name))

    def found(self):
        box = self._shape.BoundBox
        outline, sides = self._outline(box.ZMin)
        holes = self._holes()
        round_ones = [set(hole.faces) for hole in holes]
        recesses = [recess for name in self._faces if (recess := self._recess(name)) is not None]
        return Found(
            tuple(name for name, face in self._faces.items() if _is_free_form(face)),
            tuple(recess for recess in recesses if set(recess.walls) not in round_ones),
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
        top = min(self._faces[other].BoundBox.ZMax for other in walls)
        return Recess(name, z, top, len(islands), tuple(dict.fromkeys([*walls, *around])))

    def _rises(self, name, z):
        box = self._faces[name].BoundBox
        return box.ZMin > z - 1e-3 and box.ZMax > z + 1e-3 and not _level(self._faces[name])

    def _holes(self):
        """Cylinders that are hollow, upright, and whole; halves of one are put together."""
        groups = {}
        for name, face in self._faces.items():
            surface = face.Surface
            if isinstance(surface, Part.Cylinder) and abs(abs(surface.Axis.z) - 1) < LEVEL and _is_hollow(face):
                key = tuple(round(value, 4) for value in (surface.Center.x, surface.Center.y, surface.Radius))
                groups.setdefault(key, []).append((name, face))
        holes = []
        for group in groups.values():
            surface, around = group[0][1].Surface, sum(face.ParameterRange[1] - face.ParameterRange[0] for _, face in group)
            bottom, top = min(face.BoundBox.ZMin for _, face in group), max(face.BoundBox.ZMax for _, face in group)
            if around < 2 * math.pi - 1e-6 or self._filled(surface, (bottom + top) / 2):
                continue
            through = not self._filled(surface, bottom - 1e-3)
            holes.append(Hole(surface.Center.x, surface.Center.y, 2 * surface.Radius, top, bottom, through, tuple(name for name, _ in group)))
        return tuple(sorted(holes, key=lambda hole: (hole.diameter_mm, hole.x, hole.y)))

    def _filled(self, surface, z):
        """Whether there is material in the middle at that height, as in an island."""
        place = surface.Center
        place.z = z
        return self._shape.isInside(place, 1e-6, False)

    def _outline(self, z):
        under = [name for name, face in self._faces.items() if _level(face) == -1 and abs(face.CenterOfMass.z - z) < SAME_MM]
        if len(under) != 1:
            return (), ()
        edges = self._faces[under[0]].OuterWire.Edges
        names = tuple(next(name for name, one in self._edges.items() if one.isSame(edge)) for edge in edges)
        return names, tuple(dict.fromkeys(other for edge in edges for other in self._beside(edge, under[0])))


def _places(face):
    a, b, c, d = face.ParameterRange
    steps = [(number + 0.5) / WALKED for number in range(WALKED)]
    return [(a + s * (b - a), c + t * (d - c)) for s in steps for t in steps if face.isPartOfDomain(a + s * (b - a), c + t * (d - c))]


def _level(face):
    """1 where it is planar, level, and looks up; -1 where it looks down; else 0."""
    plane = face.Surface if isinstance(face.Surface, Part.Plane) else face.findPlane() if face.Surface.isPlanar(1e-7) else None
    if plane is None or abs(abs(plane.Axis.z) - 1) > LEVEL:
        return 0
    places = _places(face) or [(sum(face.ParameterRange[:2]) / 2, sum(face.ParameterRange[2:]) / 2)]
    return 1 if face.normalAt(*places[0]).z > 0 else -1


def _is_free_form(face):
    if isinstance(face.Surface, (Part.Plane, Part.Cylinder)) or face.Surface.isPlanar(1e-7):
        return False
    places = _places(face)
    return bool(places) and all(face.normalAt(*place).z > 0.01 for place in places)


def _is_hollow(face):
    u, v = (_places(face) or [(face.ParameterRange[0], face.ParameterRange[2])])[0]
    place, normal = face.valueAt(u, v), face.normalAt(u, v)
    away = place - face.Surface.Center
    return normal.x * away.x + normal.y * away.y < 0

"""What there is to machine from above: found from faces and edges, with no memory of who drew them."""

import math
from dataclasses import dataclass

import Part
from FreeCAD import Vector

LEVEL = 1e-7  # of a normal of length 1
SAME_MM = 1e-5
CLEAR_MM = 1e-3  # beside what stands straight up
WALKED = 5  # places along each parameter of a face that are looked at


@dataclass(frozen=True)
class Hole:
    """Round, along Z, and open above."""

    x: float
    y: float
    diameter_mm: float
    top: float  # where a drill may meet material; that of countersinks and wider bores around it
    bottom: float  # of its wall
    through: bool
    faces: tuple  # names of its wall


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

    def _is_apart(self, other, by):
        """Whether the part keeps off a body or a line, which lies in it whole or not at all where no face is near; far faces are not looked at, of which there may be many."""
        near = (face for face in self._faces.values() if face.BoundBox.intersect(other.BoundBox))
        return all(face.distToShape(other)[0] > by for face in near) and not self._shape.isInside(other.Vertexes[0].Point, 1e-7, False)

    def _is_open_above(self, face, z):
        up = Vector(0, 0, self._shape.BoundBox.ZMax + 1 - z)
        places = [face.valueAt(*place) for place in _places(face)]
        feet = [foot + Vector(0, 0, 2 * CLEAR_MM) for foot in places if all(edge.distToShape(Part.Vertex(foot))[0] > 2 * CLEAR_MM for edge in face.Edges)]
        return all(self._is_apart(Part.makeLine(foot, foot + up), CLEAR_MM) for foot in feet)

    def _top_of(self, name):
        """Of a wall, with what goes on above it, as above a fillet."""
        _, top = _heights(self._faces[name])
        above = [other for edge in self._faces[name].Edges for other in self._beside(edge, name) if self._rises(other, top)]
        return max((self._top_of(other) for other in set(above)), default=top)

    def _rises(self, name, z):
        bottom, top = _heights(self._faces[name])
        return bottom > z - 1e-3 and top > z + 1e-3 and not _level(self._faces[name])

    def _holes(self):
        """Cylinders that are hollow, upright, whole, and open above as wide as they are; halves of one are put together."""
        holes = []
        for group in self._bores():
            x, y, radius = group[0].surface.Center.x, group[0].surface.Center.y, group[0].surface.Radius
            open_above = []
            for wall in (one for one in _stacked(group) if sum(bore.around for bore in one) > 2 * math.pi - 1e-6):
                bottom, top = min(bore.bottom for bore in wall), max(bore.top for bore in wall)
                if self._is_clear(x, y, radius, (bottom + top) / 2, self._shape.BoundBox.ZMax + radius):
                    open_above.append((bottom, top, wall))
            if not open_above:
                continue
            bottom, top = min(one[0] for one in open_above), max(one[1] for one in open_above)
            faces = tuple(bore.name for _, _, wall in open_above for bore in wall)
            through = self._is_clear(x, y, radius, bottom - 0.1 * radius, bottom)  # neither a floor nor a ledge nor a drill's point
            holes.append(Hole(x, y, 2 * radius, max([top, *self._mouths(x, y, top)]), bottom, through, faces))
        return tuple(sorted(holes, key=lambda hole: (hole.diameter_mm, hole.x, hole.y)))

    def _bores(self):
        """Hollow upright cylinders, those of one axis and radius together."""
        groups = []
        for name, face in self._faces.items():
            if isinstance(face.Surface, Part.Cylinder) and _is_upright(face) and _is_hollow(face):
                bore = _Bore(name, face.Surface, face.BoundBox.ZMin, face.BoundBox.ZMax, face.ParameterRange[1] - face.ParameterRange[0])
                group = next((one for one in groups if abs(one[0].surface.Radius - bore.surface.Radius) < SAME_MM and _is_around(face, *one[0].surface.Center[:2])), None)
                if group is None:
                    groups.append([bore])
                else:
                    group.append(bore)
        return groups

    def _is_clear(self, x, y, radius, a, b):
        """Whether a drill as wide as that meets nothing between two heights."""
        drill = Part.makeCylinder(0.999 * radius, b - a, Vector(x, y, a))
        return self._is_apart(drill, 0.0005 * radius)

    def _mouths(self, x, y, top):
        """Up to where countersinks, roundings and wider bores go, which may not have been cut when the hole is."""
        around = [face for face in self._faces.values() if isinstance(face.Surface, (Part.Cylinder, Part.Cone, Part.Toroid)) and _is_upright(face) and _is_around(face, x, y)]
        return [face.BoundBox.ZMax for face in around if face.CenterOfMass.z > top and _is_hollow(face)]

    def _is_point(self, face, holes):
        """Of a drill, at the end of one of the holes."""
        return isinstance(face.Surface, Part.Cone) and _is_upright(face) and any(_is_around(face, hole.x, hole.y) and abs(face.BoundBox.ZMax - hole.bottom) < 1e-3 for hole in holes)

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


@dataclass(frozen=True)
class _Bore:
    name: str
    surface: Part.Cylinder
    bottom: float
    top: float
    around: float  # rad


def _stacked(bores):
    """Those that are beside each other together, and apart from those above and below."""
    stacks = []
    for bore in sorted(bores, key=lambda one: one.bottom):
        if stacks and bore.bottom < max(one.top for one in stacks[-1]) - SAME_MM:
            stacks[-1].append(bore)
        else:
            stacks.append([bore])
    return stacks


def _heights(face):
    """Of a wall: it ends at its edges, and a box round the whole of it is wider than a rounding is."""
    boxes = [edge.BoundBox for edge in face.Edges if not edge.Degenerated]
    return min(box.ZMin for box in boxes), max(box.ZMax for box in boxes)


def _is_upright(face):
    return abs(abs(face.Surface.Axis.z) - 1) < LEVEL


def _is_around(face, x, y):
    return math.hypot(face.Surface.Center.x - x, face.Surface.Center.y - y) < SAME_MM


def _is_hollow(face):
    u, v = (_places(face) or [(face.ParameterRange[0], face.ParameterRange[2])])[0]
    place, normal = face.valueAt(u, v), face.normalAt(u, v)
    away = place - face.Surface.Center
    return normal.x * away.x + normal.y * away.y < 0

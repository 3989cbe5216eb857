"""What is selected, as holes: faces and edges of them, a part as a whole, and circles and points of sketches."""

import math
from dataclasses import dataclass, replace

import numpy as np
import Part

from rmac_freecad.holes.finding import HELD_DEG, LEVEL, ROUND, UPRIGHT, bores_of_shape, holes_in, is_hollow
from rmac_freecad.holes.hole import SAME_MM, Hole
from rmac_freecad.holes.room import Room
from rmac_freecad.jobs.refusal import JobRefused


@dataclass(frozen=True)
class Source:
    """An object as it stands in the document; `names` of its faces, edges and vertices, or none for all of it. `around`: a part that it lies in, as a sketch in a body."""

    label: str
    shape: Part.Shape
    names: tuple
    around: Part.Shape | None = None
    points: tuple = ()  # of a sketch, whose shape has none

    def copied(self):
        """For a thread, which nobody shares it with."""
        return replace(self, shape=self.shape.copy(), around=None if self.around is None else self.around.copy())

    def is_same(self, other):
        return self.names == other.names and self.points == other.points and _is_same(self.shape, other.shape) and _is_same(self.around, other.around)


def _is_same(a, b):
    return a is b or (a is not None and b is not None and a.isPartner(b) and a.Placement == b.Placement)


def room_of(sources):
    """Around all parts that are there."""
    shapes = [shape for one in sources for shape in (one.shape, one.around) if shape is not None]
    return Room([face for shape in shapes if shape.Solids for face in shape.Faces])


def holes_of(sources):
    """Each once, by its part. Raises `JobRefused` for what is no hole, as soon as somebody chose that."""
    found = [hole for one in sources for hole in (_of_part(one) if one.shape.Solids else _of_drawing(one))]
    return tuple(dict.fromkeys(found))


def diameters_of(source):
    """Of what may be holes of a part as a whole, at once: nothing is looked at that is near them. Upright ones, where there are any."""
    bores = bores_of_shape(source.shape)
    upright = [bore for bore in bores if bore.axis[2] == 1]
    return [2 * bore.radius for bore in upright or bores]


def _of_part(source):
    holes = holes_in(source.shape)
    if not source.names:
        if not holes:
            raise JobRefused(f"{source.label} has no round hole that is open")
        return holes
    chosen = _Chosen(source, holes)
    return [hole for name in source.names for hole in chosen.of(name)]


class _Chosen:
    def __init__(self, source, holes):
        self._label, self._shape, self._holes = source.label, source.shape, holes

    def of(self, name):
        kind = name.rstrip("0123456789")
        parts = {"Face": self._shape.Faces, "Edge": self._shape.Edges}.get(kind, ())
        if not name[len(kind) :].isdigit() or not 1 <= int(name[len(kind) :]) <= len(parts):
            raise JobRefused(f"{self._label}.{name} is no hole; select faces or circular edges of holes, or a part as a whole")
        part = parts[int(name[len(kind) :]) - 1]
        found, why = self._of_face(name, part) if kind == "Face" else self._of_edge(part)
        if not found:
            raise JobRefused(f"{self._label}.{name}: {why}")
        return found

    def _of_face(self, name, face):
        own = [hole for hole in self._holes if name in hole.faces]
        if own:
            return own, ""
        if isinstance(face.Surface, Part.Plane):
            edges = {edge.hashCode() for edge in face.Edges}
            return [hole for hole in self._holes if any(edge.hashCode() in edges for wall in hole.faces for edge in self._shape.getElement(wall).Edges)], "no round hole begins or ends in it"
        if not isinstance(face.Surface, ROUND):
            return [], "it is no cylinder, which a hole's wall is; a spline that is as round is not taken for one"
        if not is_hollow(face):
            return [], "it is round outside, and no hole"
        if isinstance(face.Surface, Part.Cylinder):
            around = np.degrees(face.ParameterRange[1] - face.ParameterRange[0])
            return [], f"its wall goes round by {around:.0f}°; more than {HELD_DEG:.0f}° is a hole" if around <= HELD_DEG else "it is open nowhere"
        return self._coaxial(face), "there is no hole below it"

    def _coaxial(self, face):
        """Those of a countersink or a rounding."""
        axis, centre = np.array(face.Surface.Axis), np.array(face.Surface.Center)
        return [hole for hole in self._holes
                if np.linalg.norm(np.cross(axis, hole.axis)) < LEVEL and np.linalg.norm(np.cross(np.array((hole.x, hole.y, hole.top)) - centre, axis)) < SAME_MM]  # fmt: skip

    def _of_edge(self, edge):
        if not isinstance(edge.Curve, Part.Circle):
            return [], "it is no circle"
        beside = [(f"Face{number}", face) for number, face in enumerate(self._shape.Faces, 1) if any(one.isSame(edge) for one in face.Edges)]
        found = [hole for name, face in beside if isinstance(face.Surface, ROUND) for hole in self._of_face(name, face)[0]]
        return found, "it goes round no hole"


def _of_drawing(source):
    """Circles and points, which have no depth."""
    shape = source.shape
    if shape.Shells:
        raise JobRefused(f"{source.label} is a shell and no solid; make a solid of it")
    ends = {vertex.hashCode() for edge in shape.Edges for vertex in edge.Vertexes}
    circles = {f"Edge{number}": edge for number, edge in enumerate(shape.Edges, 1) if _is_circle(edge)}
    points = {f"Vertex{number}": vertex for number, vertex in enumerate(shape.Vertexes, 1) if vertex.hashCode() not in ends}
    points |= {f"Point{number}": Part.Vertex(*point) for number, point in enumerate(source.points, 1)}
    names = source.names or (*circles, *points)
    if not names:
        raise JobRefused(f"{source.label} has neither circles nor points")
    other = next((name for name in names if name not in circles and name not in points), None)
    if other is not None:
        raise JobRefused(f"{source.label}.{other} is neither a circle nor a point")
    return [_of_circle(circles[name]) if name in circles else _drawn(points[name].Point, 0.0) for name in names]


def _is_circle(edge):
    return isinstance(edge.Curve, Part.Circle) and edge.isClosed()


def _of_circle(edge):
    curve = edge.Curve
    axis = curve.Axis if (curve.Axis.z, curve.Axis.x, curve.Axis.y) > (0, 0, 0) else curve.Axis * -1
    return _drawn(curve.Center, 2 * curve.Radius, (0.0, 0.0, 1.0) if math.hypot(axis.x, axis.y) < UPRIGHT else tuple(axis))


def _drawn(place, diameter, axis=(0.0, 0.0, 1.0)):
    hole = Hole(place.x, place.y, diameter, place.z, 0.0, False, (), axis)
    return hole if axis[2] == 1 else hole.leaning()

"""What is to be cleared: a level face, or a closed sketch, as walls that have the pocket to their left."""

from dataclasses import dataclass, replace

import numpy as np
import Part
from FreeCAD import Vector

from rmac_freecad.pockets.clash import Surroundings
from rmac_freecad.pockets.crossings import crossings
from rmac_freecad.pockets.refusal import PocketRefused
from rmac_freecad.pockets.spline import smooth_parts
from rmac_freecad.pockets.tracks import ArcTrack, LineTrack, SideTrack
from rmac_freecad.pockets.wall import Wall
from rmac_freecad.profiles.contour import contour_of, edges_of
from rmac_freecad.profiles.pieces import Bow, Spline, Straight

LEVEL = 1e-7  # of a normal of length 1
SAME_PLACE_MM = 1e-5
ABOVE_MM = 1e-3


@dataclass(frozen=True)
class Outline:
    contours: tuple  # the outer one first, then islands
    z: float
    wall: Wall
    around: Surroundings | None = None  # of a solid's face


def outline_of(feature, face=""):
    """Of a face, "Face3", of the object, whose inner wires are islands, but for ways down from what is below the part's top; else of all its edges, as of a
    sketch. Where it stands in the document. Raises `PocketRefused`, and `ProfileRefused` where edges do not make contours."""
    wires, around = _wires_of_face(feature, face) if face else (_wires_of_edges(edges_of(feature)), None)
    contours = [_closed(contour_of(wire)) for wire in wires]
    z = contours[0].z
    for contour in contours:
        if abs(contour.z - z) > 1e-6:
            raise PocketRefused(f"it lies at Z {contour.z:.4g}, and others at Z {z:.4g}; a pocket's walls begin in one plane", edge=contour.pieces[0].name)
    contours = [replace(contour, pieces=tuple(part for piece in contour.pieces for part in _smooth(piece))) for contour in contours]
    _check_apart(contours)
    outer, islands = _nested(contours)
    contours = (outer, *(island.turned() for island in islands))
    return Outline(contours, z, Wall([piece for contour in contours for piece in contour.pieces]), around)


def _wires_of_face(feature, name):
    shape = feature.Shape.copy()
    shape.Placement = feature.getGlobalPlacement()
    number = name[4:] if name.startswith("Face") else ""
    if not number.isdigit() or not 1 <= int(number) <= len(shape.Faces):
        raise PocketRefused(f"{feature.Label} has no {name}; select a face, or a sketch")
    face = shape.Faces[int(number) - 1]
    plane = face.Surface if isinstance(face.Surface, Part.Plane) else face.findPlane() if face.Surface.isPlanar(1e-7) else None
    if plane is None:
        raise PocketRefused("it is not planar; a pocket is cleared on a flat, level face", edge=name)
    if abs(abs(plane.Axis.z) - 1) > LEVEL:
        raise PocketRefused("it is not level; a pocket is cleared on a face that lies across Z", edge=name)
    if shape.Solids and face.normalAt(*(sum(face.ParameterRange[i : i + 2]) / 2 for i in (0, 2))).z < 0:
        raise PocketRefused("it looks down; a pocket is cleared from above", edge=name)
    is_floor = _is_floor(shape, face)
    wires = [wire for wire in face.Wires if wire.isSame(face.OuterWire) or not (is_floor and _is_way_down(shape, face, wire))]
    named = [[(_name(shape, edge), edge) for edge in wire.Edges] for wire in wires]
    return named, Surroundings(shape, name, is_floor) if shape.Solids else None


def _is_floor(shape, face):
    """Whether the part is higher anywhere: a ledge, a slot or a pocket, and no top face."""
    z = face.CenterOfMass.z + ABOVE_MM
    if any(vertex.Point.z > z for vertex in shape.Vertexes):
        return True
    return any(other.BoundBox.ZMax > z and other.optimalBoundingBox(False).ZMax > z for other in shape.Faces)  # bent ones: the first box may be too wide


def _is_way_down(shape, face, wire):
    """From a floor into a hole or a deeper pocket, with nothing standing above: no island."""
    z, top = face.CenterOfMass.z, shape.BoundBox.ZMax
    above = Part.Face(wire).extrude(Vector(0, 0, top + 1 - z))
    above.translate(Vector(0, 0, ABOVE_MM))
    return shape.distToShape(above)[0] > 0


def _name(shape, edge):
    return next(f"Edge{number}" for number, one in enumerate(shape.Edges, 1) if one.isSame(edge))


def _wires_of_edges(edges):
    if not edges:
        raise PocketRefused("there is no edge; select a face, or a closed sketch")
    return _grouped(edges)


def _grouped(edges):
    """By their ends."""
    groups = []
    for name, edge in edges:
        ends = [vertex.Point for vertex in edge.Vertexes]
        meets = [group for group in groups if any(a.distanceToPoint(b) <= 1e-6 for a in ends for _, one in group for b in (v.Point for v in one.Vertexes))]
        groups = [group for group in groups if group not in meets]
        groups.append([pair for group in meets for pair in group] + [(name, edge)])
    return groups


def _closed(contour):
    if not contour.closed:
        raise PocketRefused("the outline is open there; close it", contour.pieces[-1].end, contour.pieces[-1].name)
    return contour


def _smooth(piece):
    if not isinstance(piece, Spline):
        return [piece]
    return [Spline(piece.name, part, 0.0) for part in smooth_parts(piece.curve)]


def _check_apart(contours):
    """Walls meet the next one of their contour at their ends, and nothing else anywhere."""
    pieces = [(piece, contour, number) for contour in contours for number, piece in enumerate(contour.pieces)]
    wall = Wall([piece for piece, _, _ in pieces])
    tracks = [_on(piece, wall) for piece, _, _ in pieces]
    for i, (a, (_, contour, number)) in enumerate(zip(tracks, pieces)):
        for b, (_, other, after) in list(zip(tracks, pieces))[i + 1 :]:
            follow = contour is other and (after - number) % len(contour.pieces) in (1, len(contour.pieces) - 1)
            for s, _ in crossings(a, b):
                place = a.at(s)
                ends = [min(np.hypot(*(place - one.at(end))) for end in (0.0, 1.0)) < SAME_PLACE_MM for one in (a, b)]
                if not (follow and all(ends)):
                    raise PocketRefused(f"it meets {b.name} there; walls of a pocket do not cross or touch", tuple(map(float, place)), a.name)


def _on(piece, wall):
    if isinstance(piece, Straight):
        return LineTrack(piece)
    if isinstance(piece, Bow):
        return ArcTrack(piece)
    spline = wall.splines[id(piece)]
    return SideTrack(piece.name, spline, float(spline.t[0]), float(spline.t[-1]), 0.0)


def _nested(contours):
    """The one that holds all others, which do not hold each other."""
    walls = [Wall(contour.pieces) for contour in contours]
    holds = [[wall.inside([other.pieces[0].start])[0] if other is not contour else False for other in contours] for wall, contour in zip(walls, contours)]
    outer = max(range(len(contours)), key=lambda i: walls[i].area())
    for i, contour in enumerate(contours):
        if i == outer:
            continue
        first = contour.pieces[0]
        if not holds[outer][i]:
            raise PocketRefused("it lies beside the other outline; make a pocket of each", first.start, first.name)
        if any(holds[j][i] for j in range(len(contours)) if j != outer):
            raise PocketRefused("it lies within an island; make a pocket of its own of it", first.start, first.name)
    return contours[outer], [contour for i, contour in enumerate(contours) if i != outer]

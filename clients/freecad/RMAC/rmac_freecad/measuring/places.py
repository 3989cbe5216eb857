"""Places on faces that a probe gets to: away from edges, and apart from each other."""

import math
from dataclasses import dataclass

import numpy as np
import Part
from FreeCAD import Vector

from rmac_freecad.measuring.refusal import MeasuringRefused

GRIDS = 13, 52  # candidates along each parameter of a face; the finer one where the first has none off the edges
CLOSE_MM = 1e-4


@dataclass(frozen=True)
class Place:
    face: str  # its name in the shape
    point: tuple
    normal: tuple  # out of the material


def places_on(shape, names, *, count, tip_radius_mm, clearance_mm, edge_mm, safe_mm, between_mm=(-math.inf, math.inf)):
    """`count` places on each of the faces, fewer where no more are found, as far apart as may be: no nearer than `edge_mm` to an edge of the face, where a probe with a tip of
    that radius touches nothing else, neither there nor `clearance_mm` off nor straight up from there to `safe_mm`. Of walls those
    heights alone are taken that leave the tip between two, as a stylus is only so long. Raises `MeasuringRefused` of a face that has no such place."""
    faces = {f"Face{number}": face for number, face in enumerate(shape.Faces, 1)}
    unknown = [name for name in names if name not in faces]
    if unknown or not names:
        raise MeasuringRefused(f"there is no {unknown[0]}; the part has Face1 to Face{len(faces)}" if unknown else "no face was named")
    if not all(math.isfinite(value) and value > 0 for value in (tip_radius_mm, clearance_mm)) or count < 1 or not edge_mm >= 0:
        raise MeasuringRefused("the tip's radius and the clearance are more than 0, and there is 1 place a face at least")
    if not math.inf > safe_mm >= shape.BoundBox.ZMax + tip_radius_mm:
        raise MeasuringRefused(f"the height to cross at, Z {safe_mm:g}, is at least the tip's radius above the part, Z {shape.BoundBox.ZMax:.4g}")
    reach = _Reach(shape, tip_radius_mm, clearance_mm, safe_mm, between_mm)
    found = []
    for name in names:
        grids = ([place for place in _candidates(name, faces[name], grid) if _off_edges(faces[name], place, edge_mm)] for grid in GRIDS)
        chosen = _apart(next(filter(None, grids), []), count, reach.gets_to)
        if not chosen:
            raise MeasuringRefused(f"{name} has no place {edge_mm:g} mm from its edges that a tip of radius {tip_radius_mm:g} mm gets to from above; have a smaller tip, clearance or distance, or leave it out")
        found += chosen
    return found


def _candidates(name, face, grid):
    a, b, c, d = face.ParameterRange
    steps = (np.arange(grid) + 0.5) / grid
    for s in steps:
        for t in steps:
            u, v = a + s * (b - a), c + t * (d - c)
            if face.isPartOfDomain(u, v):
                yield Place(name, tuple(face.valueAt(u, v)), tuple(face.normalAt(u, v)))


def _off_edges(face, place, edge_mm):
    vertex = Part.Vertex(*place.point)
    return all(_is_seam(face, edge) or edge.distToShape(vertex)[0] >= edge_mm for edge in face.Edges)


def _is_seam(face, edge):
    return sum(edge.isSame(other) for wire in face.Wires for other in wire.Edges) > 1


def _apart(candidates, count, gets_to):
    """Each is the farthest from those before; the first is the nearest to their middle. What nothing gets to is looked at only when it is due."""
    if not candidates:
        return []
    points = np.array([place.point for place in candidates])
    away = -np.linalg.norm(points - points.mean(0), axis=1)
    chosen, near = [], np.full(len(points), np.inf)
    while len(chosen) < count and np.isfinite(away).any():
        at = int(away.argmax())
        if not gets_to(candidates[at]):
            near[at] = away[at] = -np.inf
            continue
        chosen.append(candidates[at])
        near = np.minimum(near, np.linalg.norm(points - points[at], axis=1))
        near[at] = -np.inf
        away = near.copy()
    return chosen


class _Reach:
    def __init__(self, shape, tip, clearance, safe, between):
        self._shape, self._tip, self._clearance, self._safe, self._between = shape, tip, clearance, safe, between

    def gets_to(self, place):
        point, normal = Vector(*place.point), Vector(*place.normal)
        there, off = point + normal * self._tip, point + normal * (self._tip + self._clearance)
        if normal.z < -1e-6 or there.z - self._tip < self._between[0] or there.z + self._tip > self._between[1]:
            return False
        ways = [Part.makeLine(there, off)]
        if off.z < self._safe - CLOSE_MM:
            ways.append(Part.makeLine(off, Vector(off.x, off.y, self._safe)))
        return all(self._shape.distToShape(way)[0] >= self._tip - CLOSE_MM for way in ways) and not self._shape.isInside(off, 1e-7, True)

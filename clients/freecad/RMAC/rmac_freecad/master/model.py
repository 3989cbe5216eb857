"""The faces of a shape, as measured points are held against them."""

import numpy as np
import Part
from FreeCAD import Vector

from rmac_freecad.master.refusal import MasterRefused

NEAR_MM = 0.5  # a nominal place lies on its face; what is farther has none
AGREES = 0.7  # cosine between a face's normal and the one that was told


class NoFace(MasterRefused):
    """A place lies on no face."""


def measured_points(touched):
    """What was measured, one point a row. Raises `MasterRefused` where there is nothing, or no number."""
    if not touched:
        raise MasterRefused("no place was measured")
    numbers = np.array([(*one.measured, *one.place.point, *one.place.normal) for one in touched], float)
    for one, finite in zip(touched, np.isfinite(numbers).all(1)):
        if not finite:
            raise MasterRefused(f"a measured point is no number: {one.measured}, on {one.place.face} at {one.place.point}")
    return numbers[:, :3]


class Model:
    """Each place keeps the face on which it lies, so that it is the same one however far a measured point is off. Names of faces are not
    trusted: a model that was computed anew may have others."""

    def __init__(self, shape, touched, within_mm=NEAR_MM):
        self._faces = [self._face_of(shape, one.place, within_mm) for one in touched]

    def _face_of(self, shape, place, within_mm):
        point, normal = Vector(*place.point), Vector(*place.normal)
        vertex = Part.Vertex(point)
        best = None
        for face in shape.Faces:
            box = face.BoundBox
            box.enlarge(within_mm)
            if not box.isInside(point):
                continue
            away = face.distToShape(vertex)[0]
            if away <= within_mm and (best is None or away < best[0]) and _foot(face, point)[1].dot(normal) > AGREES:
                best = away, face
        if best is None:
            raise NoFace(f"no face of the model is within {within_mm:g} mm of X {point.x:.4g} Y {point.y:.4g} Z {point.z:.4g}; measure places of this model")
        return best[1]

    def held_against(self, points):
        """Distances out of the material, with the points on the surfaces below and the normals there."""
        feet = [_foot(face, Vector(*point)) for face, point in zip(self._faces, points)]
        foot, normal = np.array([tuple(one[0]) for one in feet]), np.array([tuple(one[1]) for one in feet])
        return ((points - foot) * normal).sum(1), foot, normal


def _foot(face, point):
    """On the face's surface, which may go on over its edges."""
    u, v = face.Surface.parameter(point)
    a, b, c, d = face.ParameterRange
    if not isinstance(face.Surface, (Part.Plane, Part.Cylinder, Part.Cone, Part.Sphere, Part.Toroid)):
        u, v = min(max(u, a), b), min(max(v, c), d)
    return face.Surface.value(u, v), face.normalAt(u, v)

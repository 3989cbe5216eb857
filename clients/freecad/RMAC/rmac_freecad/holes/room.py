"""Where nothing of a part is."""

import math

import numpy as np
import Part
from FreeCAD import Vector

FEW = 4  # wires of a face
SLENDER = 0.999  # of its radius: a drill in its hole touches nothing


class Room:
    """Around the faces of a part. A plate of thousand holes has faces of as many wires, of which those alone are looked at that are near."""

    def __init__(self, faces):
        self._faces = list(faces)
        boxes = [face.BoundBox for face in self._faces]
        self._low, self._high = _corners(boxes)
        self.top = max((box.ZMax for box in boxes), default=-math.inf)
        self._wires = {}

    def is_apart(self, body, by, besides=()):
        """Whether the part keeps off a body or a line that is outside of it somewhere: it would come in through a face. `besides`: numbers of faces that keep off for certain, from 0."""
        box = body.BoundBox
        low, high = np.array([box.XMin, box.YMin, box.ZMin]) - by, np.array([box.XMax, box.YMax, box.ZMax]) + by
        near = np.nonzero(((self._low <= high) & (self._high >= low)).all(1))[0]
        near = [number for number in near if number not in besides]
        return all(self._near_part(number, low, high).distToShape(body)[0] > by for number in near)

    def is_clear(self, x, y, radius, a, b, besides=()):
        """Whether a drill as wide as that meets nothing between two heights."""
        return self.is_free(Vector(x, y, a), Vector(0, 0, 1), radius, b - a, besides)

    def is_free(self, begin, axis, radius, length, besides=()):
        return self.is_apart(Part.makeCylinder(SLENDER * radius, length, begin, axis), (1 - SLENDER) / 2 * radius, besides)

    def _near_part(self, number, low, high):
        """Of a flat face with many wires the outer one, and those of the inner ones that are near: what is filled in lies elsewhere."""
        face = self._faces[number]
        if number not in self._wires:
            wires = [wire for wire in face.Wires if not wire.isSame(face.OuterWire)] if isinstance(face.Surface, Part.Plane) else []
            self._wires[number] = (face.OuterWire, wires, *_corners([wire.BoundBox for wire in wires])) if len(wires) > FEW else None
        known = self._wires[number]
        if known is None:
            return face
        outer, wires, lows, highs = known
        return Part.makeFace([outer, *(wires[i] for i in np.nonzero(((lows <= high) & (highs >= low)).all(1))[0])], "Part::FaceMakerBullseye")


def _corners(boxes):
    return np.array([[box.XMin, box.YMin, box.ZMin] for box in boxes]).reshape(-1, 3), np.array([[box.XMax, box.YMax, box.ZMax] for box in boxes]).reshape(-1, 3)

"""Plates with holes as strangers draw them."""

import Part
from FreeCAD import Vector


def block_without(*tools, size=(60, 30, 12)):
    shape = Part.makeBox(*size)
    for tool in tools:
        shape = shape.cut(tool)
    return shape


def bore(diameter, bottom, height=20, x=20.0, y=15.0):
    return Part.makeCylinder(diameter / 2, height, Vector(x, y, bottom))


def halves(diameter, x, y, height=12):
    """As STEP files of some systems have a hole: two half cylinders, which meet nowhere else."""
    at, up = Vector(x, y, 0), Vector(0, 0, 1)
    return [Part.makeCylinder(diameter / 2, height, at, up, 180).rotated(at, up, turned) for turned in (0, 180)]


def leaning(diameter, axis, x=20.0, y=15.0, z=6.0):
    axis = Vector(*axis).normalize()
    return Part.makeCylinder(diameter / 2, 80, Vector(x, y, z) - axis * 40, axis)


def box_with_holes():
    """Two of 5 mm through, in halves and not; one of 8 mm blind; one counterbored; one that leans; one that opens below."""
    tools = (bore(5, -4, x=8.0, y=8.0), *halves(5, 50, 8), bore(8, 5, x=30.0, y=20.0), bore(5, -4, x=8.0, y=22.0), bore(9, 7, x=8.0, y=22.0),
             leaning(4, (0, 1, 0), x=20.0), bore(6, -4, 10, x=44.0, y=22.0))  # fmt: skip
    return block_without(*tools)

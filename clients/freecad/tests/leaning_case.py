"""Parts that are swept with five axes, and what is held of them: told by code that shares nothing with the sweep (leaning_part.py)."""

import math
import unittest

import FreeCAD
import numpy as np
import Part
from leaning_part import Poses, cloud, outward_points
from swept_part import reachable

from rmac_freecad.surfaces import read_faces

Vector = FreeCAD.Vector
GOUGE_MM = 0.001
SIDE_MM = 0.001
FEEDS = {"feed_mm_min": 600, "rapid_mm_min": 2000}


def wavy(seed, length=6.0, width=4.0, height=0.025):
    """A solid with a random bicubic face on top."""
    chance = np.random.default_rng(seed)
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(length * i / 4, width * j / 4, 6 + chance.uniform(-height, height)) for j in range(5)] for i in range(5)])
    return surface.toShape().extrude(Vector(0, 0, -8))


def prism(outline, depth):
    """Of an outline in X and Z, along Y."""
    places = [Vector(x, 0, z) for x, z in outline]
    return Part.Face(Part.makePolygon([*places, places[0]])).extrude(Vector(0, depth, 0))


def passage(gap=6.0):
    """Between two bent blades on a hub; the faces that look into it, and its floor."""

    def blade(x, bend, thick):
        surface = Part.BSplineSurface()
        heights = [1.5 + 2.5 * j for j in range(5)]
        surface.interpolate([[Vector(x + bend * math.sin(math.pi * j / 4) + 0.1 * i, 2 * i, heights[j]) for j in range(5)] for i in range(5)])
        return surface.toShape().extrude(Vector(thick, 0, 0))

    shape = Part.makeBox(20, 8, 2, Vector(-6, 0, 0)).fuse([blade(0, 0.8, -2.5), blade(gap, 0.6, 2.5)])
    middle = [face.CenterOfMass for face in shape.Faces]
    bent = [i for i, face in enumerate(shape.Faces) if isinstance(face.Surface, Part.BSplineSurface)]
    walls = [next(i for i in bent if low < middle[i].x < high) for low, high in ((0, 2), (gap, gap + 1.5))]
    floor = next(i for i, at in enumerate(middle) if abs(at.z - 2) < 1e-6 and 1 < at.x < 5)
    return shape, walls, floor


def looks(shape, *way):
    """Number of the face that looks that way most."""
    way = Vector(*way)

    def toward(face):
        u, v = (sum(face.ParameterRange[k : k + 2]) / 2 for k in (0, 2))
        normal, point = face.normalAt(u, v), face.valueAt(u, v)
        return (-normal if shape.isInside(point + normal * 1e-3, 1e-7, False) else normal).dot(way)

    return max(range(len(shape.Faces)), key=lambda i: toward(shape.Faces[i]))


class LeaningTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("leaning")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def swept(self, shape, faces, mill, scallop_mm=0.05, **more):
        feature = self.document.addObject("Part::Feature", "Cut")
        feature.Shape = shape
        return read_faces(feature, [f"Face{face + 1}" for face in faces], mill, scallop_mm=scallop_mm, **{**FEEDS, **more})

    def check(self, shape, faces, radius, program, scallop_mm=0.05, every=6, least=-1.0):
        """No gouge, with the ball or its side, on passes, links and rapids; the scallop wherever the ball gets to."""
        poses = Poses(program, radius)
        deepest = poses.ball_gouge(shape, every)
        side = poses.side_gouge(cloud(shape, 3000, 3), every)
        worst = 0.0
        for face in faces:
            points, normals = outward_points(shape, shape.Faces[face], 2000, 1)
            above = poses.left_over(points, normals)
            high = above > 0.9 * scallop_mm
            free = reachable(shape, points[high], normals[high], radius)
            worst = max(worst, above[high][free].max(initial=0))
        print(f"ball {1e3 * max(deepest, 0):.2f} um, side {1e3 * max(side, 0):.2f} um in the part, left {1e3 * worst:.1f} um of {1e3 * scallop_mm:g}")
        self.assertLess(deepest, GOUGE_MM)
        self.assertLess(side, SIDE_MM)
        self.assertLess(worst, 1.05 * scallop_mm)
        self.assertGreater(worst, least * scallop_mm)
        return poses

    def angles(self, shape, face, poses):
        """Lead and tilt in degrees, as a stranger would measure them on the first pass."""
        surface = shape.Faces[face]
        inner = np.flatnonzero(poses.cut)[5:60:5]
        found = []
        for i in inner:
            centre = Vector(*poses.centre[i])
            near = surface.distToShape(Part.Vertex(centre))[1][0][0]
            normal = np.array(centre - near) / (centre - near).Length
            feed = poses.centre[i + 1] - poses.centre[i - 1]
            feed /= np.linalg.norm(feed)
            axis = poses.axis[i]
            lead = math.degrees(math.asin(axis @ feed))
            found.append((lead, math.degrees(math.atan2(axis @ np.cross(normal, feed), axis @ normal))))
        return np.array(found)

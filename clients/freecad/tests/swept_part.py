"""What a program leaves of a part, told by OpenCASCADE and closed formulas: shares nothing with the sweep that made it."""

import math

import FreeCAD
import numpy as np
import Part

SPACING_MM = 0.05  # of tips along a curve: a ball of 2 mm dips 0.0002 mm between two at most


def tips(program, spacing=SPACING_MM):
    """Of all moves at feed: dense along curves, and along lines."""
    found = []
    for move in program.moves:
        if hasattr(move, "curve"):
            curve = Part.BSplineCurve()
            knots = sorted(set(move.curve.knots))
            counts = [move.curve.knots.count(knot) for knot in knots]
            curve.buildFromPolesMultsKnots([FreeCAD.Vector(*p) for p in move.curve.points], counts, knots, False, move.curve.degree)
            length = sum(math.dist(a, b) for a, b in zip(move.curve.points, move.curve.points[1:]))
            found += [curve.value(float(t)) for t in np.linspace(knots[0], knots[-1], int(length / spacing) + 8)]
        elif move.start is not None and move.end is not None:
            line = np.linspace(move.start, move.end, int(math.dist(move.start, move.end) / spacing) + 2)
            found += [FreeCAD.Vector(*p) for p in line]
    return np.array([(p.x, p.y, p.z) for p in found])


def ball_gouge(shape, radius, places):
    """How deep a ball with its tip there is in the part at most; negative where it stays off."""
    deepest = -math.inf
    for x, y, z in places:
        centre = FreeCAD.Vector(x, y, z + radius)
        away = shape.distToShape(Part.Vertex(centre))[0]
        if away < radius - 1e-4 and shape.Solids and shape.isInside(centre, 1e-7, False):
            away = -away
        deepest = max(deepest, radius - away)
    return deepest


def profile(radius, corner, off):
    """Height of a mill's surface above its tip, so far from its axis; beside it there is nothing of it."""
    beyond = np.maximum(off - (radius - corner), 0)
    return np.where(off < radius, corner - np.sqrt(np.maximum(corner**2 - beyond**2, 0)), np.inf)


def mill_gouge(radius, corner, places, points):
    """As `ball_gouge`, of any mill, by points of the part, along Z."""
    deepest = -math.inf
    for place in places:
        depth = points[:, 2] - place[2] - profile(radius, corner, np.hypot(*(points[:, :2] - place[:2]).T))
        deepest = max(deepest, depth.max(initial=-math.inf))
    return deepest


def mill_left_over(radius, corner, points, normals, places, ladder):
    """The least of these heights above each point, along its normal, that a mill took away somewhere; infinite where none."""
    up = np.full(len(points), np.inf)
    for number, (point, normal) in enumerate(zip(points, normals)):
        near = places[(np.abs(places[:, :2] - point[:2]) < radius + ladder[-1]).all(1)]
        above = point + np.multiply.outer(ladder, normal)
        off = np.hypot(above[:, :1] - near[:, 0], above[:, 1:2] - near[:, 1])
        taken = (above[:, 2:] - near[:, 2] >= profile(radius, corner, off)).any(1)
        if taken.any():
            up[number] = ladder[taken.argmax()]
    return up


def face_points(face, count, seed, steepest_deg=80.0):
    """Points inside of the face, at random in its parameters, with upward normals, where it is no steeper."""
    chance, found = np.random.default_rng(seed), []
    a, b, c, d = face.ParameterRange
    while len(found) < count:
        u, v = chance.uniform(a, b), chance.uniform(c, d)
        if not face.isPartOfDomain(u, v):
            continue
        normal = face.normalAt(u, v)
        sign = 1 if normal.z >= 0 else -1
        if abs(normal.z) >= math.cos(math.radians(steepest_deg)):
            found.append((*face.valueAt(u, v), *(sign * normal)))
    found = np.array(found)
    return found[:, :3], found[:, 3:]


def reachable(shape, points, normals, radius):
    """Where a ball that touches the point is nowhere in the part."""
    centres = [FreeCAD.Vector(*centre) for centre in points + radius * normals]
    away = np.array([shape.distToShape(Part.Vertex(centre))[0] for centre in centres]) > radius - 1e-6
    return away & np.array([not shape.isInside(centre, 1e-7, False) for centre in centres])


def left_over(points, normals, places, radius):
    """Above each point along its normal, up to where a ball that was somewhere first took it away."""
    up = np.full(len(points), np.inf)
    for number, (point, normal) in enumerate(zip(points, normals)):
        near = places[(np.abs(places[:, :2] - point[:2]) < 1.5 * radius).all(1)]
        way = near + (0, 0, radius) - point
        along = way @ normal
        inside = radius**2 - (way**2).sum(1) + along**2
        hit = inside >= 0
        enter = along[hit] - np.sqrt(inside[hit])
        up[number] = np.maximum(enter[along[hit] > 0], 0).min(initial=np.inf)
    return up

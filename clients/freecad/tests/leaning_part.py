"""What a program with five axes leaves of a part, told by OpenCASCADE and closed formulas: shares nothing with the sweep that made it."""

import math

import FreeCAD
import numpy as np
import Part
from swept_part import ball_gouge

SPACING_MM = 0.05
Vector = FreeCAD.Vector


class Poses:
    """Centres of the ball and axes, dense along all moves whose begin is known; `cut` where that is at feed along a pass."""

    def __init__(self, program, radius, spacing=SPACING_MM):
        self.radius, found, at = radius, [], None
        for move in program.moves:
            if hasattr(move, "curve"):
                found.append((_along(move.curve, spacing), move.curve.degree == 5))
                at = np.array(move.curve.points[-1])
            elif move.end is not None:
                end = np.array((*move.target.p, *move.target.axis))
                if at is not None:
                    share = np.linspace(0, 1, int(math.dist(at[:3], end[:3]) / spacing) + 12)[:, None]
                    found.append((at + share * (end - at), False))
                at = end
        poses = np.concatenate([one for one, _ in found])
        self.cut = np.concatenate([np.full(len(one), cut) for one, cut in found])
        self.axis = poses[:, 3:] / np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
        self.tip = poses[:, :3]
        self.centre = self.tip + radius * self.axis

    def ball_gouge(self, shape, every):
        return ball_gouge(shape, self.radius, self.centre[::every] - (0, 0, self.radius))

    def side_gouge(self, points, every):
        """How deep points of the part are in the cylinder above the ball at most."""
        deepest = -math.inf
        for centre, axis in zip(self.centre[::every], self.axis[::every]):
            way = points - centre
            up = way @ axis
            off = np.sqrt(np.maximum((way**2).sum(1) - up**2, 0))
            deepest = max(deepest, (self.radius - off[up > 0]).max(initial=-math.inf))
        return deepest

    def left_over(self, points, normals):
        """Above each point along its normal, up to where the ball that was somewhere first took it away."""
        centre = self.centre[self.cut]
        up = np.full(len(points), np.inf)
        for number, (point, normal) in enumerate(zip(points, normals)):
            way = centre[(np.abs(centre - point) < 1.2 * self.radius).all(1)] - point
            along = way @ normal
            inside = self.radius**2 - (way**2).sum(1) + along**2
            hit = inside >= 0
            up[number] = np.maximum(along[hit] - np.sqrt(inside[hit]), 0).min(initial=np.inf)
        return up

    def most_turn(self):
        """Degrees that the axis turns in a millimetre of the ball's way along passes at most."""
        both = self.cut[1:] & self.cut[:-1]
        way = np.linalg.norm(np.diff(self.centre, axis=0), axis=1)[both]
        turn = np.degrees(np.linalg.norm(np.diff(self.axis, axis=0), axis=1))[both]
        return (turn[way > 1e-3] / way[way > 1e-3]).max()


def _along(curve, spacing):
    knots = sorted(set(curve.knots))
    counts = [curve.knots.count(knot) for knot in knots]
    length = sum(math.dist(a[:3], b[:3]) for a, b in zip(curve.points, curve.points[1:]))
    found = []
    for part in (slice(0, 3), slice(3, 6)):
        spline = Part.BSplineCurve()
        spline.buildFromPolesMultsKnots([Vector(*p[part]) for p in curve.points], counts, knots, False, curve.degree)
        found.append([tuple(spline.value(float(t))) for t in np.linspace(knots[0], knots[-1], int(length / spacing) + 8)])
    return np.hstack(found)


def outward_points(shape, face, count, seed):
    """At random in the parameters of a face, with normals that lead out of the solid."""
    chance, found = np.random.default_rng(seed), []
    a, b, c, d = face.ParameterRange
    while len(found) < count:
        u, v = chance.uniform(a, b), chance.uniform(c, d)
        if face.isPartOfDomain(u, v):
            point, normal = face.valueAt(u, v), face.normalAt(u, v)
            if shape.isInside(point + normal * 1e-3, 1e-7, False):
                normal = -normal
            found.append((*point, *normal))
    found = np.array(found)
    return found[:, :3], found[:, 3:]


def cloud(shape, count, seed):
    """Points on all faces, edges among them."""
    chance, found = np.random.default_rng(seed), []
    for face in shape.Faces:
        a, b, c, d = face.ParameterRange
        for u, v in zip(chance.uniform(a, b, count), chance.uniform(c, d, count)):
            if face.isPartOfDomain(u, v):
                found.append(tuple(face.valueAt(u, v)))
    for edge in shape.Edges:
        if not edge.Degenerated:
            found += [tuple(point) for point in edge.discretize(Number=200)]
    return np.array(found)

"""What a leaning mill with a disc leaves of a part, told by OpenCASCADE's distances and by halving: shares nothing with the sweep."""

import math

import FreeCAD
import numpy as np
import Part
from leaning_part import Poses

Vector = FreeCAD.Vector
STARTS, APART = 4, 0.25  # places of the part that are nearest, so many radii apart
NEAR_MM = 0.1
ROUNDS = 8
HALVINGS = 24


class DiscPoses(Poses):
    def __init__(self, program, radius, corner, spacing=0.05):
        super().__init__(program, radius, spacing)
        self.corner, self.middle = corner, self.tip + corner * self.axis

    def gouge(self, shape, points, count, seed):
        """How deep the mill is in the part at most, of poses chosen at random, as many on passes as elsewhere; negative where it stays
        off. `points` of the part are where the nearest places are sought from."""
        chance = np.random.default_rng(seed)
        faces = Part.makeCompound(shape.Faces)
        chosen = np.concatenate([chance.choice(np.flatnonzero(which), count) for which in (self.cut, ~self.cut)])
        return max(self._gouge(shape, faces, points, self.middle[i], self.axis[i]) for i in chosen)

    def _gouge(self, shape, faces, points, middle, axis):
        away = self._outside(points - middle, axis)
        deepest, starts = -away.min(), []
        for i in np.argsort(away)[:400]:
            if away[i] > NEAR_MM or len(starts) == STARTS:
                break
            if all(math.dist(points[i], other) > APART * self.radius for other in starts):
                starts.append(points[i])
        for place in starts:
            for _ in range(ROUNDS):  # to and fro between the part and what is nearest to it of the mill's core
                inner = self._core(middle, axis, place)
                off, pairs, _ = faces.distToShape(Part.Vertex(inner))
                place = np.array(pairs[0][0])
            inside = away.min() < -self.corner / 2 and shape.isInside(inner, 1e-7, False)  # which is told of places outside, too, now and then
            deepest = max(deepest, self.corner + off if inside else self.corner - off)
        return deepest

    def _core(self, middle, axis, place):
        """The place of the disc, or of the cylinder upon it, that is nearest, a corner's radius inside of the mill."""
        way = place - middle
        up = way @ axis
        aside = way - up * axis
        return Vector(*(middle + max(up, 0) * axis + aside * min(1, (self.radius - self.corner) / max(np.linalg.norm(aside), 1e-12))))

    def _outside(self, way, axis):
        """Of the mill; no less than a corner's radius inside."""
        up = (way * axis).sum(-1)
        off = np.sqrt(np.maximum((way**2).sum(-1) - up**2, 0))
        return np.hypot(np.maximum(off - self.radius + self.corner, 0), np.minimum(up, 0)) - self.corner

    def left_over(self, points, normals, most):
        """Above each point along its normal, up to where the mill that was somewhere first took it away; infinite beyond the most."""
        middle, axis = self.middle[self.cut], self.axis[self.cut]
        up = np.full(len(points), np.inf)
        for number, (point, normal) in enumerate(zip(points, normals)):
            near = (np.abs(middle - point) < 1.05 * self.radius + most).all(1)
            way, along = point - middle[near], axis[near]
            if len(way):
                up[number] = self._entry(way, along, normal, most).min()
        return up

    def _entry(self, way, axis, normal, most):
        """By thirds to where it is deepest, for the mill is convex; by halves to where that begins."""

        def outside(up):
            return self._outside(way + up[:, None] * normal, axis)

        low, high = np.zeros(len(way)), np.full(len(way), most)
        for _ in range(HALVINGS):
            one, other = low + (high - low) / 3, high - (high - low) / 3
            falls = outside(one) > outside(other)
            low, high = np.where(falls, one, low), np.where(falls, high, other)
        out, inside = np.zeros(len(way)), (low + high) / 2
        taken, begins = outside(inside) <= 0, outside(out) <= 0
        for _ in range(HALVINGS):
            middle = (out + inside) / 2
            cut = outside(middle) <= 0
            out, inside = np.where(cut, out, middle), np.where(cut, middle, inside)
        return np.where(begins, 0, np.where(taken, inside, np.inf))

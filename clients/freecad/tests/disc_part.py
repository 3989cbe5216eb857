"""What a leaning mill with a disc leaves of a part, told by OpenCASCADE's distances and by halving: shares nothing with the sweep."""

import FreeCAD
import numpy as np
import Part
from leaning_part import Poses

Vector = FreeCAD.Vector
RIM = np.linspace(0, 2 * np.pi, 360, endpoint=False)
STARTS, APART = 4, 0.25  # places of the rim that are deepest by the points of the part, so many radii apart
NEAR_MM = 0.1
HALVINGS = 24
FINER = np.linspace(-1, 1, 33)  # between poses, twice: an edge that comes over a place leaves least of it as soon as it does


class Skin:
    """Points of a part with normals that lead out of it, chosen at random in the parameters of each face; and such of its edges, without."""

    def __init__(self, shape, count, seed):
        chance, found = np.random.default_rng(seed), []
        self.shape, self.faces = shape, Part.makeCompound(shape.Faces)
        for face in shape.Faces:
            a, b, c, d = face.ParameterRange
            places = [at for at in zip(chance.uniform(a, b, count), chance.uniform(c, d, count)) if face.isPartOfDomain(*at)]
            normal = face.normalAt(*places[0])
            sense = -1 if shape.isInside(face.valueAt(*places[0]) + 1e-3 * normal, 1e-7, False) else 1
            found += [(*face.valueAt(*at), *(sense * face.normalAt(*at))) for at in places]
        edges = [point for edge in shape.Edges if not edge.Degenerated for point in edge.discretize(Number=200)]
        self.points = np.array([*(one[:3] for one in found), *map(tuple, edges)])
        self.normals = np.array([one[3:] for one in found])

    def depth(self, place, height):
        """Of a place that is so high above what is near."""
        off = self.faces.distToShape(Part.Vertex(Vector(*place)))[0]
        return off if height < 0 and self.shape.isInside(Vector(*place), 1e-7, False) else -off


class DiscPoses(Poses):
    def __init__(self, program, radius, corner, spacing=0.05):
        super().__init__(program, radius, spacing)
        self.corner, self.middle = corner, self.tip + corner * self.axis

    def gouge(self, skin, count, seed):
        """How deep the mill is in the part at most, of poses chosen at random, as many on passes as elsewhere; negative where it stays
        off."""
        chance = np.random.default_rng(seed)
        chosen = np.concatenate([chance.choice(np.flatnonzero(which), count) for which in (self.cut, ~self.cut)])
        return max(max(-self._outside(skin.points - self.middle[i], self.axis[i]).min(), self._rim_depth(skin, self.middle[i], self.axis[i])) for i in chosen)

    def _rim_depth(self, skin, middle, axis):
        """Of the corner, by the circle in its middle: there the part may be nearest between its points."""
        aside = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
        aside /= np.linalg.norm(aside)
        rim = middle + (self.radius - self.corner) * (np.outer(np.cos(RIM), aside) + np.outer(np.sin(RIM), np.cross(axis, aside)))
        near = np.flatnonzero((np.abs(skin.points[: len(skin.normals)] - middle) < 1.2 * self.radius).all(1))
        if not len(near):
            return -NEAR_MM
        points = skin.points[near]
        nearest = near[((rim**2).sum(1)[:, None] - 2 * rim @ points.T + (points**2).sum(1)).argmin(1)]
        height = ((rim - skin.points[nearest]) * skin.normals[nearest]).sum(1)
        deepest, starts = -NEAR_MM, []
        for i in np.argsort(height):
            if height[i] > self.corner + NEAR_MM or len(starts) == STARTS:
                break
            if all(np.linalg.norm(rim[i] - other) > APART * self.radius for other in starts):
                starts.append(rim[i])
                deepest = max(deepest, self.corner + skin.depth(rim[i], height[i]))
        return deepest

    def _outside(self, way, axis):
        """Of the mill; negative inside."""
        up = (way * axis).sum(-1)
        off = np.sqrt(np.maximum((way**2).sum(-1) - up**2, 0))
        beyond = off - self.radius + self.corner
        return np.hypot(np.maximum(beyond, 0), np.minimum(up, 0)) + np.minimum(np.maximum(beyond, -up), 0) - self.corner

    def left_over(self, points, normals, most):
        """Above each point along its normal, up to where the mill that was somewhere first took it away; infinite beyond the most."""
        up = np.full(len(points), np.inf)
        for number, (point, normal) in enumerate(zip(points, normals)):
            near = np.flatnonzero(self.cut & (np.abs(self.middle - point) < 1.05 * self.radius + most).all(1))
            if len(near):
                found = self._entry(point - self.middle[near], self.axis[near], normal, most)
                up[number] = self._between(near[found.argmin()], point, normal, most) if np.isfinite(found.min()) else np.inf
        return up

    def _between(self, i, point, normal, most):
        """About a pose, where those before and behind it are of a pass, too."""
        sides = [i + way if self.cut[i + way] else i for way in (-1, 1)]
        share, width = np.zeros(1), 1.0
        for _ in range(2):
            shares = np.clip(share + width * FINER, -1, 1)
            middle, axis = (
                one[i] + np.maximum(shares, 0)[:, None] * (one[sides[1]] - one[i]) + np.maximum(-shares, 0)[:, None] * (one[sides[0]] - one[i])
                for one in (self.middle, self.axis)
            )
            found = self._entry(point - middle, axis, normal, most)
            share, width = shares[found.argmin()], width / 16
        return found.min()

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

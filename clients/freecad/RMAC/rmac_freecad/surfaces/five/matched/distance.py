"""How far a mill, with its disc and its side without an end, is from the part: exact from faces and edges that are near.

What is near is sought by the mill's core, which is the mill without the round of its corner: by the square of how far a place is from that.
However small the corner is, it has a gradient wherever the place is outside."""

import numpy as np

from rmac_freecad.surfaces.five.clearance import downhill, least_along
from rmac_freecad.surfaces.five.solid import outside, seen_along

NEAR = 1.5  # radii from the middle of the disc: so far the dense points are looked at
COARSE_MARGIN = 0.05  # radii that the side keeps off coarse points
TOLD_MM = 0.5  # what is farther away is told as that far
DEEP_MM = -1e-3  # what is deeper inside needs not be known exactly
CANDIDATES = 6  # places of one face or edge: a disc that fits may touch all along its rim
APART = 0.3  # radii
NEWTON, STILL = 12, 1e-9  # of a face, where a step changes nothing any more
LONGEST = 0.25  # step, in radii
UNEVEN = 0.3  # where the face bends as the mill does: a bowl's bend there, in that of the distance over the disc's radius


class Distance:
    def __init__(self, body):
        self._body, self._mill = body, body.mill
        self._ways, self._on_face = _ways(body), body.labels < len(body.faces)

    def __call__(self, tips, axes):
        """Of each pose; negative inside."""
        middles = tips + self._mill.corner_mm * axes
        found = np.full(len(tips), TOLD_MM)
        chosen = [(np.zeros(0, int), np.zeros(0, int))]
        for number, (middle, axis) in enumerate(zip(middles, axes)):
            if not np.isfinite(middle).all():
                found[number] = -np.inf
                continue
            found[number], places = self._nearest(middle, axis)
            chosen.append((np.full(len(places), number), places))
        rows, places = (np.concatenate(column) for column in zip(*chosen))
        labels, parameters = self._body.labels[places], self._body.parameters[places]
        for label in np.unique(labels):
            of = labels == label
            refined = self._from_face if label < len(self._body.faces) else self._from_edge
            np.minimum.at(found, rows[of], refined(label, parameters[of], middles[rows[of]], axes[rows[of]]))
        return found

    def _nearest(self, middle, axis):
        """How far the nearest point is, and the points from which a nearer place may be found."""
        body, reach = self._body, NEAR * self._mill.radius_mm
        near = body.near(middle - reach, middle + reach)
        away, hoped = self._hoped(near, middle, axis)
        least = min(away.min(initial=TOLD_MM), self._far(middle, axis, reach))
        if least < DEEP_MM:
            return least, np.zeros(0, int)
        bar = min(hoped.min(initial=TOLD_MM), least)
        hopeful = hoped < bar + self._gain(body.labels[near])
        near, hoped = near[hopeful], hoped[hopeful]
        chosen, apart = [], (APART * self._mill.radius_mm) ** 2
        for label in np.unique(body.labels[near]):
            of = np.flatnonzero(body.labels[near] == label)
            for _ in range(CANDIDATES):
                if not len(of):
                    break
                best = of[hoped[of].argmin()]
                chosen.append(near[best])
                of = of[((body.points[near[of]] - body.points[near[best]]) ** 2).sum(1) > apart]
        return least, np.array(chosen, int)

    def _hoped(self, near, middle, axis):
        """How far these points are, and how far the part is if it goes on straight from each up to where it is nearest, a step away at most."""
        ways, ahead = self._body.points[near] - middle, self._ways[near]
        off, up = seen_along(ways, axis)
        beyond, below = np.maximum(off - self._mill.flat_mm, 0), np.maximum(-up, 0)
        square = beyond**2 + below**2
        rise = ahead @ axis
        along = (beyond * ((ways * ahead).sum(1) - up * rise) / np.maximum(off, 1e-12) - below * rise) ** 2
        slip = np.where(self._on_face[near], square - along, along)
        hoped = np.sqrt(np.maximum(square - np.minimum(slip, self._body.step_of[self._body.labels[near]] ** 2), 0))
        return outside(self._mill, off, up), hoped - self._mill.corner_mm

    def _far(self, middle, axis, reach):
        """From coarse points, where dense ones are not looked at."""
        way = self._body.coarse - middle
        if (middle - reach >= self._body.low).all() and (middle + reach <= self._body.high).all():
            way = way[(np.abs(way) > reach).any(1)]
        margin = COARSE_MARGIN * self._mill.radius_mm
        return outside(self._mill, *seen_along(way, axis)).min(initial=np.inf) - margin

    def _gain(self, labels):
        """How much nearer or farther a place may be than was hoped: by the bend of the disc and that of the part."""
        return self._body.step_of[labels] ** 2 / self._mill.flat_mm + 8 * self._body.sag_of[labels] + 1e-6

    def _from_face(self, label, uv, middles, axes):
        """By Newton's method; infinite where the nearest place of the surface is none of the face."""
        face = self._body.faces[label]
        low, high = face.trim.low, face.trim.high
        at, found, left = uv.copy(), np.full(len(uv), np.inf), np.arange(len(uv))
        for _ in range(NEWTON):
            point, *ways = face.evaluate(at[left], 2)
            far, metric, *model = self._model(point - middles[left], axes[left], ways)
            better = np.flatnonzero(far < found[left])
            better = better[face.trim.inside(at[left[better]])]
            found[left[better]] = far[better]
            new = np.clip(at[left] + self._shortened(downhill(*model), metric), low, high)
            goes_on = (np.abs(new - at[left]) > STILL * (high - low)).any(1)
            at[left] = new
            left = left[goes_on]
            if not len(left):
                break
        if len(left):
            far = outside(self._mill, *seen_along(face.evaluate(at[left]) - middles[left], axes[left]))
            found[left] = np.minimum(found[left], np.where(face.trim.inside(at[left]), far, np.inf))
        return found

    def _shortened(self, steps, metric):
        square = metric[0] * steps[:, 0] ** 2 + 2 * metric[1] * steps[:, 0] * steps[:, 1] + metric[2] * steps[:, 1] ** 2
        return steps * np.minimum(1, LONGEST * self._mill.radius_mm / np.sqrt(np.maximum(square, 1e-300)))[:, None]

    def _model(self, way, axes, ways):
        """Distances and the face's metric; and of half the square of the distance from the core, along u and v, gradients, second
        derivatives, and such as lead downhill wherever one begins."""
        u, v, uu, uv, vv = ways
        off, up = seen_along(way, axes)
        outward = (way - up[:, None] * axes) / np.maximum(off, 1e-12)[:, None]
        beyond, below = np.maximum(off - self._mill.flat_mm, 0)[:, None], np.maximum(-up, 0)[:, None]
        gradient = beyond * outward - below * axes
        turns = (beyond > 0) * outward, (below > 0) * axes, np.sqrt(beyond / np.maximum(off, 1e-12)[:, None]) * np.cross(axes, outward)
        pairs = (u, u, uu), (u, v, uv), (v, v, vv)
        metric = [(a * b).sum(1) for a, b, _ in pairs]
        straight = [sum((turn * a).sum(1) * (turn * b).sum(1) for turn in turns) for a, b, _ in pairs]
        bent = [first + (gradient * second).sum(1) for first, (_, _, second) in zip(straight, pairs)]
        even = UNEVEN * np.sqrt((gradient**2).sum(1)) / self._mill.flat_mm
        flat = [first + even * own for first, own in zip(straight, metric)]
        return outside(self._mill, off, up), metric, np.stack([(gradient * u).sum(1), (gradient * v).sum(1)], 1), bent, flat

    def _from_edge(self, label, t, middles, axes):
        def far(points):
            return outside(self._mill, *seen_along(points - middles[:, None], axes[:, None]))

        return least_along(self._body.edges[label - len(self._body.faces)], t[:, 0], far)


def _ways(body):
    """At the points of the cloud: normals of faces, whichever way they lead, and directions of edges."""
    found = np.zeros_like(body.points)
    for label in np.unique(body.labels):
        of = np.flatnonzero(body.labels == label)
        if label < len(body.faces):
            _, u, v = body.faces[label].evaluate(body.parameters[of], 1)
            found[of] = np.cross(u, v)
        else:
            curve, t = body.edges[label - len(body.faces)], body.parameters[of, 0]
            step = curve.interval / 100
            found[of] = curve(np.minimum(t + step, curve.last)) - curve(np.maximum(t - step, curve.first))
    return found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-30)

"""How far a mill, with its disc and its side without an end, is from the part: exact from faces and edges that are near."""

import numpy as np

from rmac_freecad.surfaces.five.clearance import downhill, least_along
from rmac_freecad.surfaces.five.solid import outside, seen_along, slopes

NEAR = 1.5  # radii from the middle of the disc: so far the dense points are looked at
COARSE_MARGIN = 0.05  # radii that the side keeps off coarse points
TOLD_MM = 0.5  # what is farther away is told as that far
CANDIDATES = 3  # places of one face or edge: a disc that fits may touch with its front, its back and beside
APART = 4.0  # steps of the cloud
NEWTON = 8


class Distance:
    def __init__(self, body):
        self._body, self._mill = body, body.mill

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
        away = outside(self._mill, *seen_along(body.points[near] - middle, axis))
        least = min(away.min(initial=TOLD_MM), self._far(middle, axis, reach))
        hopeful = away < least + self._gain(body.labels[near])
        near, away = near[hopeful], away[hopeful]
        chosen = []
        for label in np.unique(body.labels[near]):
            of = np.flatnonzero(body.labels[near] == label)
            for _ in range(CANDIDATES):
                if not len(of):
                    break
                best = of[away[of].argmin()]
                chosen.append(near[best])
                off = ((body.points[near[of]] - body.points[near[best]]) ** 2).sum(1)
                of = of[off > (APART * body.step_of[label]) ** 2]
        return least, np.array(chosen, int)

    def _far(self, middle, axis, reach):
        """From coarse points, where dense ones are not looked at."""
        way = self._body.coarse - middle
        if (middle - reach >= self._body.low).all() and (middle + reach <= self._body.high).all():
            way = way[(np.abs(way) > reach).any(1)]
        margin = COARSE_MARGIN * self._mill.radius_mm
        return outside(self._mill, *seen_along(way, axis)).min(initial=np.inf) - margin

    def _gain(self, labels):
        """How much nearer the part may be than the nearest point of the cloud."""
        return 1.5 * self._body.step_of[labels] ** 2 / self._mill.corner_mm + 2 * self._body.sag_of[labels] + 1e-6

    def _from_face(self, label, uv, middles, axes):
        """By Newton's method; infinite where the nearest place of the surface is none of the face."""
        face = self._body.faces[label]
        low, high = face.trim.low, face.trim.high
        most, at, found = (high - low) / 10, uv.copy(), np.full(len(uv), np.inf)
        for _ in range(NEWTON):
            point, *ways = face.evaluate(at, 2)
            far, *model = self._model(point - middles, axes, ways)
            found = np.minimum(found, np.where(face.trim.inside(at), far, np.inf))
            at = np.clip(at + np.clip(downhill(*model), -most, most), low, high)
        far = outside(self._mill, *seen_along(face.evaluate(at) - middles, axes))
        return np.minimum(found, np.where(face.trim.inside(at), far, np.inf))

    def _model(self, way, axes, ways):
        """Distances; and along u and v their gradients, their second derivatives, and such as lead downhill wherever one begins."""
        u, v, uu, uv, vv = ways
        off, up = seen_along(way, axes)
        far = outside(self._mill, off, up)
        away, along = slopes(self._mill, off, up)
        outward = (way - up[:, None] * axes) / np.maximum(off, 1e-12)[:, None]
        gradient = away[:, None] * outward + along[:, None] * axes
        aside = np.where(away != 0, away / np.maximum(off, 1e-12), 0)[:, None] ** 0.5 * np.cross(axes, outward)
        rounded = np.where((away != 0) & (along != 0), 1 / np.maximum(far + self._mill.corner_mm, 1e-9), 0)[:, None] ** 0.5 * (
            away[:, None] * axes - along[:, None] * outward
        )
        bent = [
            sum((turn * a).sum(1) * (turn * b).sum(1) for turn in (aside, rounded)) + (gradient * second).sum(1)
            for a, b, second in ((u, u, uu), (u, v, uv), (v, v, vv))
        ]
        flat = [(a * b).sum(1) / self._mill.corner_mm for a, b in ((u, u), (u, v), (v, v))]
        return far, np.stack([(gradient * u).sum(1), (gradient * v).sum(1)], 1), bent, flat

    def _from_edge(self, label, t, middles, axes):
        def far(points):
            return outside(self._mill, *seen_along(points - middles[:, None], axes[:, None]))

        return least_along(self._body.edges[label - len(self._body.faces)], t[:, 0], far)

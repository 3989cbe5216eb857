"""Families of lines of contact on faces: along a face's own parameters, or where the centre of the corner's ball stays in upright planes. w tells
the pass."""

import math

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces import bspline
from rmac_freecad.surfaces.five.contours import Contours
from rmac_freecad.surfaces.five.track import Track

INSET_MM = 1e-3  # the outermost passes touch the face this far from its border
GRID = 6  # places a detail of the mill, from which lines in planes are sought
MOST_GRID = 400
NEWTON = 4
ON_PLANE_MM = 1e-10
SPANS = 2  # a radius, of the line's spline in (u, v)


class _Family:
    def __init__(self, body, targets, steepest, over_mm):
        self.targets, self._body, self._corner = targets, body, body.mill.corner_mm
        self._least = -2.0 if steepest is None else math.cos(steepest)
        self._over = over_mm

    def gentle(self, normal):
        return normal[:, 2] >= self._least

    def face(self, label):
        return self._body.faces[label]

    def touch(self, label, uv):
        """Points, normals and where the ball's centre is then."""
        point, normal, _, _ = self._body.outward(label, uv)
        return point, normal, point + self._corner * normal


class Isolines(_Family):
    """Along u (axis 0) or v (axis 1) of one face."""

    def __init__(self, body, label, axis, steepest, over_mm):
        super().__init__(body, [label], steepest, over_mm)
        self._axis = axis
        self._trim = body.faces[label].trim
        uv = body.of_target(label)
        gentle = self.gentle(body.outward(label, uv)[1])
        if not gentle.any():
            raise JobRefused("the face has no place that is less steep than what is to be cut")
        slopes = np.linalg.norm(body.faces[label].evaluate(uv, 1)[2 - axis], axis=1)
        self.w_mm = max(slopes.max(), 1e-12)
        inset = INSET_MM / self.w_mm
        self.w_range = self._trim.low[1 - axis] + inset, self._trim.high[1 - axis] - inset

    def places(self, uv, centre):
        """w of the pass that touches the face there."""
        return uv[:, 1 - self._axis]

    def tracks(self, w):
        def contact(t):
            uv = np.column_stack([t, np.full(len(t), w)] if self._axis == 0 else [np.full(len(t), w), t])
            point, normal, along, turns = self._body.outward(self.targets[0], uv)
            inside = self._trim.inside(uv) & self.gentle(normal)
            feed = _unit(along[self._axis] + self._corner * turns[self._axis])
            return point, normal, feed, inside, _bend(normal, along, turns, feed)

        return [Track(self.targets[0], contact, self._trim.low[self._axis], self._trim.high[self._axis], self._body.mill, self._over)]


class Planes(_Family):
    """In upright planes, the angle is that from X, or in level ones; all targets together."""

    def __init__(self, body, targets, angle, steepest, over_mm):
        super().__init__(body, targets, steepest, over_mm)
        level = angle == "level"
        self._along = None if level else np.array([math.cos(angle), math.sin(angle), 0.02])  # where planes stand across a wall, upward
        self._across = np.array([0.0, 0.0, 1.0] if level else [-math.sin(angle), math.cos(angle), 0.0])
        self._grids = {label: self._grid(label) for label in targets}
        self.w_mm = 1.0
        found = []
        for label in targets:
            rim = np.concatenate(body.faces[label].trim.loops)
            for uv in (body.of_target(label), rim):
                _, normal, centre = self.touch(label, uv)
                found.append(centre[self.gentle(normal) & np.isfinite(centre).all(1)] @ self._across)
        found = np.concatenate(found)
        if not len(found):
            raise JobRefused("the faces have no place that is less steep than what is to be cut")
        if np.ptp(found) < 4 * INSET_MM:
            raise JobRefused("the faces stand along the planes of the passes; give another direction, or 'u', 'v' or 'level'")
        self.w_range = found.min() + INSET_MM, found.max() - INSET_MM

    def _grid(self, label):
        trim = self._body.faces[label].trim
        rough = self._values(label, *(np.linspace(a, b, 25) for a, b in zip(trim.low, trim.high)))[1]
        lengths = [np.nanmax(np.nansum(np.linalg.norm(np.diff(rough, axis=k), axis=2), k)) for k in (0, 1)]
        counts = [int(np.clip(length / self._body.mill.detail_mm * GRID, 24, MOST_GRID)) + 1 for length in lengths]
        u, v = (np.linspace(a, b, n) for a, b, n in zip(trim.low, trim.high, counts))
        return Contours(u, v, self._values(label, u, v)[0])

    def _values(self, label, u, v):
        uv = np.stack(np.meshgrid(u, v, indexing="ij"), 2)
        centre = self.touch(label, uv.reshape(-1, 2))[2].reshape(*uv.shape[:2], 3)
        return centre @ self._across, centre

    def places(self, uv, centre):
        return centre @ self._across

    def tracks(self, w):
        return [self._track(label, line, w) for label in self.targets for line in self._grids[label].at(w)]

    def _track(self, label, line, w):
        """The line is made smooth first: its places come from a grid, at uneven distances."""
        line = self._on_plane(label, line, w)
        centres = self.touch(label, line)[2]
        far = np.concatenate([[0], np.cumsum(np.nan_to_num(np.linalg.norm(np.diff(centres, axis=0), axis=1)) + 1e-9)])
        if np.nansum(np.diff(centres, axis=0) * self._ahead(label, line)) < 0:
            line, centres, far = line[::-1], centres[::-1], far[-1] - far[::-1]
        spans = max(int(far[-1] / self._body.mill.radius_mm * SPANS), 1)
        even = np.linspace(0, far[-1], 3 * spans + 4)
        line = self._on_plane(label, np.column_stack([np.interp(even, far, line[:, k]) for k in (0, 1)]), w)
        knots = bspline.clamped(np.linspace(0, far[-1], spans + 1), 5)
        poles = bspline.fitted(knots, 5, even, line)
        ahead = self._feed(label, line)[:-1] * np.diff(self.touch(label, line)[2], axis=0)
        sense = -1.0 if np.nansum(ahead) < 0 else 1.0

        def contact(t):
            uv = self._on_plane(label, bspline.value(knots, 5, poles, t), w)
            point, normal, along, turns = self._body.outward(label, uv)
            feed = sense * self._feed(label, uv)
            return point, normal, feed, self.face(label).trim.inside(uv) & self.gentle(normal), _bend(normal, along, turns, feed)

        return Track(label, contact, 0.0, far[-1], self._body.mill, self._over)

    def _ahead(self, label, line):
        """Where passes go: in level planes about Z, counter-clockwise round what stands upright."""
        return self._along if self._along is not None else np.cross([0, 0, 1], self.touch(label, line[:-1])[1])

    def _feed(self, label, uv):
        _, _, ways, slope = self._sloped(label, uv)
        return _unit(slope[:, :1] * ways[1] - slope[:, 1:] * ways[0])

    def _on_plane(self, label, uv, w):
        """The nearest places, by Newton's method."""
        trim = self.face(label).trim
        size = trim.high - trim.low
        for _ in range(NEWTON):
            point, normal, _, slope = self._sloped(label, uv)
            off = (point + self._corner * normal) @ self._across - w
            if not (np.abs(off) > ON_PLANE_MM).any():
                break
            scaled = slope * size
            uv = uv - np.nan_to_num(off[:, None] * scaled * size / np.maximum((scaled**2).sum(1, keepdims=True), 1e-30))
            uv = np.clip(uv, trim.low, trim.high)
        return uv

    def _sloped(self, label, uv):
        """With how the ball's centre goes along u and v, and how far off the plane that leads."""
        point, normal, along, turns = self._body.outward(label, uv)
        ways = [one + self._corner * turn for one, turn in zip(along, turns)]
        return point, normal, ways, np.column_stack([way @ self._across for way in ways])


def _bend(normal, along, turns, feed):
    """How far a face bends toward the mill, 1/mm: along the feed, along and across it, across it."""
    metric = [(along[i] * along[j]).sum(1) for i, j in ((0, 0), (0, 1), (1, 1))]
    shape = [-((turns[i] * along[j]).sum(1) + (turns[j] * along[i]).sum(1)) / 2 for i, j in ((0, 0), (0, 1), (1, 1))]
    with np.errstate(divide="ignore", invalid="ignore"):
        area = metric[0] * metric[2] - metric[1] ** 2
        ways = []
        for way in (feed, np.cross(normal, feed)):
            u, v = ((one * way).sum(1) for one in along)
            ways.append(((metric[2] * u - metric[1] * v) / area, (metric[0] * v - metric[1] * u) / area))
        return np.column_stack(
            [shape[0] * a[0] * b[0] + shape[1] * (a[0] * b[1] + a[1] * b[0]) + shape[2] * a[1] * b[1] for a, b in ((ways[0],) * 2, ways, (ways[1],) * 2)]
        )


def _unit(vectors):
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-30)

"""The part as the sweep sees it: exact faces and edges, and a cloud of points on them from which contacts are sought."""

import math

import numpy as np

from rmac_freecad.surfaces.bspline import Curve, Surface
from rmac_freecad.surfaces.trim import Trim

SPACING = 10  # points a radius of the mill
MOST_POINTS = 200_000  # of the cloud of a face
SAG_MM = 2e-4  # of an edge between points
CELLS = 4  # of the cloud's grid, a radius of the mill


class Face:
    def __init__(self, face):
        spline = face.Surface.copy()
        for periodic, end in ((spline.isUPeriodic(), spline.setUNotPeriodic), (spline.isVPeriodic(), spline.setVNotPeriodic)):
            if periodic:
                end()
        self.closed = spline.isUClosed() or spline.isVClosed()
        self.surface = Surface(spline)
        self.trim = Trim(face)
        self.turn = self._turn(face)

    def _turn(self, face):
        """Periods: a face may reach over the seam of its surface."""
        return [self.surface.knots[k][-1] - self.surface.knots[k][0] if closed else 0.0
                for k, closed in enumerate((face.Surface.isUPeriodic(), face.Surface.isVPeriodic()))]  # fmt: skip

    def evaluate(self, uv, order=0):
        return self.surface(self._wrapped(uv), order)

    def _wrapped(self, uv):
        uv = uv.copy()
        for k, turn in enumerate(self.turn):
            low, high = self.surface.knots[k][0], self.surface.knots[k][-1]
            if turn:
                off = (uv[:, k] < low) | (uv[:, k] > high)
                uv[off, k] = low + np.mod(uv[off, k] - low, turn)
            else:
                uv[:, k] = np.clip(uv[:, k], low, high)
        return uv

    def grid(self, spacing):
        """Parameters as far apart as `spacing`, at least some a knot interval; their distance in mm, and how far the surface bends away from the
        chord between them."""
        low, high = self.trim.low, self.trim.high
        coarse = [np.linspace(a, b, 25) for a, b in zip(low, high)]
        u, v = np.meshgrid(*coarse, indexing="ij")
        points = self.evaluate(np.column_stack([u.ravel(), v.ravel()])).reshape(25, 25, 3)
        lengths = [np.linalg.norm(np.diff(points, axis=k), axis=2).sum(k).max() for k in (0, 1)]
        spacing = max(spacing, math.sqrt(lengths[0] * lengths[1] / MOST_POINTS))
        inside = [np.sum((knots > a) & (knots < b)) for knots, a, b in zip(self.surface.knots, low, high)]
        counts = [int(max(length / spacing, 4 * (more + 1), 6)) + 1 for length, more in zip(lengths, inside)]
        u, v = np.meshgrid(*(np.linspace(a, b, n) for a, b, n in zip(low, high, counts)), indexing="ij")
        uv = np.column_stack([u.ravel(), v.ravel()])
        self.interval = (high - low) / (np.array(counts) - 1)
        bends = [np.linalg.norm(np.diff(points, 2, axis=k), axis=2).max() / 8 * (24 / (count - 1)) ** 2 for k, count in enumerate(counts)]
        return uv[self.trim.inside(uv)], max(length / (count - 1) for length, count in zip(lengths, counts)), sum(bends)


class Part:
    """`targets` are indices of faces. Of the others what the mill cannot come near is left out."""

    def __init__(self, shape, targets, radius_mm):
        exact = shape.toNurbs()
        self.faces = [Face(face) for face in exact.Faces]
        self.targets = targets
        self.edges, self.faces_of = edges_of(exact)
        self.radius_mm = radius_mm
        self.top = shape.BoundBox.ZMax
        self._sample(radius_mm / SPACING)

    @property
    def inner(self):
        """Labels of what is touched within the faces that are to be cut: themselves, and the edges between them."""
        edges = [self.owner(i) for i, faces in enumerate(self.faces_of) if len(faces) > 1 and set(faces) <= set(self.targets)]
        return np.array([*self.targets, *edges])

    def owner(self, edge):
        """Faces have the first numbers, edges those behind them."""
        return len(self.faces) + edge

    def of_target(self, label):
        return self.points[self.labels == label], self.parameters[self.labels == label]

    def _sample(self, spacing):
        clouds, self.step_of = [], []
        order = [*self.targets, *(i for i in range(len(self.faces)) if i not in self.targets)]
        steps, sags = {}, {}
        for label in order:
            uv, steps[label], sags[label] = self.faces[label].grid(spacing)
            clouds.append((self.faces[label].evaluate(uv), np.full(len(uv), label), uv))
            if label == self.targets[-1]:
                self._bound([points for points, _, _ in clouds])
        for number, curve in enumerate(self.edges):
            t, step, sag = points_along(curve, spacing / 2)
            curve.interval = t[1] - t[0]
            steps[self.owner(number)], sags[self.owner(number)] = step, sag
            clouds.append((curve(t), np.full(len(t), self.owner(number)), np.column_stack([t, t])))
        self.step_of, self.sag_of = (np.array([of[label] for label in range(len(of))]) for of in (steps, sags))
        points, labels, parameters = (np.concatenate(column) for column in zip(*clouds))
        near = (points[:, 2] >= self.floor) & (points[:, :2] >= self.low).all(1) & (points[:, :2] <= self.high).all(1)
        self._index(points[near], labels[near], parameters[near])

    def _bound(self, clouds):
        """The tip goes no lower than a radius below the lowest that is to be cut, nor further aside than over its rim."""
        points = np.concatenate(clouds)
        self.floor = points[:, 2].min() - self.radius_mm - 0.1
        self.low, self.high = points[:, :2].min(0) - 4 * self.radius_mm, points[:, :2].max(0) + 4 * self.radius_mm

    def _index(self, points, labels, parameters):
        self._cell = self.radius_mm / CELLS
        cells = np.floor((points[:, :2] - self.low) / self._cell).astype(int)
        self._columns = int((self.high[0] - self.low[0]) / self._cell) + 1
        key = cells[:, 1] * self._columns + cells[:, 0]
        order = np.argsort(key, kind="stable")
        self.points, self.labels, self.parameters, self._key = points[order], labels[order], parameters[order], key[order]

    def near(self, low, high):
        """Indices of the cloud's points in a rectangle and somewhat round it."""
        a, b = (np.floor((np.asarray(x) - self.low) / self._cell).astype(int) for x in (low, high))
        rows = np.arange(max(a[1], 0), b[1] + 1)
        left, right = max(a[0], 0), min(b[0], self._columns - 1)
        begin = np.searchsorted(self._key, rows * self._columns + left)
        end = np.searchsorted(self._key, rows * self._columns + right, side="right")
        parts = [np.arange(x, y) for x, y in zip(begin, end) if y > x]
        return np.concatenate(parts) if parts else np.zeros(0, int)


def edges_of(exact):
    curves, faces_of, known = [], [], {}
    for number, face in enumerate(exact.Faces):
        for edge in face.Edges:
            if edge.Degenerated:
                continue
            same = known.setdefault(edge.hashCode(), [])
            index = next((i for other, i in same if other.isSame(edge)), None)
            if index is None:
                index = len(curves)
                same.append((edge, index))
                spline = edge.Curve.copy()
                if spline.isPeriodic():
                    spline.setNotPeriodic()
                curves.append(Curve(spline, *edge.ParameterRange))
                faces_of.append([])
            faces_of[index].append(number)  # a seam has its face twice
    return curves, faces_of


def points_along(curve, spacing):
    t = np.linspace(curve.first, curve.last, 60)
    length = np.linalg.norm(np.diff(curve(t), axis=0), axis=1).sum()
    count = max(length / spacing, 8 * len(np.unique(curve.knots)), 16)
    for _ in range(2):  # a wall nearer than that to the mill's side would be between two points
        t = np.linspace(curve.first, curve.last, int(min(count, 20_000)) + 1)
        sag = np.linalg.norm(np.diff(curve(t), 2, axis=0), axis=1).max() / 8
        count *= max(math.sqrt(sag / SAG_MM), 1)
    return t, length / (len(t) - 1), sag

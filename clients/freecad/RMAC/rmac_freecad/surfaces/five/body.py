"""The part as a tool meets it from any side: exact faces and edges, points of them near what is cut, and fewer of them everywhere."""

import FreeCAD
import numpy as np

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.drop import upward
from rmac_freecad.surfaces.part import SPACING, Face, edges_of, points_along

DISC_SPACING = 5  # points of a disc's detail: they are many, and only where Newton's method begins
AROUND = 4  # radii round what is cut, where points are dense: more than a pass goes beyond its face and the side is looked at closely
COARSE = 0.3  # radii between points elsewhere
CELLS = 2  # of the grid, a radius
ASIDE_MM = 1e-3  # of a face, where its material is looked for
POLE = 1e-6  # of a face's size, below which a place has no normal
LOOKED_AT = 7  # places of a face


class Body:
    """`targets` are indices of faces. Its points are as dense as what the mill follows along the faces wants them."""

    def __init__(self, shape, targets, mill):
        exact = shape.toNurbs()
        self.faces = [Face(face) for face in exact.Faces]
        self.edges, _ = edges_of(exact)
        self.targets, self.mill = targets, mill
        self.top = shape.BoundBox
        self._sides = {label: _side(shape, exact.Faces[label], self.faces[label], label) for label in targets}
        self._sizes = {label: _size(self.faces[label]) for label in targets}
        self._sample(mill.detail_mm / (DISC_SPACING if mill.flat_mm else SPACING))

    def outward(self, label, uv):
        """Points, normals that point away from the material, and the derivatives of both along u and v; nan at poles."""
        point, normal, along, turns = upward(self.faces[label], uv)
        across = np.cross(*along)
        turn = np.where(across[:, 2:] < 0, -1, 1) * self._sides[label]
        turn = np.where(np.linalg.norm(across, axis=1, keepdims=True) < POLE * self._sizes[label], np.nan, turn)
        return point, normal * turn, along, [one * turn for one in turns]

    def _sample(self, spacing):
        clouds, steps, sags = [], [], []
        for label, face in enumerate(self.faces):
            uv, step, sag = face.grid(spacing)
            clouds.append((face.evaluate(uv), np.full(len(uv), label), uv))
            steps.append(step), sags.append(sag)
        for number, curve in enumerate(self.edges, len(self.faces)):
            t, step, sag = points_along(curve, spacing / 2)
            curve.interval = t[1] - t[0]
            clouds.append((curve(t), np.full(len(t), number), np.column_stack([t, t])))
            steps.append(step), sags.append(sag)
        points, labels, parameters = (np.concatenate(column) for column in zip(*clouds))
        self.step_of, self.sag_of = np.array(steps), np.array(sags)
        cut = points[np.isin(labels, self.targets)]
        self.low, self.high = cut.min(0) - AROUND * self.mill.radius_mm, cut.max(0) + AROUND * self.mill.radius_mm
        near = ((points >= self.low) & (points <= self.high)).all(1)
        self._index(points[near], labels[near], parameters[near])
        self.coarse = self._thinned(points, labels)

    def _thinned(self, points, labels):
        """Faces and edges each by themselves: what is nearest to an edge is none of a face's points."""
        faces = labels < len(self.faces)
        cells = np.floor(points[faces] / (COARSE * self.mill.radius_mm)).astype(int)
        on_faces = points[faces][np.unique(cells, axis=0, return_index=True)[1]]
        on_edges = []
        for number in range(len(self.faces), len(self.faces) + len(self.edges)):
            of = points[labels == number]
            every = max(int(COARSE * self.mill.radius_mm / max(self.step_of[number], 1e-9)), 1)
            on_edges += [of[::every], of[-1:]]
        return np.concatenate([on_faces, *on_edges])

    def of_target(self, label):
        return self.parameters[self.labels == label]

    def _index(self, points, labels, parameters):
        self._cell = self.mill.radius_mm / CELLS
        cells = np.floor((points - self.low) / self._cell).astype(int)
        self._counts = np.floor((self.high - self.low) / self._cell).astype(int) + 1
        key = (cells[:, 0] * self._counts[1] + cells[:, 1]) * self._counts[2] + cells[:, 2]
        order = np.argsort(key, kind="stable")
        self.points, self.labels, self.parameters, self._key = points[order], labels[order], parameters[order], key[order]

    def near(self, low, high):
        """Indices of the points in a box and somewhat round it."""
        a, b = (np.floor((x - self.low) / self._cell).astype(int) for x in (low, high))
        a, b = np.maximum(a, 0), np.minimum(b, self._counts - 1)
        if (a > b).any():
            return np.zeros(0, int)
        rows = (np.add.outer(np.arange(a[0], b[0] + 1) * self._counts[1], np.arange(a[1], b[1] + 1)) * self._counts[2]).ravel()
        begin = np.searchsorted(self._key, rows + a[2])
        end = np.searchsorted(self._key, rows + b[2], side="right")
        parts = [np.arange(x, y) for x, y in zip(begin, end) if y > x]
        return np.concatenate(parts) if parts else np.zeros(0, int)


def _size(face):
    """Square millimetres a unit of u and v."""
    uv = face.trim.low + (face.trim.high - face.trim.low) * np.random.default_rng(1).uniform(size=(100, 2))
    return np.linalg.norm(np.cross(*face.evaluate(uv, 1)[1:]), axis=1).max()


def _side(shape, exact, face, label):
    """1 where the surface's own normal leads away from the material, else -1."""
    chance = np.random.default_rng(1)
    uv = face.trim.low + (face.trim.high - face.trim.low) * chance.uniform(size=(400, 2))
    uv = uv[face.trim.inside(uv)][:LOOKED_AT]
    if not len(uv):
        return 1
    point, along_u, along_v = face.evaluate(uv, 1)
    normal = np.cross(along_u, along_v)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-30)
    told = sum(1 if FreeCAD.Vector(*n).dot(exact.normalAt(*map(float, at))) > 0 else -1 for n, at in zip(normal, uv))
    solids = [(one, one.isInside(one.BoundBox.Center + FreeCAD.Vector(0, 0, 2 * one.BoundBox.DiagonalLength + 1), 1e-7, False)) for one in shape.Solids]
    ahead, behind = (
        sum(any(one.isInside(FreeCAD.Vector(*at), 1e-7, False) != inverted for one, inverted in solids) for at in point + way * ASIDE_MM * normal)
        for way in (1, -1)
    )
    if ahead and behind and min(ahead, behind) * 2 > len(uv):
        raise JobRefused(f"Face{label + 1} has material on both of its sides; sweep a face that the mill gets to")
    return (1 if behind > ahead else -1) if ahead != behind else (1 if told >= 0 else -1)

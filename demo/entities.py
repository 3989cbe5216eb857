"""The geometry that a program (.rmac) sends, and exact distances of points from it. Part frame, mm."""

import dataclasses
import json

import numpy as np
from scipy.spatial import cKDTree

import nurbs


class Line:
    def __init__(self, start, end):
        self.start, self.end = np.asarray(start, float), np.asarray(end, float)
        self.length_mm = float(np.linalg.norm(self.end - self.start))

    def closest(self, points):
        """(distance, arc length of the foot) of each point."""
        along = (self.end - self.start) / max(self.length_mm, 1e-300)
        s = np.clip((points - self.start) @ along, 0, self.length_mm)
        return np.linalg.norm(points - self.start - s[:, None] * along, axis=1), s


class Arc:
    """Circular arc about an axis through the centre: rotation +1 counter-clockwise about the axis, -1 clockwise."""

    def __init__(self, centre, axis, rotation, closed, start, end):
        self.start, self.end = np.asarray(start, float), np.asarray(end, float)
        self.centre = np.asarray(centre, float)
        self.normal = np.asarray(axis, float) / np.linalg.norm(axis)
        spoke = self.start - self.centre
        self.centre = self.centre + self.normal * (spoke @ self.normal)
        spoke = self.start - self.centre
        self.radius = float(np.linalg.norm(spoke))
        self.first = spoke / self.radius
        self.second = rotation * np.cross(self.normal, self.first)
        self.turn = 2 * np.pi if closed else self._angle(self.end[None, :])[0] or 2 * np.pi
        self.length_mm = self.turn * self.radius

    def _angle(self, points):
        spoke = points - self.centre
        return np.arctan2(spoke @ self.second, spoke @ self.first) % (2 * np.pi)

    def closest(self, points):
        angle = self._angle(points)
        beyond = angle > self.turn
        angle[beyond] = np.where(angle[beyond] - self.turn < 2 * np.pi - angle[beyond], self.turn, 0)
        foot = self.centre + self.radius * (
            np.cos(angle)[:, None] * self.first + np.sin(angle)[:, None] * self.second
        )
        return np.linalg.norm(points - foot, axis=1), angle * self.radius


class Spline:
    SAMPLES = 2000

    def __init__(self, curve):
        self.curve = curve
        self.t = np.linspace(*curve.domain, self.SAMPLES)
        self.samples = curve(self.t)
        self.start, self.end = self.samples[0], self.samples[-1]
        self.s = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(self.samples, axis=0), axis=1))])
        self.length_mm = float(self.s[-1])
        self.tree = cKDTree(self.samples)

    def closest(self, points):
        """Newton's method on (C(t) - p) . C'(t) = 0, from the nearest of many samples."""
        t = self.t[self.tree.query(points)[1]]
        for _ in range(4):
            p, d1, d2 = self.curve.evaluate(t, 2)
            gap = p - points
            slope = np.einsum("nd,nd->n", gap, d1)
            bend = np.einsum("nd,nd->n", d1, d1) + np.einsum("nd,nd->n", gap, d2)
            t = np.clip(t - slope / np.where(bend > 0, bend, np.inf), *self.curve.domain)
        return np.linalg.norm(self.curve(t) - points, axis=1), np.interp(t, self.t, self.s)


@dataclasses.dataclass
class Move:
    id: int
    method: str
    shape: object
    feed_mm_min: float


@dataclasses.dataclass
class Program:
    mechanism: str
    part_origin_mm: np.ndarray
    moves: list


def read_program(path, start=None):
    """Moves of a program in order. `start` is the tip where it begins, for a first move that names only its target."""
    mechanism, origin, feed, end, moves = None, np.zeros(3), None, start, []
    with open(path, encoding="utf-8") as file:
        for request in map(json.loads, file):
            method, parameters = request["method"].split(".")[-1], request.get("params", {})
            if method == "Load":
                mechanism = parameters["Name"]
            elif method == "SetPartFrame":
                part_frame = parameters["PartFrame"]
                origin = np.asarray(part_frame["p"], float)
                if not np.allclose(np.abs(part_frame["q"]), [1, 0, 0, 0], atol=0, rtol=0):
                    raise ValueError(f"{path}: these checks need a part frame parallel to the machine's")
            elif method == "SetFeedrate":
                feed = parameters["Feedrate"]
            elif method.startswith("Move"):
                shape = make_shape(method, parameters, end)
                moves.append(Move(parameters["MoveID"], method, shape, feed))
                end = shape.end
    return Program(mechanism, origin, moves)


def make_shape(method, parameters, end):
    if method == "MoveAlongNurbs":
        return Spline(nurbs.Curve.from_wire(parameters["Nurbs"]))
    if method == "MoveAlongLine":
        return Line(parameters["StartPoint"]["p"], parameters["EndPoint"]["p"])
    if method == "MoveToPathTarget":
        return Line(parameters["TargetFrame"]["p"] if end is None else end, parameters["TargetFrame"]["p"])
    if method == "MoveAlongArc":
        centre = parameters["CenterPoint"]
        return Arc(
            centre["p"], centre["axis"], parameters["RotSign"], parameters["Closed"],
            parameters["StartPoint"]["p"], parameters["EndPoint"]["p"],
        )  # fmt: skip
    raise ValueError(f"no check knows the shape of {method}")

"""NURBS curves and surfaces evaluated with numpy alone.

The demo computes its tool paths and checks the machine's answers with this module. It shares no code with the planner:
basis functions come from the Cox-de Boor recursion and derivatives from differenced poles, for whole arrays of
parameters at once. Lengths are in mm.
"""

import json

import numpy as np

CHUNK = 40000


def find_spans(knots, degree, t):
    """Index i of the knot span [knots[i], knots[i+1]) that holds each t; the last span is closed."""
    last = len(knots) - degree - 2
    return np.clip(np.searchsorted(knots, t, side="right") - 1, degree, last)


def basis(knots, degree, t):
    """The degree+1 basis functions that do not vanish at each t: (first pole index, values of shape (len(t), p+1))."""
    t = np.asarray(t, float)
    spans = find_spans(knots, degree, t)
    values = np.zeros((len(t), degree + 1))
    values[:, 0] = 1.0
    for p in range(1, degree + 1):
        carried = np.zeros(len(t))
        for r in range(p):
            right = knots[spans + r + 1]
            left = knots[spans + r + 1 - p]
            part = values[:, r] / (right - left)
            values[:, r] = carried + (right - t) * part
            carried = (t - left) * part
        values[:, p] = carried
    return spans - degree, values


def differenced(knots, degree, poles):
    """Knots, degree and poles of the derivative; poles run along the first axis."""
    width = knots[degree + 1 : len(poles) + degree] - knots[1 : len(poles)]
    scale = np.divide(degree, width, out=np.zeros_like(width), where=width > 0)
    return knots[1:-1], degree - 1, np.diff(poles, axis=0) * scale.reshape(-1, *[1] * (poles.ndim - 1))


class Curve:
    """A NURBS curve, given as on the wire."""

    def __init__(self, degree, knots, points, weights=None):
        self.degree = int(degree)
        self.knots = np.asarray(knots, float)
        self.points = np.asarray(points, float)
        self.weights = None if weights is None else np.asarray(weights, float)
        if len(self.knots) != len(self.points) + self.degree + 1:
            raise ValueError(
                f"a degree {self.degree} curve of {len(self.points)} poles needs "
                f"{len(self.points) + self.degree + 1} knots, not {len(self.knots)}"
            )
        poles = self.points
        if self.weights is not None:
            poles = np.hstack([self.points * self.weights[:, None], self.weights[:, None]])
        self._levels = [(self.knots, self.degree, poles)]

    @classmethod
    def from_wire(cls, data):
        knots = data["knots"]
        if "multiplicities" in data:
            knots = np.repeat(knots, data["multiplicities"])
        return cls(data["degree"], knots, data["points"], data.get("weights"))

    def to_wire(self):
        data = {"degree": self.degree, "knots": self.knots.tolist(), "points": self.points.tolist()}
        if self.weights is not None:
            data["weights"] = self.weights.tolist()
        return data

    @property
    def domain(self):
        return self.knots[self.degree], self.knots[-self.degree - 1]

    def _derivative_of_poles(self, t, order):
        while len(self._levels) <= order:
            knots, degree, poles = self._levels[-1]
            self._levels.append(differenced(knots, degree, poles) if degree else (knots, 0, np.zeros_like(poles)))
        knots, degree, poles = self._levels[order]
        first, values = basis(knots, degree, t)
        return np.einsum("np,npd->nd", values, poles[first[:, None] + np.arange(degree + 1)])

    def evaluate(self, t, order=0):
        """List of the derivatives 0..order by the parameter, each of shape (len(t), dimension)."""
        t = np.atleast_1d(np.asarray(t, float))
        raw = [self._derivative_of_poles(t, k) for k in range(order + 1)]
        if self.weights is None:
            return raw
        weight = [r[:, -1:] for r in raw]
        result = []
        binomial = [1]
        for k in range(order + 1):
            value = raw[k][:, :-1].copy()
            for i in range(1, k + 1):
                value -= binomial[i] * weight[i] * result[k - i]
            result.append(value / weight[0])
            binomial = [1] + [a + b for a, b in zip(binomial, binomial[1:])] + [1]
        return result

    def __call__(self, t):
        return self.evaluate(t)[0]


class Surface:
    """A rational tensor-product surface; `points` has the shape (poles in u, poles in v, 3)."""

    def __init__(self, degrees, knots, points, weights):
        self.degrees = tuple(degrees)
        self.knots = tuple(np.asarray(k, float) for k in knots)
        self.points = np.asarray(points, float)
        self.weights = np.asarray(weights, float)
        for axis, name in enumerate("uv"):
            expected = self.points.shape[axis] + self.degrees[axis] + 1
            if len(self.knots[axis]) != expected:
                raise ValueError(f"the surface needs {expected} knots in {name}, not {len(self.knots[axis])}")
        self._poles = np.concatenate([self.points * self.weights[..., None], self.weights[..., None]], axis=2)
        self._cache = {}

    @classmethod
    def read(cls, path):
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        return cls(data["degrees"], data["knots"], data["points"], data["weights"])

    @property
    def domain(self):
        return [(k[p], k[-p - 1]) for k, p in zip(self.knots, self.degrees)]

    def _net(self, du, dv):
        if (du, dv) not in self._cache:
            knots_u, degree_u, poles = self.knots[0], self.degrees[0], self._poles
            for _ in range(du):
                knots_u, degree_u, poles = differenced(knots_u, degree_u, poles)
            knots_v, degree_v, poles = self.knots[1], self.degrees[1], poles.swapaxes(0, 1)
            for _ in range(dv):
                knots_v, degree_v, poles = differenced(knots_v, degree_v, poles)
            self._cache[du, dv] = (knots_u, degree_u, knots_v, degree_v, poles.swapaxes(0, 1))
        return self._cache[du, dv]

    def _homogeneous(self, u, v, du, dv):
        knots_u, degree_u, knots_v, degree_v, poles = self._net(du, dv)
        first_u, values_u = basis(knots_u, degree_u, u)
        first_v, values_v = basis(knots_v, degree_v, v)
        index_u = first_u[:, None, None] + np.arange(degree_u + 1)[None, :, None]
        index_v = first_v[:, None, None] + np.arange(degree_v + 1)[None, None, :]
        return np.einsum("np,nq,npqd->nd", values_u, values_v, poles[index_u, index_v], optimize=True)

    def evaluate(self, u, v, order=0):
        """Dictionary (du, dv) -> derivative, shape (n, 3), for du + dv <= order <= 2."""
        u, v = np.broadcast_arrays(np.atleast_1d(np.asarray(u, float)), np.atleast_1d(np.asarray(v, float)))
        parts = [
            self._evaluate_chunk(u[i : i + CHUNK], v[i : i + CHUNK], order) for i in range(0, max(len(u), 1), CHUNK)
        ]
        return {key: np.concatenate([p[key] for p in parts]) for key in parts[0]}

    def _evaluate_chunk(self, u, v, order):
        raw = {(i, k - i): self._homogeneous(u, v, i, k - i) for k in range(order + 1) for i in range(k + 1)}
        w = {key: value[:, 3:] for key, value in raw.items()}
        a = {key: value[:, :3] for key, value in raw.items()}
        s = {(0, 0): a[0, 0] / w[0, 0]}
        if order >= 1:
            for key in ((1, 0), (0, 1)):
                s[key] = (a[key] - w[key] * s[0, 0]) / w[0, 0]
        if order >= 2:
            s[2, 0] = (a[2, 0] - 2 * w[1, 0] * s[1, 0] - w[2, 0] * s[0, 0]) / w[0, 0]
            s[0, 2] = (a[0, 2] - 2 * w[0, 1] * s[0, 1] - w[0, 2] * s[0, 0]) / w[0, 0]
            s[1, 1] = (a[1, 1] - w[1, 0] * s[0, 1] - w[0, 1] * s[1, 0] - w[1, 1] * s[0, 0]) / w[0, 0]
        return s

    def normal(self, u, v):
        """Point and upward unit normal."""
        s = self.evaluate(u, v, 1)
        n = np.cross(s[1, 0], s[0, 1])
        return s[0, 0], n / np.linalg.norm(n, axis=1)[:, None]

    def row(self, u):
        """Function of one v that gives points and upward unit normals at (u, v): `normal` for many rows, but faster."""
        u = np.asarray(u, float)
        stations = {}
        for du in (0, 1):
            knots_u, degree_u, *_ = self._net(du, 0)
            first, values = basis(knots_u, degree_u, u)
            stations[du] = first[:, None] + np.arange(degree_u + 1), values

        def at(v):
            raw = {}
            for du, dv in ((0, 0), (1, 0), (0, 1)):
                _, _, knots_v, degree_v, poles = self._net(du, dv)
                first, values = basis(knots_v, degree_v, np.array([v]))
                line = values[0] @ poles[:, first[0] : first[0] + degree_v + 1]
                index, weights = stations[du]
                raw[du, dv] = np.einsum("np,npd->nd", weights, line[index])
            point = raw[0, 0][:, :3] / raw[0, 0][:, 3:]
            n = np.cross(*(raw[key][:, :3] - raw[key][:, 3:] * point for key in ((1, 0), (0, 1))))
            return point, n / np.linalg.norm(n, axis=1)[:, None]

        return at

    def principal_curvatures(self, u, v):
        """Smallest and largest principal curvature, 1/mm, positive where the surface is concave seen from above."""
        s = self.evaluate(u, v, 2)
        n = np.cross(s[1, 0], s[0, 1])
        n /= np.linalg.norm(n, axis=1)[:, None]
        dot = lambda p, q: np.einsum("nd,nd->n", p, q)
        e, f, g = dot(s[1, 0], s[1, 0]), dot(s[1, 0], s[0, 1]), dot(s[0, 1], s[0, 1])
        l, m, k = dot(s[2, 0], n), dot(s[1, 1], n), dot(s[0, 2], n)
        area = e * g - f * f
        mean = (e * k - 2 * f * m + g * l) / (2 * area)
        root = np.sqrt(np.maximum(mean**2 - (l * k - m * m) / area, 0))
        return mean - root, mean + root

    def at_xy(self, x, y, iterations=8):
        """Parameters of the points of the surface above (x, y): Newton from the nearest sample of a coarse net."""
        from scipy.spatial import cKDTree

        (u0, u1), (v0, v1) = self.domain
        net_u, net_v = [g.ravel() for g in np.meshgrid(np.linspace(u0, u1, 160), np.linspace(v0, v1, 160))]
        tree = cKDTree(self.evaluate(net_u, net_v)[0, 0][:, :2])
        _, nearest = tree.query(np.column_stack([x, y]))
        u, v = net_u[nearest].copy(), net_v[nearest].copy()
        for _ in range(iterations):
            s = self.evaluate(u, v, 1)
            rx, ry = s[0, 0][:, 0] - x, s[0, 0][:, 1] - y
            a, b, c, d = s[1, 0][:, 0], s[0, 1][:, 0], s[1, 0][:, 1], s[0, 1][:, 1]
            determinant = a * d - b * c
            u = np.clip(u - (rx * d - ry * b) / determinant, u0, u1)
            v = np.clip(v - (ry * a - rx * c) / determinant, v0, v1)
            if max(np.abs(rx).max(initial=0), np.abs(ry).max(initial=0)) < 1e-9:
                break
        return u, v

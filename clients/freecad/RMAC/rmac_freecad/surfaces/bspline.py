"""B-splines over whole arrays of parameters: values, derivatives, fits."""

import numpy as np


def spans(knots, degree, t):
    """Index of the knot interval of each parameter; the last one holds the end."""
    return np.clip(np.searchsorted(knots, t, side="right") - 1, degree, len(knots) - degree - 2)


def basis(knots, degree, span, t, order=0):
    """The degree + 1 functions that are not zero there, from number span - degree on; and in a list behind them their derivatives, up to that
    order."""
    near = knots[span[:, None] + np.arange(1 - degree, degree + 1)]
    ahead, behind = near[:, degree:] - t[:, None], t[:, None] - near[:, :degree]
    wide = [ahead[:, :p] + behind[:, degree - p :] for p in range(degree + 1)]
    lower = [np.ones((len(t), 1))]
    for p in range(1, degree + 1):
        share = lower[-1] / wide[p]
        lower.append(_beside(share * behind[:, degree - p :], share * ahead[:, :p]))
    found = []
    for times in range(order + 1):
        if times > degree:
            found.append(np.zeros_like(lower[-1]))
            continue
        one = lower[degree - times]
        for p in range(degree - times + 1, degree + 1):
            weight = p * one / wide[p]
            one = _beside(weight, -weight)
        found.append(one)
    return found


def _beside(right, left):
    """What of each function of a degree goes to the two of the next."""
    out = np.zeros((len(right), right.shape[1] + 1))
    out[:, 1:] = right
    out[:, :-1] += left
    return out


def matrix(knots, degree, t):
    """Of the fit: a row for each parameter, a column for each pole."""
    span = spans(knots, degree, t)
    out = np.zeros((len(t), len(knots) - degree - 1))
    np.put_along_axis(out, (span - degree)[:, None] + np.arange(degree + 1), basis(knots, degree, span, t)[0], axis=1)
    return out


def value(knots, degree, poles, t):
    span = spans(knots, degree, t)
    near = poles[(span - degree)[:, None] + np.arange(degree + 1)]
    return np.einsum("nk,nk...->n...", basis(knots, degree, span, t)[0], near)


def clamped(breaks, degree):
    """Knots with these breaks, once each inside: as smooth as the degree allows."""
    return np.concatenate([[breaks[0]] * degree, breaks, [breaks[-1]] * degree])


def fitted(knots, degree, t, values):
    """Poles nearest to `values` at `t`, through the first and the last of them."""
    rows = matrix(knots, degree, t)
    poles = np.empty((rows.shape[1], *values.shape[1:]))
    poles[0], poles[-1] = values[0], values[-1]
    rest = values - rows[:, [0, -1]] @ poles[[0, -1]]
    poles[1:-1] = np.linalg.lstsq(rows[:, 1:-1], rest, rcond=None)[0]
    return poles


class Curve:
    """Of an edge: rational, in space."""

    def __init__(self, spline, first, last):
        self.degree = spline.Degree
        self.knots = np.array(spline.KnotSequence)
        self.poles = _homogeneous(spline.getPoles(), spline.getWeights())
        self.first, self.last = first, last
        self.interval = last - first  # between points of a cloud on it

    def __call__(self, t):
        found = value(self.knots, self.degree, self.poles, t)
        return found[:, :3] / found[:, 3:]


class Surface:
    """Of a face: rational, with first and second derivatives."""

    def __init__(self, spline):
        self.degrees = spline.UDegree, spline.VDegree
        self.knots = np.array(spline.UKnotSequence), np.array(spline.VKnotSequence)
        self.poles = np.array([_homogeneous(row, weights) for row, weights in zip(spline.getPoles(), spline.getWeights())])

    def __call__(self, uv, order=0):
        """Point, and with `order` 1 its derivatives along u and v, with 2 along uu, uv and vv, too."""
        spread = [spans(knots, degree, uv[:, k]) for k, (knots, degree) in enumerate(zip(self.knots, self.degrees))]
        rows, columns = ((span - degree)[:, None] + np.arange(degree + 1) for span, degree in zip(spread, self.degrees))
        near = self.poles[rows[:, :, None], columns[:, None, :]]
        functions = [basis(self.knots[k], self.degrees[k], spread[k], uv[:, k], order) for k in (0, 1)]
        along = [np.einsum("ni,nijc->njc", one, near) for one in functions[0]]
        h = {(a, b): np.einsum("nj,njc->nc", functions[1][b], along[a]) for a in range(order + 1) for b in range(order + 1 - a)}
        return _projected(h, order)


def _projected(h, order):
    """From homogeneous derivatives to those in space."""
    weight = h[0, 0][:, 3:]
    point = h[0, 0][:, :3] / weight
    if not order:
        return point
    first = [(h[k][:, :3] - h[k][:, 3:] * point) / weight for k in ((1, 0), (0, 1))]
    if order == 1:
        return point, *first
    second = []
    for k, (a, b) in zip(((2, 0), (1, 1), (0, 2)), ((0, 0), (0, 1), (1, 1))):
        wa, wb = (h[(1, 0) if one == 0 else (0, 1)][:, 3:] for one in (a, b))
        second.append((h[k][:, :3] - wa * first[b] - wb * first[a] - h[k][:, 3:] * point) / weight)
    return point, *first, *second


def _homogeneous(poles, weights):
    return np.array([(p.x * w, p.y * w, p.z * w, w) for p, w in zip(poles, weights)])

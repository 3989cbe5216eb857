"""How far places are from the part: from whichever face or edge is nearest. Exact where the ball, of the mill or of its corner, might
touch."""

import numpy as np

AT_ONCE = 32
REACH = 0.03  # radii: what is farther off the ball is told as that far
CANDIDATES = 2  # places of one face or edge; two where it is bent nearly as the ball is
APART = 3.0  # steps of the cloud
NEWTON = 10
LEVELS = 12
STILL = 1e-10  # of a face


class Clearance:
    def __init__(self, body):
        self._body = body
        self._reach = body.mill.corner_mm + REACH * body.mill.radius_mm

    def __call__(self, centres):
        centres = np.asarray(centres, float).reshape(-1, 3)
        found = np.full(len(centres), self._reach)
        found[~np.isfinite(centres).all(1)] = -np.inf
        asked = np.flatnonzero(np.isfinite(centres).all(1))
        pairs = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]
        pairs += [self._candidates(centres, some) for some in np.array_split(asked, len(asked) // AT_ONCE + 1) if len(some)]
        rows, chosen, away = (np.concatenate(column) for column in zip(*pairs))
        np.minimum.at(found, rows, away)
        labels, parameters = self._body.labels[chosen], self._body.parameters[chosen]
        for label in np.unique(labels):
            of = labels == label
            refine = self._from_face if label < len(self._body.faces) else self._from_edge
            np.minimum.at(found, rows[of], refine(label, parameters[of], centres[rows[of]]))
        return found

    def _candidates(self, centres, some):
        """Points of the cloud from which the nearest place may be found: numbers of centres, of points, how far these are."""
        body, here = self._body, centres[some]
        near = body.near(here.min(0) - self._reach, here.max(0) + self._reach)
        near = near[np.argsort(body.labels[near], kind="stable")]
        starts = np.flatnonzero(np.diff(body.labels[near], prepend=-1))
        found = []
        for of in np.split(near, starts[1:]) if len(near) else ():
            points, step = body.points[of], body.step_of[body.labels[of[0]]]
            away = np.sqrt(sum((here[:, k : k + 1] - points[:, k]) ** 2 for k in range(3)))
            rows = np.arange(len(here))
            for again in range(CANDIDATES):
                best = away[rows, away[rows].argmin(1)]
                index = away[rows].argmin(1)
                good = best < self._reach + self._gain(body.labels[of[0]], best)
                rows, index, best = rows[good], index[good], best[good]
                if not len(rows):
                    break
                found.append((some[rows], of[index], best))
                if again + 1 < CANDIDATES:
                    close = sum((points[:, k] - points[index, k : k + 1]) ** 2 for k in range(3)) < (APART * step) ** 2
                    away[rows] = np.where(close, np.inf, away[rows])
        if not found:
            return np.zeros(0, int), np.zeros(0, int), np.zeros(0)
        rows, chosen, away = (np.concatenate(column) for column in zip(*found))
        least = np.full(len(centres), np.inf)
        np.minimum.at(least, rows, away)
        hopeful = away - self._gain(body.labels[chosen], away) <= least[rows]
        return rows[hopeful], chosen[hopeful], away[hopeful]

    def _gain(self, label, away):
        """How much nearer the part may be than the nearest point of the cloud."""
        step = self._body.step_of[label]
        return np.minimum(step**2 / np.maximum(away, 1e-9), step) + 2 * self._body.sag_of[label] + 1e-6

    def _from_face(self, label, uv, centres):
        """By Newton's method; infinite where the nearest place of the surface is none of the face."""
        face = self._body.faces[label]
        low, high = face.trim.low, face.trim.high
        most, at, left = (high - low) / 10, uv.copy(), np.arange(len(uv))
        for _ in range(NEWTON):
            step = downhill(*_bowl(*face.evaluate(at[left], 2), centres[left]))
            new = np.clip(at[left] + np.clip(step, -most, most), low, high)
            goes_on = (np.abs(new - at[left]) > STILL * (high - low)).any(1)
            at[left] = new
            left = left[goes_on]
            if not len(left):
                break
        return np.where(face.trim.inside(at), np.linalg.norm(face.evaluate(at) - centres, axis=1), np.inf)

    def _from_edge(self, label, t, centres):
        return least_along(self._body.edges[label - len(self._body.faces)], t[:, 0], lambda points: np.linalg.norm(points - centres[:, None], axis=2))


def least_along(curve, t, far):
    """The least of a function of points, (places, some, 3), on an edge's curve about each of these parameters."""
    at, width = t, curve.interval
    found, rows = np.full(len(at), np.inf), np.arange(len(at))
    for _ in range(LEVELS):
        tried = np.clip(at[:, None] + width * np.linspace(-1, 1, 9), curve.first, curve.last)
        away = far(curve(tried.ravel()).reshape(*tried.shape, 3))
        best = away.argmin(1)
        at, width = tried[rows, best], width / 4
        found = np.minimum(found, away[rows, best])
    return found


def _bowl(point, u, v, uu, uv, vv, centres):
    """Of half the square of the distance from the centres, along u and v: gradients, second derivatives, and these of a plane."""
    way = point - centres
    gradient = np.stack([(way * u).sum(1), (way * v).sum(1)], 1)
    flat = [(a * b).sum(1) for a, b in ((u, u), (u, v), (v, v))]
    return gradient, [first + (way * second).sum(1) for first, second in zip(flat, (uu, uv, vv))], flat


def downhill(gradient, bent, flat):
    """Newton's step; by the second derivatives `flat` where the others are none of a bowl."""
    bowl = (bent[0] > 0) & (bent[0] * bent[2] > bent[1] ** 2 * (1 + 1e-9))
    a, b, c = (np.where(bowl, full, short) for full, short in zip(bent, flat))
    with np.errstate(divide="ignore", invalid="ignore"):
        step = np.stack([b * gradient[:, 1] - c * gradient[:, 0], b * gradient[:, 0] - a * gradient[:, 1]], 1) / (a * c - b * b)[:, None]
    return np.where(np.isfinite(step), step, 0)

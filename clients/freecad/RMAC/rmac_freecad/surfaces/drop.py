"""How low the mill may go at a place: to where it first touches the part, whatever face or edge that is.

A cloud of points tells where that may be; the contact itself is found on the exact surface: where the mill touches a point with the
upward normal n, its tip is at p + corner (n - z) + flat m, m being n seen from above. On an edge it is the highest tip over all
points of the edge.
"""

from dataclasses import dataclass, fields

import numpy as np

AT_ONCE = 32
CANDIDATES = 4  # places of one face or edge that may be touched; several also where it is bent nearly as the mill is
APART = 1.5  # steps of the cloud
CLOSED_MM = 1e-8
UPRIGHT = 1e-3  # the normal's z below which a face is a wall, touched along its upper edge alone
NEWTON = 10
STILL = 1e-9  # of a face, where a step changes nothing any more
HOPEFUL = 4  # steps, after which one that is still far off finds nothing
LEVELS = 13
CLIMBS = 14
GRID = np.stack(np.meshgrid([-1, -0.5, 0, 0.5, 1], [-1, -0.5, 0, 0.5, 1]), 2).reshape(1, 25, 2)


@dataclass
class Heights:
    """Of the tip, with what is touched there. -inf where nothing is."""

    z: np.ndarray
    label: np.ndarray
    point: np.ndarray
    normal: np.ndarray  # of faces; nan on edges
    on_target: np.ndarray  # whether what is to be cut is touched, not at its border alone, be it with others

    def part(self, begin, end):
        return Heights(*(getattr(self, one.name)[begin:end] for one in fields(self)))


class Drop:
    def __init__(self, part, mill):
        self._part, self._mill = part, mill

    def __call__(self, xy):
        xy = np.asarray(xy, float).reshape(-1, 2)
        found = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]
        found += [self._candidates(xy[i : i + AT_ONCE], i) for i in range(0, len(xy), AT_ONCE)]
        tips, chosen, z = (np.concatenate(column) for column in zip(*found))
        part = self._part
        labels, uv = part.labels[chosen], part.parameters[chosen]
        points, normals = part.points[chosen].copy(), np.full((len(chosen), 3), np.nan)
        for label in np.unique(labels):
            of = np.flatnonzero(labels == label)
            refine = self._on_face if label < len(part.faces) else self._on_edge
            refine(label, of, xy[tips[of]], uv, points, normals, z)
        return self._best(len(xy), tips, z, labels, points, normals)

    def surely_blocked(self, tips, by_mm):
        """Where a point of the cloud is farther than that inside the mill; quick, and of the others nothing is known."""
        found = [np.zeros(0, bool)]
        for some in np.array_split(tips, len(tips) // AT_ONCE + 1):
            near = self._part.points[self._part.near(some[:, :2].min(0) - self._mill.radius_mm, some[:, :2].max(0) + self._mill.radius_mm)]
            off = np.hypot(some[:, :1] - near[:, 0], some[:, 1:2] - near[:, 1])
            found.append((near[:, 2] - self._mill.height(off) > some[:, 2:] + by_mm).any(1))
        return np.concatenate(found)

    def _candidates(self, xy, first):
        """Of each face and edge the highest points of the cloud that are apart from each other; numbers of tips, of points, heights."""
        part, mill = self._part, self._mill
        near = part.near(xy.min(0) - mill.radius_mm, xy.max(0) + mill.radius_mm)
        near = near[np.argsort(part.labels[near], kind="stable")]
        starts = np.flatnonzero(np.diff(part.labels[near], prepend=-1))
        found = [(np.zeros(0, int), np.zeros(0, int), np.zeros(0))]
        for of in np.split(near, starts[1:]) if len(near) else ():
            points, apart = part.points[of], (APART * part.step_of[part.labels[of[0]]]) ** 2
            off = np.sqrt((xy[:, :1] - points[:, 0]) ** 2 + (xy[:, 1:] - points[:, 1]) ** 2)
            tip = points[:, 2] - mill.height(off)
            rows = np.arange(len(xy))
            for again in range(CANDIDATES):
                best = tip[rows].argmax(1)
                highest = tip[rows, best]
                good = np.isfinite(highest)
                rows, best = rows[good], best[good]
                if not len(rows):
                    break
                found.append((rows + first, of[best], highest[good]))
                if again + 1 < CANDIDATES:
                    away = points[best]
                    close = sum((points[:, k] - away[:, k : k + 1]) ** 2 for k in range(3)) < apart
                    if part.labels[of[0]] < len(part.faces) and part.faces[part.labels[of[0]]].closed:
                        close &= self._same_side(of, best)
                    tip[rows] = np.where(close, -np.inf, tip[rows])
        tips, chosen, z = (np.concatenate(column) for column in zip(*found))
        if not len(tips):
            return tips, chosen, z
        top = np.full(len(xy), -np.inf)
        np.maximum.at(top, tips - first, z)
        hopeful = z + self._gain(part.labels[chosen], np.linalg.norm(part.points[chosen, :2] - xy[tips - first], axis=1)) >= top[tips - first]
        return tips[hopeful], chosen[hopeful], z[hopeful]

    def _same_side(self, of, best):
        """Not beyond the seam: a place there is found from its own side alone."""
        parameters, trim = self._part.parameters[of], self._part.faces[self._part.labels[of[0]]].trim
        return sum(np.abs(parameters[:, k] - parameters[best, k : k + 1]) > (trim.high - trim.low)[k] / 2 for k in (0, 1)) == 0

    def _gain(self, labels, off):
        """How much higher the contact may be than the nearest point of the cloud: by the bend of the mill and that of the part. The
        steeper the mill is there, the more."""
        step, mill = self._part.step_of[labels], self._mill
        sine = np.clip((off - mill.flat_mm) / max(mill.corner_mm, 1e-9), 0, 0.99)
        cosine = np.sqrt(1 - sine**2)
        bend = step**2 / (4 * max(mill.corner_mm, 1e-9)) / cosine**3
        return 1.5 * np.minimum(bend, 2 * step) + 4 * self._part.sag_of[labels] / cosine + 1e-6

    def _on_face(self, label, of, xy, uv, points, normals, z):
        face = self._part.faces[label]
        at, tip, off, point, normal = contact(face, self._mill, uv[of], xy)
        good = (off < CLOSED_MM) & face.trim.inside(at)
        points[of[good]], normals[of[good]], z[of[good]] = point[good], normal[good], tip[good]
        if self._mill.flat_mm:
            self._on_top(face, of, xy, uv, points, normals, z)
        within = (at > face.trim.low).all(1) & (at < face.trim.high).all(1) & np.isnan(normals[of, 2])
        stuck = of[within]
        if len(stuck):
            self._climb(face, stuck, xy[within], uv[stuck], points, normals, z)

    def _climb(self, face, of, xy, at, points, normals, z):
        """Where Newton's method finds nothing within a face, bent there as the mill is: the highest tip on ever finer grids."""
        width = np.tile(face.interval, (len(of), 1))
        for _ in range(CLIMBS):
            tried = at[:, None] + width[:, None] * GRID
            tried = np.minimum(np.maximum(tried, face.trim.low), face.trim.high)
            flat = tried.reshape(-1, 2)
            point = face.evaluate(flat).reshape(*tried.shape[:2], 3)
            tip = point[:, :, 2] - self._mill.height(np.linalg.norm(point[:, :, :2] - xy[:, None], axis=2))
            tip = np.where(face.trim.inside(flat).reshape(tip.shape), tip, -np.inf)
            best = tip.argmax(1)
            rows = np.arange(len(of))
            at, width = tried[rows, best], width / 2
            better = tip[rows, best] > z[of]
            z[of[better]], points[of[better]] = tip[rows, best][better], point[rows, best][better]
        normals[of] = upward(face, at)[1]

    def _on_top(self, face, of, xy, uv, points, normals, z):
        """The flat of the mill stands on the highest point round its axis."""
        at, left = uv[of].copy(), np.arange(len(of))
        for _ in range(NEWTON):
            _, u, v, uu, uv_, vv = face.evaluate(at[left], 2)
            hessian = np.stack([uu[:, 2], uv_[:, 2], uv_[:, 2], vv[:, 2]], 1).reshape(-1, 2, 2)
            values, vectors = np.linalg.eigh(hessian)
            slope = np.einsum("nji,nj->ni", vectors, np.stack([u[:, 2], v[:, 2]], 1))
            least = 1e-9 * np.abs(values).max(1, initial=1e-30)[:, None]
            step = np.where(np.abs(values) > least, slope / np.maximum(np.abs(values), least), 0)
            new = np.clip(at[left] + np.einsum("nij,nj->ni", vectors, step), face.trim.low, face.trim.high)
            goes_on = (np.abs(new - at[left]) > STILL * (face.trim.high - face.trim.low)).any(1)
            at[left] = new
            left = left[goes_on]
            if not len(left):
                break
        point = face.evaluate(at)
        inside = (np.linalg.norm(point[:, :2] - xy, axis=1) <= self._mill.flat_mm) & face.trim.inside(at) & (point[:, 2] >= z[of])
        points[of[inside]], z[of[inside]] = point[inside], point[inside, 2]
        normals[of[inside]] = (0, 0, 1)

    def _on_edge(self, label, of, xy, t, points, normals, z):
        curve = self._part.edges[label - len(self._part.faces)]
        width = np.full(len(of), curve.interval)
        at = t[of, 0]
        for _ in range(LEVELS):
            tried = np.clip(at[:, None] + width[:, None] * np.linspace(-1, 1, 9), curve.first, curve.last)
            point = curve(tried.ravel()).reshape(*tried.shape, 3)
            off = np.linalg.norm(point[:, :, :2] - xy[:, None], axis=2)
            tip = point[:, :, 2] - self._mill.height(off)
            best = tip.argmax(1)
            rows = np.arange(len(of))
            at, width = tried[rows, best], width / 4
            better = tip[rows, best] > z[of]
            z[of[better]], points[of[better]] = tip[rows, best][better], point[rows, best][better]

    def _best(self, count, tips, z, labels, points, normals):
        found = Heights(np.full(count, -np.inf), np.full(count, -1), np.full((count, 3), np.nan), np.full((count, 3), np.nan), np.zeros(count, bool))
        target = np.isin(labels, self._part.targets)
        for among in (np.arange(len(z)), np.flatnonzero(target)):  # a target's contact is told where it is as high as any
            order = among[np.lexsort((z[among], tips[among]))]
            last = order[np.append(tips[order][1:] != tips[order][:-1], True)] if len(order) else order
            last = last[z[last] >= found.z[tips[last]] - 1e-7]
            to = tips[last]
            found.z[to] = np.maximum(found.z[to], z[last])
            found.label[to], found.point[to], found.normal[to] = labels[last], points[last], normals[last]
        found.on_target = np.isin(found.label, self._part.inner)
        return found


def upward(face, uv):
    """Points, upward normals, and the derivatives of both along u and v."""
    point, u, v, uu, uv_, vv = face.evaluate(uv, 2)
    cross = _across(u, v)
    with np.errstate(divide="ignore", invalid="ignore"):
        long = np.linalg.norm(cross, axis=1, keepdims=True) * np.where(cross[:, 2:] < 0, -1, 1)
        normal = cross / long
        turns = [(_across(a, v) + _across(u, b)) / long for a, b in ((uu, uv_), (uv_, vv))]
        turns = [one - normal * (one * normal).sum(1, keepdims=True) for one in turns]
    return point, normal, (u, v), turns


def tips(face, mill, uv):
    """Where the tip is when the mill touches there, the point and its normal."""
    point, normal, _, _ = upward(face, uv)
    tip = point + mill.corner_mm * (normal - (0, 0, 1))
    if mill.flat_mm:
        with np.errstate(divide="ignore", invalid="ignore"):
            tip[:, :2] += mill.flat_mm * normal[:, :2] / np.linalg.norm(normal[:, :2], axis=1, keepdims=True)
    return tip, point, normal


def contact(face, mill, uv, xy):
    """Newton's method: where the mill with its axis at xy touches the face. Parameters, tip, how far off it is, point, normal."""
    low, high = face.trim.low, face.trim.high
    most = (high - low) / 20
    at = uv.copy()
    off, point, normal = np.full(len(uv), np.inf), np.empty((len(uv), 3)), np.empty((len(uv), 3))
    sense, left = np.zeros(len(uv), bool), np.arange(len(uv))
    for turn in range(NEWTON):
        point[left], normal[left], along, turns = upward(face, at[left])
        (e, f), ((eu, fu), (ev, fv)), sense[left] = _miss(mill, xy[left], point[left], normal[left], along, turns)
        off[left] = np.abs(e) + np.abs(f)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.stack([ev * f - e * fv, e * fu - eu * f], 1) / (eu * fv - ev * fu)[:, None]
        step = np.where(np.isfinite(step), np.minimum(np.maximum(step, -most), most), 0)
        new = np.minimum(np.maximum(at[left] + step, low), high)
        goes_on = (off[left] > CLOSED_MM / 100) & (new != at[left]).any(1)  # else it is there, or at the face's end
        if turn >= HOPEFUL:
            goes_on &= off[left] < 0.02 * mill.radius_mm
        if not goes_on.any():
            break
        left = left[goes_on]
        at[left] = new[goes_on]
    off = np.where(np.isfinite(off) & (normal[:, 2] > UPRIGHT) & sense, off, np.inf)
    return at, point[:, 2] + mill.corner_mm * (normal[:, 2] - 1), off, point, normal


def _miss(mill, xy, point, normal, along, turns):
    """What is to become zero, and its derivatives. With a flat: the way from the centre of the corner's circle to the axis is as long
    as the flat's radius, and along the normal; said without dividing by the normal, which may point straight up."""
    way = xy - point[:, :2] - mill.corner_mm * normal[:, :2]
    ways = [-one[:, :2] - mill.corner_mm * turn[:, :2] for one, turn in zip(along, turns)]
    if not mill.flat_mm:
        return way.T, [one.T for one in ways], True
    length = np.maximum(np.linalg.norm(way, axis=1), 1e-12)
    value = _cross(normal, way), length - mill.flat_mm
    slopes = [(_cross(turn, way) + _cross(normal, one), (way * one).sum(1) / length) for one, turn in zip(ways, turns)]
    return value, slopes, (way * normal[:, :2]).sum(1) >= 0


def _across(a, b):
    """numpy's own is slow for few vectors."""
    x, y, z = a.T
    u, v, w = b.T
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], 1)


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]

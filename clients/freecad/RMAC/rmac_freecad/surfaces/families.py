"""Families of passes over the plan: by planes, or along a face's own parameters. w tells the pass, t the place on it."""

import math

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.surfaces.drop import tips

INSET_MM = 1e-3  # the outermost passes touch the face this far from its border
SAME_MM = 1e-5


class Planes:
    """Upright planes in one direction; the tip stays in its plane. They cut all targets together."""

    straight = True

    def __init__(self, part, mill, steepest, angle):
        self.targets = part.targets
        self._d, self._e = np.array([math.cos(angle), math.sin(angle)]), np.array([-math.sin(angle), math.cos(angle)])
        places = np.concatenate([_tips_of(part, mill, steepest, label) for label in part.targets])
        if not len(places):
            raise JobRefused("the faces have no place that is less steep than what is to be cut")
        along, across = places @ self._d, places @ self._e
        self.t_range = along.min() - mill.radius_mm, along.max() + mill.radius_mm
        missed = max(_missed_mm(part, mill, steepest, label) for label in part.targets)
        self.w_range = across.min() + INSET_MM - missed, across.max() - INSET_MM + missed
        self.t_mm = self.w_mm = 1.0
        self._least = math.cos(steepest)

    def places(self, uv, tip):
        """w and t of the pass that touches the face there."""
        return tip[:, :2] @ self._e, tip[:, :2] @ self._d

    def plan(self, w, t):
        return np.multiply.outer(t, self._d) + w * self._e

    def cuts(self, w, t, heights):
        return heights.on_target & ~(heights.normal[:, 2] < self._least)


class Isolines:
    """Along u or v of one face: the mill touches the face on that line."""

    straight = False

    def __init__(self, part, mill, steepest, label, axis):
        self.targets = [label]
        self._face, self._mill, self._axis = part.faces[label], mill, axis
        self._least = math.cos(steepest)
        trim = self._face.trim
        points, uv = part.of_target(label)
        _, _, normal = tips(self._face, mill, uv)
        gentle = normal[:, 2] >= self._least
        if not gentle.any():
            raise JobRefused("the face has no place that is less steep than what is to be cut")
        if mill.flat_mm and (np.linalg.norm(normal[gentle, :2], axis=1) < 0.02).any():
            raise JobRefused("along its parameters a face that is level somewhere is swept with a ball end; take planes (along=0)")
        self.t_range = trim.low[axis], trim.high[axis]
        self.t_mm, self.w_mm = (_mm_of(self._face, k, uv[gentle]) for k in (axis, 1 - axis))
        w = uv[gentle, 1 - axis]
        step = (trim.high - trim.low)[1 - axis] / 200  # as far as the cloud may have missed the slope that is cut
        inset = INSET_MM / self.w_mm
        self.w_range = max(w.min() - step, trim.low[1 - axis]) + inset, min(w.max() + step, trim.high[1 - axis]) - inset

    def places(self, uv, tip):
        return uv[:, 1 - self._axis], uv[:, self._axis]

    def plan(self, w, t):
        return self._tips(w, t)[0][:, :2]

    def cuts(self, w, t, heights):
        tip, normal, uv = self._tips(w, t)
        return (heights.z - tip[:, 2] < SAME_MM) & (normal[:, 2] >= self._least) & self._face.trim.inside(uv)

    def _tips(self, w, t):
        uv = np.column_stack([t, np.full(len(t), w)] if self._axis == 0 else [np.full(len(t), w), t])
        tip, _, normal = tips(self._face, self._mill, uv)
        return tip, normal, uv


def _tips_of(part, mill, steepest, label):
    """Of the mill at all places of a face that are not too steep; over level ones its axis."""
    face = part.faces[label]
    rim = np.concatenate(face.trim.loops)
    found = []
    for uv in (part.of_target(label)[1], rim):
        tip, point, normal = tips(face, mill, uv)
        tip = np.where(np.isfinite(tip), tip, point)
        found.append(tip[normal[:, 2] >= math.cos(steepest), :2])
    return np.concatenate(found)


def _missed_mm(part, mill, steepest, label):
    """How far beyond the cloud's places the slope may be that is still cut; the pass at that border is sought."""
    normal = tips(part.faces[label], mill, part.of_target(label)[1])[2]
    return 0.0 if (normal[:, 2] >= math.cos(steepest)).all() else 2 * part.step_of[label]


def _mm_of(face, axis, uv):
    """Millimetres a unit of a parameter, where that is most."""
    slopes = np.linalg.norm(face.evaluate(uv, 1)[1 + axis], axis=1)
    return max(slopes.max(), 1e-12)

"""From the end of one curve to the beginning of the next: near the part where nothing is touched on the way, else out along the axis
and over the part."""

import numpy as np

LIFTS = (0.0, 0.05, 0.1, 0.2, 0.4, 0.8)  # of the mill's radius
KNOTS = np.array([0.0, 0, 0, 0, 1, 1, 1, 1])
DENSER = 5  # than along passes it is looked whether a link touches
MOST_TURN = 0.5  # radians of the axis
OPPOSITE = -0.8  # cosine between axes, from which on the axis turns by way of upright


class Links:
    """Poses are x y z of the tip and i j k of the axis. `clear_mm` is the height of the tip where it crosses over the part."""

    def __init__(self, body, touching, clear_mm, aside_mm):
        self._touching, self._radius = touching, body.mill.radius_mm
        box, self._clear = body.top, clear_mm
        margin = aside_mm + self._radius
        self._low = np.array([box.XMin - margin, box.YMin - margin, -np.inf])
        self._high = np.array([box.XMax + margin, box.YMax + margin, clear_mm])

    def between(self, begin, end):
        """Poles of a cubic that rises away from the part; None where the mill has to be taken off."""
        centres = [pose[:3] + self._radius * pose[3:] for pose in (begin, end)]
        way, turn = centres[1] - centres[0], begin[3:] @ end[3:]
        length = np.linalg.norm(way)
        if length > 2 * self._radius or turn < np.cos(MOST_TURN):
            return None
        away = begin[3:] + end[3:]
        away /= np.linalg.norm(away)
        shares = np.array([0, 1 / 3, 2 / 3, 1])
        axes = begin[3:] + shares[:, None] * (end[3:] - begin[3:])
        for lift in LIFTS:
            balls = centres[0] + shares[:, None] * way + np.outer([0, 1, 1, 0], lift * self._radius * away)
            poles = np.column_stack([balls - self._radius * axes, axes])
            poles[0], poles[-1] = begin, end
            if not len(self._touching(KNOTS, poles, 3, length + lift * self._radius, DENSER)):
                return poles
        return None

    def out(self, pose):
        """Poses that lead from there along the axis to where the mill, as long as it may be, is beside or above the part, and up to
        where it crosses. The axis does not point down, so that all of the mill is above its ball or beyond it."""
        tip, axis = pose[:3], pose[3:]
        with np.errstate(divide="ignore", invalid="ignore"):
            far = np.where(axis > 0, (self._high - tip) / axis, (self._low - tip) / axis)
        far = far[np.abs(axis) > 1e-9]
        away = tip + max(far[np.isfinite(far)].min(initial=np.inf), 0.0) * axis
        poses = [np.concatenate([away, axis])]
        if away[2] < self._clear - 1e-9:
            poses.append(np.concatenate([away[:2], [self._clear], axis]))
        return poses

    def over(self, begin, end):
        """Poses at the height of crossing, between them."""
        if begin[3:] @ end[3:] > OPPOSITE:
            return []
        return [np.concatenate([begin[:2], [self._clear, 0, 0, 1]])]

"""Where along a curve the mill is in the part."""

import numpy as np

from rmac_freecad.surfaces.five import fit
from rmac_freecad.surfaces.fit import DEGREE

BALL_CHECKS, SIDE_CHECKS, DISC_CHECKS = 20, 12, 20  # places a radius
FEWEST = 5
MAY_MM = 2e-4  # that it is in the part by an exact check


class Touching:
    """`checks` are so many places a radius, and what tells of tips and axes there whether the mill passes."""

    def __init__(self, mill, *checks):
        self._mill, self._checks = mill, checks

    def __call__(self, knots, poles, degree=DEGREE, length_mm=None, denser=1):
        """Parameters of a curve, which are lengths in mm unless its length is given."""
        length_mm = knots[-1] - knots[0] if length_mm is None else length_mm
        bad = []
        for count, passes in self._checks:
            s = np.linspace(knots[0], knots[-1], int(length_mm / self._mill.radius_mm * count * denser) + FEWEST)
            bad.append(s[~passes(*fit.poses(knots, poles, s, degree))])
        return np.concatenate(bad)


def ball_touching(mill, clearance, access):
    def ball_passes(tips, axes):
        return clearance(tips + mill.radius_mm * axes) >= mill.radius_mm - MAY_MM

    def side_passes(tips, axes):
        return access(tips + mill.radius_mm * axes, axes[:, None])[:, 0]

    return Touching(mill, (SIDE_CHECKS, side_passes), (BALL_CHECKS, ball_passes))


def disc_touching(mill, distance):
    may_mm = min(MAY_MM, mill.corner_mm / 2)  # deeper than its corner the distance has no gradient
    return Touching(mill, (DISC_CHECKS, lambda tips, axes: distance(tips, axes) >= -may_mm))

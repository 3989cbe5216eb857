"""From where the mill may come: its side, as thick as its ball and without an end, is to pass the part."""

import numpy as np

NEAR = 2  # radii: so far the dense points of the part are looked at
MARGIN = 0.0025  # radii that the side keeps off dense points, between which the part may be nearer
COARSE_MARGIN = 0.05  # and off coarse ones
LOWEST = -1e-6  # an axis that points further down would need a spindle below the part
UP = 2.0  # so much more than the spare is kept of that


class Access:
    def __init__(self, body):
        self._body, self._radius = body, body.mill.radius_mm

    def margin_mm(self, spare):
        """That the side keeps off the part at least wherever it passes."""
        return self._radius * (COARSE_MARGIN + spare)

    def __call__(self, centres, axes, spare=0.0):
        """Whether it passes, `spare` radii off: `axes` are several for each centre, (centres, axes, 3)."""
        free = np.zeros(axes.shape[:2], bool)
        for number, (centre, some) in enumerate(zip(centres, axes)):
            wanted = np.isfinite(some).all(1) & (some[:, 2] >= LOWEST + UP * spare)
            if not wanted.any() or not np.isfinite(centre).all():
                continue
            free[number, wanted] = self._passes(centre, some[wanted], spare)
        return free

    def _passes(self, centre, axes, spare):
        reach = NEAR * self._radius
        near = self._body.points[self._body.near(centre - reach, centre + reach)] - centre
        far = self._body.coarse - centre
        if self._within(centre, reach):
            far = far[(np.abs(far) > reach).any(1)]
        free = np.ones(len(axes), bool)
        for points, margin in ((near, MARGIN), (far, COARSE_MARGIN)):
            limit = (self._radius * (1 + margin + spare)) ** 2
            up = points @ axes[free].T
            blocked = (up > 0) & ((points**2).sum(1)[:, None] - up**2 < limit)
            free[free] = ~blocked.any(0)
        return free

    def _within(self, centre, reach):
        """Whether dense points are there all around."""
        return bool((centre - reach >= self._body.low).all() and (centre + reach <= self._body.high).all())

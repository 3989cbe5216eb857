"""From the end of one curve to the beginning of the next, along the part where nothing is touched on the way."""

import numpy as np

LIFTS = (0.05, 0.1, 0.2, 0.4, 0.8)  # of the mill's radius
BETWEEN = 200  # samples a radius of the mill


class Links:
    def __init__(self, drop, mill):
        self._drop, self._mill = drop, mill

    def between(self, begin, end):
        """Poles of a line or of a cubic that rises above it; None where the mill has to be lifted off."""
        length = np.linalg.norm(end - begin)
        if length > 2 * self._mill.radius_mm:
            return None
        count = max(int(length / self._mill.radius_mm * BETWEEN), 12)
        s = np.linspace(0, 1, count + 1)[1:-1]
        straight = begin + s[:, None] * (end - begin)
        floor = self._drop(straight[:, :2]).z
        for lift in (0.0, *LIFTS):
            rise = lift * self._mill.radius_mm
            if (straight[:, 2] + 3 * s * (1 - s) * rise >= floor).all():
                if not rise:
                    return np.array([begin, end])
                third = (end - begin) / 3
                return np.array([begin, begin + third + (0, 0, rise), end - third + (0, 0, rise), end])
        return None

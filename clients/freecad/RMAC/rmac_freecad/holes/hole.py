"""A round hole, as it is drilled or told why it is not."""

import math
from dataclasses import dataclass, replace

UPRIGHT = (0.0, 0.0, 1.0)
ALL_ROUND_DEG = 360.0
SAME_MM = 1e-5


@dataclass(frozen=True)
class Hole:
    x: float
    y: float
    diameter_mm: float  # 0 of a point
    top: float  # where a drill may meet material; that of countersinks and wider bores around it
    depth_mm: float  # from there to the end of its wall, along the axis; 0 of a circle or a point, which do not tell it
    through: bool
    faces: tuple  # names of its wall
    axis: tuple = UPRIGHT  # out of it
    around_deg: float = ALL_ROUND_DEG  # that its wall goes; a keyway takes some of it
    obstacle: str = ""  # what keeps off a drill that comes from above

    @property
    def bottom(self):
        """Z of the end of its wall."""
        return self.top - self.depth_mm * self.axis[2]

    @property
    def lean_deg(self):
        return math.degrees(math.acos(max(-1.0, min(1.0, self.axis[2]))))

    def leaning(self):
        """Told as what it is."""
        return replace(self, obstacle=f"its axis leans by {self.lean_deg:.4g}° from Z; turn the part until it stands upright")

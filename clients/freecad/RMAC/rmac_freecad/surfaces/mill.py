"""What cuts: a disc with a rounded corner, turned about Z. A ball end is all corner, a flat end has none."""

import math
from dataclasses import dataclass

import numpy as np

from rmac_freecad.jobs.refusal import JobRefused

SIDE_MM = 2e-4  # a wall this far inside the side of the mill is one that it passes
LARGEST_MM = 1000.0
DETAIL = 0.2  # of its radius, of a mill whose corner is smaller
KINDS = {"ballend": "ball_end", "bullnose": "bull_nose", "endmill": "flat_end"}


@dataclass(frozen=True)
class Mill:
    radius_mm: float
    corner_mm: float

    def __post_init__(self):
        for name, least in (("radius_mm", 1e-3), ("corner_mm", 0)):
            size = getattr(self, name)
            if isinstance(size, bool) or not isinstance(size, (int, float, np.floating, np.integer)) or not least <= size <= LARGEST_MM:
                raise JobRefused(f"the mill's {name} is {size!r}: give millimetres, {least:g} to {LARGEST_MM:g}")
        if self.corner_mm > self.radius_mm:
            raise JobRefused(f"the mill's corner, {self.corner_mm:g} mm, is larger than its radius of {self.radius_mm:g} mm")

    @property
    def flat_mm(self):
        """Radius of the disc that it stands on."""
        return self.radius_mm - self.corner_mm

    @property
    def detail_mm(self):
        """What it follows along a face is no smaller: its corner, or a share of its radius."""
        return max(self.corner_mm, DETAIL * self.radius_mm)

    def grown(self, by_mm):
        """The places that are no farther from it."""
        return Mill(self.radius_mm + by_mm, self.corner_mm + by_mm)

    def height(self, off):
        """Of its surface above the tip, so far from its axis; infinite beside it."""
        beyond = np.maximum(off - self.flat_mm, 0)
        inside = off <= self.radius_mm - SIDE_MM
        return np.where(inside, self.corner_mm - np.sqrt(np.maximum(self.corner_mm**2 - beyond**2, 0)), np.inf)


def ball_end(radius_mm):
    return Mill(radius_mm, radius_mm)


def bull_nose(radius_mm, corner_mm):
    return Mill(radius_mm, corner_mm)


def flat_end(radius_mm):
    return Mill(radius_mm, 0.0)


def mill_of(controller):
    """Of a tool controller of the Path workbench."""
    tool = controller.Tool
    kind = KINDS.get(getattr(tool, "ShapeName", None))
    if kind is None:
        raise JobRefused(f"{controller.Label} has a tool of the shape {getattr(tool, 'ShapeName', '?')}; faces are swept with {', '.join(KINDS)}")
    radius = float(tool.Diameter) / 2
    return {"ball_end": ball_end, "flat_end": flat_end}[kind](radius) if kind != "bull_nose" else bull_nose(radius, float(tool.FlatRadius))

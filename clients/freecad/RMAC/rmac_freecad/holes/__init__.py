"""Round holes drilled, without a Path job."""

from rmac_freecad.holes.drilling import Drilling, read_holes

__all__ = ["Drilling", "read_holes"]

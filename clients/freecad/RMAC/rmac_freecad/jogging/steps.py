"""How far a tap on a jog button goes, in round numbers of the unit that FreeCAD shows."""

import FreeCAD

MM = (0.01, 0.1, 0.5, 1, 5, 10, 50)
INCHES = (0.001, 0.01, 0.05, 0.1, 0.25, 0.5, 1)
MM_PER_INCH = 25.4


def in_inches():
    """Whether lengths are shown in inches, or in feet."""
    return any(unit in FreeCAD.Units.Quantity("10 mm").UserString for unit in ("in", "ft", '"', "'", "thou"))


def steps():
    """mm."""
    return [step * MM_PER_INCH for step in INCHES] if in_inches() else list(MM)

"""Lengths and feeds in the unit that FreeCAD shows; values are mm and mm/s, or mm/min where that is said, whatever the unit is."""

import FreeCAD
from PySide import QtGui

HIGHEST = 1e6
LENGTH = FreeCAD.Units.Length
SPEED = FreeCAD.Units.Velocity


class QuantityField(QtGui.QDoubleSpinBox):
    """FreeCAD's own field keeps no more of a value than it shows: a thousandth of an inch is 0 there."""

    def __init__(self, kind, value=0.0, lowest=-HIGHEST):
        super().__init__()
        self._per_unit, unit = _shown(FreeCAD.Units.Quantity(10, kind))
        self.setDecimals(3 if self._per_unit < 10 else 4)
        self.setSuffix(f" {unit}")
        self.setRange(lowest / self._per_unit, HIGHEST / self._per_unit)
        self.set_quantity(value)

    @property
    def quantity(self):
        """mm, or mm/s."""
        return self.value() * self._per_unit

    def set_quantity(self, value):
        self.setValue(value / self._per_unit)


def length_text(mm):
    """In the unit that FreeCAD shows for what a machine is as large as: a thousandth of a millimetre is not suddenly one of µm."""
    return _text(mm, FreeCAD.Units.Quantity(10, LENGTH))


def position_text(mm):
    """The same, with as many places always, so that digits stay where they are."""
    per_unit, unit = _shown(FreeCAD.Units.Quantity(10, LENGTH))
    return f"{_not_minus_zero(mm / per_unit, 3 if per_unit < 10 else 4):.{3 if per_unit < 10 else 4}f} {unit}"


def feed_text(mm_min):
    return _text(mm_min / 60, FreeCAD.Units.Quantity(10, SPEED))


def _text(value, like):
    per_unit, unit = _shown(like)
    return f"{_not_minus_zero(value / per_unit, 4):.4f}".rstrip("0").rstrip(".") + f" {unit}"


def _shown(like):
    """How much of FreeCAD's own unit one is of what is shown for a quantity, and what that is called."""
    return like.getUserPreferred()[1:]


def _not_minus_zero(value, places):
    return round(value, places) + 0.0


def time_text(seconds):
    if round(seconds, 1) < 60:
        return f"{seconds:.1f} s"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest:02} s"

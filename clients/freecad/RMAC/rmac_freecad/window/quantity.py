"""Fields for lengths and feeds, in the unit that FreeCAD shows; their values are mm and mm/min, whatever that is."""

import FreeCAD
import FreeCADGui


def quantity_field(unit, value=0.0, lowest=None, highest=None):
    """`unit`: FreeCAD's own for the quantity, mm or mm/s."""
    field = FreeCADGui.UiLoader().createWidget("Gui::QuantitySpinBox")
    field.setProperty("unit", unit)
    if lowest is not None:
        field.setProperty("minimum", lowest)
    if highest is not None:
        field.setProperty("maximum", highest)
    set_value(field, value)
    return field


def value_of(field):
    return float(field.property("rawValue"))


def set_value(field, value):
    field.setProperty("rawValue", float(value))


def length_text(mm):
    return FreeCAD.Units.Quantity(mm, FreeCAD.Units.Length).UserString


def feed_text(mm_min):
    return FreeCAD.Units.Quantity(mm_min / 60, FreeCAD.Units.Velocity).UserString


def time_text(seconds):
    minutes, rest = divmod(seconds, 60)
    return f"{minutes:.0f} min {rest:02.0f} s" if minutes else f"{seconds:.1f} s"

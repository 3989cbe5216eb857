"""Deviations in colours on the part: blue, material is missing; red, there is too much."""

import FreeCAD
import Part

BALL_MM = 0.6


def colour(off_mm, full_mm):
    """Blue over white to red; full at `full_mm`."""
    share = max(-1.0, min(1.0, off_mm / full_mm))
    return (1.0, 1.0 - share, 1.0 - share) if share >= 0 else (1.0 + share, 1.0 + share, 1.0)


def show_deviations(document, found, full_mm=None, label="Deviations", ball_mm=BALL_MM):
    """A ball at each measured place, coloured where there is a window, in one step that can be undone. Its values are in its property
    `Deviation`, mm. Colours are full at `full_mm`, or at the largest one."""
    document.openTransaction(f"Show {label}")
    shown = document.addObject("Part::Feature", "Deviations")
    shown.Label = label
    shown.Shape = Part.makeCompound([Part.makeSphere(ball_mm, FreeCAD.Vector(*one.place.point)) for one in found.touched])
    shown.addProperty("App::PropertyFloatList", "Deviation", "Measured", "mm, out of the material")
    shown.Deviation = found.off.tolist()
    if shown.ViewObject is not None:
        paint(shown, full_of(shown) if full_mm is None else full_mm)
    document.commitTransaction()
    return shown


def update_deviations(shown, found):
    """An object that `show_deviations` made of the same places: other values, and no step of its own."""
    shown.Deviation = found.off.tolist()
    if shown.ViewObject is not None:
        paint(shown, full_of(shown))
    shown.purgeTouched()


def full_of(shown):
    return max(map(abs, shown.Deviation), default=0.0) or 1.0


def paint(shown, full_mm):
    """An object that `show_deviations` made: in a window alone. A document that was saved without one has no colours."""
    shown.ViewObject.DisplayMode = "Shaded"
    shown.ViewObject.DiffuseColor = [(*colour(off, full_mm), 0.0) for off in shown.Deviation]

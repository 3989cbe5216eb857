"""What `recognise` found, in words, with the names of faces or edges and the dialog that machines or measures them."""

from collections.abc import Callable
from dataclasses import dataclass

from rmac_freecad.window.holes.drill_dialog import show as show_drill
from rmac_freecad.window.measuring.measure_dialog import show as show_measure
from rmac_freecad.window.operations.operations import show_pocket, show_profile, show_sweep


@dataclass(frozen=True)
class FoundRow:
    kind: str
    text: str
    names: tuple = ()  # of faces or edges
    button: str = ""
    does: Callable | None = None  # with the session; None where there is no dialog


def rows_of(found):
    rows = [FoundRow("Pocket", _pocket_text(one), (one.floor,), "Clear…", show_pocket) for one in found.recesses]
    rows += [FoundRow("Hole", _hole_text(one), one.faces, "Drill…", show_drill) for one in found.holes]
    if found.free_form:
        rows.append(FoundRow("Free form", _named(found.free_form), found.free_form, "Sweep…", show_sweep))
    if found.outline:
        rows.append(FoundRow("Outline", f"{len(found.outline)} edges round the underside", found.outline, "Cut along…", show_profile))
    if datums := (*found.tops, *found.sides):
        rows.append(FoundRow("Top and sides", _named(datums), datums, "Measure…", show_measure))
    return tuple(rows)


def _pocket_text(one):
    islands = f", {one.islands} island{'' if one.islands == 1 else 's'}" if one.islands else ""
    return f"{one.floor} at Z {one.z:.4g}, {one.top - one.z:.4g} mm deep{islands}"


def _hole_text(one):
    return f"Ø {one.diameter_mm:.4g} mm at X {one.x:.4g} Y {one.y:.4g}, {'through' if one.through else f'down to Z {one.bottom:.4g}'}"


def _named(names):
    return f"{', '.join(names[:4])}{f' and {len(names) - 4} more' if len(names) > 4 else ''}"

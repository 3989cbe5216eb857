"""A STEP file becomes the one solid that is to be machined."""

import pathlib

import FreeCAD
import Import
import Part

ASSEMBLY = b"NEXT_ASSEMBLY_USAGE_OCCURRENCE"
INCH_MM = 25.4
TINY_MM = 2.0  # who machines less than that has most likely the wrong unit
MOST_NAMED = 8


class PartRefused(Exception):
    """It says what to do."""


def open_step(file, name=None):
    """The object of the solid, in a new document, as large as the file says, whatever unit it has. `name` is the label of the solid where
    there are several, "Solid 1" and so on in an assembly. Refused, no document stays."""
    path = pathlib.Path(file)
    if not path.is_file():
        raise PartRefused(f"{path}: there is no such file")
    document = FreeCAD.newDocument(path.stem)
    try:
        return _only(document, path, name)
    except Exception:
        FreeCAD.closeDocument(document.Name)
        raise


def _only(document, path, name):
    try:
        (_insert_assembly if ASSEMBLY in path.read_bytes() else Import.insert)(str(path), document.Name)
    except Exception as error:  # FreeCAD raises whatever its reader throws
        raise PartRefused(f"{path.name} is no STEP file that FreeCAD reads: {str(error).strip() or type(error).__name__}") from error
    document.recompute()
    solids = _solids(document)
    if not solids:
        raise PartRefused(f"{path.name} holds no solid; surfaces alone do not tell where the material is: export the part as a solid")
    chosen = solids if name is None else [one for one in solids if one[0] == name]
    if len(chosen) != 1:
        labels = ", ".join(f"{label} ({_size(solid)})" for label, _, solid in solids[:MOST_NAMED])
        more = f" and {len(solids) - MOST_NAMED} more" if len(solids) > MOST_NAMED else ""
        asked = f"none of them is {name}; " if name is not None and not chosen else ""
        raise PartRefused(f"{path.name} holds {len(solids)} solid{'s' if len(solids) > 1 else ''}: {labels}{more}; {asked}name the one that is to be machined (name=)")
    label, feature, solid = chosen[0]
    if not solid.isValid():
        raise PartRefused(f"{label} of {path.name} is no sound solid; Part > Check geometry tells where: repair it, or export it anew")
    if len(feature.Shape.Solids) == 1:
        return feature
    alone = document.addObject("Part::Feature", "Solid")
    alone.Label, alone.Shape = label, solid
    document.recompute()
    return alone


def _insert_assembly(file, document):
    """Its solids where they stand, numbered as the file has them. `Import` of FreeCAD 0.20 ends FreeCAD where it reads an assembly."""
    for number, solid in enumerate(Part.read(file).Solids, 1):
        feature = FreeCAD.getDocument(document).addObject("Part::Feature", "Solid")
        feature.Label, feature.Shape = f"Solid {number}", solid


def _solids(document):
    """Label, object and shape of each, where it stands."""
    found = []
    for feature in document.Objects:
        if not feature.isDerivedFrom("Part::Feature") or any(one.isDerivedFrom("Part::Feature") for one in feature.OutList):
            continue  # a compound of others, which are looked at themselves
        solids = feature.Shape.Solids
        placed = feature.getGlobalPlacement() * feature.Placement.inverse()
        for number, solid in enumerate(solids, 1):
            moved = solid.copy()
            moved.Placement = placed * moved.Placement
            found.append((feature.Label if len(solids) == 1 else f"{feature.Label}.{number}", feature, moved))
    return found


def _size(shape):
    box = shape.BoundBox
    return f"{box.XLength:.4g} × {box.YLength:.4g} × {box.ZLength:.4g} mm"


def check_size(shape, machine):
    """`machine` as `client.machines` finds it. A part that cannot be right there is told before any path is planned."""
    box, volume = shape.BoundBox, machine.working_volume_mm
    lengths = box.XLength, box.YLength, box.ZLength
    if any(length > room for length, room in zip(lengths, volume)):
        inches = all(length / INCH_MM <= room for length, room in zip(lengths, volume)) and max(lengths) > 5 * max(volume)
        hint = f"; were it drawn in millimetres and exported as inches, it would be {', '.join(f'{length / INCH_MM:.4g}' for length in lengths)} mm" if inches else ""
        raise PartRefused(f"the part is {_size(shape)}, and {machine.name} has room for {' × '.join(f'{room:g}' for room in volume)} mm; choose a larger machine{hint}")
    if max(lengths) < TINY_MM:
        raise PartRefused(f"the part is {_size(shape)}; were it drawn in inches and exported as millimetres, it would be {max(lengths) * INCH_MM:.4g} mm long: look at the unit of the file")

"""The part of `./demo.sh cad` as its designer drew it: a block with a free-form face, a pocket with an island, and holes.

Two lengths of it are cells of a spreadsheet, by which the master model is corrected. Its STEP file tells of neither: who opens
it finds faces.
"""

import FreeCAD
import Import
import Part  # noqa: F401  its types of objects

LENGTH, WIDTH, HEIGHT = 60.0, 40.0, 12.0  # mm; the origin is the middle of the top
DIMENSIONS = {"PocketDepth": 4.0, "HoleDiameter": 8.0}
HOLES = ((6.0, -14.0), (24.0, -14.0), (6.0, 14.0), (24.0, 14.0))
STEP_X = 0.0  # to its left the face is free-form
# Heights of the free-form face, every 12 mm from X -39 and every 14 mm from Y -28.
HEIGHTS = ((-4.6, -3.9, -4.4, -3.8, -4.5), (-3.8, -2.6, -3.4, -2.4, -3.6), (-3.4, -1.7, -2.6, -1.5, -2.9), (-3.2, -1.4, -1.9, -1.6, -2.6), (-2.9, -1.6, -1.3, -1.5, -2.2))


def draw(name="designed"):
    """The designer's document. `Dimensions` is its spreadsheet, `Part` the whole."""
    document = FreeCAD.newDocument(name)
    sheet = document.addObject("Spreadsheet::Sheet", "Dimensions")
    for row, (alias, value) in enumerate(DIMENSIONS.items(), 1):
        sheet.set(f"A{row}", alias)
        sheet.set(f"B{row}", f"{value:g} mm")
        sheet.setAlias(f"B{row}", alias)
    document.recompute()
    block = _box(document, "Block", (-LENGTH / 2, -WIDTH / 2, -HEIGHT), (LENGTH, WIDTH, HEIGHT))
    above = document.addObject("Part::Feature", "AboveFace")
    above.Shape = _face().extrude(FreeCAD.Vector(0, 0, 20)).common(Part.makeBox(80, 80, 60, FreeCAD.Vector(STEP_X - 80, -40, -30)))
    hollow = document.addObject("Part::Cut", "Hollow")
    hollow.Base, hollow.Tool = _rounded(document, "Walls", (5.0, -7.5), (20.0, 15.0), 3.0), _rounded(document, "Island", (11.0, -2.0), (8.0, 4.0), 1.5)
    drills = [_drill(document, number, place) for number, place in enumerate(HOLES, 1)]
    away = document.addObject("Part::MultiFuse", "Away")
    away.Shapes = [above, hollow, *drills]
    part = document.addObject("Part::Cut", "Part")
    part.Base, part.Tool = block, away
    document.recompute()
    return document


def write_step(document, file):
    Import.export([document.Part], str(file))


def _face():
    surface = Part.BSplineSurface()
    surface.interpolate([[FreeCAD.Vector(-39 + 12 * i, -28 + 14 * j, z) for j, z in enumerate(row)] for i, row in enumerate(HEIGHTS)])
    return surface.toShape()


def _box(document, name, corner, size):
    box = document.addObject("Part::Box", name)
    box.Length, box.Width, box.Height = size
    box.Placement.Base = FreeCAD.Vector(*corner)
    return box


def _rounded(document, name, corner, size, radius):
    """A pocket's depth of it below the top, and some above."""
    box = _box(document, name + "Box", (*corner, 0), (*size, 1))
    box.setExpression("Height", "Dimensions.PocketDepth + 5 mm")
    box.setExpression("Placement.Base.z", "-Dimensions.PocketDepth")
    document.recompute()
    rounded = document.addObject("Part::Fillet", name)
    rounded.Base = box
    upright = [number for number, edge in enumerate(box.Shape.Edges, 1) if abs(edge.tangentAt(edge.FirstParameter).z) > 0.5]
    rounded.Edges = [(number, radius, radius) for number in upright]
    return rounded


def _drill(document, number, place):
    drill = document.addObject("Part::Cylinder", f"Drill{number}")
    drill.setExpression("Radius", "Dimensions.HoleDiameter / 2")
    drill.Height = HEIGHT + 10
    drill.Placement.Base = FreeCAD.Vector(*place, -HEIGHT - 5)
    return drill

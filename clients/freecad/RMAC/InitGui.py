# FreeCAD runs this file at the start of its window, as text: it has no name and no place of its own.
import FreeCADGui
from rmac_freecad.window import RmacWorkbench, add_preferences

add_preferences()
FreeCADGui.addWorkbench(RmacWorkbench())

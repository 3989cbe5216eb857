# FreeCAD reads this file at its start, with this folder on Python's path already: `import rmac_freecad` needs no more.

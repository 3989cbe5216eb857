"""FreeCAD's side of an RMAC appliance, usable without a window."""

from rmac_freecad import client_package

client_package.require()

"""FreeCAD's window runs this file (clients/freecad/tests/window/start.py): the part that the demo measured, in colours, and its paths. RMAC_DEMO_OUT is
the folder with `part.FCStd`; freecad.png is written there."""

import os
import pathlib
import traceback

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui

OUT = pathlib.Path(os.environ["RMAC_DEMO_OUT"])
SIZE = 1300, 850
SETTLED_MS = 1500
STDERR = 2


def draw():
    from rmac_freecad.master import colours

    document = FreeCAD.openDocument(str(OUT / "part.FCStd"))
    shown = next(one for one in document.Objects if hasattr(one, "Deviation"))
    part = next(one for one in document.Objects if one.isDerivedFrom("Part::Feature") and one is not shown and one.Shape.Solids)
    part.ViewObject.Transparency = 25
    part.ViewObject.ShapeColor = (0.72, 0.75, 0.8)
    colours.paint(shown, colours.full_of(shown))
    view = FreeCADGui.ActiveDocument.ActiveView
    view.setAxisCross(True)
    view.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    QtCore.QTimer.singleShot(SETTLED_MS, lambda: finish(lambda: shoot(view)))


def shoot(view):
    view.saveImage(str(OUT / "freecad.png"), *SIZE, "White")
    if not (OUT / "freecad.png").is_file():
        raise RuntimeError("FreeCAD wrote no picture")


def finish(what, last=True):
    code = 1
    try:
        what()
        code = 0
    except BaseException:
        os.write(STDERR, traceback.format_exc().encode())
    if last or code:
        QtGui.QApplication.processEvents()
        os._exit(code)


QtCore.QTimer.singleShot(0, lambda: finish(draw, last=False))

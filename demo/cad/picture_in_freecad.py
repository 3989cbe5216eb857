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
FEWEST_COLOURS = 50
STDERR = 2


def draw():
    from rmac_freecad.master import colours

    document = FreeCAD.openDocument(str(OUT / "part.FCStd"))
    shown = next(one for one in document.Objects if hasattr(one, "Deviation"))
    part = next(one for one in document.Objects if one.isDerivedFrom("Part::Feature") and one is not shown and one.Shape.Solids)
    for one in document.Objects:
        if one.ViewObject is not None:
            one.ViewObject.Visibility = one in (part, shown)  # a document that was saved without a window has nothing visible
    part.ViewObject.Transparency = 25
    part.ViewObject.ShapeColor = (0.72, 0.75, 0.8)
    colours.paint(shown, colours.full_of(shown))
    view = FreeCADGui.ActiveDocument.ActiveView
    view.viewIsometric()
    FreeCADGui.SendMsgToActiveView("ViewFit")
    QtCore.QTimer.singleShot(SETTLED_MS, lambda: finish(lambda: shoot(view)))


def shoot(view):
    file = OUT / "freecad.png"
    view.saveImage(str(file), *SIZE, "White")
    picture = QtGui.QImage(str(file))
    colours_in = {picture.pixel(x, y) for x in range(0, picture.width(), 5) for y in range(0, picture.height(), 5)}
    if len(colours_in) < FEWEST_COLOURS:
        file.unlink(missing_ok=True)
        raise RuntimeError(f"FreeCAD's picture has {len(colours_in)} colours: nothing is on it")


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

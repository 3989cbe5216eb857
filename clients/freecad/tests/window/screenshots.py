"""Draws the pictures of docs/freecad.md: RMAC_BUILD=… RMAC_SOURCE=… PYTHONPATH=clients/freecad/RMAC start.py screenshots.py"""

import os
import pathlib
import sys
import traceback
import unittest

from PySide import QtCore, QtGui

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parent)]
IMAGES = pathlib.Path(os.environ["RMAC_SOURCE"]) / "docs/images/freecad"


def shoot(name, *widgets):
    """The whole screen, or what the widgets cover of it."""
    QtGui.QApplication.processEvents()
    picture = QtGui.QGuiApplication.primaryScreen().grabWindow(0)
    if widgets:
        area = QtCore.QRect()
        for widget in widgets:
            area = area.united(widget.frameGeometry())
        picture = picture.copy(area)
    IMAGES.mkdir(exist_ok=True)
    if not picture.toImage().convertToFormat(QtGui.QImage.Format_Indexed8).save(str(IMAGES / f"{name}.png")):
        raise AssertionError(f"{name}.png was not written")


def run():
    code = 1
    try:
        import screens

        result = unittest.main(screens, argv=["freecad"], exit=False, verbosity=2).result
        code = 0 if result.testsRun > 0 and result.wasSuccessful() else 1
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ != "screenshots":  # FreeCAD runs it; `screens` imports it
    QtCore.QTimer.singleShot(0, run)

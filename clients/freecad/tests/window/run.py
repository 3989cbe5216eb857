"""FreeCAD runs this file in its window: the tests of one module, RMAC_TEST."""

import os
import pathlib
import sys
import traceback
import unittest

from PySide import QtCore

HERE = pathlib.Path(__file__).parent


def run():
    code = 1
    try:
        sys.path[:0] = [str(HERE), str(HERE.parent)]
        result = unittest.main(os.environ["RMAC_TEST"], argv=["freecad", *os.environ.get("RMAC_TESTS", "").split()], exit=False, verbosity=2).result
        code = 0 if result.testsRun > 0 and result.wasSuccessful() else 1
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


QtCore.QTimer.singleShot(0, run)

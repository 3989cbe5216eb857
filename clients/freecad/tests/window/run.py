"""FreeCAD runs this file in its window: the tests of one module, RMAC_TEST; of them those that RMAC_TESTS names, or all."""

import faulthandler
import os
import pathlib
import sys
import traceback
import unittest

from PySide import QtCore

HERE = pathlib.Path(__file__).parent
BOUND_S = int(os.environ.get("RMAC_BOUND_S", "600"))
STDERR = 2  # FreeCAD's own one is no file


def run():
    """Nobody closes a window that hangs: it says where, and ends."""
    code = 1
    try:
        faulthandler.enable(file=STDERR)
        faulthandler.dump_traceback_later(BOUND_S, exit=True, file=STDERR)
        sys.path[:0] = [str(HERE), str(HERE.parent)]
        words = ["freecad", *os.environ.get("RMAC_TESTS", "").split()]
        result = unittest.main(os.environ["RMAC_TEST"], argv=words, exit=False, verbosity=2).result
        code = 0 if result.testsRun > 0 and result.wasSuccessful() else 1
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


QtCore.QTimer.singleShot(0, run)

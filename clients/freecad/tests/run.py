"""FreeCAD runs this file: the tests of one module, RMAC_TEST. FreeCAD's own exit code would tell nothing of them."""

import os
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent))
result = unittest.main(os.environ["RMAC_TEST"], argv=["freecad"], exit=False, verbosity=2).result
sys.stdout.flush()
sys.stderr.flush()
os._exit(0 if result.testsRun > 0 and result.wasSuccessful() else 1)

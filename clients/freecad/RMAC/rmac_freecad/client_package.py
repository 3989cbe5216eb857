"""Finds the Python package `rmac`, which talks to the appliance: as installed by pip, or beside this add-on in a checkout."""

import importlib.util
import pathlib
import sys

BESIDE = pathlib.Path(__file__).resolve().parents[3] / "python/src"


def require(beside=BESIDE):
    if importlib.util.find_spec("rmac") is not None:
        return
    if (beside / "rmac/__init__.py").is_file():
        sys.path.append(str(beside))
        return
    raise ImportError(
        "The Python package rmac is missing, which talks to the appliance. Install it for FreeCAD's Python "
        f"({sys.executable}) by pip install clients/python of the RMAC checkout, or link this add-on from that checkout instead of copying it."
    )

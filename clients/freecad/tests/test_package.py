"""The add-on as FreeCAD and its addon manager find it."""

import importlib.util
import pathlib
import sys
import unittest
from unittest import mock

import FreeCAD
from rmac_freecad import client_package

ADD_ON = pathlib.Path(client_package.__file__).parents[1]


class PackageTest(unittest.TestCase):
    def test_freecad_reads_what_the_addon_manager_needs(self):
        metadata = FreeCAD.Metadata(str(ADD_ON / "package.xml"))
        self.assertEqual(metadata.Name, "RMAC")
        self.assertEqual(metadata.Content["workbench"][0].FreeCADMin, "0.20.0")

    def test_rmac_beside_the_add_on_is_found(self):
        self.assertIsNotNone(importlib.util.find_spec("rmac"))

    def test_without_rmac_it_says_what_to_install(self):
        with mock.patch.object(importlib.util, "find_spec", return_value=None), self.assertRaisesRegex(ImportError, "pip install"):
            client_package.require(pathlib.Path("/nowhere"))

    def test_what_pip_installed_goes_before_what_lies_beside(self):
        before = list(sys.path)
        client_package.require(pathlib.Path("/nowhere"))
        self.assertEqual(sys.path, before)

"""The workbench in FreeCAD's window: toolbar, commands, preferences."""

import unittest

import FreeCADGui
from PySide import QtGui
from rmac_freecad.window.commands import COMMANDS


class WorkbenchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        FreeCADGui.activateWorkbench("RmacWorkbench")

    def test_the_toolbar_has_every_command_with_a_picture(self):
        window = FreeCADGui.getMainWindow()
        bar = window.findChild(QtGui.QToolBar, "Direct machining")
        self.assertIsNotNone(bar)
        self.assertEqual([action.text() for action in bar.actions()], ["Select machine…", "Jog…", "Machine a job…", "Simulate a job…", "Stop the machine"])
        for action in bar.actions():
            self.assertFalse(action.icon().pixmap(24, 24).isNull(), action.text())

    def test_jobs_need_a_document_and_stopping_does_not(self):
        by_name = {command.name: command for command in COMMANDS}
        self.assertTrue(by_name["RMAC_Stop"].IsActive())
        self.assertFalse(by_name["RMAC_Machine"].IsActive())

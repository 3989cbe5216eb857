"""The workbench in FreeCAD's window: toolbar, commands, preferences."""

import unittest

import FreeCAD
import FreeCADGui
from PySide import QtCore, QtGui
from rmac_freecad.station import Settings
from rmac_freecad.window.commands import COMMANDS
from rmac_freecad.window.session import session
from rmac_freecad.window.shown_machine import shown_machine
from windowed import MACHINE, WindowTest, process_until

import rmac  # isort: skip

EVERY_MS = 20


class ToolbarTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        FreeCADGui.activateWorkbench("RmacWorkbench")

    def test_the_toolbar_has_every_command_with_a_picture(self):
        window = FreeCADGui.getMainWindow()
        bar = window.findChild(QtGui.QToolBar, "Direct machining")
        self.assertIsNotNone(bar)
        self.assertEqual([action.text() for action in bar.actions()], ["Select machine…", "Jog…", "Open legacy code…", "Open a STEP part…", "Cut along edges…", "Clear a pocket…", "Drill holes…", "Sweep faces…", "Machine a job…", "Simulate a job…", "Measure a part…", "Compare with the model…", "Show the machine", "Stop the machine"])
        for action in bar.actions():
            self.assertFalse(action.icon().pixmap(24, 24).isNull(), action.text())

    def test_jobs_need_a_document_and_stopping_does_not(self):
        by_name = {command.name: command for command in COMMANDS}
        self.assertTrue(by_name["RMAC_Stop"].IsActive())
        self.assertFalse(by_name["RMAC_Machine"].IsActive())


class PreferencesTest(unittest.TestCase):
    def test_the_page_keeps_address_and_program(self):
        """The dialog holds up who opens it, so a timer fills it in."""
        timer = QtCore.QTimer()
        timer.timeout.connect(lambda: self.fill_in(QtGui.QApplication.activeModalWidget()))
        timer.start(EVERY_MS)
        FreeCADGui.showPreferences("RMAC", 0)
        timer.stop()
        self.assertEqual((Settings().address, Settings().rmac), ("unix:/run/rmac/rmacd.sock", "/opt/rmac"))

    def fill_in(self, dialog):
        if dialog is not None and (address := dialog.findChild(QtGui.QLineEdit, "address")) is not None:
            address.setText("unix:/run/rmac/rmacd.sock")
            dialog.findChild(QtGui.QWidget, "program").setProperty("fileName", "/opt/rmac")
            dialog.findChild(QtGui.QDialogButtonBox).button(QtGui.QDialogButtonBox.Ok).click()


class CommandsTest(WindowTest):
    def setUp(self):
        super().setUp()
        FreeCADGui.activateWorkbench("RmacWorkbench")
        Settings().address = self.address
        Settings().rmac = self.settings.rmac
        self.addCleanup(session().station.disconnect)

    def run_command(self, name, title):
        """The dialog that it opens."""
        FreeCADGui.runCommand(name)
        dialog = next(one for one in FreeCADGui.getMainWindow().findChildren(QtGui.QDialog) if one.windowTitle() == title and one.isVisible())
        self.dialogs.append(dialog)
        return dialog

    def test_select_lists_the_machines(self):
        dialog = self.run_command("RMAC_Select", "Machine search and selection")
        process_until(lambda: dialog.list.machines, lambda: dialog.message.text())

    def test_jog_knows_the_machine(self):
        dialog = self.run_command("RMAC_Jog", "Jog")
        process_until(lambda: dialog.rows, lambda: dialog.message.text())

    def test_simulate_simulates_the_document_s_job_at_once(self):
        self.profile()
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(1, 0.0, 2.5)
        self.told(self.run_command("RMAC_Simulate", "Machine a job"), "It takes")

    def test_open_legacy_code_needs_no_document(self):
        dialog = self.run_command("RMAC_Legacy", "Open legacy code")
        self.assertTrue(dialog.open_button.isEnabled())
        dialog.open_button.click()
        self.refused(dialog, "Choose a file")

    def test_measure_says_that_faces_are_to_be_selected(self):
        document = FreeCAD.newDocument("Empty")
        self.addCleanup(lambda: FreeCAD.closeDocument(document.Name))
        FreeCADGui.Selection.clearSelection()
        self.refused(self.run_command("RMAC_Measure", "Measure a part"), "nothing is selected")

    def test_machine_waits_for_cut(self):
        self.profile()
        dialog = self.run_command("RMAC_Machine", "Machine a job")
        process_until(lambda: dialog.headline.text(), lambda: dialog.message.text())
        self.assertFalse(dialog.machining.running)

    def test_the_machine_is_shown_until_the_button_is_pressed_again(self):
        document = FreeCAD.newDocument("Shown")
        self.addCleanup(lambda: FreeCAD.closeDocument(document.Name))
        shown = shown_machine(session())
        self.addCleanup(shown.leave)
        FreeCADGui.runCommand("RMAC_Animate")
        process_until(lambda: shown.follower is not None and shown.follower.model is not None, "the machine is drawn")
        head = shown.follower.model.objects["head"]
        self.assertEqual([one.Label for one in document.RootObjects], [MACHINE])
        before = head.Placement.Base.z
        with self.connect() as other, other.authority():
            other.run([rmac.MoveJoints((0, 0, -20))]).wait()
        process_until(lambda: abs(head.Placement.Base.z - before + 20) < 0.1, lambda: f"the head went down to {head.Placement.Base.z}")
        FreeCADGui.runCommand("RMAC_Animate")
        self.assertEqual(document.Objects, [])

    def test_stop_stops_who_else_moves_the_machine(self):
        other = self.connect()
        with other.authority():
            other.cam.SetFeedrate(1)
            other.cam.JogPath((1, 0, 0), 40)
            FreeCADGui.runCommand("RMAC_Stop")
            process_until(lambda: not other.state()["moving"], "it stopped")
            self.assertLess(other.state()["pose"][0], 39)


if __name__ == "__main__":
    unittest.main()

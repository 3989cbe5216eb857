"""A file of another control opened, shown, simulated and cut in FreeCAD's window, and what may go wrong."""

import shutil
import time
import unittest

import FreeCAD
import FreeCADGui
from legacy_file import AWAY, REFUSED_IN_ITS_MIDST, SLOT, file_of, folder_of, lines
from PySide import QtCore
from rmac_freecad.legacy import codes
from rmac_freecad.path import DONE, LIMITS
from rmac_freecad.station import Settings
from rmac_freecad.window.legacy.open_dialog import OpenDialog
from rmac_freecad.window.machines.search_dialog import SearchDialog
from rmac_freecad.window.running.machining_dialog import MachiningDialog
from windowed import WindowTest, process_until

import rmac

MANY = 500_000
PAUSE = "G21 M3 S800\nG0 X0 Y0 Z20\nG1 X1 F1000\nM0\nG1 X40 F1000\nM2\n"
LONG_LINE = "G21 M3 S800\nG0 X0 Y0 Z20\n\nG1 X40 F10\nG1 Y5 F1000\nM2\n"  # its fourth line takes long even in virtual time


def rounded(colour):
    return tuple(round(value, 2) for value in colour)


class LegacyTest(WindowTest):
    def setUp(self):
        super().setUp()
        Settings().rmac = self.settings.rmac  # objects that read by themselves are the window's
        with self.connect("set-up") as client:
            self.free(client)
            with client.authority():
                client.cam.SetFeedOverride(100)
                client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
                client.cam.SetTool(1, 0.0, 2.5)
        self.document = FreeCAD.newDocument("codes")
        self.addCleanup(lambda: self.document and FreeCAD.closeDocument(self.document.Name))

    def opening(self, content, name="Träger 1 (neu).ngc"):
        """The dialog that opens a file of that content, which is `self.file`."""
        self.file = file_of(self, content, name)
        dialog = self.opened(OpenDialog(self.session))
        dialog.file.setText(str(self.file))
        return dialog

    def code(self, content=SLOT, name="Träger 1 (neu).ngc"):
        dialog = self.opening(content, name)
        dialog.open_button.click()
        self.told(dialog, "is in the document")
        dialog.close()
        return codes(FreeCAD.ActiveDocument)[-1]

    def machining(self):
        dialog = self.opened(MachiningDialog(self.session))
        dialog.begin()
        process_until(lambda: dialog.headline.text() or dialog.message.refused, "the machine was looked at")
        dialog.at_machine_zero.setChecked(True)
        return dialog

    def state(self):
        return self.session.station.state

    def shown(self, code):
        """The path that the object itself shows, once it does."""
        process_until(lambda: code.ViewObject.Proxy.path is not None, "the path is shown")
        return code.ViewObject.Proxy.path

    def test_a_file_becomes_an_object_that_shows_its_path(self):
        code = self.code()
        self.assertEqual((code.Label, code.FileName, code.File), ("Träger 1 (neu).ngc", "Träger 1 (neu).ngc", str(self.file)))
        self.assertEqual(FreeCADGui.Selection.getSelection(), [code])
        self.shown(code)
        box = self.bounds(code)
        self.assertAlmostEqual(box[0], 0, 1)
        self.assertAlmostEqual(box[1], 20, 1)

    def bounds(self, code):
        """Least and greatest X of what is drawn of it."""
        from pivy import coin

        action = coin.SoGetBoundingBoxAction(coin.SbViewportRegion())
        action.apply(code.ViewObject.RootNode)
        box = action.getBoundingBox()
        return box.getMin()[0], box.getMax()[0]

    def test_what_the_import_refuses_is_told_with_line_and_column_and_nothing_is_opened(self):
        dialog = self.opening(REFUSED_IN_ITS_MIDST)
        dialog.open_button.click()
        self.refused(dialog, "Träger 1 (neu).ngc, line 4, column 3", "G76")
        self.assertEqual(self.document.Objects, [])
        dialog.tick()
        self.assertTrue(dialog.open_button.isEnabled())

    def test_what_a_file_does_not_say_is_given_in_the_dialog(self):
        dialog = self.opening(SLOT.replace("G21 ", ""), "slot.txt")
        dialog.open_button.click()
        self.refused(dialog, "choose RS274/NGC, Fanuc, Haas or APT")
        dialog.language.setCurrentText("RS274/NGC")
        dialog.open_button.click()
        self.refused(dialog, "--unit")
        dialog.unit.setCurrentText("inch")
        dialog.open_button.click()
        self.told(dialog, "is in the document")
        code = codes(self.document)[0]
        self.shown(code)
        self.assertAlmostEqual(self.bounds(code)[1], 20 * 25.4, 0)

    def test_opened_again_it_is_replaced_and_undone(self):
        code = self.code()
        self.shown(code)
        self.file.write_text(SLOT.replace("X20 Y-10", "X20.5 Y-10 ").replace("I0 J-10", "R12"))
        dialog = self.opened(OpenDialog(self.session))
        dialog.file.setText(str(self.file))
        dialog.open_button.click()
        self.told(dialog, "is in the document")
        self.assertEqual(codes(self.document), [code])
        process_until(lambda: abs(self.bounds(code)[1] - 20.5) < 0.1, "the new path is shown")
        self.document.undo()
        process_until(lambda: abs(self.bounds(code)[1] - 20) < 0.1, "the old path is shown")

    def test_a_simulated_file_tells_time_and_limits_and_colours_the_path(self):
        code = self.code()
        own = self.shown(code)
        dialog = self.machining()
        dialog.simulate_button.click()
        self.told(dialog, "It takes")
        self.assertGreater(dialog.limits.topLevelItemCount(), 0)
        colours = {rounded(dialog.view.colour(number)) for number in range(5)}
        self.assertTrue(colours & {rounded(colour) for colour in LIMITS.values()}, colours)
        self.assertEqual(code.ViewObject.Proxy._switch.whichChild.getValue(), -1)
        dialog.close()
        self.assertEqual(code.ViewObject.Proxy._switch.whichChild.getValue(), -3)
        self.assertIs(code.ViewObject.Proxy.path, own)

    def test_a_file_is_cut_and_its_tool_asked_for(self):
        with self.connect("set-up") as client, client.authority():
            other = 2 if client.cam.GetTools()["Mounted"] == 1 else 1
            client.cam.SetTool(other, 0.0, 1.0)
        self.code(SLOT.replace("T1", f"T{other}"))
        dialog = self.machining()
        dialog.cut_button.click()
        process_until(lambda: dialog.prompts.isVisible() and dialog.prompts.tool.value() == other, "the tool is asked for")
        dialog.prompts.confirm.click()
        self.told(dialog, "is cut")
        self.assertEqual(dialog.progress.value(), len(dialog.machining.program))
        self.assertEqual(rounded(dialog.view.colour(0)), DONE)
        self.assertEqual(str(dialog.machining.place), "Träger 1 (neu).ngc, line 13")
        self.assertEqual(len(self.document.Objects), 1)
        process_until(lambda: self.state()["authority"] == "", "authority is given back")

    def test_what_the_machine_refuses_is_told_by_its_line(self):
        self.code(AWAY)
        dialog = self.machining()
        dialog.simulate_button.click()
        self.refused(dialog, "Träger 1 (neu).ngc, line 4: ", "beyond its limit")

    def test_a_tool_that_the_table_lacks_is_added_with_length_and_diameter(self):
        self.code(SLOT.replace("T1", "T7"))
        dialog = self.machining()
        dialog.simulate_button.click()
        self.refused(dialog, "lacks tool 7", "line 4")
        row = dialog.tools.rows[0]
        row.length.set_quantity(12.5)
        row.diameter.set_quantity(6)
        row.add.click()
        process_until(lambda: not dialog.tools.rows, "the tool is in the table")
        client = self.connect("set-up")
        added = next(tool for tool in client.cam.GetTools()["Tools"] if tool["ToolNumber"] == 7)
        self.assertEqual((added["Length"], added["Radius"]), (12.5, 3))
        with client.authority():
            client.cam.RemoveTool(7)

    def test_hold_resume_and_override_act_in_mid_cut(self):
        self.code(PAUSE)
        dialog = self.machining()
        dialog.cut_button.click()
        process_until(lambda: self.state() and self.state()["state"] == "Holding", "the program's stop holds it")
        process_until(lambda: dialog.run.resume.isEnabled(), "it may be resumed")
        dialog.run.override.setValue(50)
        process_until(lambda: self.state()["override_percent"] == 50, "the override is the machine's")
        dialog.run.resume.click()
        self.told(dialog, "is cut")

    def in_mid_line(self):
        self.code(LONG_LINE)
        dialog = self.machining()
        dialog.cut_button.click()
        process_until(lambda: dialog.machining.program, "it is read")
        line = next(number for number, move in enumerate(dialog.machining.program.moves) if isinstance(move, rmac.Line))
        process_until(lambda: dialog.machining.done == line and self.state()["pose"][0] > 2 and self.state()["moving"], "the line is being cut")
        return dialog

    def test_a_stop_in_mid_cut_is_told_by_its_line_and_nothing_goes_on(self):
        dialog = self.in_mid_line()
        dialog.run.stop.click()
        self.refused(dialog, "line 4: ", "StopNow")
        self.assertFalse(dialog.machining.can_go_on)

    def test_a_lost_connection_in_mid_cut_is_gone_on_from(self):
        dialog = self.in_mid_line()
        self.session.station.client._connection._socket.shutdown(2)
        self.refused(dialog, "line 4: ", "connection")
        process_until(lambda: dialog.go_on_button.isVisible(), "it may go on")
        dialog.go_on_button.click()
        self.told(dialog, "is cut")
        self.assertAlmostEqual(self.connect().state()["joints"][1], 5, 2)

    def test_a_cut_that_is_stopped_or_closed_while_the_file_is_read_does_not_begin(self):
        code = self.code(PAUSE)
        for end in (lambda dialog: dialog.run.stop.click(), lambda dialog: dialog.close(), lambda dialog: self.session.station.stop(self.address)):
            code.Rapid -= 100  # so that it is read anew
            dialog = self.machining()
            dialog.cut_button.click()
            self.assertTrue(dialog.goes_on())
            end(dialog)
            process_until(lambda: not dialog.goes_on(), "it is dropped")
            self.settle()
            self.assertFalse(dialog.machining.running)
            self.assertIsNone(dialog.machining.program)
            dialog.hide()

    def settle(self):
        """Everything that was asked has answered."""
        answered = []
        self.session.station.ask(lambda: self.session.client().state(), answered.append)
        process_until(lambda: answered, "an answer")

    def test_a_saved_document_is_simulated_on_a_computer_that_lacks_the_file(self):
        code = self.code()
        self.shown(code)
        saved, elsewhere = folder_of(self) / "part.FCStd", folder_of(self) / "Teil ü.FCStd"
        self.document.saveAs(str(saved))
        FreeCAD.closeDocument(self.document.Name)
        shutil.move(saved, elsewhere)
        self.file.unlink()
        self.document = FreeCAD.openDocument(str(elsewhere))
        code = codes(self.document)[0]
        self.shown(code)
        self.assertAlmostEqual(self.bounds(code)[1], 20, 1)
        dialog = self.machining()
        dialog.simulate_button.click()
        self.told(dialog, "It takes")

    def test_a_file_that_was_changed_since_is_not_cut(self):
        code = self.code()
        self.file.write_text(SLOT.replace("X10", "X11"))
        dialog = self.machining()
        dialog.cut_button.click()
        self.refused(dialog, "was changed since it was opened")
        code.File = ""
        dialog.simulate_button.click()
        self.told(dialog, "It takes")

    def test_the_window_goes_on_while_a_long_file_is_read(self):
        dialog = self.opening(lines(MANY))
        told, at_s = [], []
        timer = QtCore.QTimer()
        timer.timeout.connect(lambda: (told.append(dialog.message.text()), at_s.append(time.monotonic())))
        timer.start(5)
        at_s.append(time.monotonic())
        dialog.open_button.click()
        self.told(dialog, "is in the document")
        timer.stop()
        at_s.append(time.monotonic())
        waited_s = max(b - a for a, b in zip(at_s, at_s[1:]))
        print(f"{MANY} lines were opened in {at_s[-1] - at_s[0]:.1f} s; the window waited for {waited_s:.2f} s at most")  # for docs/freecad.md
        steps = {text for text in told if "is read:" in text}
        self.assertGreater(len(steps), 10)
        self.shown(codes(self.document)[0])

    def test_a_dialog_that_was_closed_opens_nothing(self):
        dialog = self.opening(lines(20_000))
        dialog.open_button.click()
        dialog.close()
        self.settle()
        process_until(lambda: dialog._program is None or len(dialog._program) == 20_003, "it is read")
        self.settle()
        self.assertEqual(self.document.Objects, [])

    def test_a_document_that_was_closed_meanwhile_is_told(self):
        dialog = self.opening(lines(20_000))
        dialog.open_button.click()
        FreeCAD.closeDocument(self.document.Name)
        self.document = None
        self.refused(dialog, "closed meanwhile")

    def test_machines_are_ranked_by_it(self):
        self.code()
        search = self.opened(SearchDialog(self.session))
        search.connect_and_list()
        process_until(lambda: search.list.machines, "machines are listed")
        search.fits_button.click()
        self.told(search, "can cut it")

    def test_several_are_not_guessed_among(self):
        self.code(SLOT, "one.ngc")
        two = self.code(AWAY, "two.ngc")
        FreeCADGui.Selection.clearSelection()
        dialog = self.opened(MachiningDialog(self.session))
        dialog.begin()
        self.refused(dialog, "select one")
        FreeCADGui.Selection.addSelection(two)
        dialog.begin()
        process_until(lambda: "two.ngc on" in dialog.headline.text(), "the selected one is meant")


if __name__ == "__main__":
    unittest.main()

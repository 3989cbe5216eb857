"""What the tests of operations' dialogs share: a box, its faces selected, fields filled in, and the cut."""

import os
import tempfile

import FreeCAD
import FreeCADGui
from rmac_freecad.window.running.machining_dialog import show as show_machining
from windowed import WindowTest, process_until


class OperationTest(WindowTest):
    def setUp(self):
        super().setUp()
        self.stand_before_a_box("operations", 4)

    def face(self, z):
        return next(f"Face{number}" for number, face in enumerate(self.box.Shape.Faces, 1) if face.BoundBox.ZMin == face.BoundBox.ZMax == z)

    def dialog(self, kind, *names):
        for name in names:
            FreeCADGui.Selection.addSelection(self.document.Name, "Box", name)
        dialog = self.opened(kind(self.session))
        dialog.begin()
        return dialog

    def set(self, dialog, **values):
        for name, value in values.items():
            widget = dialog.fields[name].widget
            next(getattr(widget, setter) for setter in ("set_quantity", "setCurrentText", "setChecked", "setValue") if hasattr(widget, setter))(value)

    def saved_and_opened(self, dialog, listed):
        """What the dialog's operation shows, and the strokes that are shown of it when its document is opened again. `listed`: operations of its kind."""
        before = [stroke.points for stroke in self.shown(dialog)]
        dialog.close()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "Teil ü.FCStd")
            self.document.saveAs(file)
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(file)
        view = listed(self.document)[0].ViewObject.Proxy
        process_until(lambda: view.path is not None, "its path is shown")
        return before, [stroke.points for stroke in view.path._strokes]

    def deepest(self, dialog):
        return min(z for stroke in self.shown(dialog) for _, _, z in stroke.points)

    def machined(self, dialog):
        """Simulated, then cut to its end."""
        process_until(lambda: getattr(show_machining._dialog, "session", None) is self.session, "it is there")
        machining = show_machining._dialog
        self.dialogs.append(machining)
        process_until(lambda: machining.headline.text(), "the machine was looked at")
        machining.at_machine_zero.setChecked(True)
        self.told(machining, "It takes")
        self.press(dialog.cut_button)
        process_until(lambda: "is cut." in machining.message.text() or machining.message.refused or machining.prompts.isVisible(), lambda: machining.message.text())
        if machining.prompts.isVisible():
            machining.prompts.confirm.click()
            process_until(lambda: "is cut." in machining.message.text() or machining.message.refused, lambda: machining.message.text())
        self.assertIn(f"is kept in the document as {dialog.feature.Label}.rmac", machining.message.text())
        return machining

"""A STEP part opened in the window, and what was found on it taken to the dialogs that machine it."""

import pathlib
import tempfile
import unittest

import FreeCAD
import FreeCADGui
import Part
from FreeCAD import Vector
from rmac_freecad.measuring.feature import is_measure
from rmac_freecad.pockets import is_pocket
from rmac_freecad.profiles import is_profile
from rmac_freecad.surfaces import is_sweep
from rmac_freecad.window.parts.part_dialog import PartDialog
from windowed import WindowTest, process_until


def bracket(x=0.0):
    """A pocket with an island, a through hole, and a low cone, which is swept soon."""
    block = Part.makeBox(60, 30, 12, Vector(x, 0, 0)).cut(Part.makeBox(20, 16, 10, Vector(x + 4, 7, 7)).cut(Part.makeCylinder(3, 20, Vector(x + 14, 15, 0))))
    return block.cut(Part.makeCylinder(2.5, 20, Vector(x + 34, 8, -4))).fuse(Part.makeCone(5, 4, 1, Vector(x + 50, 15, 12)))


class PartDialogTest(WindowTest):
    def setUp(self):
        super().setUp()
        FreeCADGui.activateWorkbench("RmacWorkbench")
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.addCleanup(lambda: [FreeCAD.closeDocument(name) for name in FreeCAD.listDocuments()])
        FreeCADGui.Selection.clearSelection()

    def dialog(self, *shapes, name="Träger ü.step"):
        file = self.folder / name
        if shapes:
            (shapes[0] if len(shapes) == 1 else Part.makeCompound(shapes)).exportStep(str(file))
        dialog = self.opened(PartDialog(self.session))
        dialog.file.setText(str(file))
        dialog.open_button.click()
        return dialog

    def found(self, dialog):
        process_until(lambda: dialog.rows or dialog.message.refused, lambda: dialog.message.text())
        return {one.kind: (number, one) for number, one in enumerate(dialog.rows)}

    def pressed(self, dialog, kind):
        """The dialog that it opens, and the object that that one made."""
        number, _ = self.found(dialog)[kind]
        before = {one.Name for one in dialog.part.Document.Objects}
        dialog.list.itemWidget(dialog.list.topLevelItem(number), 2).click()
        made, = [one for one in dialog.part.Document.Objects if one.Name not in before]
        opened = next(one for one in FreeCADGui.getMainWindow().findChildren(type(dialog).__mro__[1]) if one.isVisible() and getattr(one, "feature", None) == made)
        self.dialogs.append(opened)
        process_until(lambda: not made.ViewObject.Proxy.busy, "it is planned")
        return opened, made

    def test_what_was_found_is_listed_with_size_and_place(self):
        dialog = self.dialog(bracket())
        found = self.found(dialog)
        self.assertIn("60 × 30 × 13 mm", dialog.headline.text())
        self.assertRegex(found["Pocket"][1].text, r"Face\d+ at Z 7, 5 mm deep, 1 island")
        self.assertIn("Ø 5 mm at X 34 Y 8, through", found["Hole"][1].text)
        self.assertEqual(list(found), ["Pocket", "Hole", "Free form", "Outline", "Top and sides"])
        self.assertIn("are not found", dialog.message.text())

    def test_each_button_opens_its_dialog_on_what_was_found(self):
        dialog = self.dialog(bracket())
        for kind, is_one, title in (("Pocket", is_pocket, "Clear a pocket"), ("Free form", is_sweep, "Sweep faces"), ("Outline", is_profile, "Cut along edges"), ("Top and sides", is_measure, "Measure a part")):
            opened, made = self.pressed(dialog, kind)
            self.assertTrue(is_one(made), kind)
            self.assertEqual(opened.windowTitle(), title)
            self.assertIsNone(made.ViewObject.Proxy.error, kind)
            opened.close()

    def test_a_part_that_is_open_is_looked_at_where_it_is_selected(self):
        dialog = self.opened(PartDialog(self.session))
        dialog.look_button.click()
        self.refused(dialog, "Select one part")
        document = FreeCAD.newDocument("drawn")
        box = document.addObject("Part::Box", "Box")
        document.recompute()
        FreeCADGui.Selection.addSelection(box)
        dialog.look_button.click()
        self.assertEqual(list(self.found(dialog)), ["Outline", "Top and sides"])

    def test_files_that_are_none_and_several_solids_are_told(self):
        dialog = self.opened(PartDialog(self.session))
        dialog.open_button.click()
        self.refused(dialog, "Choose a file")
        self.refused(self.dialog(name="gone.step"), "no such file")
        (self.folder / "broken.step").write_text("nothing of the kind")
        self.refused(self.dialog(name="broken.step"), "broken.step")
        dialog = self.dialog(bracket(), bracket(80))
        self.refused(dialog, "holds 2 solids")
        dialog.solid.setText(dialog.message.text().split(", ")[1].split(" (")[0])
        dialog.open_button.click()
        self.found(dialog)
        self.assertAlmostEqual(dialog.part.Shape.BoundBox.XMin, 80, 6)

    def test_a_part_that_is_too_large_for_the_machine_is_told_and_listed_all_the_same(self):
        self.session.machine = self.connect().machine()
        dialog = self.dialog(bracket().scale(3))
        self.refused(dialog, "has room for", "larger machine")
        self.assertTrue(dialog.rows)

    def test_a_part_that_is_gone_is_told(self):
        dialog = self.dialog(bracket())
        number, _ = self.found(dialog)["Pocket"]
        FreeCAD.closeDocument(dialog.part.Document.Name)
        dialog.list.itemWidget(dialog.list.topLevelItem(number), 2).click()
        self.refused(dialog, "not there any more")
        self.assertEqual(dialog.rows, ())


if __name__ == "__main__":
    unittest.main()

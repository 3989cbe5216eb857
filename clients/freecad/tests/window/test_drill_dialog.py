"""Holes in their dialog: listed, chosen by diameter, previewed, run dry and cut, and what is told instead."""

import unittest

import FreeCAD
import FreeCADGui
import numpy as np
import Part
from drilled_part import box_with_holes
from operating import OperationTest
from rmac_freecad.holes import drillings
from rmac_freecad.parts import recognise
from rmac_freecad.window.holes.drill_dialog import DrillDialog
from rmac_freecad.window.parts.found_rows import rows_of
from windowed import process_until


class DrillDialogTest(OperationTest):
    def setUp(self):
        super().setUp()
        self.part = self.document.addObject("Part::Feature", "Plate")
        self.part.Shape = box_with_holes()

    def opened_on(self, *names, part="Plate"):
        for name in names or ("",):
            FreeCADGui.Selection.addSelection(self.document.Name, part, name)
        dialog = self.opened(DrillDialog(self.session))
        dialog.begin()
        return dialog

    def rows(self, dialog):
        """What is listed of each diameter, and of each hole."""
        return {item.text(0): (item.text(5), [item.child(number).text(5) for number in range(item.childCount())]) for item in dialog.holes.groups()}

    def drilled_at(self, dialog):
        return {tuple(round(value, 3) for value in point[:2]) for stroke in self.shown(dialog) for point in stroke.points}

    def previewed(self, dialog, **values):
        self.set(dialog, **values)
        self.press(dialog.preview_button)
        return self.drilled_at(dialog)

    def test_a_part_lists_its_holes_and_drills_the_diameters_that_are_ticked(self):
        dialog = self.opened_on()
        self.assertEqual(self.drilled_at(dialog), {(8, 8), (50, 8), (8, 22)})
        self.assertIn("Holes of Plate: Plate", dialog.headline.text())
        self.assertIn("3 holes are drilled.", dialog.message.text())
        self.assertEqual(list(self.rows(dialog)), ["Ø 4 mm", "Ø 5 mm", "Ø 6 mm", "Ø 8 mm", "Ø 9 mm"])
        self.assertEqual(self.rows(dialog)["Ø 4 mm"], ("not chosen", ["its axis leans by 90° from Z; turn the part until it stands upright"]))
        self.assertEqual(self.rows(dialog)["Ø 5 mm"][0], "3 of 3 drilled")
        dialog.holes.tick(5, False)
        dialog.holes.tick(8)
        self.assertEqual(self.previewed(dialog, Diameter=8), {(30, 20)})
        self.assertEqual(self.rows(dialog)["Ø 8 mm"][1], ["down to Z 5 mm; the point has no room below, so its tip stops there"])
        self.assertEqual((len(drillings(self.document)), list(dialog.feature.Diameters)), (1, [8]))

    def test_chosen_holes_that_are_not_drilled_are_told_at_their_row_and_all_together(self):
        dialog = self.opened_on()
        self.shown(dialog)
        for diameter in (4, 6, 9):
            dialog.holes.tick(diameter)
        self.previewed(dialog, Predrill=True)
        self.assertIn("4 holes are drilled; 2 chosen ones are not", dialog.message.text())
        self.assertTrue(self.rows(dialog)["Ø 6 mm"][1][0].startswith("not drilled: it opens below"))
        self.assertEqual(self.rows(dialog)["Ø 4 mm"][0], "0 of 1 drilled")
        self.set(dialog, Diameter=20)
        self.press(dialog.cut_button)
        self.refused(dialog, "no hole is drilled", "take a drill that is")
        self.assertEqual(self.rows(dialog)["Ø 5 mm"][0], "0 of 3 drilled")

    def test_values_that_make_no_sense_are_told_and_put_right(self):
        dialog = self.opened_on()
        self.shown(dialog)
        for values, word in (({"Depth": -1}, "depth_mm"), ({"Depth": 0, "Point": 5}, "20 to 180"), ({"Point": 118, "Cycle": "in pecks", "Peck": 0}, "peck"), ({"Peck": 2, "Reach": -1}, "reach_mm")):
            self.set(dialog, **values)
            self.press(dialog.cut_button)
            self.refused(dialog, word)
            self.assertTrue(self.rows(dialog), "what was listed stays")
        self.assertEqual(len(self.previewed(dialog, Reach=0)), 3)

    def test_a_drill_of_the_machine_s_table_is_taken(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(7, 0.0, 4.0, "drill 8")
        dialog = self.opened_on()
        self.shown(dialog)
        process_until(dialog.tools.isEnabled, "the table is there")
        index = next(number for number in range(dialog.tools.count()) if "drill 8" in dialog.tools.itemText(number))
        dialog.tools.activated.emit(index)
        dialog.holes.tick(5, False)
        dialog.holes.tick(8)
        self.assertEqual(self.previewed(dialog), {(30, 20)})
        self.assertEqual((dialog.feature.Tool, dialog.feature.Diameter.Value), (7, 8))

    def test_it_is_run_dry_and_cut(self):
        dialog = self.opened_on()
        self.set(dialog, Cycle="in pecks", Dwell=0.2)
        self.press(dialog.simulate_button)
        self.shown(dialog)
        self.assertIn("Holes of Plate, hole ", str(self.machined(dialog).machining.place))

    def test_what_is_no_hole_is_told_and_nothing_is_made(self):
        FreeCADGui.Selection.clearSelection()
        dialog = self.opened(DrillDialog(self.session))
        dialog.begin()
        self.refused(dialog, "nothing is selected")
        line = next(f"Edge{number}" for number, edge in enumerate(self.part.Shape.Edges, 1) if isinstance(edge.Curve, Part.Line))
        self.refused(self.opened_on(line), "no circle")
        FreeCADGui.Selection.clearSelection()
        dialog = self.opened_on(part="Box")
        self.refused(dialog, "no hole whose wall")
        self.assertFalse(dialog.cut_button.isEnabled())
        self.assertEqual(drillings(self.document), [])

    def test_a_saved_one_is_shown_when_its_document_is_opened(self):
        before, after = self.saved_and_opened(self.opened_on(), drillings)
        np.testing.assert_allclose(np.concatenate(after), np.concatenate(before), atol=1e-9)

    def test_inches_are_shown_and_given(self):
        units = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units")
        self.addCleanup(FreeCAD.Units.setSchema, units.GetInt("UserSchema", 0))
        FreeCAD.Units.setSchema(3)
        dialog = self.opened_on()
        self.shown(dialog)
        self.assertIn("Ø 0.1969 in", list(self.rows(dialog))[1].replace('"', "in"))
        dialog.fields["Depth"].widget.setValue(0.1)
        self.press(dialog.preview_button)
        self.assertAlmostEqual(min(z for stroke in self.shown(dialog) for _, _, z in stroke.points), 12 - 2.54, 9)

    def test_a_hole_of_a_stranger_s_part_has_its_button(self):
        row = next(row for row in rows_of(recognise(self.part.Shape)) if row.kind == "Hole")
        for name in row.names:
            FreeCADGui.Selection.addSelection(self.document.Name, "Plate", name)
        dialog = row.does(self.session)
        self.dialogs.append(dialog)
        self.assertEqual(len(self.drilled_at(dialog)), 1)


if __name__ == "__main__":
    unittest.main()

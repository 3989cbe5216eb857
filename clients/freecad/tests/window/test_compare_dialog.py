"""What was measured held against its model in the window: figures, colours, corrections, and what is refused."""

import os
import re
import tempfile
import unittest
from types import SimpleNamespace

import FreeCAD
import FreeCADGui
import numpy as np
import Part
import Spreadsheet  # noqa: F401  its type of objects
from FreeCAD import Placement, Rotation, Vector
from measured_part import TURN_DEG, ZERO, MeasuredPartTest
from rmac_freecad.measuring import Touched, places_on
from rmac_freecad.measuring.kept import keep_measured
from rmac_freecad.surfaces.machining import placed_shape
from rmac_freecad.window.measuring.compare_dialog import TAKEN, CompareDialog
from rmac_freecad.window.measuring.views import MeasuredView
from windowed import process_until

LIES = Placement(Vector(0.1, -0.05, 0.03), Rotation(Vector(0, 0, 1), 0.1))


def colours(shown):
    return [tuple(round(value, 3) for value in colour[:3]) for colour in shown.ViewObject.DiffuseColor]


class CompareTest(MeasuredPartTest):
    def kept(self, names, lies=LIES, off=lambda place: 0.0, count=4):
        """As if the part lay there, and its faces were off."""
        shape = placed_shape(self.part)
        places = places_on(shape, names, count=count, edge_mm=2, tip_radius_mm=1, clearance_mm=2, safe_mm=60)
        touched = [Touched(one, tuple(lies.multVec(Vector(*one.point)) + lies.Rotation.multVec(Vector(*one.normal)) * off(one))) for one in places]
        kept = keep_measured(self.part, SimpleNamespace(tip_radius_mm=1.0, stood=shape), touched, "CMM", ZERO)
        MeasuredView(kept.ViewObject)
        return kept

    def compared(self, *chosen):
        FreeCADGui.Selection.clearSelection()
        for one in chosen:
            FreeCADGui.Selection.addSelection(one)
        dialog = self.opened(CompareDialog(self.session))
        dialog.begin()
        return dialog

    def fits(self, dialog):
        self.assertIsNone(dialog.message.refused, dialog.message.text())
        return dialog

    def stands(self, lies):
        np.testing.assert_allclose(self.part.getGlobalPlacement().Matrix.A, lies.Matrix.A, atol=1e-6)


class CompareDialogTest(CompareTest):
    def test_figures_tell_how_far_it_is_off_and_what_is_left_where_it_lies(self):
        top = self.top()
        kept = self.kept(self.held(), off=lambda place: 0.02 if place.face == top else 0.0)
        dialog = self.fits(self.compared(kept))
        self.assertRegex(dialog.figures.text(), r"As it was taken to lie: rms 0\.\d{4} mm, worst [+-]0\.1\d* mm")
        self.assertRegex(dialog.figures.text(), r"middle is off by X \+0\.\d{4} ± ")
        self.assertIn(f"20 places on 5 faces of {self.part.Label}, by CMM", dialog.headline.text())
        self.assertRegex(dialog.figures.text(), r"Where it lies: rms 0\.0000 mm, worst [+-]0\.0000 mm")  # the top alone tells its height
        self.stands(Placement())

    def test_deviations_are_shown_in_colours_and_follow_what_is_asked_for(self):
        top, bore = self.top(), self.face()
        kept = self.kept([*self.held(), bore], Placement(), lambda place: 0.03 if place.face == bore else 0.0)
        dialog = self.fits(self.compared(kept))
        dialog.faces.tick(bore, False)
        shown = dialog.shown
        self.assertEqual([round(off, 6) for off, face in zip(shown.Deviation, kept.Face) if face == bore], [0.03] * 4)
        self.assertEqual({colour for colour, face in zip(colours(shown), kept.Face) if face == bore}, {(1.0, 0.0, 0.0)})
        self.assertEqual({colour for colour, face in zip(colours(shown), kept.Face) if face == top}, {(1.0, 1.0, 1.0)})
        self.assertIn("full at 0.0300 mm", dialog.scale.text())
        row = dialog.faces.topLevelItem(dialog.comparison.faces.index(bore))
        self.assertEqual([row.text(column) for column in (1, 2, 3)], ["4", "+0.0300 mm", "+0.0300 mm"])
        count = len(self.document.Objects)
        dialog.colours.setCurrentText(TAKEN)
        dialog.compare()
        self.assertEqual((len(self.document.Objects), dialog.shown), (count, shown), "the same balls, other colours")

    def test_the_placement_is_corrected_in_one_step_that_can_be_undone(self):
        dialog = self.fits(self.compared(self.kept(self.held())))
        steps = self.document.UndoCount
        dialog.placement_button.click()
        self.told(dialog, "stands where it lies")
        self.stands(LIES)
        self.assertEqual(self.document.UndoCount, steps + 1)
        self.assertFalse(dialog.placement_button.isEnabled())
        self.refused(self.compared(dialog.kept), "does not stand where it stood", "corrected already")
        self.document.undo()
        self.stands(Placement())
        self.fits(self.compared(dialog.kept))

    def test_a_face_that_is_clicked_is_shown(self):
        dialog = self.fits(self.compared(self.kept(self.held())))
        dialog.faces.itemClicked.emit(dialog.faces.topLevelItem(0), 0)
        chosen, = FreeCADGui.Selection.getSelectionEx()
        self.assertEqual((chosen.Object, chosen.SubElementNames), (self.part, (self.top(),)))

    def test_nothing_that_was_measured_is_told_and_the_last_one_is_taken_where_nothing_is_selected(self):
        self.refused(self.compared(), "nothing was measured in this document", "Measure a part")
        first, second = self.kept(self.held()), self.kept(self.held())
        for chosen, taken in (((), second), ((first,), first), ((self.part,), second)):
            self.assertEqual(self.fits(self.compared(*chosen)).kept, taken)

    def test_fewer_places_than_the_fit_needs_are_told_and_shown_all_the_same(self):
        dialog = self.compared(self.kept(self.held(), count=1))
        self.refused(dialog, "5 places were measured", "takes six")
        self.assertIn("As it was taken to lie: rms", dialog.figures.text())
        self.assertEqual(len(dialog.shown.Deviation), 5)
        self.assertFalse(dialog.placement_button.isEnabled() or dialog.frame_button.isEnabled())

    def test_what_the_places_leave_free_is_told_by_its_name(self):
        self.refused(self.compared(self.kept([self.top()], count=9)), "do not hold its ", "place along ", "another way")
        dialog = self.fits(self.compared(self.kept(self.held())))
        for normal in ((1, 0, 0), (-1, 0, 0)):
            dialog.faces.tick(self.face(normal), False)
        self.refused(dialog, "place along X")
        dialog.faces.tick(self.face((1, 0, 0)))
        self.fits(dialog)
        self.assertTrue(dialog.placement_button.isEnabled())

    def test_a_part_that_was_changed_or_moved_since_is_told(self):
        kept = self.kept(self.held())
        dialog = self.fits(self.compared(kept))
        self.part.Placement = Placement(Vector(0.01, 0, 0), Rotation())
        dialog.placement_button.click()
        self.refused(dialog, "does not stand where it stood")
        self.part.Placement = Placement()
        shape = self.part.Shape
        self.part.Shape = shape.cut(shape.translated(Vector(0, 0, 19.9)))
        self.refused(self.compared(kept), "was changed since it was measured", "measure it anew")
        self.part.Shape = shape
        self.fits(self.compared(kept))
        self.document.removeObject(self.part.Name)
        self.refused(self.compared(kept), "is gone")

    def test_what_was_saved_is_compared_on_another_day(self):
        surface = Part.BSplineSurface()
        surface.interpolate([[Vector(-24 + 12 * i, -18 + 12 * j, 18 + np.sin(i) + np.cos(j)) for j in range(4)] for i in range(5)])
        self.part.Shape = self.part.Shape.common(surface.toShape().extrude(Vector(0, 0, -40))).rotated(Vector(1, 2, 3), Vector(0, 0, 1), 10)
        self.document.recompute()
        up = next(f"Face{number}" for number, face in enumerate(self.part.Shape.Faces, 1) if face.Surface.TypeId == "Part::GeomBSplineSurface")
        walls = [f"Face{number}" for number, face in enumerate(self.part.Shape.Faces, 1) if face.Surface.TypeId == "Part::GeomPlane" and abs(face.normalAt(0, 0).z) < 0.1]
        before = self.fits(self.compared(self.kept([up, *walls])))
        figures, shown = before.figures.text().splitlines()[0], colours(before.shown)
        before.close()
        with tempfile.TemporaryDirectory() as folder:
            self.document.saveAs(os.path.join(folder, "Teil ü.FCStd"))
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(os.path.join(folder, "Teil ü.FCStd"))
        self.part = self.document.getObjectsByLabel("Block")[0]
        again = self.fits(self.compared())
        self.assertEqual(again.figures.text().splitlines()[0], figures)
        self.assertEqual([len(one) for one in (colours(again.shown), self.document.Objects)], [len(shown), 3], "the balls are those that were saved")
        stood = self.part.Placement
        again.placement_button.click()
        self.stands(LIES * stood)

    def test_a_part_within_another_is_moved_to_where_it_lies(self):
        holder = self.document.addObject("App::Part", "Holder")
        holder.addObject(self.part)
        holder.Placement = stood = Placement(Vector(3, 2, 1), Rotation(Vector(0, 0, 1), 20))
        self.document.recompute()
        dialog = self.fits(self.compared(self.kept(self.held())))
        dialog.placement_button.click()
        self.told(dialog, "stands where it lies")
        self.stands(LIES * stood)
        holder.Placement = Placement()
        self.refused(self.compared(dialog.kept), "does not stand where it stood")

    def test_a_result_or_a_document_that_is_gone_meanwhile_is_told(self):
        dialog = self.fits(self.compared(self.kept(self.held())))
        self.document.removeObject(dialog.kept.Name)
        dialog.placement_button.click()
        self.refused(dialog, "not there any more")
        dialog = self.fits(self.compared(self.kept(self.held())))
        FreeCAD.closeDocument(self.document.Name)
        self.document = None
        dialog.frame_button.click()
        self.refused(dialog, "not there any more")

    def test_an_appliance_that_is_not_there_is_told(self):
        dialog = self.fits(self.compared(self.kept(self.held())))
        self.settings.address = "127.0.0.1:1"
        dialog.frame_button.click()
        self.refused(dialog, "Edit > Preferences > RMAC")


class AtTheMachineTest(CompareTest):
    def measured(self):
        dialog = self.dialog(*self.held())
        self.press(dialog.measure_button)
        self.told(dialog, "were touched")
        return dialog.kept

    def test_in_the_corrected_frame_the_part_lies_as_it_is_drawn(self):
        dialog = self.fits(self.compared(self.measured()))
        self.assertGreater(abs(dialog.comparison.taken.worst), 0.02)
        dialog.frame_button.click()
        self.told(dialog, "turned by")
        turned = float(re.search(r"turned by ([\d.]+)°", dialog.message.text()).group(1))
        self.assertAlmostEqual(turned, TURN_DEG, delta=0.001)
        again = self.fits(self.compared(self.measured()))
        self.assertLess(abs(again.comparison.taken.worst), 2e-3)
        frame = self.connect().cam.GetPartFrame()
        np.testing.assert_allclose(frame["q"][1:3], 0, atol=1e-12, err_msg="upright")

    def test_a_frame_is_corrected_once_and_the_part_not_moved_as_well(self):
        dialog = self.fits(self.compared(self.measured()))
        dialog.frame_button.click()
        self.told(dialog, "was moved by")
        frame = self.connect().cam.GetPartFrame()
        process_until(dialog.frame_button.isEnabled, "it may be pressed again")
        dialog.frame_button.click()
        self.refused(dialog, "set anew, or corrected already", "Measure anew")
        self.assertEqual(self.connect().cam.GetPartFrame(), frame)
        dialog.placement_button.click()
        self.refused(dialog, "would correct it twice")
        self.stands(Placement())

    def test_another_station_that_has_authority_is_told(self):
        dialog = self.fits(self.compared(self.kept(self.held())))
        with self.connect("lathe hand").authority():
            dialog.frame_button.click()
            self.refused(dialog, "Another station", "lathe hand")
        self.assertTrue(dialog.frame_button.isEnabled())


class ParametersTest(CompareTest):
    def drawn(self):
        """A block with a pocket, whose depth and width are cells of a spreadsheet."""
        add = self.document.addObject
        self.sheet = sheet = add("Spreadsheet::Sheet", "Dimensions")
        for number, (alias, value) in enumerate((("Depth", "5 mm"), ("Width", "14 mm"), ("Twice", "=Depth * 2"), ("Count", "3")), 1):
            sheet.set(f"A{number}", value)
            sheet.setAlias(f"A{number}", alias)
        self.document.recompute()
        block, pocket, part = add("Part::Box", "Block"), add("Part::Box", "Pocket"), add("Part::Cut", "Plate")
        block.Length, block.Width, block.Height, block.Placement.Base = 40, 30, 20, Vector(-20, -15, 0)
        pocket.Width, pocket.Height, pocket.Placement.Base = 12, 10, Vector(-7, -6, 15)
        pocket.setExpression("Length", "Dimensions.Width")
        pocket.setExpression("Placement.Base.z", "20 mm - Dimensions.Depth")
        part.Base, part.Tool = block, pocket
        self.document.recompute()
        self.floor = next(f"Face{number}" for number, face in enumerate(part.Shape.Faces, 1) if abs(face.CenterOfMass.z - 15) < 1e-6)
        return part

    def outer(self, normal):
        return max((f"Face{number}" for number, face in enumerate(self.part.Shape.Faces, 1) if face.normalAt(0, 0).dot(Vector(*normal)) > 0.99),
                   key=lambda name: self.part.getSubObject(name).Area)  # fmt: skip

    def kept_deeper(self, by):
        names = [self.floor, *(self.outer(normal) for normal in ((0, 0, 1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)))]
        return self.kept(names, off=lambda place: -by if place.face == self.floor else 0.0)

    def test_sizes_that_are_ticked_are_corrected_in_one_step_that_can_be_undone(self):
        dialog = self.fits(self.compared(self.kept_deeper(0.08)))
        listed = [dialog.lengths.topLevelItem(number).text(0) for number in range(dialog.lengths.topLevelItemCount())]
        self.assertEqual(listed, ["Dimensions.Depth", "Dimensions.Width"], "what is computed, or no length, is none")
        dialog.lengths_button.click()
        self.refused(dialog, "Tick the sizes")
        dialog.lengths.tick("Dimensions.Depth")
        steps, volume = self.document.UndoCount, self.part.Shape.Volume
        dialog.lengths_button.click()
        self.told(dialog, "Depth 5 mm is 5.0800 ± ")
        self.assertAlmostEqual(self.sheet.Depth.Value, 5.08, 4)
        self.assertAlmostEqual(self.part.Shape.Volume, volume - 14 * 12 * 0.08, 1)
        self.assertEqual(self.document.UndoCount, steps + 1)
        self.refused(self.compared(dialog.kept), "was changed since it was measured")
        self.document.undo()
        self.document.recompute()
        self.assertEqual(self.sheet.Depth.Value, 5)
        self.fits(self.compared(dialog.kept))

    def test_a_size_that_no_place_tells_is_refused_and_stays(self):
        dialog = self.fits(self.compared(self.kept_deeper(0.08)))
        dialog.lengths.tick("Dimensions.Width")
        dialog.lengths_button.click()
        self.refused(dialog, "do not hold its Width")
        self.assertEqual(self.sheet.Width.Value, 14)

    def test_a_part_that_is_computed_from_others_may_be_moved_and_one_without_sizes_has_no_button(self):
        dialog = self.fits(self.compared(self.kept_deeper(0.0)))
        self.assertTrue(dialog.lengths_button.isVisible())
        dialog.placement_button.click()
        self.told(dialog, "stands where it lies")
        self.document.undo()
        self.part = self.document.addObject("Part::Feature", "Solid")
        self.part.Shape = self.document.Plate.Shape.copy()
        self.assertFalse(self.fits(self.compared(self.kept_deeper(0.0))).lengths_button.isVisible())


if __name__ == "__main__":
    unittest.main()

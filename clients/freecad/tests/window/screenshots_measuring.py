"""Draws the pictures of measuring in docs/freecad.md. Run as the tests of the window are, with RMAC_TEST=screenshots_measuring."""

import FreeCADGui
from measured_part import MeasuredPartTest
from rmac_freecad.window.measuring.compare_dialog import CompareDialog
from rmac_freecad.window.measuring.measure_dialog import MeasureDialog
from shooting import Shooting, shoot
from windowed import process_until


class PlacesScreens(Shooting, MeasuredPartTest):
    def places(self):
        self.begin()
        self.part.ViewObject.Transparency = 40
        self.select(*self.held(), self.face())
        dialog = self.placed(MeasureDialog(self.session), 1030, 560)
        dialog.resize(505, 380)
        dialog.begin()
        dialog.built_in.setChecked(True)
        process_until(dialog.measure_button.isEnabled, "the places are there")
        return dialog


class MeasuringScreens(PlacesScreens):
    PACE = "real-time"  # so that one is seen in its midst

    def test_a_picture_in_its_midst(self):
        dialog = self.places()
        FreeCADGui.Selection.clearSelection()
        self.seen(2)
        dialog.measure_button.click()
        process_until(lambda: dialog.measuring.done >= 6, lambda: dialog.message.text())
        FreeCADGui.Selection.clearSelection()
        shoot("measure")
        dialog.stop_button.click()
        self.refused(dialog, "place")


class ComparedScreens(PlacesScreens):
    def test_a_picture_of_what_was_found(self):
        dialog = self.places()
        dialog.measure_button.click()
        self.told(dialog, "were touched")
        dialog.close()
        dialog.feature.ViewObject.Visibility = dialog.kept.ViewObject.Visibility = False
        compared = self.placed(CompareDialog(self.session), 910, 520)
        compared.resize(620, 430)
        compared.begin()
        compared.colours.setCurrentText("as it was taken to lie")
        compared.compare()
        FreeCADGui.Selection.clearSelection()
        self.seen(3)
        shoot("compare")

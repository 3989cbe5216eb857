"""Draws the pictures of measuring in docs/freecad.md. Run as the tests of the window are, with RMAC_TEST=screenshots_measuring."""

import FreeCADGui
from measured_part import MeasuredPartTest
from rmac_freecad.window.measuring.measure_dialog import MeasureDialog
from shooting import Shooting, shoot
from windowed import process_until


class MeasuringScreens(Shooting, MeasuredPartTest):
    PACE = "real-time"  # so that one is seen in its midst

    def test_pictures(self):
        self.begin()
        self.part.ViewObject.Transparency = 40
        self.select(*self.held(), self.face())
        dialog = self.placed(MeasureDialog(self.session), 1030, 560)
        dialog.resize(505, 380)
        dialog.begin()
        dialog.built_in.setChecked(True)
        process_until(dialog.measure_button.isEnabled, "the places are there")
        FreeCADGui.Selection.clearSelection()
        self.seen(2)
        dialog.measure_button.click()
        process_until(lambda: dialog.measuring.done >= 6, lambda: dialog.message.text())
        FreeCADGui.Selection.clearSelection()
        shoot("measure")
        dialog.stop_button.click()
        self.refused(dialog, "place")

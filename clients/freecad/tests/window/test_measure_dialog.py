"""A part measured from the window on a machine in virtual time, and what may go wrong."""

import os
import tempfile
import unittest

import FreeCAD
import FreeCADGui
import numpy as np
import Part
import PartDesign  # noqa: F401  its types of objects
from measured_part import ZERO, MeasuredPartTest
from rmac_freecad.measuring.kept import measured_in, touched_of
from rmac_freecad.path import DONE
from rmac_freecad.window.jogging.jog_dialog import JogDialog
from rmac_freecad.window.measuring.measure_dialog import MeasureDialog
from windowed import process_until


class MeasureDialogTest(MeasuredPartTest):
    def measured(self, *names):
        dialog = self.dialog(*names)
        self.press(dialog.measure_button)
        self.told(dialog, "were touched")
        return dialog

    def test_places_are_shown_before_anything_moves_and_follow_the_fields(self):
        before = self.connect().state()["pose"]
        dialog = self.dialog(self.top(), self.face((1, 0, 0)))
        self.assertEqual(len(self.shown(dialog)), 8)
        self.told(dialog, "8 places on 2 faces")
        dialog.fields["Count"].widget.setValue(2)
        dialog.fields["Tip"].widget.set_quantity(2)
        self.press(dialog.preview_button)
        strokes = self.shown(dialog)
        self.assertEqual(len(strokes), 4)
        for stroke in strokes[:2]:
            self.assertEqual(max(z for *_, z in stroke.points), 30, "it crosses there")
            self.assertAlmostEqual(min(z for *_, z in stroke.points), 20, 9)
            self.assertAlmostEqual(max(z for *_, z in stroke.points[4:]), 24, 9, "a tip with a radius of 2 mm")
        np.testing.assert_allclose(self.connect().state()["pose"], before, atol=0.02, err_msg="it stands where it stood")

    def test_what_was_touched_is_kept_with_face_and_deviation_and_one_undo_takes_it_away(self):
        dialog = self.measured(*self.held())
        kept = dialog.kept
        self.assertEqual((len(kept.Deviation), set(kept.Face), kept.Machine, kept.Part), (20, set(self.held()), "CMM", self.part))
        self.assertEqual(list(kept.PartFrame), [*ZERO["p"], *ZERO["q"]])
        for one, off in zip(touched_of(kept), kept.Deviation):
            self.assertAlmostEqual(one.off_mm, off, 12)
        self.assertLess(max(map(abs, kept.Deviation)), 0.1)  # 0.2 degrees at 18 mm
        self.assertGreater(max(map(abs, kept.Deviation)), 0.02)
        self.assertEqual(dialog.progress.value(), 20)
        self.assertEqual([round(value, 2) for value in dialog.feature.ViewObject.Proxy.path.colour(0)], list(DONE))
        process_until(lambda: self.session.station.state["authority"] == "", "authority is given back")
        self.document.undo()
        self.assertEqual(measured_in(self.document), [])

    def test_a_saved_document_has_what_was_measured_to_its_last_digit(self):
        kept = self.measured(self.top()).kept
        before, label = touched_of(kept), kept.Label
        with tempfile.TemporaryDirectory() as folder:
            self.document.saveAs(os.path.join(folder, "Teil ü.FCStd"))
            FreeCAD.closeDocument(self.document.Name)
            self.document = FreeCAD.openDocument(os.path.join(folder, "Teil ü.FCStd"))
        again, = measured_in(self.document)
        self.assertEqual((touched_of(again), again.Label, again.Part.Label), (before, label, "Block"))
        process_until(lambda: again.ViewObject.Proxy.path is not None, "its places are shown")
        self.assertEqual(len(again.ViewObject.Proxy.path._strokes), len(before))

    def test_faces_of_a_body_that_are_picked_in_the_view_are_those_of_its_feature(self):
        body = self.document.addObject("PartDesign::Body", "Body")
        box = body.newObject("PartDesign::AdditiveBox", "Solid")
        self.document.recompute()
        FreeCADGui.Selection.addSelection(self.document.Name, "Body", "Solid.Face6")
        dialog = self.opened(MeasureDialog(self.session))
        dialog.begin()
        self.assertTrue(self.shown(dialog))
        self.assertEqual(dialog.feature.Faces, (box, ["Face6"]))

    def test_the_dialog_that_measured_is_opened_again_on_the_same_places(self):
        dialog = self.measured(self.top())
        feature = dialog.feature
        dialog.appear()
        self.shown(dialog)
        self.assertEqual(dialog.feature, feature)
        self.press(dialog.measure_button)
        process_until(lambda: len(measured_in(self.document)) == 2, lambda: dialog.message.text())

    def test_nothing_selected_edges_and_a_part_without_faces_are_told(self):
        self.refused(self.dialog(), "nothing is selected")
        dialog = self.dialog("Edge1")
        self.refused(dialog, "Block.Edge1 is no face")
        self.assertFalse(dialog.measure_button.isEnabled())
        self.assertEqual([one.Name for one in self.document.Objects], ["Block"])

    def test_values_that_make_no_sense_are_told_and_put_right(self):
        dialog = self.dialog(self.top())
        self.shown(dialog)
        for name, value, word in (("Tip", 0, "more than 0"), ("Safe", 19, "height to cross"), ("Edge", 18, "no place"), ("Count", 0, "1 place")):
            before = dialog.fields[name].widget.value()
            dialog.fields[name].widget.setValue(value)
            self.press(dialog.measure_button)
            self.refused(dialog, word)
            self.assertFalse(dialog.busy)
            dialog.fields[name].widget.setValue(before)
        self.press(dialog.preview_button)
        self.assertEqual(len(self.shown(dialog)), 4)

    def test_faces_that_are_gone_are_told(self):
        dialog = self.dialog(self.face())
        self.shown(dialog)
        self.part.Shape = Part.makeBox(40, 30, 20)  # has no bore
        self.document.recompute()
        self.press(dialog.measure_button)
        self.refused(dialog, "gone", "select faces anew")
        self.document.removeObject(self.part.Name)
        self.document.recompute()
        self.press(dialog.measure_button)
        self.refused(dialog, "the part is gone")

    def test_no_probe_in_the_spindle_is_told_before_anything_moves(self):
        dialog = self.dialog(self.top(), built_in=False)
        self.press(dialog.measure_button)
        self.refused(dialog, "No probe is in the spindle", "probe is built in")
        dialog.built_in.setChecked(True)
        client = self.connect("set-up")
        for radius, needs_spindle, words in ((1.0, True, ("No probe", "tool 7 (cutter)", "needs no spindle")), (1.3, False, ("tool 7 (cutter)", "1.3 mm", "1 mm"))):
            with client.authority():
                client.cam.SetTool(7, 0.0, radius, "cutter", NeedsSpindle=needs_spindle)
            self.mount(client, 7)
            self.press(dialog.measure_button)
            self.refused(dialog, *words)
        with client.authority():
            client.cam.SetTool(7, 0.0, 1.0, "probe", NeedsSpindle=False)
        self.press(dialog.measure_button)
        self.told(dialog, "were touched")
        self.mount(client, 0)

    def mount(self, client, number):
        self.free(client)
        with client.authority(), client.states() as states:
            if client.cam.GetTools()["Mounted"] == number:
                return
            client.start_cycle()
            client.cam.DoToolChange(number)
            while not next(states)["tool_prompt"]:
                pass
            client.cam.ConfirmToolChange(number)
            client.until_done()

    def test_a_machine_without_a_probe_is_told(self):
        dialog = self.dialog(self.top())
        with self.connect("set-up") as client, client.authority():
            client.load("DMACXYZ")
        self.press(dialog.measure_button)
        self.refused(dialog, "DMACXYZ has no probe that answers")

    def test_a_part_whose_group_was_moved_is_measured_where_it_stands_now(self):
        holder = self.document.addObject("App::Part", "Holder")
        holder.addObject(self.part)
        dialog = self.dialog(self.top())
        self.shown(dialog)
        holder.Placement = FreeCAD.Placement(FreeCAD.Vector(0, 0, 20), FreeCAD.Rotation())
        with self.connect("set-up") as client, client.authority():
            client.cam.SetPartFrame({"p": [0, 0, -60], "q": [1, 0, 0, 0]})
        dialog.fields["Safe"].widget.set_quantity(50)
        self.press(dialog.measure_button)
        self.told(dialog, "were touched")
        self.assertEqual({round(point.z, 6) for point in dialog.kept.Nominal}, {40})
        self.assertLess(max(map(abs, dialog.kept.Deviation)), 1e-3)

    def test_a_machine_in_virtual_mode_or_none_is_told(self):
        dialog = self.dialog(self.top())
        client = self.connect("set-up")
        with client.authority():
            client.load("CMM", virtual=True)
        self.press(dialog.measure_button)
        self.refused(dialog, "virtual mode")
        with client.authority():
            client.device.Unload()
        self.press(dialog.measure_button)
        self.refused(dialog, "No machine is loaded", "Select machine")

    def test_a_part_frame_that_was_not_set_is_asked_for(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
        dialog = self.dialog(self.top())
        self.press(dialog.measure_button)
        self.refused(dialog, "part's zero was not set", "Part zero here")
        self.assertFalse(dialog.busy)

    def test_what_the_machine_refuses_is_told_with_its_place_and_shown(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetPartFrame({"p": [0, 0, -60], "q": [1, 0, 0, 0]})
        dialog = self.dialog(self.top())
        self.press(dialog.measure_button)
        self.refused(dialog, "place 1 of 4, on ", "at X ", "touched where nothing was expected")
        chosen, = FreeCADGui.Selection.getSelectionEx()
        self.assertEqual((chosen.Object, chosen.SubElementNames), (self.part, (self.top(),)))
        self.assertEqual(measured_in(self.document), [])

    def test_another_station_that_has_authority_is_told(self):
        with self.connect("lathe hand").authority():
            dialog = self.dialog(self.top())
            self.press(dialog.measure_button)
            self.refused(dialog, "Another station", "lathe hand")

    def test_a_jog_dialog_that_has_the_machine_gives_it_back(self):
        jog = self.opened(JogDialog(self.session))
        jog.begin()
        process_until(lambda: jog.rows, "the machine is known")
        self.measured(self.top())

    def test_an_appliance_that_is_not_there_is_told(self):
        dialog = self.dialog(self.top())
        self.shown(dialog)
        self.settings.address = "127.0.0.1:1"
        self.press(dialog.measure_button)
        self.refused(dialog, "Edit > Preferences > RMAC")

    def test_a_part_that_was_deleted_meanwhile_is_told(self):
        dialog = self.dialog(self.top())
        self.press(dialog.measure_button)
        process_until(lambda: dialog.busy or dialog.kept, "it measures")
        self.document.removeObject(self.part.Name)
        self.refused(dialog, "was deleted")


class StopsTest(MeasuredPartTest):
    """In real time."""

    PACE = "real-time"

    def in_mid_measuring(self):
        dialog = self.dialog(*self.held())
        self.press(dialog.measure_button)
        process_until(lambda: dialog.measuring.done >= 1, lambda: dialog.message.text())
        return dialog

    def test_stop_is_at_hand_the_dialog_stays_and_nothing_is_kept(self):
        dialog = self.in_mid_measuring()
        dialog.close()
        self.assertTrue(dialog.isVisible())
        self.told(dialog, "Stop it first")
        self.assertFalse(dialog.measure_button.isEnabled())
        self.opened(jog := JogDialog(self.session)).begin()
        self.refused(jog, "A part is being measured")
        told = []
        self.session.machining.start([], lambda: None, told.append)
        process_until(lambda: told, "a cut is refused")
        self.assertIn("A part is being measured", str(told[0]))
        dialog.stop_button.click()
        self.refused(dialog, "of 20, on Face")
        self.assertEqual(measured_in(self.document), [])
        process_until(lambda: self.session.station.state["authority"] == "" and not self.session.station.state["moving"], "the machine rests")

    def test_a_connection_that_is_lost_is_told_with_the_place(self):
        dialog = self.in_mid_measuring()
        self.session.station.client.close()
        self.refused(dialog, "of 20, on Face", "comes to rest by itself", "measure anew")
        with self.connect("watch") as watch:
            self.free(watch)
        self.assertEqual(measured_in(self.document), [])


if __name__ == "__main__":
    unittest.main()

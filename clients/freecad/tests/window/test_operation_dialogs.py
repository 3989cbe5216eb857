"""Pockets, swept faces and profiles in their dialogs: values, preview, dry run and cut, and what is told instead."""

import unittest

import FreeCAD
import FreeCADGui
import Part
import Sketcher  # noqa: F401  its type of objects
from operating import OperationTest
from rmac_freecad.pockets import pockets
from rmac_freecad.profiles import profiles
from rmac_freecad.surfaces import sweeps
from rmac_freecad.window.operations.operations import PocketDialog, ProfileDialog, SweepDialog
from rmac_freecad.window.running.machining_dialog import show as show_machining
from windowed import process_until


class PocketDialogTest(OperationTest):
    def test_a_face_is_previewed_and_follows_the_fields(self):
        dialog = self.dialog(PocketDialog, self.face(4))
        self.assertEqual(self.deepest(dialog), 3)
        self.assertIn("Box Face", dialog.headline.text())
        self.assertRegex(dialog.message.text(), r"600 mm².* does not get into 5\.3\d mm² of it: 1\.3 mm² at X ")
        self.set(dialog, Depth=2.5, Diameter=6, Entry="ramp")
        self.press(dialog.preview_button)
        self.assertEqual(self.deepest(dialog), 1.5)
        self.assertAlmostEqual(min(x for stroke in self.shown(dialog) for x, _, _ in stroke.points), 3, 6)
        self.assertEqual((len(pockets(self.document)), dialog.feature.Depth.Value, dialog.feature.Entry), (1, 2.5, "ramp"))

    def test_it_is_run_dry_and_cut(self):
        dialog = self.dialog(PocketDialog, self.face(4))
        self.set(dialog, Depth=0.5, StepOver=2.4, Diameter=8)
        self.press(dialog.cut_button)
        process_until(lambda: getattr(show_machining._dialog, "session", None) is self.session and show_machining._dialog.message.refused, "it is told")
        self.assertIn("has a diameter of 5 mm in the tool table of DMACXYZ, and of 8 mm in Pocket of Box", show_machining._dialog.message.text())
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(1, 0.0, 4.0)
        self.press(dialog.simulate_button)
        self.shown(dialog)
        machining = self.machined(dialog)
        self.assertIn("Pocket of Box, ", str(machining.machining.place))

    def test_the_floor_of_a_part_is_as_deep_as_it_is(self):
        pocket = self.document.addObject("Part::Feature", "Tray")
        pocket.Shape = Part.makeBox(30, 20, 10).cut(Part.makeBox(24, 14, 5, FreeCAD.Vector(3, 3, 7)))
        floor = next(f"Face{number}" for number, face in enumerate(pocket.Shape.Faces, 1) if abs(face.BoundBox.ZMin - 7) + abs(face.BoundBox.ZMax - 7) < 1e-6)
        FreeCADGui.Selection.addSelection(self.document.Name, "Tray", floor)
        dialog = self.opened(PocketDialog(self.session))
        dialog.begin()
        self.assertEqual((dialog.fields["Top"].widget.quantity, dialog.fields["Depth"].widget.quantity), (10, 3))
        self.assertAlmostEqual(self.deepest(dialog), 7, 9)

    def test_values_that_make_no_sense_are_told_and_put_right(self):
        dialog = self.dialog(PocketDialog, self.face(4))
        self.shown(dialog)
        for values, word in (({"Depth": -1}, "depth"), ({"Depth": 0}, "depth"), ({"Diameter": 20.5, "Depth": 1}, "smaller"), ({"Diameter": 5, "StepOver": 4.9}, "4.75")):
            self.set(dialog, **values)
            self.press(dialog.cut_button)
            self.refused(dialog, word)
            self.assertIsNone(dialog.feature.ViewObject.Proxy.path)
        self.set(dialog, StepOver=2)
        self.press(dialog.preview_button)
        self.assertEqual(self.deepest(dialog), 3)

    def test_what_is_no_face_is_told_and_nothing_is_made(self):
        self.refused(self.dialog(PocketDialog), "nothing is selected")
        self.refused(self.dialog(PocketDialog, "Edge1"), "no single face")
        FreeCADGui.Selection.clearSelection()
        upright = next(f"Face{number}" for number, face in enumerate(self.box.Shape.Faces, 1) if face.BoundBox.ZMin != face.BoundBox.ZMax)
        dialog = self.dialog(PocketDialog, upright)
        self.refused(dialog, "not level")
        self.assertFalse(dialog.cut_button.isEnabled())
        self.assertEqual(pockets(self.document), [])

    def test_one_that_is_selected_is_shown_again_and_follows_its_part(self):
        dialog = self.dialog(PocketDialog, self.face(4))
        self.set(dialog, Depth=2)
        self.press(dialog.preview_button)
        self.shown(dialog)
        dialog.close()
        again = self.dialog(PocketDialog)
        self.assertEqual((again.feature, again.fields["Depth"].widget.quantity), (dialog.feature, 2))
        self.shown(again)
        self.box.Length = 40
        self.document.recompute()
        view = again.feature.ViewObject.Proxy
        process_until(lambda: view.path is not None and abs(max(x for s in view.path._strokes for x, _, _ in s.points) - 37.5) < 1e-6, "the path follows")

    def test_a_saved_one_is_shown_when_its_document_is_opened(self):
        before, after = self.saved_and_opened(self.dialog(PocketDialog, self.face(4)), pockets)
        self.assertEqual(after, before)

    def test_one_that_was_deleted_is_told(self):
        dialog = self.dialog(PocketDialog, self.face(4))
        self.shown(dialog)
        self.document.removeObject(dialog.feature.Name)
        self.press(dialog.preview_button)
        self.refused(dialog, "deleted")

    def test_inches_are_shown_and_given(self):
        units = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Units")
        self.addCleanup(FreeCAD.Units.setSchema, units.GetInt("UserSchema", 0))
        FreeCAD.Units.setSchema(3)
        dialog = self.dialog(PocketDialog, self.face(4))
        self.assertIn("in", dialog.fields["Depth"].widget.suffix() + dialog.fields["Depth"].widget.suffix().replace('"', "in"))
        dialog.fields["Depth"].widget.setValue(0.1)
        self.press(dialog.preview_button)
        self.assertAlmostEqual(self.deepest(dialog), 4 - 2.54, 9)


class OthersTest(OperationTest):
    def test_faces_are_swept_run_dry_and_cut(self):
        dialog = self.dialog(SweepDialog, self.face(4))
        self.set(dialog, Mill="flat end")
        self.press(dialog.simulate_button)
        self.shown(dialog)
        self.assertIn("nothing is left out", dialog.message.text())
        machining = self.machined(dialog)
        self.assertIn("Faces of Box, ", str(machining.machining.place))
        self.assertEqual(len(sweeps(self.document)), 1)

    def test_an_upright_face_is_swept_by_lead_and_tilt(self):
        wall = next(f"Face{number}" for number, face in enumerate(self.box.Shape.Faces, 1) if face.BoundBox.XMin == face.BoundBox.XMax > 0)
        dialog = self.dialog(SweepDialog, wall)
        self.refused(dialog, "less steep")
        self.set(dialog, Axis="by lead and tilt", Along="level", Tilt=50, Safe=20)
        self.press(dialog.preview_button)
        strokes = self.shown(dialog)
        self.assertIn("nothing is left out", dialog.message.text())
        self.assertGreater(len(strokes), 3)
        self.set(dialog, Lead=75, Tilt=75)
        self.press(dialog.preview_button)
        self.refused(dialog, "at most 80")

    def test_a_bull_nose_is_matched_to_the_face_and_the_passes_it_saves_are_told(self):
        dialog = self.dialog(SweepDialog, self.face(4))
        self.set(dialog, Axis="matched to the face", Mill="ball end")
        self.press(dialog.preview_button)
        self.refused(dialog, "bull_nose")
        self.set(dialog, Mill="bull nose", Safe=20)
        self.press(dialog.preview_button)
        self.shown(dialog)
        self.assertRegex(dialog.message.text(), "[0-9]+ passes instead of [0-9]+ with a ball end")

    def test_a_scallop_that_makes_no_sense_and_no_face_are_told(self):
        dialog = self.dialog(SweepDialog, self.face(4))
        self.set(dialog, Scallop=3)
        self.press(dialog.preview_button)
        self.refused(dialog, "quarter of the mill")
        FreeCADGui.Selection.clearSelection()
        self.refused(self.dialog(SweepDialog, "Edge1"), "Box.Edge1 is no face")

    def test_a_profile_is_previewed_beside_its_edges_run_dry_and_cut(self):
        top = [f"Edge{number}" for number, edge in enumerate(self.box.Shape.Edges, 1) if edge.BoundBox.ZMin == edge.BoundBox.ZMax == 4]
        dialog = self.dialog(ProfileDialog, *top)
        self.shown(dialog)
        self.set(dialog, Side="outside", Bottom=3.5, Step=0.5)
        self.press(dialog.simulate_button)
        self.assertAlmostEqual(max(x for stroke in self.shown(dialog) for x, _, _ in stroke.points), 32.5, 6)
        self.machined(dialog)
        self.assertEqual(len(profiles(self.document)), 1)


if __name__ == "__main__":
    unittest.main()

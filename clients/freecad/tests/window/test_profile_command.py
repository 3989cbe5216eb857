"""Selected edges and sketches become profiles in FreeCAD's window, are shown, simulated and cut."""

import unittest

import FreeCAD
import FreeCADGui
import Part
import Sketcher  # noqa: F401  its type of objects
from PySide import QtGui
from rmac_freecad.profiles import profiles
from rmac_freecad.window.running.machining_dialog import MachiningDialog
from windowed import WindowTest, process_until


class ProfileCommandTest(WindowTest):
    def setUp(self):
        super().setUp()
        self.stand_before_a_box("profiles", 10)

    def top_edges(self):
        return [f"Edge{number}" for number, edge in enumerate(self.box.Shape.Edges, 1) if edge.BoundBox.ZMin == edge.BoundBox.ZMax == 10]

    def profile(self):
        for name in self.top_edges():
            FreeCADGui.Selection.addSelection(self.document.Name, "Box", name)
        FreeCADGui.runCommand("RMAC_Profile")
        return profiles(self.document)[0]

    def reach(self, profile):
        view = profile.ViewObject.Proxy
        return max(x for stroke in view.path._strokes for x, _, _ in stroke.points) if view.path is not None else 0

    def told(self, *words):
        """By the message box, which is closed."""
        box = next(one for one in FreeCADGui.getMainWindow().findChildren(QtGui.QMessageBox) if one.isVisible())
        for word in words:
            self.assertIn(word, box.text())
        box.close()
        self.assertEqual(profiles(self.document), [])

    def test_selected_edges_become_a_profile_that_is_shown_and_follows_its_properties(self):
        profile = self.profile()
        self.assertEqual(FreeCADGui.Selection.getSelection(), [profile])
        process_until(lambda: abs(self.reach(profile) - 30) < 1e-9, "the path is shown")
        profile.Side = "outside"
        self.document.recompute()
        process_until(lambda: abs(self.reach(profile) - 32.5) < 1e-9, "the path is beside the edges")
        self.box.Length = 40
        self.document.recompute()
        process_until(lambda: abs(self.reach(profile) - 42.5) < 1e-9, "the path follows the box")

    def test_what_cannot_be_cut_shows_no_path_and_says_why(self):
        profile = self.profile()
        process_until(lambda: self.reach(profile), "the path is shown")
        profile.Side, profile.Diameter = "inside", 20.5
        self.document.recompute()
        process_until(lambda: profile.ViewObject.Proxy.path is None, "nothing is shown")
        self.assertIn("smaller", str(profile.ViewObject.Proxy.error))
        self.assertIn("Invalid", profile.State)

    def test_a_sketch_is_simulated_and_cut(self):
        sketch = self.document.addObject("Sketcher::SketchObject", "Sketch")
        sketch.addGeometry([Part.LineSegment(FreeCAD.Vector(0, 0), FreeCAD.Vector(20, 0)), Part.ArcOfCircle(Part.Circle(FreeCAD.Vector(20, 5), FreeCAD.Vector(0, 0, 1), 5), -1.5707963267948966, 1.5707963267948966)], False)  # fmt: skip
        self.document.recompute()
        FreeCADGui.Selection.addSelection(self.document.Name, "Sketch")
        FreeCADGui.runCommand("RMAC_Profile")
        dialog = self.opened(MachiningDialog(self.session))
        dialog.begin()
        process_until(lambda: dialog.headline.text(), "the machine was looked at")
        dialog.at_machine_zero.setChecked(True)
        dialog.simulate_button.click()
        process_until(lambda: "It takes" in dialog.message.text() or dialog.message.refused, lambda: dialog.message.text())
        self.assertIn("It takes", dialog.message.text())
        dialog.cut_button.click()
        process_until(lambda: "is cut." in dialog.message.text() or dialog.message.refused or dialog.prompts.isVisible(), lambda: dialog.message.text())
        if dialog.prompts.isVisible():
            dialog.prompts.confirm.click()
            process_until(lambda: "is cut." in dialog.message.text() or dialog.message.refused, lambda: dialog.message.text())
        self.assertIn("is kept in the document as Along Sketch.rmac", dialog.message.text())
        self.assertIn("Along Sketch, Edge", str(dialog.machining.place))

    def test_what_is_no_edge_and_no_sketch_is_told(self):
        FreeCADGui.runCommand("RMAC_Profile")
        self.told("nothing is selected")
        FreeCADGui.Selection.addSelection(self.document.Name, "Box", "Face1")
        FreeCADGui.runCommand("RMAC_Profile")
        self.told("Box.Face1", "select edges")
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(self.document.Name, "Box")
        FreeCADGui.runCommand("RMAC_Profile")
        self.told("no sketch")

    def test_edges_that_do_not_join_are_told_with_their_place(self):
        first, second = self.top_edges()[:2]
        for name in [first] + [f"Edge{number}" for number, edge in enumerate(self.box.Shape.Edges, 1) if edge.BoundBox.ZMax == 0][:1]:
            FreeCADGui.Selection.addSelection(self.document.Name, "Box", name)
        FreeCADGui.runCommand("RMAC_Profile")
        self.told("plane Z")


if __name__ == "__main__":
    unittest.main()

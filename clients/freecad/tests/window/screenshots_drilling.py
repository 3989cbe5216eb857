"""Draws the picture of drilled holes of docs/freecad.md. Run as the tests of the window are, with RMAC_TEST=screenshots_drilling."""

import FreeCAD
import FreeCADGui
import Part
from FreeCAD import Vector
from pivy import coin
from rmac_freecad.window.holes.drill_dialog import DrillDialog
from shooting import Shooting, shoot
from windowed import WindowTest, process_until


def flange():
    """A plate with a hub, six holes round it, two blind ones and one from the side."""
    ring = [Part.makeCylinder(2.5, 20, Vector(45, 30, -4) + FreeCAD.Rotation(Vector(0, 0, 1), 60 * number).multVec(Vector(20, 0, 0))) for number in range(6)]
    blind = [Part.makeCylinder(4, 20, Vector(x, y, 5)) for x, y in ((8, 8), (8, 52))]
    shape = Part.makeBox(90, 60, 12).fuse(Part.makeCylinder(12, 14, Vector(45, 30, 12)))
    for tool in (*ring, *blind, Part.makeCylinder(3, 15, Vector(90, 8, 6), Vector(-1, 0, 0))):
        shape = shape.cut(tool)
    return shape


class Screens(Shooting, WindowTest):
    def test_a_picture_of_holes(self):
        self.begin()
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(1, 62.0, 2.5, "drill 5")
        document = FreeCAD.newDocument("drill_example")
        self.addCleanup(FreeCAD.closeDocument, document.Name)
        part = document.addObject("Part::Feature", "Flange")
        part.Shape = flange()
        part.ViewObject.Transparency = 40
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(document.Name, "Flange")
        dialog = self.placed(DrillDialog(self.session), 780, 390)
        dialog.begin()
        process_until(dialog.preview_button.isEnabled, "the path is there")
        dialog.fields["Cycle"].widget.setCurrentText("in pecks")
        dialog.fields["Safe"].widget.set_quantity(14)
        dialog.holes.tick(6)
        dialog.preview_button.click()
        process_until(dialog.preview_button.isEnabled, "the path is there")
        FreeCADGui.Selection.clearSelection()
        self.seen(4)
        self.aside(0.42, -0.22)
        shoot("drill")

    def aside(self, right, up):
        """The camera, by so much of what it sees: the dialog stands beside the part."""
        camera = FreeCADGui.ActiveDocument.ActiveView.getCameraNode()
        high = camera.height.getValue()
        way = camera.orientation.getValue().multVec(coin.SbVec3f(right * high, up * high, 0))
        camera.position.setValue(camera.position.getValue() + way)
        self.settle()

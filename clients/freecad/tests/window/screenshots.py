"""Draws the pictures of docs/freecad.md: its ten minutes. Run as the tests of the window are, with RMAC_TEST=screenshots."""

import FreeCAD
import FreeCADGui
import Part
from legacy_file import file_of, folder_of
import PathScripts.PathProfile as PathProfile
from path_job import operation_of
from rmac_freecad.legacy import codes
from rmac_freecad.window.jogging.jog_dialog import JogDialog
from rmac_freecad.window.legacy.open_dialog import OpenDialog
from rmac_freecad.window.machines.search_dialog import SearchDialog
from rmac_freecad.window.operations.operations import PocketDialog, SweepDialog
from rmac_freecad.window.parts.part_dialog import PartDialog
from rmac_freecad.window.running.machining_dialog import MachiningDialog
from rmac_freecad.window.shown_machine import ShownMachine
from shooting import Shooting, hide_docks, shoot
from windowed import MACHINE, WindowTest, process_until

import rmac

# A wheel: its rim and four spokes, with a spline around the hub.
WHEEL = """%
#1 = 0
G21 G17 G90
G0 X30 Y0 Z5
M3 S800
G1 Z-1 F100
G3 I-30 J0 F600
G0 Z5
G0 X10 Y0
G1 Z-1 F100
G5 X0 Y10 I0 J8 P8 Q0 F600
G5 X-10 Y0 I-8 J0 P0 Q8
G5 X0 Y-10 I0 J-8 P-8 Q0
G5 X10 Y0 I8 J0 P0 Q-8
G0 Z5
o1 repeat [4]
  G0 X[12 * COS[#1]] Y[12 * SIN[#1]]
  G1 Z-1 F100
  G1 X[28 * COS[#1]] Y[28 * SIN[#1]] F600
  G0 Z5
  #1 = [#1 + 90]
o1 endrepeat
M2
%
"""


def tray():
    """A pocket with corners that are too narrow, and an island, 5 mm deep."""
    at = FreeCAD.Vector
    box = Part.makeBox(54, 34, 5, at(3, 3, 7))
    hollow = box.makeFillet(2, [edge for edge in box.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.5])
    return Part.makeBox(60, 40, 12).cut(hollow.cut(Part.makeCylinder(5, 9, at(22, 18, 5))))


def wave():
    """A block with a bent top."""
    surface = Part.BSplineSurface()
    heights = ((8, 9, 8, 10), (10, 7, 9, 8), (8, 10, 7, 9), (9, 8, 10, 8))
    surface.interpolate([[FreeCAD.Vector(12 * i, 9 * j, z) for j, z in enumerate(row)] for i, row in enumerate(heights)])
    return surface.toShape().extrude(FreeCAD.Vector(0, 0, -12)).common(Part.makeBox(36, 27, 20))


class Screens(Shooting, WindowTest):
    def test_pictures(self):
        self.show_job()
        self.search()
        self.jog()
        self.machine()
        self.legacy()

    def test_pictures_of_operations(self):
        window = FreeCADGui.getMainWindow()
        window.setGeometry(0, 0, 1600, 1000)
        FreeCADGui.activateWorkbench("RmacWorkbench")
        self.operation("pocket", PocketDialog, tray, 7, Diameter=6, StepDown=1.5, StepOver=3.5)
        self.operation("sweep", SweepDialog, wave, None, Diameter=4, Scallop=0.2)

    def test_a_picture_of_a_part(self):
        self.begin()
        file = str(folder_of(self) / "bracket.step")
        tray().cut(Part.makeCylinder(2.5, 20, FreeCAD.Vector(46, 18, -4))).exportStep(file)
        dialog = self.placed(PartDialog(self.session), 930, 500)
        dialog.file.setText(file)
        dialog.open_button.click()
        process_until(lambda: dialog.rows, lambda: dialog.message.text())
        dialog.file.setText("/home/me/parts/bracket.step")
        self.addCleanup(FreeCAD.closeDocument, dialog.part.Document.Name)
        self.seen(3)
        shoot("part")

    def test_a_picture_of_the_machine(self):
        window = FreeCADGui.getMainWindow()
        window.setGeometry(0, 0, 1600, 1000)
        FreeCADGui.activateWorkbench("RmacWorkbench")
        with self.connect("set-up") as client, client.authority():
            client.load("SuginoXYZAC", virtual=True)
            client.run([rmac.MoveJoints((60, -30, 40, 25, 30))]).wait()
            document = FreeCAD.newDocument("shown")
            self.addCleanup(FreeCAD.closeDocument, document.Name)
            shown = ShownMachine(self.session)
            self.addCleanup(shown.leave)
            shown.show(document)
            process_until(lambda: shown.follower is not None and shown.follower.model is not None, "the machine is drawn")
            FreeCADGui.ActiveDocument.ActiveView.viewIsometric()
            self.settle()
            FreeCADGui.SendMsgToActiveView("ViewFit")
            self.settle()
            shoot("machine")
            client.load(MACHINE)

    def operation(self, name, kind, shape, z, **values):
        for one in self.dialogs:
            one.close()
        document = FreeCAD.newDocument(f"{name}_example")
        self.addCleanup(FreeCAD.closeDocument, document.Name)
        part = document.addObject("Part::Feature", "Part")
        part.Shape = shape()
        part.ViewObject.Transparency = 40
        faces = list(enumerate(part.Shape.Faces, 1))
        number = next(i for i, face in faces if abs(face.CenterOfMass.z - z) < 1e-6) if z is not None else max(faces, key=lambda one: one[1].CenterOfMass.z)[0]
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(document.Name, "Part", f"Face{number}")
        dialog = self.placed(kind(self.session), 1030, 585)
        dialog.begin()
        process_until(dialog.preview_button.isEnabled, "the path is there")
        for field, value in values.items():
            dialog.fields[field].widget.set_quantity(value)
        dialog.preview_button.click()
        process_until(dialog.preview_button.isEnabled, "the path is there")
        FreeCADGui.Selection.clearSelection()
        view = FreeCADGui.ActiveDocument.ActiveView
        view.viewIsometric()
        hide_docks()
        self.settle()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        for _ in range(3):
            FreeCADGui.runCommand("Std_ViewZoomOut")
        self.settle()
        shoot(name)

    def show_job(self):
        window = FreeCADGui.getMainWindow()
        window.setGeometry(0, 0, 1600, 1000)
        FreeCADGui.activateWorkbench("RmacWorkbench")
        self.part_job = self.job()
        operation_of(self.part_job, PathProfile, "Profile", StepDown="2 mm")
        view = FreeCADGui.ActiveDocument.ActiveView
        view.viewIsometric()
        hide_docks()
        self.settle()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        for _ in range(4):  # the dialog stands beside it
            FreeCADGui.runCommand("Std_ViewZoomOut")

    def search(self):
        dialog = self.placed(SearchDialog(self.session), 150, 150)
        dialog.connect_and_list()
        process_until(lambda: dialog.list.machines, "machines are listed")
        dialog.fits_button.click()
        self.told(dialog, "can cut it")
        self.settle()
        shoot("search", dialog)
        dialog.close()

    def jog(self):
        with rmac.connect(self.address, "set-up") as client, client.authority():
            client.cam.SetTool(1, 0.0, 2.5)
            client.cam.Home()
            client.until_done()
        dialog = self.placed(JogDialog(self.session), 150, 150)
        dialog.begin()
        process_until(lambda: dialog.rows and self.session.station.state, "the machine is known")
        dialog.steps.step.set_quantity(20)
        for row, axis in ((0, 0), (1, 1)):
            dialog.rows[row].minus.click()
            process_until(lambda: abs(self.session.station.state["pose"][axis] + 20) < 0.01, "it is there")
        process_until(lambda: not self.session.station.state["moving"], "it rests")
        dialog.zero_button.click()
        process_until(lambda: "stands at" in dialog.part_zero.text(), "the part's zero is set")
        self.settle()
        shoot("jog", dialog)
        dialog.close()
        process_until(lambda: not self.session.station.state["authority"], "authority is given back")

    def machine(self):
        dialog = self.placed(MachiningDialog(self.session), 1000, 545)
        dialog.resize(540, 350)
        dialog.begin()
        process_until(lambda: dialog.headline.text(), "the machine was looked at")
        dialog.simulate_button.click()
        self.told(dialog, "It takes")
        self.settle()
        shoot("simulated")
        with rmac.connect(self.address, "set-up") as client:
            mounted = client.cam.GetTools()["Mounted"]
        dialog.cut_button.click()
        if mounted != 1:
            process_until(lambda: dialog.prompts.isVisible(), "the tool is asked for")
            self.settle()
            dialog.prompts.confirm.click()
        self.told(dialog, "is cut")
        self.settle()
        shoot("cut")

    def legacy(self):
        for one in self.dialogs:
            one.close()
        with rmac.connect(self.address, "set-up") as client, client.authority():
            client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
        FreeCAD.newDocument("wheel")
        dialog = self.placed(OpenDialog(self.session), 960, 130)
        dialog.file.setText(str(file_of(self, WHEEL, "wheel.ngc")))
        dialog.open_button.click()
        self.told(dialog, "is in the document")
        codes(FreeCAD.ActiveDocument)[0].File = "/home/me/parts/wheel.ngc"
        codes(FreeCAD.ActiveDocument)[0].purgeTouched()
        dialog.file.setText("/home/me/parts/wheel.ngc")
        machining = self.placed(MachiningDialog(self.session), 960, 545)
        machining.resize(540, 350)
        machining.begin()
        process_until(lambda: machining.headline.text(), "the machine was looked at")
        machining.simulate_button.click()
        self.told(machining, "It takes")
        view = FreeCADGui.ActiveDocument.ActiveView
        view.viewIsometric()
        hide_docks()
        self.settle()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        FreeCADGui.runCommand("Std_ViewZoomOut")
        self.settle()
        shoot("legacy")

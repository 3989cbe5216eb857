"""A block on the simulated measuring machine, and the same block drawn in a document."""

import contextlib
import json

import FreeCAD
import FreeCADGui
import Part
from FreeCAD import Vector
from windowed import Appliance, WindowTest

from rmac_freecad.window.measuring.measure_dialog import MeasureDialog

ZERO = {"p": [0, 0, -40], "q": [1, 0, 0, 0]}  # of the part, where its lower corner is drawn at Z 0
TURN_DEG = 0.2  # of the block on the machine, as its description has it


def block():
    return Part.makeBox(40, 30, 20, Vector(-20, -15, 0)).cut(Part.makeCylinder(8, 30, Vector(0, 0, 5)))


@contextlib.contextmanager
def described(folder):
    """A machine, to be changed."""
    file = folder / "device.json"
    device = json.loads(file.read_text())
    yield device
    file.write_text(json.dumps(device))


class MeasuredPartTest(WindowTest):
    MACHINE = "CMM"

    @classmethod
    def made_appliance(cls):
        """Whose bore is open above, so that a tip over it touches nothing, and whose mill has no probe."""
        appliance = Appliance(pace=cls.PACE, own_tree=True)
        with described(appliance.tree / "cmm/3-axis/CMM") as device:
            device["DigitalIOInterface"]["Parameters"]["part_bore_mm"][4] = 0
        with described(appliance.tree / "mill/3-axis/DMACXYZ") as device:
            del device["DigitalIOInterface"]["Inputs"]["Probe"]
        return appliance

    def setUp(self):
        super().setUp()
        FreeCADGui.activateWorkbench("RmacWorkbench")
        with self.connect("set-up") as client:
            self.free(client)
            with client.authority():
                if client.state()["mechanism"] not in (self.MACHINE, None):
                    client.device.Unload()  # else it would be a role of that one
                client.load(self.MACHINE)
                client.cam.SetPartFrame(ZERO)
        self.document = FreeCAD.newDocument("measured")
        self.addCleanup(lambda: self.document and FreeCAD.closeDocument(self.document.Name))
        self.part = self.drawn()
        self.document.recompute()
        FreeCADGui.Selection.clearSelection()

    def drawn(self):
        part = self.document.addObject("Part::Feature", "Block")
        part.Shape = block()
        return part

    def face(self, normal=None):
        """Looking that way; without, the bore."""
        kind = "Part::GeomPlane" if normal else "Part::GeomCylinder"
        return next(f"Face{number}" for number, face in enumerate(self.part.Shape.Faces, 1)
                    if face.Surface.TypeId == kind and (normal is None or face.normalAt(0, 0).dot(Vector(*normal)) > 0.99))  # fmt: skip

    def top(self):
        return next(f"Face{number}" for number, face in enumerate(self.part.Shape.Faces, 1) if abs(face.CenterOfMass.z - 20) < 1e-6)

    def held(self):
        """Faces that hold all freedoms."""
        return [self.top(), *(self.face(normal) for normal in ((-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0)))]

    def dialog(self, *names, built_in=True):
        self.select(*names)
        dialog = self.opened(MeasureDialog(self.session))
        dialog.begin()
        dialog.built_in.setChecked(built_in)
        return dialog

    def select(self, *names):
        FreeCADGui.Selection.clearSelection()
        for name in names:
            FreeCADGui.Selection.addSelection(self.document.Name, self.part.Name, name)

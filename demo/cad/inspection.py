"""What the person in FreeCAD does next: the part is measured, and the model corrected by it. Through `rmac_freecad` alone."""

import numpy as np
from rmac_freecad import master
from rmac_freecad.measuring import measure, places_on

TIP_RADIUS, CLEARANCE, SAFE_MM = 1.0, 1.5, 6.0
ZERO = (0.0, 0.0, -30.0)  # where the part was set on the measuring machine, as its user found it
HOLE_EDGE, FREE_EDGE = 2.0, 7.0  # from there on a face is measured
WIDE_MM2 = 15.0  # walls that are measured


class Inspection:
    """Of the part of a session. What it finds is for `verdict.py`."""

    def __init__(self, session):
        self.part, self.found, self.nominal = session.part, session.found, session.part.Shape.copy()
        self._client, self._step, self._say = session.client, session.steps.step, session.say

    def places(self):
        """Where the part will be measured: the free-form face, sides, floor and flat walls of the pocket, and the holes."""
        shape, recess, found = self.nominal, self.found.recesses[0], self.found
        common = {"tip_radius_mm": TIP_RADIUS, "clearance_mm": CLEARANCE, "safe_mm": SAFE_MM}
        walls = {name: shape.getElement(name) for name in recess.walls}
        flat = [name for name, wall in walls.items() if wall.Surface.TypeId == "Part::GeomPlane" and wall.Area > WIDE_MM2]
        under, top = shape.BoundBox.ZMin, shape.BoundBox.ZMax
        return [
            *places_on(shape, found.free_form, count=16, edge_mm=FREE_EDGE, **common),
            *places_on(shape, found.tops[:1], count=9, edge_mm=1.5, **common),
            *places_on(shape, found.sides, count=3, edge_mm=1.5, between_mm=(under + 1.0, under + 5.5), **common),
            *places_on(shape, [recess.floor], count=6, edge_mm=1.6, **common),
            *places_on(shape, flat, count=2, edge_mm=1.0, between_mm=(recess.z + 0.5, top), **common),
            *places_on(shape, [name for hole in found.holes for name in hole.faces], count=4, edge_mm=HOLE_EDGE, between_mm=(under + 1.0, top), **common),
        ]  # fmt: skip

    def load_cmm(self):
        with self._client.authority():
            self._client.drivers.Rescan()  # the part lies there now: in this simulated world, the description of the machine tells it
            self._client.load("CMM")
            self._client.cam.SetPartFrame({"p": list(ZERO), "q": [1, 0, 0, 0]})

    def touch(self, places):
        return measure(self._client, places, tip_radius_mm=TIP_RADIUS, clearance_mm=CLEARANCE, safe_mm=SAFE_MM)

    def measure_part(self, places):
        with self._step("load the measuring machine and measure"):
            self.load_cmm()
            self.touched = self.touch(places)
        self.before = master.deviations(self.nominal, self.touched)
        self._say(f"  {len(self.touched)} places; as the part was taken to lie: rms {1000 * self.before.rms:.1f} µm, worst {1000 * self.before.worst:+.1f} µm")

    def correct(self):
        """Where the part lies, by its datums: top, sides, and the pocket's walls. On the free-form face scallops stand; floor and holes are as deep
        and as wide as a tool is."""
        with self._step("fit where the part lies, correct the model"):
            aside = {*self.found.free_form, *self.sized()}
            self.datums = [one for one in self.touched if one.place.face not in aside]
            self.fit = master.fit_placement(self.nominal, self.datums)
            self.after = master.deviations(self.nominal, self.touched, self.fit.placement)
            self.frame = master.corrected_frame({"p": list(ZERO), "q": [1, 0, 0, 0]}, self.fit, upright=True)
            shown = master.show_deviations(self.part.Document, self.after)
            stood = self.part.Placement
            master.correct_placement(self.part, self.fit)
            self.moved = not _same(self.part.Placement, stood)
            self.part.Document.undo()
            self.undone = _same(self.part.Placement, stood)
            self.part.Document.redo()
            shown.Placement = self.part.Placement
        self._say(f"  {self.fit}")

    def sized(self):
        """Faces whose places tell a size that is to be corrected: the pocket's floor, and holes."""
        return [self.found.recesses[0].floor, *(name for hole in self.found.holes for name in hole.faces)]

    def measure_again(self, places):
        """In the corrected part frame."""
        with self._step("measure again in the corrected part frame"):
            with self._client.authority():
                self._client.cam.SetPartFrame(self.frame)
            self.again = master.deviations(self.nominal, self.touch(places))
        self._say(f"  rms {1000 * self.again.rms:.1f} µm, worst {1000 * self.again.worst:+.1f} µm")

    def correct_parameters(self, designed, names):
        """The designer's model, in whose spreadsheet the names are; by the datums and what has those sizes."""
        with self._step("fit named parameters, correct the master model"):
            designed.UndoMode = 1
            sized = [one for one in self.touched if one.place.face in self.sized()]
            self.parameters = master.fit_parameters(designed.Part, designed.Dimensions, names, [*self.datums, *sized])
            master.correct_parameters(designed.Part, self.parameters)
            self.corrected = master.deviations(designed.Part.Shape, self.touched, self.parameters.placement)
        self._say(f"  {self.parameters}")


def _same(a, b):
    return np.allclose(a.Matrix.A, b.Matrix.A, rtol=0, atol=1e-9)

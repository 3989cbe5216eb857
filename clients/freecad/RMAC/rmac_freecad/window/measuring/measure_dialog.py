"""A part measured by touch: places on the faces that are selected, shown before anything moves, touched, and kept. Closing waits until nothing moves."""

import FreeCADGui
from PySide import QtGui

from rmac_freecad.jogging import is_machine_frame
from rmac_freecad.measuring import feature as measure_feature
from rmac_freecad.measuring.feature import is_measure, measure_of
from rmac_freecad.measuring.kept import keep_measured
from rmac_freecad.measuring.readiness import check_probe
from rmac_freecad.measuring.refusal import MeasuringRefused
from rmac_freecad.running import check_part_zero, look
from rmac_freecad.window.dialog import OnlyOne, button, row
from rmac_freecad.window.measuring.views import MeasuredView, PlacesView
from rmac_freecad.window.operations.chosen_faces import chosen_faces
from rmac_freecad.window.operations.object_dialog import ObjectDialog, is_there
from rmac_freecad.window.quantity import length_text
from rmac_freecad.window.session import session

FIELDS = (("Count", "Places on each face"), ("Edge", "Off the edges"), ("Tip", "Tip's radius"), ("Clearance", "Clearance"),
          ("Safe", "Cross at"), ("Lowest", "Not below"), ("Speed", "Speed"))  # fmt: skip


class MeasureDialog(ObjectDialog):
    DONE = "measured"

    def __init__(self, here):
        super().__init__(here, "Measure a part", measure_feature.PROPERTIES, FIELDS, lambda document: measure_of(document, *chosen_faces()), is_measure, PlacesView)
        self.measuring = here.measuring
        self.kept = None  # what came of it last
        self._measured = None  # what is being measured: its object, plan, and part
        self.preview_button.setText("Show places")
        self.measure_button = button("Measure", self.measure, "Has the machine touch the places, in their order; it begins at once where nothing speaks against it")
        self.stop_button = button("Stop", self.stop, "At once. This is no emergency stop")
        self.built_in = QtGui.QCheckBox("The probe is built in: no tool is in the spindle")
        self.at_machine_zero = QtGui.QCheckBox("The part stands at the machine's own zero")
        self.progress = QtGui.QProgressBar()
        self.progress.setFormat("%v of %m")
        self.lay_out(self.measure_button, below=(self.built_in, self.at_machine_zero, row(self.progress, self.stop_button)))

    @property
    def busy(self):
        return self.measuring.running

    def measure(self):
        """A group that was moved with the part in it tells nobody: its places are made anew."""
        if is_there(self.feature) and "Touched" not in self.feature.State and not self._is_current():
            self.feature.touch()
        self.apply(self._measure)

    def stop(self):
        self.station.stop(self.session.settings.address, failed=self.failed)

    def tick(self):
        super().tick()
        self.stop_button.setEnabled(self.busy)
        if self.busy:
            self._show_progress()

    def reject(self):
        """Escape, and whatever else would close it."""
        if self.busy:
            return self.message.tell("The machine measures. Stop it first, or leave this open.")
        super().reject()

    def failed(self, error):
        super().failed(error)
        place = getattr(error, "place", None)
        if place is not None and is_there(self._measured[2]):
            FreeCADGui.Selection.clearSelection()
            FreeCADGui.Selection.addSelection(self._measured[2], place.face, *place.point)

    def _measure(self):
        try:
            plan = self.feature.Proxy.planning(self.feature)()
            part = self.feature.Faces[0]
        except Exception as error:
            return self.failed(error)
        self._measured = self.feature, plan, part
        built_in, at_zero = self.built_in.isChecked(), self.at_machine_zero.isChecked()

        def check(client):
            now = look(client)
            check_probe(client, now, plan.tip_radius_mm, built_in)
            check_part_zero(now, at_zero)
            return now

        self.progress.setRange(0, len(plan.places))
        self.measuring.start(plan, check, self._done, self.failed)
        self.message.tell("the machine measures…")
        self.tick()
        self._enable()

    def _is_current(self):
        try:
            return self.feature.Proxy.is_current(self.feature)
        except MeasuringRefused:
            return False  # which is told when it is made anew

    def _show_progress(self):
        self.progress.setValue(self.measuring.done)
        path = self._measured[0].ViewObject.Proxy.path if is_there(self._measured[0]) else None
        if path is not None:
            path.show_done(self.measuring.done)

    def _done(self, touched, now):
        self._enable()
        if touched is None:
            return self.message.tell("It was stopped before it began.")
        self._show_progress()
        self.session.machine = now.machine
        _, plan, part = self._measured
        if not is_there(part):
            return self.failed(ValueError("The part was deleted, or its document closed, while it was measured; what was found is not kept."))
        self.kept = keep_measured(part, plan, touched, now.machine.name, now.part_frame)
        MeasuredView(self.kept.ViewObject)
        worst = max((one.off_mm for one in touched), key=abs)
        zero = " The part's zero is the machine's own." if is_machine_frame(now.part_frame) else ""
        self.message.tell(f"{len(touched)} places were touched, the worst {length_text(round(worst, 4))} off. It is kept in the document as {self.kept.Label}; Compare with the model says where the part lies.{zero}")


show = OnlyOne(MeasureDialog)


def show_for(feature):
    """To change its values, or to measure anew."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(feature)
    show(session())

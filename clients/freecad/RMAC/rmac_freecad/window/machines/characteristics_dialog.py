"""All that the database tells of a machine, with its picture, figure 4.4."""

from PySide import QtCore, QtGui

from rmac_freecad.machines import draw
from rmac_freecad.window.dialog import Dialog
from rmac_freecad.window.quantity import feed_text, length_text


def rows_of(machine):
    return (
        ("Type", f"{machine.type}, {machine.configuration}"),
        ("Joints", str(machine.joints)),
        ("Working volume", " × ".join(length_text(side) for side in machine.working_volume_mm)),
        ("Feed at most", feed_text(machine.max_feed_mm_min)),
        ("Spindle", f"{machine.spindle_max_rpm:g} rpm, {machine.spindle_max_torque_nm:g} N·m, {machine.spindle_hp:g} hp"),
        ("Pallet load", f"{machine.max_pallet_load_kg:g} kg"),
        ("Positioning, repeatability", f"{length_text(machine.positioning_tolerance_mm)}, {length_text(machine.repeatability_tolerance_mm)}"),
        ("Device driver", f"{machine.driver}, version {machine.driver_version}"),
    )


class CharacteristicsDialog(Dialog):
    def __init__(self, session, machine):
        super().__init__(session, f"{machine.name}: characteristics")
        form = QtGui.QFormLayout()
        for label, text in rows_of(machine):
            form.addRow(f"{label}:", QtGui.QLabel(text))
        self.picture = QtGui.QLabel()
        self.picture.setMinimumSize(420, 300)
        self.picture.setAlignment(QtCore.Qt.AlignCenter)
        box = QtGui.QVBoxLayout(self)
        box.addLayout(form)
        box.addWidget(self.picture)
        box.addWidget(self.message)
        program = session.settings.rmac
        self.message.tell("drawing the machine…")
        self.station.ask(lambda: draw(machine.name, session.client().address, program), self._show_picture, self.failed)

    def _show_picture(self, png):
        self.message.tell("")
        pixmap = QtGui.QPixmap()
        pixmap.loadFromData(QtCore.QByteArray(png))
        self.picture.setPixmap(pixmap.scaledToWidth(640, QtCore.Qt.SmoothTransformation))
        self.adjustSize()

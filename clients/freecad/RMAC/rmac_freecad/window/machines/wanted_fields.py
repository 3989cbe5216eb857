"""The fields of a search, figure 6.4."""

from PySide import QtGui

from rmac_freecad.machines import TYPES, Wanted
from rmac_freecad.window.quantity import LENGTH, SPEED, QuantityField

ANY = "any"
LENGTHS = (("length_mm", "Length at least"), ("width_mm", "Width at least"), ("depth_mm", "Depth at least"),
           ("positioning_mm", "Positioning at most"), ("repeatability_mm", "Repeatability at most"))  # fmt: skip
NUMBERS = (("spindle_hp", "Spindle power at least", " hp"), ("spindle_rpm", "Spindle speed at least", " rpm"),
           ("spindle_torque_nm", "Spindle torque at least", " N·m"), ("load_kg", "Pallet load at least", " kg"))  # fmt: skip


class WantedFields(QtGui.QGroupBox):
    def __init__(self):
        super().__init__("What the machine must have")
        self._numbers = {}
        self.name = QtGui.QLineEdit()
        self.type = QtGui.QComboBox()
        self.type.addItems([ANY, *TYPES])
        self.joints = QtGui.QSpinBox()
        self.joints.setRange(0, 32)
        self.joints.setSpecialValueText(ANY)
        left, right = QtGui.QFormLayout(), QtGui.QFormLayout()
        left.addRow("Name", self.name)
        left.addRow("Type", self.type)
        left.addRow("Joints", self.joints)
        for key, label in LENGTHS:
            form = left if key in ("length_mm", "width_mm", "depth_mm") else right
            form.addRow(label, self._field(key, QuantityField(LENGTH, lowest=0)))
        right.insertRow(0, "Feed at least", self._field("feed_mm_min", QuantityField(SPEED, lowest=0)))
        for key, label, unit in NUMBERS:
            right.insertRow(0, label, self._field(key, _number(unit)))
        box = QtGui.QHBoxLayout(self)
        box.addLayout(left)
        box.addLayout(right)

    def wanted(self):
        values = {key: read() for key, read in self._numbers.items()}
        values["feed_mm_min"] *= 60
        kind = "" if self.type.currentText() == ANY else self.type.currentText()
        return Wanted(name=self.name.text().strip(), type=kind, joints=self.joints.value(), **values)

    def _field(self, key, field):
        setattr(self, key, field)
        field.setSpecialValueText(ANY)
        self._numbers[key] = (lambda: field.quantity) if isinstance(field, QuantityField) else field.value
        return field


def _number(unit):
    field = QtGui.QDoubleSpinBox()
    field.setRange(0, 1e6)
    field.setSuffix(unit)
    return field

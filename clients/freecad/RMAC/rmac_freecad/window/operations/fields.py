"""A field for a property of an object, in the unit that FreeCAD shows."""

from PySide import QtGui

from rmac_freecad.window.quantity import LENGTH, SPEED, QuantityField

QUANTITIES = {"App::PropertyLength": LENGTH, "App::PropertyDistance": LENGTH, "App::PropertySpeed": SPEED}
SUFFIXES = {"SpindleSpeed": " rpm", "Dwell": " s"}  # of plain numbers


class PropertyField:
    """`name` of the property, `label` and `widget` for a form."""

    def __init__(self, name, kind, label, tip):
        self.name, self.label = name, label
        if kind in QUANTITIES:
            self.widget = QuantityField(QUANTITIES[kind], lowest=0 if kind == "App::PropertySpeed" else -1e6)
            self._show, self._value = self.widget.set_quantity, lambda: self.widget.quantity
        elif kind == "App::PropertyEnumeration":
            self.widget = QtGui.QComboBox()
            self._show, self._value = self.widget.setCurrentText, self.widget.currentText
        elif kind == "App::PropertyBool":
            self.widget = QtGui.QCheckBox()
            self._show, self._value = self.widget.setChecked, self.widget.isChecked
        elif kind == "App::PropertyInteger":
            self.widget = QtGui.QSpinBox()
            self.widget.setRange(0, 9999)
            self._show, self._value = self.widget.setValue, self.widget.value
        else:
            self.widget = QtGui.QDoubleSpinBox()
            self.widget.setRange(-1e6, 1e6)
            self.widget.setSuffix("°" if kind == "App::PropertyAngle" else SUFFIXES[name])
            self._show, self._value = self.widget.setValue, self.widget.value
        self._kind = kind
        self._shown = None
        self.widget.setToolTip(tip)

    def take(self, feature):
        if self._kind == "App::PropertyEnumeration":
            self.widget.clear()
            self.widget.addItems(feature.getEnumerationsOfProperty(self.name))
        value = getattr(feature, self.name)
        self._show(getattr(value, "Value", value))
        self._shown = self._value()

    def give(self, feature):
        """What was not changed stays to its last digit, of which the field shows some. Whether it was changed."""
        value = self._value()
        changed = value != self._shown
        if changed:
            setattr(feature, self.name, value)
            self._shown = value
        return changed

"""How far a tap goes, by a slider as in figure 6.6 or by its value, and how fast."""

from PySide import QtCore, QtGui

from rmac_freecad.jogging import steps
from rmac_freecad.window.dialog import row
from rmac_freecad.window.quantity import LENGTH, SPEED, QuantityField

SPEED_MM_S = 10.0


class StepFields(QtGui.QGroupBox):
    def __init__(self):
        super().__init__("Jog")
        self._steps = steps()
        self.by_steps = QtGui.QRadioButton("by a step")
        self.while_held = QtGui.QRadioButton("while the button is held")
        self.by_steps.setChecked(True)
        self.step = QuantityField(LENGTH, lowest=0)
        self.slider = QtGui.QSlider(QtCore.Qt.Horizontal)
        self.slider.setRange(0, len(self._steps) - 1)
        self.slider.valueChanged.connect(lambda number: self.step.set_quantity(self._steps[number]))
        self.slider.setValue(3)
        self.speed = QuantityField(SPEED, SPEED_MM_S, lowest=0)
        self.speed.setToolTip("Of axes that turn: as many degrees a second as this is mm")
        box = QtGui.QVBoxLayout(self)
        box.addLayout(row(self.by_steps, self.slider, self.step))
        box.addLayout(row(self.while_held, None, QtGui.QLabel("Speed"), self.speed))

    @property
    def step_mm(self):
        return self.step.quantity

    @property
    def speed_mm_s(self):
        return self.speed.quantity

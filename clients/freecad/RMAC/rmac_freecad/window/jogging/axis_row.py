"""One axis of the jog dialog: where it stands, its two buttons, and what it is to read."""

import FreeCAD
from PySide import QtCore, QtGui

from rmac_freecad.window.dialog import button
from rmac_freecad.window.quantity import LENGTH, QuantityField, position_text


class AxisRow:
    def __init__(self, axis, step, place):
        """`step(axis, sign)` when a button was tapped; `place(axis, mm)` when the tool is to read so there."""
        self.axis = axis
        self.place = QtGui.QLabel("—")
        self.place.setAlignment(QtCore.Qt.AlignRight | QtCore.Qt.AlignVCenter)
        self.place.setStyleSheet("font: bold 15pt monospace")
        self.place.setMinimumWidth(170)
        self.minus = button(f"{axis.name} −", lambda: step(axis, -1))
        self.plus = button(f"{axis.name} +", lambda: step(axis, 1))
        self.reads = None if axis.turns else QuantityField(LENGTH)
        self.set_button = None if axis.turns else button(
            f"Set {axis.name}", lambda: place(axis, self.reads.quantity), "Moves the part's zero so that the tool reads this where it stands")  # fmt: skip

    def add_to(self, grid, number):
        widgets = (QtGui.QLabel(self.axis.name), self.place, self.minus, self.plus, self.reads, self.set_button)
        for column, widget in enumerate(widgets):
            if widget is not None:
                grid.addWidget(widget, number, column)

    def show(self, state):
        if state is None or not state["mechanism"]:
            return self.place.setText("—")
        value = self.axis.place(state)
        self.place.setText(FreeCAD.Units.Quantity(value, FreeCAD.Units.Angle).UserString if self.axis.turns else position_text(value))

    def held(self):
        """1 or -1 while a button is down, else 0."""
        return self.plus.isDown() - self.minus.isDown()

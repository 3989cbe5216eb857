"""The tools of the program that the machine's table lacks, and how long each is."""

from dataclasses import replace

from PySide import QtGui

from rmac_freecad.jobs import lacking
from rmac_freecad.window.dialog import button, row
from rmac_freecad.window.quantity import LENGTH, QuantityField


class ToolsBox(QtGui.QGroupBox):
    """Hidden where none is lacking."""

    def __init__(self, add):
        """`add(tool, length_mm)` when one is to be put into the table."""
        super().__init__("Tools that the machine's table lacks")
        self._add = add
        self.rows = []
        self._box = QtGui.QVBoxLayout(self)
        self.hide()

    def show_tools(self, tools, table):
        for widget in self.rows:
            self._box.removeWidget(widget)
            widget.deleteLater()
        self.rows = [self._row(tool) for tool in lacking(tools, table)]
        for widget in self.rows:
            self._box.addWidget(widget)
        self.setVisible(bool(self.rows))

    def _row(self, tool):
        widget = QtGui.QWidget()
        widget.length = QuantityField(LENGTH, lowest=0)
        widget.length.setToolTip("From the spindle to the tip. With one tool whose tip sets the part's zero it may stay 0")
        widget.add = button("Add", lambda: self._add(replace(tool, radius_mm=tool.radius_mm or widget.diameter.quantity / 2), widget.length.quantity))
        widget.diameter = QuantityField(LENGTH, 2 * tool.radius_mm, lowest=0)
        widget.diameter.setEnabled(tool.radius_mm == 0)  # a file of another control does not tell it
        label = QtGui.QLabel(f"{tool.number}: {tool.label}")
        widget.setLayout(row(label, None, QtGui.QLabel("Diameter"), widget.diameter, QtGui.QLabel("Length"), widget.length, widget.add))
        return widget

"""What is at hand while a program runs."""

from PySide import QtCore, QtGui

from rmac_freecad.window.dialog import button, row


class RunButtons(QtGui.QWidget):
    def __init__(self, does):
        """`does`: an object with hold, resume, stop, override(percent)."""
        super().__init__()
        self.hold = button("Hold", does.hold, "Comes to rest on the path; Resume goes on")
        self.resume = button("Resume", does.resume)
        self.stop = button("Stop", does.stop, "At once; the rest of the program is dropped. This is no emergency stop")
        self.override = QtGui.QSlider(QtCore.Qt.Horizontal)
        self.override.setRange(0, 200)
        self.override.setValue(100)
        self.override.valueChanged.connect(does.override)
        self.percent = QtGui.QLabel("100 %")
        self.setLayout(row(self.hold, self.resume, self.stop, QtGui.QLabel("Feed"), self.override, self.percent))
        self.layout().setContentsMargins(0, 0, 0, 0)

    def show(self, state, running):
        """`state`: the topic's, or None."""
        machine = state["state"] if state else ""
        self.hold.setEnabled(machine == "Running")
        self.resume.setEnabled(machine == "Holding")
        self.override.setEnabled(running and state is not None)
        if state is not None and not self.override.isSliderDown():
            self.override.blockSignals(True)
            self.override.setValue(round(state["override_percent"]))
            self.override.blockSignals(False)
        self.percent.setText(f"{self.override.value()} %")

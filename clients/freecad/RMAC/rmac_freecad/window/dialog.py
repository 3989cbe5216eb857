"""What all dialogs of the workbench are: beside FreeCAD's window rather than over it, with a line for what went wrong."""

import FreeCADGui
from PySide import QtCore, QtGui

from rmac_freecad.window.message import Message


class Dialog(QtGui.QDialog):
    def __init__(self, session, title):
        super().__init__(FreeCADGui.getMainWindow())
        self.setWindowTitle(title)
        self.setAttribute(QtCore.Qt.WA_DeleteOnClose, False)
        self.session = session
        self.station = session.station
        self.message = Message()

    def showEvent(self, event):
        super().showEvent(event)
        self.session.off_tick(self.tick)
        self.session.on_tick(self.tick)

    def hideEvent(self, event):
        self.session.off_tick(self.tick)
        super().hideEvent(event)

    def appear(self):
        goes_on = self.goes_on()
        self.show()
        if not goes_on:
            self.begin()
        self.raise_()

    def goes_on(self):
        """Whether it is at something already, and only comes to the front."""
        return self.isVisible()

    def begin(self):
        """What it does first when it appears."""

    def tick(self):
        """By the session's timer while the dialog is there."""

    def ask(self, what, done, working=""):
        """`what(client)` by a thread, connected; then `done(answer)`, or what went wrong in the dialog's message."""
        self.message.tell(working)
        self.station.ask(lambda: what(self.session.client()), done, self.failed)

    def change(self, what, done, working=""):
        """As `ask`, of what changes the machine: with authority, and refused while a job is being cut."""

        def with_authority():
            client = self.session.client_unless_it_cuts()
            with client.authority():
                return what(client)

        self.message.tell(working)
        self.station.ask(with_authority, done, self.failed)

    def failed(self, error):
        self.message.refuse(error)


class OnlyOne:
    """Brings up the one dialog of a kind that a session has."""

    def __init__(self, kind):
        self._kind = kind
        self._dialog = None

    def __call__(self, session):
        if self._dialog is None or self._dialog.session is not session:
            self._dialog = self._kind(session)
        self._dialog.appear()
        return self._dialog


def button(text, does, tip=""):
    made = QtGui.QPushButton(text)
    made.setAutoDefault(False)  # Enter in a field must start no machine
    made.setToolTip(tip)
    made.clicked.connect(lambda checked=False: does())
    return made


def row(*widgets):
    box = QtGui.QHBoxLayout()
    for widget in widgets:
        if widget is None:
            box.addStretch()
        elif isinstance(widget, QtGui.QLayout):
            box.addLayout(widget)
        else:
            box.addWidget(widget)
    return box

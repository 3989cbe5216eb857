"""A line of a dialog that says what happens, or what went wrong and what to do."""

from PySide import QtCore, QtGui

import rmac
from rmac_freecad.simulation import NoProgram


def words_of(error):
    """For somebody who makes parts: without the numbers of the protocol."""
    if isinstance(error, rmac.AuthorityHeld):
        return f"Another station has authority over the machine: {error.message}. Finish there first; Stop acts from here, too."
    if isinstance(error, rmac.CannotConnect):
        return f"{error} The address stands in Edit > Preferences > RMAC."
    if isinstance(error, NoProgram):
        return "The program rmac, which simulates and imports, was not found; give its path in Edit > Preferences > RMAC."
    return error.message if isinstance(error, rmac.Refused) else str(error)


class Message(QtGui.QLabel):
    def __init__(self):
        super().__init__()
        self.setWordWrap(True)
        self.setTextInteractionFlags(QtCore.Qt.TextSelectableByMouse)
        self.setTextFormat(QtCore.Qt.PlainText)
        self.refused = None

    def tell(self, text):
        self.refused = None
        self.setStyleSheet("")
        self.setText(text)

    def refuse(self, error):
        self.refused = error
        self.setStyleSheet("color: #b01818")
        self.setText(words_of(error))

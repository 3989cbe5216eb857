"""What a person at the machine is to do before it goes on: another tool, or a stop of the program."""

from PySide import QtGui

from rmac_freecad.window.dialog import button, row


class Prompts(QtGui.QGroupBox):
    """Hidden where nobody is asked for anything."""

    def __init__(self, confirm):
        """`confirm(number)`: that tool is in the spindle."""
        super().__init__("At the machine")
        self.text = QtGui.QLabel()
        self.text.setWordWrap(True)
        self.tool = QtGui.QSpinBox()
        self.tool.setRange(0, 9999)
        self.tool.setSpecialValueText("none")
        self.confirm = button("It is in the spindle", lambda: confirm(self.tool.value()))
        self._asked_for = object()  # what the field was filled in for
        box = QtGui.QVBoxLayout(self)
        box.addWidget(self.text)
        box.addLayout(row(None, QtGui.QLabel("Tool"), self.tool, self.confirm))
        self.hide()

    def show_state(self, state, suggestion):
        """`suggestion`: the tool where the machine does not say which one it wants."""
        text, is_tool = _text(state)
        self.setVisible(bool(text))
        self.text.setText(text)
        self.tool.setVisible(is_tool)
        self.confirm.setVisible(is_tool)
        asked_for = (state["tool"], state["tool_wanted"]) if is_tool else None
        if is_tool and asked_for != self._asked_for:
            self.tool.setValue(state["tool_wanted"] if state["tool_wanted"] is not None else suggestion)
        self._asked_for = asked_for


def _text(state):
    if state is None or not state["mechanism"]:
        return "", False
    if state["tool_prompt"]:
        return state["tool_prompt"], True
    if state["tool"] is None:
        return "Nobody knows which tool is in the spindle: look, and say it.", True
    return state["stop_prompt"], False

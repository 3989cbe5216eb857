"""The tools of the machine's table, one of which may be taken."""

from PySide import QtGui

from rmac_freecad.window.quantity import length_text

UNKNOWN = "the machine's table is not known; type the tool"


class TableTools(QtGui.QComboBox):
    def __init__(self, took):
        """`took(number, diameter_mm, reach_mm)` when somebody chooses one; the reach is None where the table tells none."""
        super().__init__()
        self.setToolTip("Takes its number, its diameter and how far it cuts over into the fields. The table tells no angle of the point")
        self._took = took
        self._tools = []
        self.activated.connect(self._chosen)
        self.show_table(None)

    def show_table(self, table):
        """As `client.cam.GetTools()` gives it, or None."""
        self._tools = [] if table is None else table["Tools"]
        self.clear()
        self.addItem(UNKNOWN if table is None else "the table has no tools" if not self._tools else "choose one of the machine's table…")
        self.addItems([f"{tool['ToolNumber']}: {tool.get('Name') or 'tool'}, Ø {length_text(2 * tool['Radius'])}" for tool in self._tools])
        self.setEnabled(bool(self._tools))

    def _chosen(self, index):
        if index > 0:
            tool = self._tools[index - 1]
            self._took(tool["ToolNumber"], 2 * tool["Radius"], (tool.get("Shape") or {}).get("LCF"))

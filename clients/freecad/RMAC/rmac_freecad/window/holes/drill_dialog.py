"""Holes drilled: which, with what, and how."""

import FreeCADGui

from rmac_freecad.holes import drilling_of, feature, is_drilling
from rmac_freecad.jobs import JobRefused
from rmac_freecad.window.dialog import OnlyOne, row
from rmac_freecad.window.holes.drill_view import DrillView
from rmac_freecad.window.holes.holes_list import HolesList
from rmac_freecad.window.holes.table_tools import TableTools
from rmac_freecad.window.operations.operation_dialog import OperationDialog
from rmac_freecad.window.session import session

FIELDS = (("Tool", "Tool"), ("Diameter", "Diameter"), ("Point", "Point"), ("Reach", "Reach"), ("End", "To the end"), ("Depth", "Depth"), ("Beyond", "Beyond"),
          ("Predrill", "Predrill"), ("Cycle", "Cycle"), ("Peck", "Peck"), ("Dwell", "Dwell"), ("Above", "Above"), ("Safe", "Cross at"), ("Feed", "Feed"),
          ("SpindleSpeed", "Spindle"))  # fmt: skip


class DrillDialog(OperationDialog):
    DONE = "drilled"

    def __init__(self, here):
        super().__init__(here, "Drill holes", feature.PROPERTIES, FIELDS, _drilling, is_drilling, DrillView)
        self.fields[self.holes.name] = self.holes
        self.resize(760, 560)

    def made_below(self):
        self.holes, self.tools = HolesList(), TableTools(self._take_tool)
        return row(self.tools, None), self.holes

    def begin(self):
        self.holes.show_rows(())
        super().begin()
        self.station.ask(lambda: self.session.client().cam.GetTools(), self.tools.show_table, lambda error: self.tools.show_table(None))

    def failed(self, error):
        """The rows tell why, too."""
        super().failed(error)
        self._show_holes()

    def _told(self):
        self._show_holes()
        return super()._told()

    def _show_holes(self):
        """What was listed stays where nothing new was planned."""
        try:
            last = None if self.feature is None else self.feature.Proxy.last
        except ReferenceError:
            last = None
        if last is not None:
            self.holes.show_rows(last[1].rows)

    def _take_tool(self, number, diameter_mm, reach_mm):
        self.fields["Tool"].widget.setValue(number)
        self.fields["Diameter"].widget.set_quantity(diameter_mm)
        self.fields["Reach"].widget.set_quantity(reach_mm or 0.0)


def _drilling(document):
    chosen = [(one.Object, [name for name in one.SubElementNames if name]) for one in FreeCADGui.Selection.getSelectionEx()]
    if not chosen:
        raise JobRefused("nothing is selected; select holes by their faces or circles, a part as a whole, or a sketch with circles or points")
    other = next((one for one, _ in chosen if not hasattr(one, "Shape")), None)
    if other is not None:
        raise JobRefused(f"{other.Label} has no shape; select parts with holes, or sketches")
    return drilling_of(document, chosen)


show = OnlyOne(DrillDialog)


def show_for(drilled):
    """To change its values."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(drilled)
    show(session())

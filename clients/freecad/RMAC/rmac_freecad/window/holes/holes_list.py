"""The holes that were found, those of one diameter together, which is ticked or not; each with what becomes of it."""

from PySide import QtCore, QtGui

from rmac_freecad.holes.drilling import FITS_MM
from rmac_freecad.window.quantity import length_text

HEADINGS = ("Hole", "Where", "Deep", "Goes", "Axis", "What becomes of it")
MISSING = QtGui.QColor("#b01818")
OPENED = 12  # holes of a diameter that are shown at once


class HolesList(QtGui.QTreeWidget):
    """A field of the dialog, of the property `Diameters`."""

    name = "Diameters"

    def __init__(self):
        super().__init__()
        self.setHeaderLabels(HEADINGS)
        self.setMinimumHeight(150)
        self.itemChanged.connect(lambda item, column: self._ticked())
        self._diameters = ()

    def take(self, feature):
        self._diameters = tuple(feature.Diameters)
        self.show_rows(())

    def give(self, feature):
        changed = self._diameters != tuple(feature.Diameters)
        if changed:
            feature.Diameters = list(self._diameters)
        return changed

    def show_rows(self, rows):
        self.blockSignals(True)
        self.clear()
        groups = {}
        for row in rows:
            groups.setdefault(next((one for one in groups if abs(one - row.hole.diameter_mm) < FITS_MM), row.hole.diameter_mm), []).append(row)
        for diameter, group in sorted(groups.items()):
            self.addTopLevelItem(self._group(diameter, group))
        for item, group in zip(self.groups(), [groups[diameter] for diameter in sorted(groups)]):
            item.setExpanded(len(group) <= OPENED or len(groups) == 1)
        for column in range(self.columnCount()):
            self.resizeColumnToContents(column)
        self.blockSignals(False)

    def groups(self):
        return [self.topLevelItem(number) for number in range(self.topLevelItemCount())]

    def tick(self, diameter, on=True):
        item = next(item for item in self.groups() if abs(item.data(0, QtCore.Qt.UserRole) - diameter) < FITS_MM)
        item.setCheckState(0, QtCore.Qt.Checked if on else QtCore.Qt.Unchecked)

    def _group(self, diameter, rows):
        chosen, drilled = any(row.is_chosen for row in rows), sum(row.tip is not None for row in rows)
        told = f"{drilled} of {len(rows)} drilled" if chosen else "not chosen"
        item = QtGui.QTreeWidgetItem([f"Ø {length_text(diameter)}" if diameter else "Points", f"{len(rows)} hole{'' if len(rows) == 1 else 's'}", "", "", "", told])
        item.setData(0, QtCore.Qt.UserRole, diameter)
        item.setCheckState(0, QtCore.Qt.Checked if chosen else QtCore.Qt.Unchecked)
        if chosen and drilled < len(rows):
            item.setForeground(5, MISSING)
        item.addChildren([_item(row) for row in rows])
        return item

    def _ticked(self):
        """Those that are not listed stay chosen: they come back with their part."""
        listed = {item.data(0, QtCore.Qt.UserRole): item.checkState(0) == QtCore.Qt.Checked for item in self.groups()}
        others = [one for one in self._diameters if not any(abs(one - diameter) < FITS_MM for diameter in listed)]
        self._diameters = tuple(sorted([*others, *(diameter for diameter, on in listed.items() if on)]))


def _item(row):
    hole = row.hole
    told = row.told if row.tip is None else "; ".join(part for part in (f"down to Z {length_text(row.tip)}", row.told) if part)
    goes = "" if not hole.depth_mm else "through" if hole.through else "blind"
    axis = "Z" if hole.lean_deg < 1e-4 else "−Z" if hole.lean_deg > 180 - 1e-4 else " ".join(f"{round(value, 4) + 0.0:g}" for value in hole.axis)
    where = f"X {length_text(hole.x)} Y {length_text(hole.y)} Z {length_text(hole.top)}"
    item = QtGui.QTreeWidgetItem(["", where, length_text(hole.depth_mm) if hole.depth_mm else "", goes, axis, f"not drilled: {told}" if row.is_missing else told])
    item.setToolTip(5, told)
    if row.is_missing:
        item.setForeground(5, MISSING)
    return item

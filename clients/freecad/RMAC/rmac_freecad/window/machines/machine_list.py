"""Machines that were found, figure 6.5; and which of them can cut the job."""

from PySide import QtCore, QtGui

from rmac_freecad.window.quantity import feed_text, length_text, position_text, time_text

COLUMNS = ("Machine", "Type", "Joints", "Working volume", "Spindle", "Feed", "Cuts this part in", "Off its path by")
TIME, OFF = 6, 7


class MachineList(QtGui.QTreeWidget):
    def __init__(self):
        super().__init__()
        self.setHeaderLabels(COLUMNS)
        self.header().moveSection(OFF, TIME)  # why a machine cannot is long
        self.setRootIsDecorated(False)
        self._machines = []

    @property
    def machines(self):
        return list(self._machines)

    @property
    def chosen(self):
        """The `rmac.Machine` that is clicked, or None."""
        item = self.currentItem()
        return None if item is None else next(machine for machine in self._machines if machine.name == item.text(0))

    def choose(self, name):
        for item in self._items():
            if item.text(0) == name:
                self.setCurrentItem(item)

    def show_machines(self, machines):
        self.clear()
        self._machines = list(machines)
        for machine in machines:
            volume = " × ".join(length_text(side) for side in machine.working_volume_mm)
            spindle = f"{machine.spindle_max_rpm:g} rpm, {machine.spindle_hp:g} hp"
            self.addTopLevelItem(QtGui.QTreeWidgetItem(
                [machine.name, machine.type, str(machine.joints), volume, spindle, feed_text(machine.max_feed_mm_min), "", ""]))  # fmt: skip
        self._fit_columns()

    def show_fits(self, fits, why):
        """Those that can come first, as they are ranked."""
        ranks = {fit.machine: rank for rank, fit in enumerate(fits)}
        items = [self.takeTopLevelItem(0) for _ in range(self.topLevelItemCount())]
        for item in sorted(items, key=lambda item: ranks.get(item.text(0), len(ranks))):
            name = item.text(0)
            if name in ranks:
                found = fits[ranks[name]].found
                item.setText(TIME, time_text(found.cycle_time_s))
                item.setText(OFF, "not known" if found.off_path_mm is None else position_text(found.off_path_mm))
            elif name in why:
                item.setText(TIME, f"no: {why[name]}")
                item.setToolTip(TIME, str(why[name]))
                for column in range(len(COLUMNS)):
                    item.setForeground(column, QtGui.QBrush(QtCore.Qt.gray))
            self.addTopLevelItem(item)
        self._fit_columns()
        if fits:
            self.choose(fits[0].machine)

    def _items(self):
        return [self.topLevelItem(number) for number in range(self.topLevelItemCount())]

    def _fit_columns(self):
        for column in range(len(COLUMNS)):
            if column != TIME:
                self.resizeColumnToContents(column)

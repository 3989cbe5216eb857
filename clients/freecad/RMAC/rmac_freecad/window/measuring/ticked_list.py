"""Names that are ticked or not, with what is said of each beside it."""

from PySide import QtCore, QtGui


class TickedList(QtGui.QTreeWidget):
    def __init__(self, headings, changed):
        """`changed()` when somebody ticks one, or takes a tick away."""
        super().__init__()
        self.setHeaderLabels(headings)
        self.setRootIsDecorated(False)
        self.setMinimumHeight(90)
        self.itemChanged.connect(lambda item, column: changed())

    def fill(self, rows, ticked=False):
        """Each row is its name, and what is said of it."""
        self.blockSignals(True)
        self.clear()
        for words in rows:
            item = QtGui.QTreeWidgetItem(list(words))
            item.setCheckState(0, QtCore.Qt.Checked if ticked else QtCore.Qt.Unchecked)
            self.addTopLevelItem(item)
        self._fit()
        self.blockSignals(False)

    def say(self, number, column, *words):
        """From that column on."""
        self.blockSignals(True)
        for place, word in enumerate(words, column):
            self.topLevelItem(number).setText(place, word)
        self._fit()
        self.blockSignals(False)

    def ticked(self):
        items = [self.topLevelItem(number) for number in range(self.topLevelItemCount())]
        return [item.text(0) for item in items if item.checkState(0) == QtCore.Qt.Checked]

    def tick(self, name, on=True):
        item = next(item for number in range(self.topLevelItemCount()) if (item := self.topLevelItem(number)).text(0) == name)
        item.setCheckState(0, QtCore.Qt.Checked if on else QtCore.Qt.Unchecked)

    def _fit(self):
        for column in range(self.columnCount()):
            self.resizeColumnToContents(column)

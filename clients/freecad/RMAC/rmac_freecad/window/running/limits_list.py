"""What limited a simulated job, the longest first, in the colours that the path has in the 3D view."""

from PySide import QtGui

from rmac_freecad.path import colour_of_limit
from rmac_freecad.window.quantity import time_text


class LimitsList(QtGui.QTreeWidget):
    def __init__(self):
        super().__init__()
        self.setHeaderLabels(("Limited by", "for"))
        self.setRootIsDecorated(False)
        self.setMinimumHeight(110)

    def show_found(self, found):
        self.clear()
        for limit, seconds in sorted(found.limited_by_s.items(), key=lambda one: -one[1]):
            item = QtGui.QTreeWidgetItem([limit, time_text(seconds)])
            item.setForeground(0, QtGui.QBrush(QtGui.QColor.fromRgbF(*colour_of_limit(limit))))
            self.addTopLevelItem(item)
        self.resizeColumnToContents(0)

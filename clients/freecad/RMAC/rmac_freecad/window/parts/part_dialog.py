"""A STEP part opened, or one of the document, with what there is to machine on it; each with the dialog that does it."""

import FreeCADGui
from PySide import QtGui

from rmac_freecad.parts import PartRefused, check_size, open_step, recognise
from rmac_freecad.surfaces.machining import placed_shape
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.operations.object_dialog import is_there
from rmac_freecad.window.parts.found_rows import rows_of

FILTER = "STEP files (*.step *.stp *.STEP *.STP);;All files (*)"


class PartDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Open a STEP part")
        self.part = None
        self.rows = ()
        self._wanted = None  # what is being looked at: a new object each time
        self.file = QtGui.QLineEdit()
        self.solid = QtGui.QLineEdit()
        self.solid.setPlaceholderText("its name, where the file holds several")
        self.open_button = button("Open", self.open, "Into a document of its own, as large as the file says, whatever its unit")
        self.look_button = button("Look at the selected part", self.look, "At a part that is open already")
        self.headline = QtGui.QLabel()
        self.headline.setWordWrap(True)
        self.list = QtGui.QTreeWidget()
        self.list.setHeaderLabels(("Found", "What it is", ""))
        self.list.setRootIsDecorated(False)
        form = QtGui.QFormLayout()
        form.addRow("File", row(self.file, button("Browse…", self._browse)))
        form.addRow("Solid", self.solid)
        box = QtGui.QVBoxLayout(self)
        for part in (form, row(None, self.look_button, self.open_button), self.headline, self.list, self.message):
            box.addLayout(part) if isinstance(part, QtGui.QLayout) else box.addWidget(part)
        self.resize(600, 400)

    def open(self):
        path = self.file.text().strip()
        if not path:
            return self.failed(PartRefused("Choose a file first."))
        try:
            part = open_step(path, self.solid.text().strip() or None)
        except Exception as error:
            return self.failed(error)
        FreeCADGui.activeDocument().activeView().viewIsometric()
        FreeCADGui.SendMsgToActiveView("ViewFit")
        self._look(part)

    def look(self):
        chosen = [one for one in FreeCADGui.Selection.getSelection() if hasattr(one, "Shape")]
        if len(chosen) != 1:
            return self.failed(PartRefused("Select one part of the document first." if not chosen else "Select one part alone."))
        self._look(chosen[0])

    def do(self, found):
        """Selects what was found, and opens its dialog on it."""
        if not is_there(self.part):
            self._show(None, ())
            return self.failed(PartRefused("The part is not there any more: it was deleted, or its document was closed. Open it again."))
        FreeCADGui.setActiveDocument(self.part.Document.Name)
        FreeCADGui.Selection.clearSelection()
        for name in found.names:
            FreeCADGui.Selection.addSelection(self.part.Document.Name, self.part.Name, name)
        return found.does(self.session)

    def failed(self, error):
        self._wanted = None
        super().failed(error)

    def hideEvent(self, event):
        self._wanted = None  # who closes it does not want it any more
        super().hideEvent(event)

    def tick(self):
        for one in (self.open_button, self.look_button):
            one.setEnabled(self._wanted is None)

    def _look(self, part):
        """Which takes a thread a while, where there are many faces."""
        self._show(None, ())
        try:
            shape = placed_shape(part)
        except Exception as error:
            return self.failed(error)
        wanted = self._wanted = object()

        def done(found):
            if self._wanted is wanted:
                self._wanted = None
                self._found(part, shape, found)

        def failed(error):
            if self._wanted is wanted:
                self.failed(error)

        self.message.tell(f"{part.Label} is looked at…")
        self.station.ask(lambda: recognise(shape), done, failed)

    def _found(self, part, shape, found):
        if not is_there(part):
            return self.failed(PartRefused("The part was deleted, or its document closed, while it was looked at."))
        box = shape.BoundBox
        self.headline.setText(f"{part.Label}: {box.XLength:.4g} × {box.YLength:.4g} × {box.ZLength:.4g} mm; {found}")
        self._show(part, rows_of(found))
        self.message.tell("What is machined from the side or below, threads, and pockets that are open at a side are not found.")
        if self.session.machine is not None:
            try:
                check_size(shape, self.session.machine)
            except PartRefused as error:
                self.failed(error)

    def _show(self, part, rows):
        self.part, self.rows = part, rows
        self.list.clear()
        if part is None:
            self.headline.setText("")
        for number, one in enumerate(rows):
            self.list.addTopLevelItem(QtGui.QTreeWidgetItem([one.kind, one.text, ""]))
            if one.does is not None:
                self.list.setItemWidget(self.list.topLevelItem(number), 2, button(one.button, lambda found=one: self.do(found)))
        for column in range(3):
            self.list.resizeColumnToContents(column)

    def _browse(self):
        chosen, _ = QtGui.QFileDialog.getOpenFileName(self, "Open a STEP part", self.file.text(), FILTER)
        if chosen:
            self.file.setText(chosen)


show = OnlyOne(PartDialog)

"""A file of another control opened: read and imported by a thread, and put into the document when it is understood."""

import FreeCAD
import FreeCADGui
from PySide import QtGui

from rmac_freecad.legacy import CodeRefused, Options, code_of, import_source, read_source
from rmac_freecad.legacy.options import ENDINGS, LANGUAGES, UNITS
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.legacy.code_view import CodeView
from rmac_freecad.window.quantity import SPEED, QuantityField

FILTER = f"Programs of other controls ({' '.join(f'*{ending} *{ending.upper()}' for ending in ENDINGS)});;All files (*)"


class OpenDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Open legacy code")
        self.file = QtGui.QLineEdit()
        self.language = _choice(LANGUAGES, "--dialect")
        self.unit = _choice(UNITS, "--unit: of a program without G20 and G21, or UNITS")
        self.rapid = QuantityField(SPEED, Options.rapid_mm_min / 60, lowest=0)
        self.rapid.setToolTip("--rapid: of G0 and RAPID; at most what the machine may go")
        self.approach = QtGui.QLineEdit()
        self.approach.setPlaceholderText("X,Y,Z in mm, where the program's first move is no G0 to X, Y and Z")
        self.approach.setToolTip("--approach: where the tool tip goes straight, at rapid, first and after a tool change")
        self.assume_g43 = QtGui.QCheckBox("The tool's length counts from M6 on, though no G43 says so (--assume-g43)")
        self.block_delete = QtGui.QCheckBox("Leave out blocks that begin with / (--block-delete)")
        self.further = QtGui.QLineEdit()
        self.further.setPlaceholderText("as --offset G55=10,0,0 --tool-diameter 3=10")
        self.open_button = button("Open", self.open)
        form = QtGui.QFormLayout()
        form.addRow("File", row(self.file, button("Browse…", self._browse)))
        for label, field in (("Language", self.language), ("Unit", self.unit), ("Rapids", self.rapid), ("Approach", self.approach),
                             ("Further options", self.further)):  # fmt: skip
            form.addRow(label, field)
        box = QtGui.QVBoxLayout(self)
        box.addLayout(form)
        for part in (self.assume_g43, self.block_delete):
            box.addWidget(part)
        box.addLayout(row(None, self.open_button))
        box.addWidget(self.message)
        self.resize(560, 300)
        self._wanted = None  # what is being read: a new object each time
        self._program = None  # as far as it is read

    def open(self):
        path, options, program = self.file.text().strip(), self.options(), self.session.settings.rmac
        if not path:
            return self.failed(CodeRefused("Choose a file first."))
        wanted = self._wanted = object()
        document = FreeCAD.ActiveDocument.Name if FreeCAD.ActiveDocument is not None else None

        def read():
            source = read_source(path)
            made = import_source(source, options, rmac=program, watch=self._watch)
            made.strokes  # drawn by the window, made here
            return source, made

        def done(came):
            if self._wanted is wanted:
                self._opened(document, options, *came)

        def failed(error):
            if self._wanted is wanted:
                self.failed(error)

        self.message.tell("the file is read…")
        self.station.ask(read, done, failed)

    def options(self):
        return Options(LANGUAGES[self.language.currentText()], UNITS[self.unit.currentText()], self.rapid.quantity * 60, self.approach.text(),
                       self.assume_g43.isChecked(), self.block_delete.isChecked(), self.further.text())  # fmt: skip

    def tick(self):
        self.open_button.setEnabled(self._wanted is None)
        if self._wanted is not None and self._program is not None:
            self.message.tell(f"{self._program.file} is read: {len(self._program)} steps…")

    def failed(self, error):
        self._wanted = self._program = None
        super().failed(error)

    def hideEvent(self, event):
        self._wanted = self._program = None  # who closes it does not want it any more
        super().hideEvent(event)

    def _watch(self, program):
        self._program = program

    def _browse(self):
        chosen, _ = QtGui.QFileDialog.getOpenFileName(self, "Open legacy code", self.file.text(), FILTER)
        if chosen:
            self.file.setText(chosen)

    def _opened(self, name, options, source, program):
        self._wanted = self._program = None
        try:
            document = FreeCAD.newDocument() if name is None else FreeCAD.getDocument(name)
        except NameError:  # so FreeCAD says that there is none of that name
            return self.failed(CodeRefused("the document was closed meanwhile; open it again", source.name))
        code = code_of(document, source, options, program)
        if not isinstance(code.ViewObject.Proxy, CodeView):
            CodeView(code.ViewObject)
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(code)
        self.message.tell(f"{source.name} is in the document: {len(program)} steps. Machine a job simulates and cuts it while it is selected.")


def _choice(texts, tip):
    box = QtGui.QComboBox()
    box.addItems(list(texts))
    box.setToolTip(tip)
    return box


show = OnlyOne(OpenDialog)

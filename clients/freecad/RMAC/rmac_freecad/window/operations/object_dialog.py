"""An object of the document that is made of what is selected: its values, and a preview in the document. Nothing moves by that."""

import FreeCAD
import FreeCADGui
from PySide import QtGui

from rmac_freecad.window.dialog import Dialog, button, row
from rmac_freecad.window.operations.fields import PropertyField

COLUMN = 8  # fields


class ObjectDialog(Dialog):
    """`made(document)` makes the object of what is selected, `is_one(feature)` knows one, and `view` is its view."""

    DONE = "cut"  # what becomes of what is selected

    def __init__(self, session, title, properties, labels, made, is_one, view):
        """A kind of it makes its buttons, and then calls `lay_out`."""
        super().__init__(session, title)
        self._title, self._made, self._is_one, self._view = title, made, is_one, view
        self.feature = None
        self._awaited = None  # what is done once the path is there
        self.headline = QtGui.QLabel()
        self.headline.setWordWrap(True)
        kinds = {name: (kind, tip) for name, kind, _, tip in properties}
        self.fields = {name: PropertyField(name, kinds[name][0], label, kinds[name][1]) for name, label in labels}
        self.preview_button = button("Preview", self.preview, "Shows the path in the document, and tells what is left")
        self.buttons = (self.preview_button,)

    def lay_out(self, *buttons, below=()):
        """`buttons`: of what is done with it once its path is there."""
        self.buttons = (self.preview_button, *buttons)
        forms = []
        for number, field in enumerate(self.fields.values()):
            if number % COLUMN == 0:
                forms.append(QtGui.QFormLayout())
            forms[-1].addRow(field.label, field.widget)
        box = QtGui.QVBoxLayout(self)
        box.addWidget(self.headline)
        box.addLayout(row(*forms))
        box.addLayout(row(None, *self.buttons))
        for part in below:
            box.addLayout(part) if isinstance(part, QtGui.QLayout) else box.addWidget(part)
        box.addWidget(self.message)
        self.resize(520, 340)

    @property
    def busy(self):
        """At what it was made for."""
        return False

    def goes_on(self):
        return self.busy

    def begin(self):
        """With the object that is selected, or a new one of the faces, edges or sketch that are."""
        self._awaited = None
        self.feature = None
        self._enable()
        try:
            self.feature = self._chosen()
        except Exception as error:
            self.headline.setText("")
            return self.failed(error)
        self.headline.setText(f"{self.feature.Label}: {_base_text(self.feature)}")
        for field in self.fields.values():
            field.take(self.feature)
        self._select()
        self._enable()
        self.preview()

    def preview(self):
        self.apply(lambda: None)

    def tick(self):
        """Paths come from threads."""
        if self._awaited is None:
            return
        try:
            view = self.feature.ViewObject.Proxy
            if view.busy:
                return
            then, self._awaited = self._awaited, None
            self._enable()
            if view.error is not None:
                return self.failed(view.error)
            self.message.tell(self._told())
            self._select()
        except ReferenceError:
            return self._gone()
        then()

    def hideEvent(self, event):
        self._awaited = None  # nothing begins that nobody sees
        super().hideEvent(event)

    def failed(self, error):
        self._awaited = None
        self._enable()
        super().failed(error)

    def _gone(self):
        self.feature = self._awaited = None
        self._enable()
        self.failed(ValueError(f"It was deleted from the document; select what is to be {self.DONE}, and open this anew."))

    def apply(self, then):
        """The fields' values become the object's, its path is made anew, and then it goes on."""
        if not is_there(self.feature):
            return self._gone()
        try:
            document = self.feature.Document
            document.openTransaction(self._title)
            changed = [field.give(self.feature) for field in self.fields.values()]
            document.commitTransaction()
            view = self.feature.ViewObject.Proxy
            if any(changed) or view.path is None or "Touched" in self.feature.State:
                self.feature.touch()
                document.recompute()
        except ReferenceError:
            return self._gone()
        self._awaited = then
        self._enable()
        self.message.tell("the path is made…")

    def _enable(self):
        for one in self.buttons:
            one.setEnabled(self.feature is not None and self._awaited is None and not self.busy)

    def _told(self):
        proxy = self.feature.Proxy
        return proxy.told(proxy.last[1]) if hasattr(proxy, "told") else "The path is in the document."

    def _chosen(self):
        for one in FreeCADGui.Selection.getSelection():
            if self._is_one(one):
                return one
        feature = self._made(FreeCAD.ActiveDocument)
        self._view(feature.ViewObject)
        return feature

    def _select(self):
        """So that machining means it."""
        FreeCADGui.Selection.clearSelection()
        FreeCADGui.Selection.addSelection(self.feature)


def is_there(feature):
    """What was deleted lives on where that can be undone."""
    try:
        return feature.Document.getObject(feature.Name) is not None
    except (ReferenceError, RuntimeError, AttributeError):
        return False


def _base_text(feature):
    for name in ("Base", "Faces", "Edges", "Holes"):
        base = getattr(feature, name, None)
        if base:
            pairs = base if isinstance(base, list) else [base]
            return ", ".join(f"{one.Label} {' '.join(part for part in parts if part)}".strip() for one, parts in pairs)
    return "what it was made of is gone"

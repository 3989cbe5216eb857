"""What was measured, held against the model: in colours, in figures, and what is corrected by it."""

import math

import FreeCAD
import FreeCADGui
from PySide import QtGui

from rmac_freecad.master import lengths_of, show_deviations, update_deviations
from rmac_freecad.measuring.comparison import Comparison
from rmac_freecad.measuring.kept import is_measured, measured_in
from rmac_freecad.measuring.refusal import MeasuringRefused
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.measuring.ticked_list import TickedList
from rmac_freecad.window.operations.object_dialog import is_there

FITTED, TAKEN = COLOURS = ("where it lies", "as it was taken to lie")


class CompareDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Compare with the model")
        self.kept = None
        self.comparison = None
        self.fits = False  # the places tell where the part lies
        self.shown = None  # the deviations, an object of the document
        self._sheets = {}
        self.headline, self.figures, self.scale = QtGui.QLabel(), QtGui.QLabel(), QtGui.QLabel()
        for label in (self.headline, self.figures):
            label.setWordWrap(True)
        self.faces = TickedList(("Faces by which it is fitted", "Places", "Worst, taken to lie", "Worst, where it lies"), self.compare)
        self.faces.itemClicked.connect(lambda item, column: self._select(item.text(0)))
        self.lengths = TickedList(("Sizes that may be corrected", "Is"), self._enable)
        self.colours = QtGui.QComboBox()
        self.colours.addItems(COLOURS)
        self.colours.activated.connect(lambda number: self.compare())
        self.upright = QtGui.QCheckBox("Leave its tilt out, as machines of slides alone need")
        self.upright.setChecked(True)
        self.placement_button = button("Correct the placement", self.correct_placement, "Moves the part in the document to where it lies. Edit > Undo takes it back")
        self.frame_button = button("Correct the part frame", self.correct_frame, "At the machine: the part lies in the new one as it is drawn. Nothing moves")
        self.lengths_button = button("Correct parameters", self.correct_lengths, "Fits the sizes that are ticked, and writes them into their cells. Edit > Undo takes it back")
        box = QtGui.QVBoxLayout(self)
        for part in (self.headline, self.faces, self.figures, row(QtGui.QLabel("Colours"), self.colours, self.scale, None), self.lengths, self.upright,
                     row(None, self.placement_button, self.frame_button, self.lengths_button), self.message):  # fmt: skip
            box.addLayout(part) if isinstance(part, QtGui.QLayout) else box.addWidget(part)
        self.resize(620, 480)

    def goes_on(self):
        return False

    def begin(self):
        self.kept = self.comparison = self.shown = None
        self._sheets = {}
        for text in (self.headline, self.figures, self.scale):
            text.setText("")
        self.faces.fill(())
        self.lengths.fill(())
        self._enable()
        try:
            self.kept = _chosen()
            self._held_against()
        except Exception as error:
            return self.failed(error)
        kept, part = self.kept, self.comparison.part
        self.headline.setText(f"{kept.Label}: {len(self.comparison.touched)} places on {len(self.comparison.faces)} faces of {part.Label}, by {kept.Machine}, {kept.When}")
        self.faces.fill([(name,) for name in self.comparison.faces], ticked=True)
        for sheet, name, mm in lengths_of(part):
            self._sheets[f"{sheet.Label}.{name}"] = sheet, name, mm
        self.lengths.fill([(called, f"{mm:.6g} mm") for called, (_, _, mm) in self._sheets.items()])
        self.lengths.setVisible(bool(self._sheets))
        self.lengths_button.setVisible(bool(self._sheets))
        self.compare()

    def compare(self):
        """By the faces that are ticked; the colours and the figures follow."""
        self.message.tell("")
        try:
            taken = self._held_against().taken
            fitted, refused = self._fitted()
            self.fits = fitted is not None
            left = fitted.left if fitted else None
            self._show(left if left is not None and self.colours.currentText() == FITTED else taken)
        except Exception as error:
            self.comparison = None
            self._enable()
            return self.failed(error)
        for number, name in enumerate(self.comparison.faces):
            there, after = taken.of([name]), left.of([name]) if left is not None else None
            self.faces.say(number, 1, str(len(there.touched)), _signed(there.worst), _signed(after.worst) if after else "—")
        told = [f"As it was taken to lie: {_figures(taken)}."]
        if fitted:
            told += [f"Where it lies: {_figures(left)}.", f"There, {fitted.placement}."]
        self.figures.setText("\n".join(told))
        self._enable()
        if refused is not None:
            self.failed(refused)

    def correct_placement(self):
        def correct(comparison):
            fitted = comparison.correct_placement(self.faces.ticked())
            return f"{comparison.part.Label} stands where it lies; Edit > Undo takes it back. What is left: {_figures(fitted.left)}. Measure anew to go on."

        self._correct(correct)

    def correct_lengths(self):
        def correct(comparison):
            chosen = [self._sheets[name] for name in self.lengths.ticked()]
            if not chosen:
                raise MeasuringRefused("Tick the sizes that are to be corrected.")
            if any(sheet != chosen[0][0] for sheet, _, _ in chosen):
                raise MeasuringRefused("The sizes that are ticked are of several spreadsheets; correct those of one first.")
            fit = comparison.correct_parameters(self.faces.ticked(), chosen[0][0], [name for _, name, _ in chosen])
            return f"{fit}. It is written; Edit > Undo takes it back. Measure anew to go on."

        self._correct(correct)

    def correct_frame(self):
        try:
            correct = self._held_against().correcting_frame(self.faces.ticked(), self.upright.isChecked())
        except Exception as error:
            return self.failed(error)
        self.frame_button.setEnabled(False)
        self.change(correct, self._frame_corrected, "the part frame is corrected…")

    def failed(self, error):
        super().failed(error)
        self._enable()

    def _correct(self, correct):
        """By the document as it is now."""
        try:
            told = correct(self._held_against())
        except Exception as error:
            return self.failed(error)
        self.comparison = None
        self._enable()
        self.message.tell(told)

    def _frame_corrected(self, frames):
        before, after = (frame["p"] for frame in frames)
        turn = math.degrees(2 * math.acos(min(1.0, abs(sum(a * b for a, b in zip(*(frame["q"] for frame in frames)))))))
        shift = " ".join(f"{axis} {b - a:+.4f}" for axis, a, b in zip("XYZ", before, after))
        if is_there(self.kept):
            self.kept.Corrected = "The part frame at the machine"
            self.kept.purgeTouched()
        self._enable()
        self.message.tell(f"The part frame was moved by {shift} mm and turned by {turn:.4f}°. What is machined in it lies on the part as it is drawn. Measure anew to see what is left.")

    def _held_against(self):
        if not is_there(self.kept):
            self.comparison = None
            raise MeasuringRefused("What was measured is not there any more: it was deleted, or its document was closed.")
        self.comparison = Comparison(self.kept)
        return self.comparison

    def _fitted(self):
        """And why there is none: what was measured is shown all the same."""
        try:
            return self.comparison.fitted(self.faces.ticked()), None
        except Exception as error:
            return None, error

    def _show(self, found):
        document, label = self.kept.Document, f"Deviations of {self.kept.Label}"
        if self.shown is None or not is_there(self.shown):
            self.shown = next((one for one in document.Objects if one.Label == label and hasattr(one, "Deviation")), None)
        if self.shown is None:
            self.shown = show_deviations(document, found, label=label)
        else:
            update_deviations(self.shown, found)
        self.scale.setText(f"red, too much; blue, too little; full at {abs(found.worst):.4f} mm")

    def _select(self, face):
        """So that one sees which it is."""
        if self.comparison is not None and is_there(self.comparison.part):
            FreeCADGui.Selection.clearSelection()
            FreeCADGui.Selection.addSelection(self.comparison.part, face)

    def _enable(self):
        for one in (self.placement_button, self.frame_button, self.lengths_button):
            one.setEnabled(self.comparison is not None and self.fits)


def _chosen():
    """What is selected, or measured last on what is selected, or in the document."""
    there = measured_in(FreeCAD.ActiveDocument)
    if not there:
        raise MeasuringRefused("nothing was measured in this document; select faces of a part, and Measure a part")
    for one in FreeCADGui.Selection.getSelection():
        if is_measured(one):
            return one
        of_it = [kept for kept in there if kept.Part == one]
        if of_it:
            return of_it[-1]
    return there[-1]


def _figures(found):
    return f"rms {found.rms:.4f} mm, worst {_signed(found.worst)}"


def _signed(mm):
    return f"{round(mm, 4) + 0.0:+.4f} mm"


show = OnlyOne(CompareDialog)


def show_for(kept, here):
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(kept)
    show(here)

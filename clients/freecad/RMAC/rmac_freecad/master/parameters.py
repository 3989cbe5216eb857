"""Named lengths of a model, corrected from what was measured on the part."""

import re
from dataclasses import dataclass

import numpy as np

from rmac_freecad.master.model import Model, NoFace, measured_points
from rmac_freecad.master.placement import INSTRUMENT_MM, fit_placement
from rmac_freecad.master.refusal import MasterRefused, document_of
from rmac_freecad.master.rigid import FREEDOMS, check_held, covariance, placement_of, matrix_of, rows, spread_of

CELL = re.compile(r"^[A-Z]{1,2}[1-9]\d*$")
STEP_MM = 0.02  # by which each parameter is changed to see what it moves
MOST_ROUNDS = 8
DONE_MM = 1e-6
WRITTEN = re.compile(r"^=?\s*[-+]?[\d.,]+(e[-+]?\d+)?\s*[^\W\d]*[\"\']?$", re.I)  # a number and its unit


@dataclass(frozen=True)
class ParametersFit:
    sheet: object
    names: tuple
    nominal: tuple  # mm
    values: tuple  # mm, as they are in the part
    uncertainty: tuple  # mm, one standard deviation
    before: np.ndarray  # distances of the points, with the part where it lies
    after: np.ndarray
    placement: object  # where the model lies, fitted with them

    def __str__(self):
        return "; ".join(f"{name} {old:.4g} mm is {new:.4f} ± {2 * sure:.4f} mm" for name, old, new, sure in zip(self.names, self.nominal, self.values, self.uncertainty))


def lengths_of(feature):
    """What `fit_parameters` may be asked for: sheet, alias and mm of each written length on whose sheet the feature depends."""
    found = []
    for sheet in feature.OutListRecursive:
        if sheet.isDerivedFrom("Spreadsheet::Sheet"):
            for name in filter(None, (sheet.getAlias(cell) for cell in sheet.PropertiesList if CELL.match(cell))):
                try:
                    found.append((sheet, name, _length(sheet, name)))
                except MasterRefused:
                    pass  # it is computed, or no length
    return found


def fit_parameters(feature, sheet, names, touched, instrument_mm=INSTRUMENT_MM):
    """`names` are aliases of cells with lengths, on which `feature` depends. The part's place is fitted with them, so that neither is
    taken for the other. The document is left as it was. Raises `MasterRefused`."""
    document = _document_of(feature, sheet)
    nominal = [_length(sheet, name) for name in names]
    if not names:
        raise MasterRefused("no parameter was named")
    measured = measured_points(touched)
    centre = measured.mean(0)
    shapes = _Shapes(document, feature, sheet, names)
    document.openTransaction("Look at parameters")
    try:
        start = fit_placement(shapes.at(nominal), touched, instrument_mm)  # else a part that lies far off is taken for sizes that are
        values, rotation, shift = np.array(nominal), matrix_of(start.turn), start.shift
        before = None
        for _ in range(MOST_ROUNDS):
            points = (measured - centre - shift) @ rotation + centre
            off, _, normals = shapes.model_at(values, touched).held_against(points)
            before = off if before is None else before
            moved = [shapes.model_at(values + STEP_MM * one, touched).held_against(points)[0] for one in np.eye(len(names))]
            jacobian = np.column_stack([rows(points, normals, centre), *[(off - other) / STEP_MM for other in moved]])
            scales = np.array([1.0] * 3 + [spread_of(points, centre)] * 3 + [1.0] * len(names))
            check_held(jacobian, (*FREEDOMS, *names), scales)
            step = np.linalg.lstsq(jacobian / scales, off, rcond=None)[0] / scales
            shift = shift + rotation @ step[:3]
            rotation = rotation @ matrix_of(step[3:6])
            values = values + step[6:]
            if np.abs(step * scales).max() < DONE_MM:
                break
        else:
            raise MasterRefused("the fit does not come to rest; is this the part that was measured?")
        sure = np.sqrt(np.diag(covariance(jacobian, off, instrument_mm)))[6:]
    finally:
        document.abortTransaction()
        shapes.restore()  # a document that keeps no undo steps has nothing to go back to
    placement = placement_of(rotation, centre + shift - rotation @ centre)
    return ParametersFit(sheet, tuple(names), tuple(nominal), tuple(map(float, values)), tuple(map(float, sure)), before, off, placement)


def correct_parameters(feature, fit):
    """Writes the values into their cells and computes the model anew, in one step that can be undone. A model that cannot be computed
    with them is refused, and stays as it was."""
    document = _document_of(feature, fit.sheet)
    shapes = _Shapes(document, feature, fit.sheet, fit.names)
    document.openTransaction(f"Correct {', '.join(fit.names)}")
    try:
        shapes.at(fit.values)
    except MasterRefused:
        document.abortTransaction()
        shapes.restore()
        raise
    document.commitTransaction()


class _Shapes:
    """The feature's shape with other values in the cells."""

    def __init__(self, document, feature, sheet, names):
        self._document, self._feature, self._sheet, self._names = document, feature, sheet, names
        self._cells = [_cell(sheet, name) for name in names]
        self._texts = [sheet.getContents(cell) for cell in self._cells]
        needed = {feature.Name, *(one.Name for one in feature.OutListRecursive)}
        self._watched = [one for one in document.Objects if one.Name in needed or "Invalid" not in one.State]  # what else was broken before may stay so

    def restore(self):
        for cell, text in zip(self._cells, self._texts):
            if self._sheet.getContents(cell) != text:
                self._sheet.set(cell, text)
        self._document.recompute()

    def at(self, values):
        for cell, value in zip(self._cells, values):
            self._sheet.set(cell, f"={float(value):.9f} mm")
        self._document.recompute()
        broken = [one.Label for one in self._watched if "Invalid" in one.State]
        if broken or self._feature.Shape.isNull():
            raise MasterRefused(f"with {self._told(values)} the model cannot be computed: {', '.join(broken) or self._feature.Label} is broken")
        shape = self._feature.Shape.copy()
        shape.Placement = self._feature.getGlobalPlacement()
        return shape

    def model_at(self, values, touched):
        try:
            return Model(self.at(values), touched)
        except NoFace as gone:
            raise MasterRefused(f"with {self._told(values)}, {gone}, or set the parameters nearer to what they are") from gone

    def _told(self, values):
        return ", ".join(f"{name} {value:.4f} mm" for name, value in zip(self._names, values))


def _document_of(feature, sheet):
    document = document_of(feature)
    if document_of(sheet).Name != document.Name:
        raise MasterRefused(f"{sheet.Label} is in the document {sheet.Document.Label}, and {feature.Label} in {document.Label}; correct a model whose spreadsheet is in its document")
    return document


def _cell(sheet, name):
    cell = sheet.getCellFromAlias(name)
    if not cell:
        raise MasterRefused(f"{sheet.Label} has no cell with the alias {name}")
    return cell


def _length(sheet, name):
    cell = _cell(sheet, name)
    if not WRITTEN.match(sheet.getContents(cell)):
        raise MasterRefused(f"{name} is computed ({sheet.getContents(cell)}); correct what it is computed from")
    value = getattr(sheet, name)
    if str(getattr(value, "Unit", "")).find("Length") < 0:
        raise MasterRefused(f"{name} is {value}, which is no length; write it with its unit, as 4 mm")
    return value.Value

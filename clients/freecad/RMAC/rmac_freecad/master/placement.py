"""Where a part lies, by least squares over the distances of measured points from the model's faces."""

import math
from dataclasses import dataclass

import FreeCAD
import numpy as np

from rmac_freecad.master.model import Model, measured_points
from rmac_freecad.master.refusal import MasterRefused, document_of
from rmac_freecad.master.rigid import FREEDOMS, check_held, covariance, matrix_of, placement_of, rows, spread_of

MOST_STEPS = 30
DONE_MM = 1e-9
INSTRUMENT_MM = 0.5e-3  # one standard deviation of a hit: docs/measuring.md


@dataclass(frozen=True)
class PlacementFit:
    """`placement` takes the model, as it was taken to lie, to where it lies. Distances in mm, out of the material."""

    placement: FreeCAD.Placement
    before: np.ndarray
    after: np.ndarray
    centre: np.ndarray  # of the measured places: the shift is told there
    shift: np.ndarray  # of that centre
    turn: np.ndarray  # rad, about x, y, z
    covariance: np.ndarray  # of shift and turn, one standard deviation squared
    stood: FreeCAD.Placement  # the shape's, as it was taken to lie

    @property
    def uncertainty(self):
        """Standard deviations: three of the shift in mm, three of the turn in rad."""
        return np.sqrt(np.diag(self.covariance))

    def uncertainty_at(self, point):
        """Standard deviation of where that point of the part lies, in mm, all directions together."""
        arm = np.asarray(point, float) - self.centre
        cross = np.array([[0, arm[2], -arm[1]], [-arm[2], 0, arm[0]], [arm[1], -arm[0], 0]])
        jacobian = np.hstack([np.eye(3), cross])
        return math.sqrt(np.trace(jacobian @ self.covariance @ jacobian.T))

    def __str__(self):
        sure = self.uncertainty
        shift = ", ".join(f"{axis} {value:+.4f} ± {2 * one:.4f} mm" for axis, value, one in zip("XYZ", self.shift, sure[:3]))
        turn = ", ".join(f"{axis} {math.degrees(value):+.4f} ± {math.degrees(2 * one):.4f}°" for axis, value, one in zip("XYZ", self.turn, sure[3:]))
        return f"the part's middle is off by {shift}; it is turned about {turn} (± two standard deviations)"


def fit_placement(shape, touched, instrument_mm=INSTRUMENT_MM):
    """`shape` as it was taken to lie, in the part frame. Raises `MasterRefused` where the places do not hold the part."""
    if len(touched) < 7:
        raise MasterRefused(f"{len(touched)} places were measured; where a part lies takes six, and one more tells how sure that is")
    measured = measured_points(touched)
    centre = measured.mean(0)
    model = Model(shape, touched)
    before, _, _ = model.held_against(measured)
    rotation, shift = np.eye(3), np.zeros(3)  # of the part, about the centre
    for _ in range(MOST_STEPS):
        points = (measured - centre - shift) @ rotation + centre  # where they are on a part that lies as it was taken to
        off, _, normals = model.held_against(points)
        jacobian = rows(points, normals, centre)
        scales = np.array([1.0] * 3 + [spread_of(points, centre)] * 3)
        check_held(jacobian, FREEDOMS, scales)
        step = np.linalg.lstsq(jacobian / scales, off, rcond=None)[0] / scales
        shift = shift + rotation @ step[:3]
        rotation = rotation @ matrix_of(step[3:])
        if np.abs(step * scales).max() < DONE_MM:
            break
    else:
        raise MasterRefused("the fit does not come to rest; is this the part that was measured?")
    placement = placement_of(rotation, centre + shift - rotation @ centre)
    return PlacementFit(placement, before, off, centre, shift, _turn_of(rotation), covariance(jacobian, off, instrument_mm), shape.Placement)


def _turn_of(rotation):
    vector = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]]) / 2
    size = np.linalg.norm(vector)
    return vector if size < 1e-12 else vector * math.atan2(size, (np.trace(rotation) - 1) / 2) / size


def corrected_frame(part_frame, fit, upright=False):
    """The part frame in which the part lies as the model does: what `client.cam.SetPartFrame` takes, from what `GetPartFrame` gave when it was
    measured. `upright` leaves the tilt of the part out, about the middle of the places, for machines that cannot follow one."""
    w, *xyz = part_frame["q"]
    frame = FreeCAD.Placement(FreeCAD.Vector(*part_frame["p"]), FreeCAD.Rotation(*xyz, w))
    placement = fit.placement
    if upright:
        rotation = matrix_of(np.array([0, 0, fit.turn[2]]))
        placement = placement_of(rotation, fit.centre + fit.shift - rotation @ fit.centre)
    found = frame * placement
    x, y, z, w = found.Rotation.Q
    return {"p": list(found.Base), "q": [w, x, y, z]}


def correct_placement(feature, fit):
    """Puts the object where it lies, or the body that it is in, in one step that can be undone; the document keeps undo steps where `UndoMode`
    is 1. Refused where it does not stay there."""
    document, moved = document_of(feature), _moved_with(feature)
    if moved.ExpressionEngine and any(path.startswith("Placement") for path, _ in moved.ExpressionEngine):
        raise MasterRefused(f"an expression rules the placement of {moved.Label}; correct what it refers to")
    if getattr(moved, "MapMode", "Deactivated") != "Deactivated":
        raise MasterRefused(f"{moved.Label} is attached, and would be put back when what it is attached to changes; correct that, or detach it")
    if not _same(feature.getGlobalPlacement(), fit.stood):
        raise MasterRefused(f"{feature.Label} does not stand where the shape stood to which the fit was made; it may have been corrected already: fit anew, to its shape as it stands in the document")
    stood, outer = moved.Placement, moved.getGlobalPlacement() * moved.Placement.inverse()
    document.openTransaction(f"Correct where {feature.Label} lies")
    moved.Placement = outer.inverse() * fit.placement * outer * stood
    document.recompute()
    if not _same(feature.getGlobalPlacement(), fit.placement * fit.stood):
        document.abortTransaction()
        moved.Placement = stood  # a document that keeps no undo steps has nothing to go back to
        document.recompute()
        raise MasterRefused(f"{moved.Label} does not stay where it was put, as it is computed from others; correct where those stand")
    document.commitTransaction()


def _moved_with(feature):
    """A body computes where its features stand; it is moved with all of them."""
    group = feature.getParentGeoFeatureGroup()
    return group if group is not None and group.isDerivedFrom("PartDesign::Body") else feature


def _same(one, other):
    return np.allclose(one.Matrix.A, other.Matrix.A, rtol=0, atol=1e-9)

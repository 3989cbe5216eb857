"""How far measured points are off the faces of a model."""

from dataclasses import dataclass

import FreeCAD
import numpy as np

from rmac_freecad.master.model import Model, measured_points
from rmac_freecad.master.refusal import MasterRefused


@dataclass(frozen=True)
class Deviations:
    """mm, out of the material: more material is more."""

    touched: tuple
    off: np.ndarray

    @property
    def rms(self):
        return float(np.sqrt((self.off**2).mean()))

    @property
    def worst(self):
        """With its sign."""
        return float(self.off[np.abs(self.off).argmax()])

    def of(self, names):
        """Those on these faces."""
        chosen = [number for number, one in enumerate(self.touched) if one.place.face in names]
        if not chosen:
            raise MasterRefused(f"no place was measured on {', '.join(names)}")
        return Deviations(tuple(self.touched[number] for number in chosen), self.off[chosen])


def deviations(shape, touched, placement=None):
    """`placement` takes the model to where it lies, as a `PlacementFit` has it; without one it lies where it was taken to lie."""
    points = measured_points(touched)
    if placement is not None:
        back = placement.inverse()
        points = np.array([tuple(back.multVec(FreeCAD.Vector(*map(float, point)))) for point in points])
    off, _, _ = Model(shape, touched).held_against(points)
    return Deviations(tuple(touched), off)

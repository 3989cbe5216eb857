"""What was measured, held against the part as it is drawn: where it lies, how far its faces are off, and what is corrected by that."""

from dataclasses import dataclass

import numpy as np

from rmac_freecad.master import (
    Deviations,
    PlacementFit,
    correct_parameters,
    correct_placement,
    corrected_frame,
    deviations,
    fit_parameters,
    fit_placement,
)
from rmac_freecad.measuring.kept import part_frame_of, part_of, touched_of
from rmac_freecad.measuring.refusal import MeasuringRefused

SAME = 1e-9  # of numbers of a frame


@dataclass(frozen=True)
class Fitted:
    placement: PlacementFit
    left: Deviations  # of all places, with the part where it lies


class Comparison:
    """Refused where the part is not as it was measured."""

    def __init__(self, kept):
        self.kept = kept
        self.part, self.shape = part_of(kept)
        self.touched = touched_of(kept)
        self.taken = deviations(self.shape, self.touched)  # as the part was taken to lie
        self.faces = tuple(dict.fromkeys(one.place.face for one in self.touched))

    def fitted(self, faces):
        """By the places on these faces."""
        placement = fit_placement(self.shape, self._on(faces))
        return Fitted(placement, deviations(self.shape, self.touched, placement.placement))

    def correct_placement(self, faces):
        """In one step that can be undone."""
        if self.kept.Corrected:
            raise MeasuringRefused(f"{self.kept.Corrected} was corrected by this already; to move the part, too, would correct it twice. Measure anew.")
        fitted = self.fitted(faces)
        correct_placement(self.part, fitted.placement)
        return fitted

    def correcting_frame(self, faces, upright):
        """What a thread may call with a client that has authority: the part frame at the machine becomes the one in which the part lies as it is
        drawn. Gives it as it was and as it is."""
        fit, measured = self.fitted(faces).placement, part_frame_of(self.kept)

        def correct(client):
            before = client.cam.GetPartFrame()
            if not np.allclose([*before["p"], *before["q"]], [*measured["p"], *measured["q"]], rtol=0, atol=SAME):
                raise MeasuringRefused("The part frame at the machine is not the one in which the part was measured: it was set anew, or corrected already. Measure anew.")
            frame = corrected_frame(before, fit, upright)
            client.cam.SetPartFrame(frame)
            return before, frame

        return correct

    def correct_parameters(self, faces, sheet, names):
        """In one step that can be undone."""
        fit = fit_parameters(self.part, sheet, names, self._on(faces))
        correct_parameters(self.part, fit)
        return fit

    def _on(self, faces):
        return [one for one in self.touched if one.place.face in faces]

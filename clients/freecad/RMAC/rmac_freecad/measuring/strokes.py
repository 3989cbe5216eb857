"""The way of a probe to its places, to be drawn: one stroke a place, with the tip where it touches."""

import math

from rmac_freecad.path import Stroke

CHORDS = 24


def strokes_of_places(places, tip_radius_mm, clearance_mm, safe_mm):
    """Across at the safe height, down, along the normal, and round the tip."""
    strokes, at = [], None
    for index, place in enumerate(places):
        tip, over = ((tuple(a + by * b for a, b in zip(place.point, place.normal))) for by in (tip_radius_mm, tip_radius_mm + clearance_mm))
        above = (*over[:2], safe_mm)
        strokes.append(Stroke(index, (*([] if at is None else [at]), above, over, place.point, *_tip(tip, tip_radius_mm, place.normal))))
        at = above
    return strokes


def strokes_of_touched(touched, tip_radius_mm):
    """The tip alone, where it was."""
    return [Stroke(index, (one.measured, *_tip(tuple(a + tip_radius_mm * b for a, b in zip(one.measured, one.place.normal)), tip_radius_mm, one.place.normal)))
            for index, one in enumerate(touched)]  # fmt: skip


def _tip(centre, radius, normal):
    """From where it touches round it twice, in two planes."""
    across = _across(normal)
    for beside in (across, _cross(normal, across)):
        for number in range(CHORDS + 1):
            angle = 2 * math.pi * number / CHORDS
            yield tuple(c - radius * math.cos(angle) * n + radius * math.sin(angle) * b for c, n, b in zip(centre, normal, beside))


def _across(normal):
    other = _cross(normal, (1.0, 0.0, 0.0) if abs(normal[0]) < 0.7 else (0.0, 1.0, 0.0))
    length = math.hypot(*other)
    return tuple(value / length for value in other)


def _cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

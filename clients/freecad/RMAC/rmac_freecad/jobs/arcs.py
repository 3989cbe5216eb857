"""G2 and G3 as the appliance's arcs. FreeCAD gives the centre from the start, whatever the plane."""

import math

import rmac

from rmac_freecad.jobs.refusal import JobRefused

# Axes in the plane, and across it.
PLANES = {"G17": (0, 1, 2), "G18": (2, 0, 1), "G19": (1, 2, 0)}
CLOSED_MM = 1e-6
# A centre may be so far from evenly between both ends: RS274's own bounds for rounded programs.
MOST_OFF_MM, MOST_OFF_OF_RADIUS = 0.005, 0.001


def arc(begin, end, words, plane, clockwise, place):
    first, second, across = PLANES[plane]
    normal = tuple(1 if axis == across else 0 for axis in range(3))
    arm = [words.get(letter, 0.0) for letter in "IJK"]
    if abs(arm[across]) > CLOSED_MM:
        raise JobRefused(f"{'IJK'[across]} leads out of the arc's plane {plane}", place)
    center = [begin[axis] + (arm[axis] if axis != across else 0.0) for axis in range(3)]
    from_begin = math.hypot(arm[first], arm[second])
    from_end = math.hypot(end[first] - center[first], end[second] - center[second])
    if from_begin < CLOSED_MM:
        raise JobRefused("an arc needs its centre (I, J, K), which is not where it begins", place)
    chord = math.hypot(end[first] - begin[first], end[second] - begin[second])
    off = abs(from_begin - from_end)
    if off > MOST_OFF_MM and off > MOST_OFF_OF_RADIUS * from_begin:
        raise JobRefused(f"the centre is {from_begin:.4f} mm from the arc's start and {from_end:.4f} mm from its end", place)
    closed = chord < CLOSED_MM
    if not closed:
        _center_evenly(center, begin, end, first, second, chord, off)
    return rmac.Arc(begin, end, center, normal, clockwise=clockwise, closed=closed)


def _center_evenly(center, begin, end, first, second, chord, off):
    """Moves a rounded centre along the chord to be evenly far from both ends. Where the arc nearly closes, that would take it
    far from what was written; then it stays."""
    along = [(end[axis] - begin[axis]) / chord for axis in (first, second)]
    middle = [(end[axis] + begin[axis]) / 2 for axis in (first, second)]
    away = sum(u * (center[axis] - m) for u, axis, m in zip(along, (first, second), middle))
    if abs(away) <= 2 * off:
        for u, axis in zip(along, (first, second)):
            center[axis] -= away * u

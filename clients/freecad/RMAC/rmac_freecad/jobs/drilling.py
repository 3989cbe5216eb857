"""Canned cycles, written out: G73, G81, G82, G83."""

import math

from rmac_freecad.jobs.refusal import JobRefused

BACK_OFF_MM = 0.254  # LinuxCNC's 0.010 inch: where a peck goes on, and how far chips are broken
MOST_PECKS = 10_000
SAME_DEPTH = 1e-9


def drill(mover, code, words, feed, initial, place, dwell_s=0.0):
    """`initial` is the height above R that G98 retracts to; None where G99 holds. `dwell_s`: at the bottom of a cycle whose code tells none."""
    for letter in {"G73": "ZRQ", "G81": "ZR", "G82": "ZRP", "G83": "ZRQ"}[code]:
        if letter not in words:
            raise JobRefused(f"a {code} needs {letter}", place)
    retract, bottom = words["R"], words["Z"]
    if bottom > retract:
        raise JobRefused("the hole's bottom (Z) is above the retract height (R)", place)
    clear = retract if initial is None else max(initial, retract)
    if mover.start(place)[2] < retract:
        mover.rapid({"Z": retract}, place)
    mover.rapid({axis: words[axis] for axis in "XY" if axis in words}, place)
    mover.rapid({"Z": retract}, place)
    if code in ("G73", "G83"):
        _peck(mover, code, words["Q"], retract, bottom, feed, place)
    mover.line({"Z": bottom}, feed, place)
    if code == "G82" or dwell_s:
        mover.dwell(words["P"] if code == "G82" else dwell_s, place)
    mover.rapid({"Z": clear}, place)


def _peck(mover, code, peck, retract, bottom, feed, place):
    """All pecks but the last. By number: a peck may be too small to change the depth that it is taken from."""
    if not peck > 0 or (retract - bottom) / peck > MOST_PECKS:
        raise JobRefused(f"a peck of {peck:g} mm for a hole of {retract - bottom:g} mm", place)
    for number in range(1, math.ceil((retract - bottom) / peck - SAME_DEPTH)):
        depth = retract - number * peck
        mover.line({"Z": depth}, feed, place)
        if code == "G83":
            mover.rapid({"Z": retract}, place)
        mover.rapid({"Z": min(depth + BACK_OFF_MM, retract)}, place)

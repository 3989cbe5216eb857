"""How near the holder comes to the clamp's stud, by places of the stud's surface held against the holder's cone: nothing of it is the appliance's."""

import clamping
import numpy as np
import swept

LOW, HIGH, TALL = clamping.HOLDER[0]  # the section that is nearest to the part
SLANT = (HIGH - LOW) / TALL


def stud():
    """Places on the top of the stud and on its side below, part frame."""
    x, y = clamping.STUD_PLACE
    turn = np.linspace(0, 2 * np.pi, 181)[:-1]
    rings = [(share * clamping.STUD_RADIUS, clamping.STUD_TOP) for share in np.linspace(0, 1, 21)]
    rings += [(clamping.STUD_RADIUS, clamping.STUD_TOP - down) for down in np.linspace(0.25, 15, 60)]
    return np.concatenate([np.stack([x + r * np.cos(turn), y + r * np.sin(turn), np.full_like(turn, z)], 1) for r, z in rings])


def from_holder(up, across):
    """Distance from the holder's lowest section of places `up` its axis from the tip and `across` from it; negative inside."""
    below = clamping.HOLDER_FROM - up
    beside = (across - LOW - SLANT * (up - clamping.HOLDER_FROM)) / np.hypot(1, SLANT)
    return np.where((below > 0) & (across > LOW), np.hypot(below, across - LOW), np.maximum(below, beside))


def gaps(joints):
    """Of each row of joints, mm; negative: how deep the deepest place of the stud is in the holder."""
    here = stud()
    nearest = []
    motion = swept.motion(joints)
    for middle, axis in zip(motion.middle, motion.axis):
        way = here - middle
        up = way @ axis
        across = np.sqrt(np.maximum((way**2).sum(1) - up**2, 0))
        nearest.append(from_holder(up + clamping.BALL_RADIUS, across).min())
    return np.array(nearest)


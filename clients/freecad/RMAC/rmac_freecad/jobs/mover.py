"""Where the tool is, and the moves that take it on. Lengths are in mm, feeds in mm a minute."""

import math

import rmac

from rmac_freecad.jobs.arcs import arc
from rmac_freecad.jobs.refusal import JobRefused

SAME_PLACE_MM = 1e-6  # FreeCAD computes in double precision; what is closer is rounding


class Mover:
    def __init__(self, program, rapid_mm_min):
        self._program = program
        self._fastest = rapid_mm_min
        self.rapids_mm_min = (rapid_mm_min, rapid_mm_min)  # sideways, along Z
        self._at = {}
        self._feed_in_force = None

    def forget(self):
        """A tool changer leaves the joints where nobody here knows."""
        self._at = {}

    def set_rapids(self, horizontal, vertical):
        """0 is as fast as the machine may go."""
        self.rapids_mm_min = tuple(min(rapid or self._fastest, self._fastest) for rapid in (horizontal, vertical))

    def start(self, place):
        if len(self._at) < 3:
            lacking = ", ".join(axis for axis in "XYZ" if axis not in self._at)
            raise JobRefused(f"nobody knows {lacking} here; a rapid (G0) must have said where the tool is first", place)
        return self._at["X"], self._at["Y"], self._at["Z"]

    def target(self, words, place):
        x, y, z = self.start(place)
        return words.get("X", x), words.get("Y", y), words.get("Z", z)

    def rapid(self, words, place):
        """Until all of X, Y and Z are known nothing moves: the first rapid that completes them goes there straight."""
        before = self._at
        after = {**before, **{axis: words[axis] for axis in "XYZ" if axis in words}}
        self._at = after
        if len(after) < 3:
            return
        target = after["X"], after["Y"], after["Z"]
        known = len(before) == 3
        if known and math.dist(target, tuple(before[axis] for axis in "XYZ")) < SAME_PLACE_MM:
            return
        upright = known and math.dist(target[:2], (before["X"], before["Y"])) < SAME_PLACE_MM
        self._set_feed(self.rapids_mm_min[1 if upright else 0], place)
        self._program.append(rmac.MoveTo(target), place)

    def line(self, words, feed, place):
        begin, end = self.start(place), self.target(words, place)
        if math.dist(begin, end) < SAME_PLACE_MM:
            return
        self._set_feed(feed, place)
        self._program.append(rmac.Line(begin, end), place)
        self._go_on(end)

    def arc(self, words, plane, clockwise, feed, place):
        begin, end = self.start(place), self.target(words, place)
        made = arc(begin, end, words, plane, clockwise, place)
        self._set_feed(feed, place)
        self._program.append(made, place)
        self._go_on(end)

    def follow(self, curve, feed, place):
        """A NURBS that begins where the tool is."""
        self._set_feed(feed, place)
        self._program.append(rmac.Nurbs(curve), place)
        self._go_on(curve.points[-1])

    def dwell(self, seconds, place):
        if not seconds >= 0:
            raise JobRefused("a dwell of less than no time", place)
        self._program.append(rmac.Dwell(seconds), place)

    def _go_on(self, end):
        self._at = dict(zip("XYZ", end))

    def _set_feed(self, feed, place):
        if feed != self._feed_in_force:
            self._program.append(rmac.calls.RMAC_CAM.SetFeedrate(feed), place)
            self._feed_in_force = feed

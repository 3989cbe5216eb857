"""The program of a sweep with five axes."""

import math

import numpy as np

import rmac
from rmac_freecad.program import Place, Program
from rmac_freecad.surfaces.beginning import begin_program
from rmac_freecad.surfaces.fit import DEGREE
from rmac_freecad.surfaces.five.links import KNOTS

OVER_MM = 0.5  # of the place where it plunges: from there on at its own feed
SAME = 1e-9


class Writer:
    """`inset_mm` is how far up its axis the mill stands in the one that was held against the part."""

    def __init__(self, label, links, feeds, inset_mm):
        self.program = Program()
        self._label, self._links, self._feeds, self._inset = label, links, feeds, inset_mm
        self._in_force = self._at = None

    def begin(self, tool, rpm):
        begin_program(self.program, self._label, tool, rpm)

    def cut(self, number, curves):
        for knots, poles in curves:
            self._go_to(poles[0], number)
            self._along(knots, poles, DEGREE, Place(self._label, number, "pass"))

    def end(self, rpm):
        place = Place(self._label, 1, "end")
        if self._at is not None:
            self._to(self._links.out(self._at), place)
        if rpm is not None:
            self.program.append(rmac.spindle(0), place)

    def _go_to(self, begin, number):
        place = Place(self._label, number, "link")
        poles = None if self._at is None else self._links.between(self._at, begin)
        if poles is not None:
            return self._along(KNOTS, poles, 3, place)
        ways = self._links.out(begin)[::-1]
        if self._at is not None:
            place = Place(self._label, number, "retract")
            up = self._links.out(self._at)
            self._to(up, place)
            self._to(self._links.over(up[-1], ways[0]), place)
        self._to(ways, place)
        above = begin.copy()
        above[:3] += min(OVER_MM, math.dist(ways[-1][:3], begin[:3])) * begin[3:]
        self._to([above], place)
        self._set_feed("plunge_mm_min", place)
        self.program.append(rmac.Line(*(tuple(self._real(pose).tolist()) for pose in (above, begin))), place)
        self._at = begin

    def _to(self, poses, place):
        for pose in poses:
            if self._at is not None and abs(self._at - pose).max() < SAME:
                continue
            self._set_feed("rapid_mm_min", place)
            self.program.append(rmac.MoveTo(tuple(self._real(pose).tolist())), place)
            self._at = pose

    def _along(self, knots, poles, degree, place):
        self._set_feed("feed_mm_min", place)
        self.program.append(rmac.PoseNurbs(rmac.NurbsCurve(degree, knots, self._real(poles))), place)
        self._at = poles[-1]

    def _real(self, poses):
        return poses + self._inset * np.concatenate([poses[..., 3:], np.zeros_like(poses[..., 3:])], -1)

    def _set_feed(self, name, place):
        if self._feeds[name] != self._in_force:
            self._in_force = self._feeds[name]
            self.program.append(rmac.calls.RMAC_CAM.SetFeedrate(self._in_force), place)

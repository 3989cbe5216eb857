"""Lines and arcs of the tool tip."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

from rmac.geometry.numbers import text, vector, whole
from rmac.geometry.pose import Point, Pose, pose
from rmac.geometry.vectors import cross, dot, mixed, turned
from rmac.moves.move import Move


class FromTo(Move):
    """From one pose to another."""

    __slots__ = ("begin", "target")
    begin: Pose
    target: Pose

    @property
    def start(self) -> Point:  # type: ignore[override]
        return self.begin.p

    @property
    def end(self) -> Point:  # type: ignore[override]
        return self.target.p


class Line(FromTo):
    __slots__ = ()
    method = "RMAC_CAM.MoveAlongLine"

    def __init__(self, start: Any, end: Any) -> None:
        self.begin = start if type(start) is Pose else pose(start, "Line: start")
        self.target = end if type(end) is Pose else pose(end, "Line: end")

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"StartPoint":{self.begin.text},"EndPoint":{self.target.text}}}'

    def rest(self, length: float) -> Line | None:
        whole = math.dist(self.begin.p, self.target.p)
        if length >= whole:
            return None
        t = max(length, 0) / whole
        return Line(Pose(mixed(self.begin.p, self.target.p, t), turned(self.begin.axis, self.target.axis, t)), self.target)


class Arc(FromTo):
    """About the axis `normal` through `center`, counter-clockwise as seen against it unless `clockwise`. `closed` makes a
    full turn and `turns` as many more. An end off the start's plane makes it a helix."""

    __slots__ = ("center", "normal", "clockwise", "closed", "turns")
    method = "RMAC_CAM.MoveAlongArc"

    def __init__(
        self, start: Any, end: Any, center: Any, normal: Any = (0, 0, 1), *, clockwise: bool = False, closed: bool = False, turns: int = 0
    ) -> None:
        self.begin = pose(start, "Arc: start")
        self.target = pose(end, "Arc: end")
        self.center = Pose(vector(center, "Arc: center"), normal)
        self.clockwise, self.closed, self.turns = bool(clockwise), bool(closed), whole(turns, "Arc: turns")

    def params(self, move_id: int) -> str:
        sense = -1 if self.clockwise else 1
        closed = "true" if self.closed else "false"
        turns = f',"Turns":{self.turns}' if self.turns else ""
        return (
            f'{{"MoveID":{move_id},"RotSign":{sense},"Closed":{closed},"CenterPoint":{self.center.text},'
            f'"StartPoint":{self.begin.text},"EndPoint":{self.target.text}{turns}}}'
        )

    def rest(self, length: float) -> Move | None:
        n, c = self.center.axis, self.center.p
        arm = tuple(a - b for a, b in zip(self.begin.p, c))
        off = tuple(a - b for a, b in zip(self.target.p, c))
        rise = dot(n, off) - dot(n, arm)
        u = tuple(a - dot(n, arm) * b for a, b in zip(arm, n))  # from the axis to the start
        sense = -1 if self.clockwise else 1
        angle = sense * math.atan2(dot(n, cross(u, off)), dot(u, off)) % (2 * math.pi)
        if self.closed:
            angle = 2 * math.pi
        angle += 2 * math.pi * self.turns
        radius = math.hypot(*u)
        t = max(length, 0) / math.hypot(radius * angle, rise)
        if t >= 1:
            return None
        way = sense * angle * t
        v = cross(n, u)
        p = tuple(b + math.cos(way) * x + math.sin(way) * y + (dot(n, arm) + rise * t) * z for b, x, y, z in zip(c, u, v, n))
        left = angle * (1 - t)
        here = Pose(p, turned(self.begin.axis, self.target.axis, t))
        return Arc(here, self.target, c, n, clockwise=self.clockwise, turns=int(left // (2 * math.pi)))


class ArcThrough(FromTo):
    """The circle through three places, from the first to the last."""

    __slots__ = ("via",)
    method = "RMAC_CAM.MoveAlongArc3"

    def __init__(self, start: Any, via: Any, end: Any) -> None:
        self.begin = pose(start, "ArcThrough: start")
        self.via = vector(via, "ArcThrough: via")
        self.target = pose(end, "ArcThrough: end")

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"ViaPoint":{text(self.via)},"StartPoint":{self.begin.text},"EndPoint":{self.target.text}}}'

    def rest(self, length: float) -> Move | None:
        return self._arc().rest(length)

    def _arc(self) -> Arc:
        a = tuple(x - y for x, y in zip(self.via, self.begin.p))
        b = tuple(x - y for x, y in zip(self.target.p, self.begin.p))
        n = cross(a, b)
        size = dot(n, n)
        toward = cross(tuple(dot(a, a) * y - dot(b, b) * x for x, y in zip(a, b)), n)
        center = tuple(p + d / (2 * size) for p, d in zip(self.begin.p, toward))
        return Arc(self.begin, self.target, center, tuple(x / math.sqrt(size) for x in n))


def polyline(places: Iterable[Any]) -> Iterator[Line]:
    """Lines from place to place."""
    before: Pose | None = None
    for number, place in enumerate(places):
        here = pose(place, f"place {number}")
        if before is not None:
            yield Line(before, here)
        before = here

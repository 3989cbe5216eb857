"""Keeps a refused move from leaving a gap that a later one jumps over.

Moves are sent before those ahead of them are answered. When one is refused, the appliance refuses the next too, because it
begins elsewhere than the queue ends: unless it happens to begin just there. So a move waits for the answers of those before
it when it begins where one of these ends, other than the one right before it.
"""

from __future__ import annotations

import math
from collections import deque

from rmac.geometry.pose import Point

_NEAR_MM = 2e-3  # the appliance takes a start within 1e-3
_CELL_MM = 0.05


class OpenEnds:
    """Ends of the last move that was taken and of those that are under way."""

    def __init__(self) -> None:
        self._order: deque[Point | None] = deque([None])  # where the queue ends at first nobody knows
        self._cells: dict[tuple[int, int, int], list[Point]] = {}
        self._unknown = 1
        self._under_way = 0

    def may_follow(self, start: Point | None) -> bool:
        """Whether a move that begins there may be sent now, right behind the last one that was added."""
        if self._under_way == 0:
            return True
        if start is None or self._unknown > (self._order[-1] is None):
            return False
        return not any(self._near(start, cell) for cell in self._cells_about(start))

    def add(self, end: Point | None) -> None:
        self._under_way += 1
        self._order.append(end)
        if end is None:
            self._unknown += 1
        else:
            self._cells.setdefault(_cell(end), []).append(end)

    def answered(self, count: int) -> None:
        """So many of the first ones that are under way were taken."""
        self._under_way -= count
        while len(self._order) > self._under_way + 1:
            end = self._order.popleft()
            if end is None:
                self._unknown -= 1
                continue
            cell = _cell(end)
            self._cells[cell].remove(end)
            if not self._cells[cell]:
                del self._cells[cell]

    def _near(self, start: Point, cell: tuple[int, int, int]) -> bool:
        own = self._order[-1]  # the one that it is to follow, once
        for end in self._cells.get(cell, ()):
            if end is not own and math.dist(end, start) < _NEAR_MM:
                return True
        return False

    @staticmethod
    def _cells_about(place: Point) -> set[tuple[int, int, int]]:
        low, high = (_cell((place[0] + by, place[1] + by, place[2] + by)) for by in (-_NEAR_MM, _NEAR_MM))
        if low == high:
            return {low}
        return {(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])}


def _cell(place: Point) -> tuple[int, int, int]:
    return math.floor(place[0] / _CELL_MM), math.floor(place[1] / _CELL_MM), math.floor(place[2] / _CELL_MM)

"""One part of a program, numbered."""

from __future__ import annotations

from dataclasses import dataclass

from rmac.moves.move import Move


@dataclass(slots=True, eq=False)
class Part:
    index: int  # within the program, from 0
    move_id: int  # as in events and records
    move: Move
    params: str  # as JSON

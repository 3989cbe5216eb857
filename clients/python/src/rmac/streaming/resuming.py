"""Where an interrupted program goes on: at the place where the machine stands, and nowhere else.

The machine tells the id of the move that it was at and how far along it. That place must be one of the program that was
interrupted, and the tool must stand there; where any of that is in doubt nothing is sent.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

from rmac.errors import CannotResume
from rmac.geometry.pose import Pose
from rmac.moves import MoveTo
from rmac.moves.move import Move
from rmac.streaming.ledger import Ledger
from rmac.streaming.part import Part
from rmac.streaming.progress import Interrupted

_MOST_OFF_MM = 1.0


def resume(interrupted: Interrupted, state: dict[str, Any]) -> tuple[Iterator[Any], int]:
    """The rest of the program, with the way back onto its path before it, and the index of its first part."""
    ledger = interrupted.ledger
    _same_machine(ledger, state)
    sent, unsent = _sent(interrupted)
    begun = _place(ledger, sent, state)
    settings = _settings_at(ledger, sent, begun)
    first = sent[begun] if begun < len(sent) else None
    back: list[Move] = []
    if first is not None and first.move_id == state["move_id"]:
        back = _way_back(first.move, state)
        begun += 1
    elif first is not None and first.move.start is not None:
        back = [_approach(first.move.start, first.move, state)]
    rest = itertools.chain(settings, back, (part.move for part in sent[begun:]), unsent, interrupted.take_remaining())
    return _once(interrupted, rest), first.index if first is not None else ledger.taken


def _sent(interrupted: Interrupted) -> tuple[list[Part], list[Any]]:
    """Kept, so that a program that could not be taken up may be another time."""
    if interrupted.sent is None:
        interrupted.sent = [], []
        for one in interrupted.take_remaining():
            if not isinstance(one, Part):
                interrupted.sent[1].append(one)  # the first one of the program's own rest: what follows stays where it is
                break
            interrupted.sent[0].append(one)
    return interrupted.sent


def _once(interrupted: Interrupted, rest: Iterator[Any]) -> Iterator[Any]:
    check_left(interrupted)
    interrupted.taken_up = True
    yield from rest


def check_left(interrupted: Interrupted) -> None:
    """Before anything is waited for: what was taken up once is at its end, or interrupted by another name."""
    if interrupted.taken_up:
        raise CannotResume("this program was taken up already")


def runs(state: dict[str, Any]) -> bool:
    return state["moving"] or state["state"] in ("Running", "Holding", "Stopping")


def _same_machine(ledger: Ledger, state: dict[str, Any]) -> None:
    if state["mechanism"] != ledger.mechanism:
        raise CannotResume(f"the machine is {state['mechanism']} now, and the program was for {ledger.mechanism}")
    if state["cycle"] < ledger.cycle:
        raise CannotResume("the appliance was started anew since, and does not know where the program was")
    if runs(state) or state["moves_in_buffer"]:
        raise CannotResume(f"the machine is {state['state']} with {state['moves_in_buffer']} moves queued; end that cycle first")


def _place(ledger: Ledger, sent: list[Part], state: dict[str, Any]) -> int:
    """Which of the parts the machine is at; the first where it is still at what it was known to be at before them. What has
    no motion, as a move to where the tool is, it is never at."""
    at = [number for number, part in enumerate(sent) if part.move.queues and part.move_id == state["move_id"]]
    if len(at) == 1:
        return at[0]
    if not at and ledger.is_behind(state["move_id"]):
        return 0
    raise CannotResume(f"the machine was at move {state['move_id']} last, which is none of those that the program waits for")


def _settings_at(ledger: Ledger, sent: list[Part], begun: int) -> list[Move]:
    """What SetFeedrate and the like were there: later ones were in force already when the connection ended."""
    settings = dict(ledger.settings)
    for part in sent[:begun]:
        if not part.move.queues:
            settings[part.move.method] = part.move
    for part in sent[begun:]:
        if not part.move.queues and part.move.method not in settings:
            raise CannotResume(f"{part.move.method} was called further on, and what it was before that the program does not say")
    return list(settings.values())


def _way_back(move: Move, state: dict[str, Any]) -> list[Move]:
    rest = move.rest(state["s_mm"])
    if rest is None:
        return [] if move.end is None else [_approach(move.end, move, state)]
    if rest.start is None:
        return [rest]
    return [_approach(rest.start, rest, state), rest]


def _approach(place: tuple[float, float, float], move: Move, state: dict[str, Any]) -> MoveTo:
    off = math.dist(place, state["pose"][:3])
    if off > _MOST_OFF_MM:
        raise CannotResume(f"the tool stands {off:.3f} mm from where the program goes on, and may stand {_MOST_OFF_MM:g} mm from it")
    axis = state["pose"][3:]
    norm = math.hypot(*axis)
    begin = getattr(move, "begin", None)
    return MoveTo(begin if isinstance(begin, Pose) and begin.p == place else Pose(place, [part / norm for part in axis]))

"""How far a program is, and how it may end before its end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from rmac.errors import ConnectionLost, Refused, RmacError
from rmac.moves.move import Move
from rmac.streaming.ledger import Ledger


class MoveRefused(RmacError):
    """The appliance does not take a move. Those before it are queued and are machined, unless authority ends; those
    after it were not taken."""

    def __init__(self, index: int, move: Move, refusal: Refused) -> None:
        super().__init__(f"move {index} of the program was refused: {refusal}")
        self.index = index
        self.move = move
        self.refusal = refusal


class MachineStopped(RmacError):
    """The machine came to rest before the program's end: somebody stopped it, or something went wrong."""

    def __init__(self, state: dict[str, Any], done: int | None, why: str) -> None:
        progress = "" if done is None else f" with {done} moves done"
        super().__init__(f"the machine is {state['state']}{progress}: {why}")
        self.state = state
        self.done = done


class Interrupted(ConnectionLost):
    """The connection ended in mid-program. The appliance stops the machine on its path and drops the queue then. Nothing
    is sent again by itself: `client.resume` takes the program up where the machine stands, once."""

    def __init__(self, cause: RmacError, ledger: Ledger, remaining: Iterator[Any]) -> None:
        super().__init__(f"{cause}; {ledger.done} moves of the program were known to be done, {ledger.taken} taken; reconnect, then resume takes it up")
        self.ledger = ledger
        self._remaining = remaining
        self.sent: tuple[list[Any], list[Any]] | None = None  # and the first one that was not, once asked for
        self.taken_up = False

    @property
    def done(self) -> int:
        return self.ledger.done

    def take_remaining(self) -> Iterator[Any]:
        """What is not known to be done, in order. What was taken from here is gone."""
        return self._remaining


def is_done(state: dict[str, Any]) -> bool:
    """Whether nothing is queued and nothing moves; raises `MachineStopped` where it will not come to that by itself."""
    halted = state["state"] == "Idle" and state["moves_in_buffer"] > 0 and state["last_stop"] is not None
    if halted or state["state"] in ("Faulted", "EmergencyStop"):
        told = state["last_stop"] or state["last_error"] or {}
        raise MachineStopped(state, None, told.get("message", "it does not tell why"))
    return state["moves_in_buffer"] == 0 and not state["moving"] and state["state"] != "Stopping"

"""One program on its way: what to send next, and what answers and states mean for it.

A transport asks `next_batch` for what may be sent now, sends it, and tells `answered` and `heard`; both clients share this.
Never more is under way than the queue has room for, so that the appliance need not refuse; where it does, the refused ones
go out again from the first one on. What is not done is kept for an interrupted program; what is done is forgotten.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence, Sized
from typing import Any

from rmac.errors import InvalidValue, QueueFull, RmacError
from rmac.moves import item
from rmac.streaming.gaps import OpenEnds
from rmac.streaming.ledger import Ledger
from rmac.streaming.part import Part
from rmac.streaming.progress import Interrupted, MachineStopped, MoveRefused
from rmac.wire.exchange import Outcome

_BATCH = 64
_BATCH_BYTES = 1 << 18
_FRAME_BYTES = 200  # of a request beside its parameters
_WINDOW = 1024  # moves that wait for their answers
_STOP_SHOWS_CYCLES = 5  # behind the refusal of what it overtook
_STOP_SHOWS_ASKS = 25  # at most: of a machine without cycles


class Stream:
    """Not for two threads at once."""

    def __init__(
        self, moves: Iterable[Any], state: dict[str, Any], capacity: int, first_id: int = 1, first_index: int = 0, line_bytes: int = 8 << 20
    ) -> None:
        self.total: int | None = len(moves) + first_index if isinstance(moves, Sized) else None
        self.failure: RmacError | None = None
        self._first_index = first_index
        self.begin(state, first_id)
        if not isinstance(moves, Iterable):
            raise InvalidValue(f"{moves!r} is no program: give moves, in a list or from a generator")
        self._source: Iterator[Any] = iter(moves)
        self._exhausted = False
        self._capacity = capacity
        self._line_bytes = line_bytes
        self._ahead: deque[Part] = deque()  # to be sent next
        self._under_way: deque[Part] = deque()
        self._refused: deque[Part] = deque()  # for want of room, until nothing is under way
        self._ends = OpenEnds()
        self._full = False
        self._refusal: MoveRefused | None = None  # that is to be told, unless it came of a stop
        self._asked: list[int] = []  # cycles of the states that were asked for because of it

    def begin(self, state: dict[str, Any], first_id: int) -> None:
        """Before anything of it is sent: the machine from which it begins, and its ids."""
        self.ledger = Ledger(state, first_id - self._first_index, self._first_index)
        self._first_cycle: int = state["cycle"]

    @property
    def asks_state(self) -> bool:
        """All was taken and the machine seems to be through, or a move was refused, perhaps because somebody stopped the
        machine: ask for its state, and tell `confirm`."""
        if self._refusal is not None:
            return self.failure is None and not self._under_way
        return self._all_taken() and self.ledger.rests and not self.ledger.complete

    @property
    def ended(self) -> bool:
        if self.failure is not None:
            return isinstance(self.failure, Interrupted) or not self._under_way
        return self._refusal is None and self._all_taken() and self.ledger.complete

    def next_batch(self) -> list[tuple[str, str]] | None:
        """Requests that may go out now; None: nothing before something is heard."""
        if self._full or self.failure is not None or self._refusal is not None:
            return None
        batch: list[tuple[str, str]] = []
        in_queue = max(self.ledger.most_in_queue, len(self.ledger.kept))  # no more is kept than the queue has room for
        room = min(_BATCH, _WINDOW - len(self._under_way), self._capacity - in_queue - len(self._under_way))
        size = 0
        while len(batch) < room:
            part = self._peek()
            if part is None or not self._ends.may_follow(part.move.start):
                break
            size += len(part.params)
            if batch and size > _BATCH_BYTES:
                break
            self._ahead.popleft()
            self._ends.add(part.move.end)
            self._under_way.append(part)
            batch.append((part.move.method, part.params))
        return batch or None

    def answered(self, outcomes: Sequence[Outcome]) -> None:
        """Of the first ones that are under way, in order."""
        for outcome in outcomes:
            part = self._under_way.popleft()
            if outcome is None:
                self._take(part)
            elif self._refused or isinstance(outcome, QueueFull):
                self._refused.append(part)  # also where it is refused because it does not join on
                self._full = True
            elif self._refusal is None:
                self._refusal = MoveRefused(part.index, part.move, outcome)
        if self._refused and not self._under_way:
            self._ahead.extendleft(reversed(self._refused))
            self._refused.clear()
            self._ends = OpenEnds()

    def heard(self, state: dict[str, Any]) -> None:
        """A state of the machine, as pushed: it may be older than what was answered lately."""
        self.ledger.heard(state, state["state"] == "Stopping" or self._stopped(state))
        if self.ledger.most_in_queue < self._capacity:
            self._full = False
        self._watch(state)

    def confirm(self, state: dict[str, Any]) -> None:
        """A state that was asked for after the last answer."""
        self.heard(state)
        if self.failure is not None:
            return
        if self._refusal is None:
            if self.asks_state:
                self.ledger.complete_all()
        elif state["state"] == "Stopping":
            self.failure = MachineStopped(state, self.ledger.done, str(self._refusal))
        elif self._stop_would_show(state["cycle"]):
            self.failure = self._refusal

    def give_up(self, error: RmacError) -> None:
        if self.failure is None:
            self.failure = error

    def lost(self, error: RmacError) -> None:
        if self.failure is None:
            self.failure = Interrupted(error, self.ledger, self.remaining())

    def remaining(self) -> Iterator[Part | Any]:
        """What is not known to be done, in order: parts that were sent, then the program's own rest."""
        yield from self.ledger.kept
        yield from self._refused
        yield from self._under_way
        yield from self._ahead
        yield from self._source

    def _all_taken(self) -> bool:
        return self._peek() is None and not self._under_way and not self._refused

    def _peek(self) -> Part | None:
        if not self._ahead and not self._exhausted:
            try:
                self._ahead.append(self._fitting(self.ledger.part(item(next(self._source)))))
            except StopIteration:
                self._exhausted = True
        return self._ahead[0] if self._ahead else None

    def _fitting(self, part: Part) -> Part:
        if len(part.params) + _FRAME_BYTES > self._line_bytes:
            raise InvalidValue(f"move {part.index} takes {len(part.params)} bytes, and a request may take {self._line_bytes}: split the curve")
        return part

    def _take(self, part: Part) -> None:
        if self._refused:
            self.failure = RmacError(f"move {part.index} was taken behind one that there was no room for; the machine must be stopped")
        self._ends.answered(1)
        self.ledger.take(part)

    def _watch(self, state: dict[str, Any]) -> None:
        if self.failure is None and self._stopped(state):
            told = state["last_stop"] or state["last_error"] or {}
            self.failure = MachineStopped(state, self.ledger.done, told.get("message", "it does not tell why"))

    def _stop_would_show(self, cycle: int) -> bool:
        """What a stop overtook is refused at once; the machine stops in one of its next cycles."""
        self._asked.append(cycle)
        return cycle - self._asked[0] >= _STOP_SHOWS_CYCLES or len(self._asked) >= _STOP_SHOWS_ASKS

    def _stopped(self, state: dict[str, Any]) -> bool:
        """A cycle that waits for moves runs: one that rests otherwise was stopped."""
        stop = state["last_stop"]
        at_rest = state["state"] == "Idle" and stop is not None and stop["cycle"] > self._first_cycle
        return at_rest or state["state"] in ("Faulted", "EmergencyStop")


def free_id(state: dict[str, Any], before: Stream | None) -> int:
    """Ids go on from those of the machine's last move and of the program before, so that a `move_id` tells whose it is."""
    last: int = max(0, state["move_id"])
    return (last if before is None else max(last, before.ledger.last_id)) + 1

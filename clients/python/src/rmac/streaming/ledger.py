"""What the machine has of a program: taken, done, and how much may still stand in its queue.

States come when they do, and tell of the time when they were made. So of what was taken since the state before, it is
assumed here that a state does not tell yet: what is counted as done is done, and what may be queued is counted as queued.
"""

from __future__ import annotations

from collections import deque
from typing import Any

from rmac.moves.between import Request
from rmac.moves.move import Move
from rmac.streaming.part import Part

_STOPS_WITHIN_CYCLES = 10


class Ledger:
    def __init__(self, state: dict[str, Any], first_id: int, first_index: int) -> None:
        self.kept: deque[Part] = deque()  # taken and not known to be done, in order
        self.finished: deque[Part] = deque()  # done, and not yet told
        self.settings: dict[str, Move] = {}  # by method, as in force behind what is done
        self.mechanism = state["mechanism"]
        self.cycle: int = state["cycle"]
        self.machine_id: int = state["move_id"]  # of the move that it was at last
        self.first_machine_id = self.machine_id
        self.done = self.taken = first_index
        self.last_done_id: int | None = None
        self.rests = False
        self._base = first_id
        self._index = first_index
        self._own_ids = False  # the program brings ids with it, which need not count up
        self._in_queue: int = state["moves_in_buffer"]
        self._queued = self._queued_done = 0
        self._queued_before = self._counted = 0
        self._told: tuple[int, int] | None = None  # in which cycle, and how many of those in the queue seemed to be done
        self._rested_since: int | None = None  # cycle

    @property
    def complete(self) -> bool:
        return self.done == self.taken

    @property
    def last_id(self) -> int:
        """Given so far."""
        return self._base + self._index - 1

    @property
    def most_in_queue(self) -> int:
        return self._in_queue + self._queued - self._counted

    def part(self, move: Move) -> Part:
        """The program's next one."""
        move_id = self._base + self._index
        if isinstance(move, Request) and move.move_id is not None:
            move_id = move.move_id
            self._own_ids = True
        part = Part(self._index, move_id, move, move.params(move_id))
        self._index += 1
        return part

    def take(self, part: Part) -> None:
        self.kept.append(part)
        self.taken += 1
        self._queued += part.move.queues
        self.rests = False

    def heard(self, state: dict[str, Any], stopped: bool) -> None:
        """`stopped`: of a machine that was stopped, or stops. A stop empties the queue some cycles before the state says that it stops:
        what a queue tells of moves that are done is believed when a later state knows of no stop."""
        self.cycle, self.machine_id = state["cycle"], state["move_id"]
        self._in_queue = state["moves_in_buffer"]
        self._counted, self._queued_before = self._queued_before, self._queued
        if stopped:
            self._told = self._rested_since = None
        self._forget(self._believed(), self._before_machine_id())
        if self._told is None and not stopped:
            self._told = self.cycle, self._counted - self._in_queue
        self.rests = self._has_rested(not stopped and not state["moving"] and state["waits_for"] in ("", "moves"))

    def _believed(self) -> int:
        """Of those in the queue, how many are done for sure."""
        if self._told is None or self.cycle < self._told[0] + _STOPS_WITHIN_CYCLES:
            return 0
        (_, done), self._told = self._told, None
        return done

    def _has_rested(self, rests: bool) -> bool:
        """For long enough that no stop can be the reason."""
        if not rests or self._in_queue > 0:
            self._rested_since = None
        elif self._rested_since is None:
            self._rested_since = self.cycle
        return self._rested_since is not None and self.cycle >= self._rested_since + _STOPS_WITHIN_CYCLES

    def is_behind(self, move_id: int) -> bool:
        """Whether a machine that is at this move has nothing begun of what is kept: it is the one that it was known to be at,
        or one that is done. What has no motion a machine is never at, so that it need not be the last one that is done."""
        if move_id == self.machine_id or self.last_done_id is None:
            return move_id == self.machine_id
        return move_id == self.last_done_id or (not self._own_ids and self.machine_id < move_id < self.last_done_id)

    def complete_all(self) -> None:
        self._forget(self._queued, self._index)

    def _before_machine_id(self) -> int:
        """Index of the part that the machine is at: those before it are done."""
        index = self.machine_id - self._base
        if self._own_ids or self.machine_id == self.first_machine_id or index >= self._index:
            return 0
        return index

    def _forget(self, queued: int, index: int) -> None:
        """What is done: so many of those in the queue, and all before that index."""
        while self.kept:
            part = self.kept[0]
            if part.move.queues:
                if self._queued_done >= queued and part.index >= index:
                    return
                self._queued_done += 1
                self.last_done_id = part.move_id
            else:
                self.settings[part.move.method] = part.move
            self.finished.append(self.kept.popleft())
            self.done += 1

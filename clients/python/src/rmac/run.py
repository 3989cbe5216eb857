"""A program that the blocking client feeds to the machine."""

from __future__ import annotations

import contextlib
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterator
from typing import TYPE_CHECKING, Any

from rmac.errors import ConnectionLost, RmacError
from rmac.hearing import Hearer
from rmac.streaming.part import Part
from rmac.streaming.stream import Stream
from rmac.wire.exchange import Outcome

if TYPE_CHECKING:
    from rmac.client import Client

STATE_RATE_HZ = 50


class Run:
    """Iterating feeds the program and gives each part of it when it is done, with its `index`, `move_id` and `move`; `wait`
    feeds it to its end. `len` is known where the program's is, so `tqdm(run)` shows how far it is."""

    def __init__(self, client: Client, stream: Stream, start: bool, first_id: int | None) -> None:
        self._client = client
        self._stream = stream
        self._start = start
        self._first_id = first_id
        self._changed = threading.Condition()
        self._news: deque[tuple[Callable[[Any], None], Any]] = deque()  # for the stream, from the thread that reads
        self._hearer = Hearer("state", STATE_RATE_HZ, self._heard, self.set_exception)
        self._parts = self._feed()

    def __iter__(self) -> Iterator[Part]:
        return self._parts

    def __len__(self) -> int:
        if self._stream.total is None:
            raise TypeError("how long this program is is not known before its end")
        return self._stream.total

    @property
    def done(self) -> int:
        """Moves that are done; those that may not be are not counted."""
        return self._stream.ledger.done

    @property
    def taken(self) -> int:
        """Moves that the appliance has taken."""
        return self._stream.ledger.taken

    @property
    def left(self) -> bool:
        """Nobody feeds it just now: the one that iterates is in the body of its loop, or out of it."""
        return not self._parts.gi_running

    def give_up(self, error: RmacError) -> None:
        """Who iterates it once more is told why it is at its end."""
        self._tell(self._stream.give_up, error)
        self._unhear()

    def _unhear(self) -> None:
        with contextlib.suppress(RmacError):
            self._client.unhear(self._hearer)

    def close(self) -> None:
        """Feeds no more of it. What was taken is machined, unless authority ends."""
        self._parts.close()

    def wait(self) -> None:
        """Until the program is done and the machine rests."""
        for _ in self._parts:
            pass

    def set_result(self, outcomes: list[Outcome]) -> None:
        """Answers to a batch."""
        self._tell(self._stream.answered, outcomes)

    def set_exception(self, error: BaseException) -> None:
        self._tell(self._stream.lost, error if isinstance(error, RmacError) else RmacError(str(error)))

    def _heard(self, state: dict[str, Any]) -> None:
        self._tell(self._stream.heard, state)

    def _tell(self, what: Callable[[Any], None], value: Any) -> None:
        """By the thread that reads. The stream belongs to the one that iterates: it runs the program's own code."""
        with self._changed:
            if self._news and self._news[-1][0] == what == self._stream.heard:
                self._news.pop()  # of states in a row the last one counts, and a run may be left alone for long
            self._news.append((what, value))
            self._changed.notify()

    def _feed(self) -> Generator[Part, None, None]:
        self._client.feeds(self)
        try:
            if self._start:
                self._client.start_cycle()
            self._client.begin(self._stream, self._first_id)
            self._client.hear(self._hearer)
            while not self._stream.ended or self._stream.ledger.finished:
                yield from self._step()
            if self._stream.failure is not None:
                raise self._stream.failure
        finally:
            self._client.feeds_no_more(self)
            self._unhear()

    def _step(self) -> Iterator[Part]:
        with self._changed:
            news, self._news = self._news, deque()
        for what, value in news:
            what(value)
        finished = self._stream.ledger.finished
        if batch := self._stream.next_batch():
            self._send(batch)
        elif self._stream.asks_state:
            self._confirm()
        elif not (finished or self._stream.ended):
            with self._changed:
                self._changed.wait_for(lambda: self._news)
        while finished:
            yield finished.popleft()

    def _send(self, batch: list[tuple[str, str]]) -> None:
        try:
            self._client.send_batch(batch, self)
        except ConnectionLost as error:
            self._stream.lost(self._client.lost or error)

    def _confirm(self) -> None:
        try:
            self._stream.confirm(self._client.state())
        except ConnectionLost as error:
            return self._stream.lost(self._client.lost or error)
        if self._stream.asks_state:
            with self._changed:
                self._changed.wait(1 / STATE_RATE_HZ)

"""A topic as an iterator, and records of it, for the blocking client."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rmac.errors import NotAnswered, RmacError
from rmac.hearing import Hearer
from rmac.records import Record, Samples

if TYPE_CHECKING:
    from rmac.client import Client

T = TypeVar("T")


class Heard(Generic[T]):
    """What comes of a topic within a `with` block, in order; waits for more, and raises `ConnectionLost` when there will be
    none. What is not taken is kept."""

    def __init__(self, client: Client, topic: str, rate_hz: float, read: Callable[[Any], T]) -> None:
        self._client = client
        self._come: queue.SimpleQueue[T | RmacError] = queue.SimpleQueue()
        self._hearer = Hearer(topic, rate_hz, lambda params: self._come.put(read(params)), self._come.put)

    def __enter__(self) -> Heard[T]:
        self._client.hear(self._hearer)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self._client.unhear(self._hearer)

    def __iter__(self) -> Heard[T]:
        return self

    def __next__(self) -> T:
        return self.next()

    def next(self, within_s: float | None = None) -> T:
        """The next one, or `NotAnswered` when none comes in time."""
        if self._come.empty() and self._client.lost is not None:
            raise self._client.lost
        try:
            come = self._come.get(timeout=within_s)
        except queue.Empty:
            raise NotAnswered(f"nothing came of the topic {self._hearer.topic} within {within_s:g} s") from None
        if isinstance(come, RmacError):
            raise come
        return come

    def so_far(self) -> list[T]:
        """What has come and was not taken; does not wait."""
        come: list[T] = []
        while not self._come.empty():
            come.append(self.next())
        return come


class Recording:
    """Samples of the topic `joints` from the beginning of a `with` block to its end; `record` gives them as numpy arrays."""

    def __init__(self, client: Client, rate_hz: float) -> None:
        self._client = client
        self._samples = Samples(rate_hz, client.greeting.cycle_hz)
        self._changed = threading.Condition()
        self._lost: RmacError | None = None
        self._hearer = Hearer("joints", rate_hz, self._take, self._end)

    def __enter__(self) -> Recording:
        self._client.hear(self._hearer)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if error is None:
            self.catch_up()
        self._client.unhear(self._hearer)

    def catch_up(self) -> None:
        """Until all has come that happened so far."""
        cycle = self._client.state()["cycle"]
        with self._changed:
            self._changed.wait_for(lambda: self._lost or self._samples.reach(cycle))
        if self._lost is not None:
            raise self._lost

    def record(self) -> Record:
        with self._changed:
            return self._samples.record()

    def _take(self, params: Any) -> None:
        with self._changed:
            self._samples.take(params["samples"])
            self._changed.notify()

    def _end(self, error: RmacError) -> None:
        with self._changed:
            self._lost = error
            self._changed.notify()

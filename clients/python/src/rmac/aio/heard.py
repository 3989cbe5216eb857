"""A topic as an asynchronous iterator, and records of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from rmac.errors import RmacError
from rmac.hearing import Hearer
from rmac.records import Record, Samples

if TYPE_CHECKING:
    from rmac.aio.client import Client

T = TypeVar("T")


class Heard(Generic[T]):
    """What comes of a topic within an `async with` block, in order; raises `ConnectionLost` when there will be no more."""

    def __init__(self, client: Client, topic: str, rate_hz: float, read: Callable[[Any], T]) -> None:
        self._client = client
        self._come: asyncio.Queue[T | RmacError] = asyncio.Queue()
        self._hearer = Hearer(topic, rate_hz, lambda params: self._come.put_nowait(read(params)), self._come.put_nowait)

    async def __aenter__(self) -> Heard[T]:
        await self._client.hear(self._hearer)
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await self._client.unhear(self._hearer)

    def __aiter__(self) -> Heard[T]:
        return self

    async def __anext__(self) -> T:
        if self._come.empty() and self._client.lost is not None:
            raise self._client.lost
        come = await self._come.get()
        if isinstance(come, RmacError):
            raise come
        return come


class Recording:
    """Samples of the topic `joints` from the beginning of an `async with` block to its end."""

    def __init__(self, client: Client, rate_hz: float) -> None:
        self._client = client
        self._samples = Samples(rate_hz, client.greeting.cycle_hz)
        self._changed = asyncio.Event()
        self._lost: RmacError | None = None
        self._hearer = Hearer("joints", rate_hz, self._take, self._end)

    async def __aenter__(self) -> Recording:
        await self._client.hear(self._hearer)
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if error is None:
            await self.catch_up()
        await self._client.unhear(self._hearer)

    async def catch_up(self) -> None:
        """Until all has come that happened so far."""
        cycle = (await self._client.state())["cycle"]
        while self._lost is None and not self._samples.reach(cycle):
            self._changed.clear()
            await self._changed.wait()
        if self._lost is not None:
            raise self._lost

    def record(self) -> Record:
        return self._samples.record()

    def _take(self, params: Any) -> None:
        self._samples.take(params["samples"])
        self._changed.set()

    def _end(self, error: RmacError) -> None:
        self._lost = error
        self._changed.set()

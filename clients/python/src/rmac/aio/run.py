"""A program that the asyncio client feeds to the machine."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import AsyncGenerator, AsyncIterator, Awaitable
from typing import TYPE_CHECKING, Any, TypeVar

from rmac.errors import RmacError
from rmac.hearing import Hearer
from rmac.run import STATE_RATE_HZ
from rmac.streaming.part import Part
from rmac.streaming.stream import Stream
from rmac.wire.exchange import Outcome

if TYPE_CHECKING:
    from rmac.aio.client import Client

T = TypeVar("T")


class Run:
    """`async for part in run` feeds the program and gives each part of it when it is done; `await run.wait()` feeds it to
    its end."""

    def __init__(self, client: Client, stream: Stream, start: bool, first_id: int | None) -> None:
        self._client = client
        self._stream = stream
        self._start = start
        self._first_id = first_id
        self._changed = asyncio.Event()
        self._hearer = Hearer("state", STATE_RATE_HZ, self._heard, self.set_exception)
        self._parts = self._feed()

    def __aiter__(self) -> AsyncIterator[Part]:
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
        return not self._parts.ag_running

    async def give_up(self, error: RmacError) -> None:
        """Who iterates it once more is told why it is at its end."""
        self._stream.give_up(error)
        await self._unhear()

    async def _unhear(self) -> None:
        with contextlib.suppress(RmacError):
            await self._client.unhear(self._hearer)

    async def close(self) -> None:
        """Feeds no more of it. What was taken is machined, unless authority ends."""
        await self._parts.aclose()

    async def wait(self) -> None:
        """Until the program is done and the machine rests."""
        async for _ in self._parts:
            pass

    def set_result(self, outcomes: list[Outcome]) -> None:
        self._stream.answered(outcomes)
        self._changed.set()

    def set_exception(self, error: BaseException) -> None:
        self._stream.lost(error if isinstance(error, RmacError) else RmacError(str(error)))
        self._changed.set()

    def _heard(self, state: dict[str, Any]) -> None:
        self._stream.heard(state)
        self._changed.set()

    async def _feed(self) -> AsyncGenerator[Part, None]:
        self._client.feeds(self)
        try:
            if self._start:
                await self._client.start_cycle()
            await self._client.begin(self._stream, self._first_id)
            await self._client.hear(self._hearer)
            finished = self._stream.ledger.finished
            while not self._stream.ended or finished:
                await self._step()
                while finished:
                    yield finished.popleft()
            if self._stream.failure is not None:
                raise self._stream.failure
        finally:
            self._client.feeds_no_more(self)
            await self._unhear()

    async def _step(self) -> None:
        self._changed.clear()
        if batch := self._stream.next_batch():
            await self._unless_lost(self._client.send_batch(batch, self))
        elif self._stream.asks_state:
            state = await self._unless_lost(self._client.state())
            if state is None:
                return
            self._stream.confirm(state)
            if self._stream.asks_state:
                await asyncio.sleep(1 / STATE_RATE_HZ)
        elif not (self._stream.ended or self._stream.ledger.finished):
            await self._changed.wait()

    async def _unless_lost(self, asked: Awaitable[T]) -> T | None:
        """None where the connection is lost by then, which the stream is told."""
        try:
            return await asked
        except RmacError:
            if self._client.lost is None:
                raise
            self.set_exception(self._client.lost)
            return None

"""Motion authority, and the operator's place, for as long as an `async with` block lasts."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Awaitable, Callable
from types import TracebackType
from typing import Any

from rmac.errors import AuthorityRequired, ConnectionLost, Refused
from rmac.generated import calls
from rmac.generated.types import AwaitingCaller
from rmac.wire.call import Call


class Authority:
    """As `rmac.authority.Authority`: its end stops a machine that still moves, and drops what is queued."""

    def __init__(self, call: AwaitingCaller, over: Callable[[], Awaitable[None]], blocks: list[Authority]) -> None:
        self._call = call
        self._over = over
        self._blocks = blocks  # of this client, which last
        self._renewal: asyncio.Task[None] | None = None
        self.dropped_moves = 0  # of whoever had it before

    async def __aenter__(self) -> Authority:
        given = await self._call(calls.Lease.acquire())
        self._blocks.append(self)
        self.dropped_moves = given["dropped_moves"]
        if given["timeout_s"] > 0:
            self._renewal = asyncio.ensure_future(self._renew(given["timeout_s"] / 3))
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._renewal is not None:
            self._renewal.cancel()
        if self in self._blocks:
            self._blocks.remove(self)
        try:
            await _give_back(self._call, calls.RMAC_CAM.StopNow() if self._blocks else calls.Lease.release(), error)
        finally:
            await self._over()

    async def _renew(self, every_s: float) -> None:
        with contextlib.suppress(ConnectionLost, Refused):  # who moves next is told
            while True:
                await asyncio.sleep(every_s)
                await self._call(calls.Lease.renew())


class OperatorPlace:
    """Holds, resumes and overrides beside the program's client, and stops nothing when it ends."""

    def __init__(self, call: AwaitingCaller) -> None:
        self._call = call
        self.held_by = ""  # who held the machine as the operator already

    async def __aenter__(self) -> OperatorPlace:
        self.held_by = (await self._call(calls.Post.acquire()))["held_by"]
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await _give_back(self._call, calls.Post.release(), error)


async def _give_back(call: AwaitingCaller, ending: Call[Any], error: BaseException | None) -> None:
    try:
        await call(ending)
    except (ConnectionLost, AuthorityRequired):
        pass
    except Refused:
        if error is None:
            raise

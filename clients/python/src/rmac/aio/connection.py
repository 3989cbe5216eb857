"""One connection of the asyncio client: streams, and a task that reads them."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from rmac.address import Address, tune
from rmac.errors import CannotConnect, ConnectionLost, NotAnswered, RmacError, asked_too_late
from rmac.wire.call import Call
from rmac.wire.exchange import Exchange, Promise

T = TypeVar("T")
_READ_BYTES = 1 << 18


class Reply:
    """An answer that is awaited, perhaps no longer."""

    def __init__(self) -> None:
        self.future: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

    def set_result(self, result: Any, /) -> None:
        if not self.future.done():
            self.future.set_result(result)

    def set_exception(self, exception: BaseException, /) -> None:
        if not self.future.done():
            self.future.set_exception(exception)


class Connection:
    def __init__(self, address: Address, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, hear: Callable[[str, Any], None]) -> None:
        self.address = address
        self.on_end: Callable[[RmacError], None] = lambda error: None
        self.ended: RmacError | None = None
        self._writer = writer
        self._exchange = Exchange(hear)
        self._reading = asyncio.ensure_future(self._read(reader))

    @classmethod
    async def open(cls, address: Address, within_s: float, hear: Callable[[str, Any], None]) -> Connection:
        if address.path:
            address.check_socket()
            opening = asyncio.open_unix_connection(address.path)
        else:
            opening = asyncio.open_connection(address.host, address.port)
        try:
            reader, writer = await asyncio.wait_for(opening, within_s)
        except asyncio.TimeoutError:
            raise CannotConnect(f"{address}: nobody answered within {within_s:g} s") from None
        except UnicodeError:
            raise address.no_name() from None
        except OSError as error:
            raise address.unreachable(error) from error
        if not address.path:
            tune(writer.get_extra_info("socket"))
        return cls(address, reader, writer, hear)

    def send(self, call: Call[Any]) -> Reply:
        reply = Reply()
        self._transmit(self._exchange.ask, call, reply)
        return reply

    async def send_batch(self, requests: Sequence[tuple[str, str]], promise: Promise) -> None:
        """Returns once there is room for more."""
        self._transmit(self._exchange.ask_batch, requests, promise)
        with contextlib.suppress(OSError):  # the reader meets the same end
            await self._writer.drain()

    async def call(self, call: Call[T], within_s: float) -> T:
        return await self.wait(self.send(call), call, within_s)

    async def wait(self, reply: Reply, call: Call[T], within_s: float) -> T:
        try:
            result: T = await asyncio.wait_for(reply.future, within_s)
            return result
        except asyncio.TimeoutError:
            raise NotAnswered(f"{self.address} did not answer {call.method} within {within_s:g} s") from None

    async def close(self) -> None:
        self._finish(ConnectionLost(f"{self.address}: this connection was closed"))
        self._reading.cancel()
        with contextlib.suppress(OSError, asyncio.CancelledError):
            await self._reading

    def _transmit(self, ask: Callable[[Any, Promise], bytes], what: Any, promise: Promise) -> None:
        if self.ended is not None:
            raise asked_too_late(self.ended, "await ") from self.ended
        self._writer.write(ask(what, promise))

    async def _read(self, reader: asyncio.StreamReader) -> None:
        try:
            while data := await reader.read(_READ_BYTES):
                self._exchange.receive(data)
            self._finish(ConnectionLost(f"{self.address}: the appliance closed the connection"))
        except OSError as error:
            self._finish(ConnectionLost(f"{self.address}: the connection broke: {error}"))
        except RmacError as error:
            self._finish(error)
        except Exception as error:  # of an answer that nobody foresaw: whoever waits must hear of it
            self._finish(RmacError(f"{self.address}: an answer could not be read: {error!r}"))

    def _finish(self, error: RmacError) -> None:
        if self.ended is not None:
            return
        self.ended = error
        self._exchange.end(error)
        self._writer.close()
        self.on_end(error)

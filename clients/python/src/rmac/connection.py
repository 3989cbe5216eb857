"""One connection of the blocking client: a socket, and a thread that reads it."""

from __future__ import annotations

import concurrent.futures
import contextlib
import socket
import threading
from collections.abc import Callable, Sequence
from typing import Any, TypeVar

from rmac.address import Address
from rmac.errors import ConnectionLost, NotAnswered, RmacError, asked_too_late
from rmac.wire.call import Call
from rmac.wire.exchange import Exchange, Promise

T = TypeVar("T")
_READ_BYTES = 1 << 18


class Connection:
    """Any thread may send; answers and topics are taken in the thread that reads."""

    def __init__(self, address: Address, within_s: float, hear: Callable[[str, Any], None]) -> None:
        self.address = address
        self.on_end: Callable[[RmacError], None] = lambda error: None
        self._socket = address.connect(within_s)
        self._exchange = Exchange(hear)
        self._sending = threading.Lock()  # ids go out in their order; what ended is asked nothing
        self._ended: RmacError | None = None
        self._reader = threading.Thread(target=self._read, name=f"rmac {address}", daemon=True)
        self._reader.start()

    @property
    def ended(self) -> RmacError | None:
        return self._ended

    def send(self, call: Call[T]) -> concurrent.futures.Future[T]:
        """Does not wait for the answer."""
        reply: concurrent.futures.Future[T] = concurrent.futures.Future()
        with self._sending:
            self._transmit(self._exchange.ask, call, reply)
        return reply

    def send_batch(self, requests: Sequence[tuple[str, str]], promise: Promise) -> None:
        with self._sending:
            self._transmit(self._exchange.ask_batch, requests, promise)

    def call(self, call: Call[T], within_s: float) -> T:
        return self.wait(self.send(call), call.method, within_s)

    def wait(self, reply: concurrent.futures.Future[T], method: str, within_s: float) -> T:
        try:
            return reply.result(within_s)
        except concurrent.futures.TimeoutError:
            raise NotAnswered(f"{self.address} did not answer {method} within {within_s:g} s") from None

    def close(self) -> None:
        self._finish(ConnectionLost(f"{self.address}: this connection was closed"))
        if threading.current_thread() is not self._reader:
            self._reader.join()

    def _transmit(self, ask: Callable[[Any, Promise], bytes], what: Any, promise: Promise) -> None:
        if self._ended is not None:
            raise asked_too_late(self._ended) from self._ended
        line = ask(what, promise)
        try:
            self._socket.sendall(line)
        except OSError as error:
            # The reader meets the same end and breaks the promises.
            raise ConnectionLost(f"{self.address}: the connection broke: {error}") from error

    def _read(self) -> None:
        try:
            while data := self._socket.recv(_READ_BYTES):
                self._exchange.receive(data)
            self._finish(ConnectionLost(f"{self.address}: the appliance closed the connection"))
        except OSError as error:
            self._finish(ConnectionLost(f"{self.address}: the connection broke: {error}"))
        except RmacError as error:
            self._finish(error)
        except Exception as error:  # of an answer that nobody foresaw: whoever waits must hear of it
            self._finish(RmacError(f"{self.address}: an answer could not be read: {error!r}"))

    def _finish(self, error: RmacError) -> None:
        with contextlib.suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)  # a thread that sends lets go of the lock
        with self._sending:
            if self._ended is not None:
                return
            self._ended = error
            self._exchange.end(error)
            self._socket.close()
        self.on_end(error)

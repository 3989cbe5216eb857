"""Requests and their answers: gives ids, frames lines, and knows which answer is whose. No I/O, no lock, no clock."""

from __future__ import annotations

import itertools
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from rmac.errors import ProtocolError, Refused, RmacError, refusal
from rmac.wire.call import Call, request


class Promise(Protocol):
    """Where an answer goes; the futures of `concurrent` and of asyncio are such."""

    def set_result(self, result: Any, /) -> None: ...

    def set_exception(self, exception: BaseException, /) -> None: ...


Outcome = Refused | None  # of one request of a batch: refused, or taken


@dataclass(frozen=True, slots=True)
class _Asked:
    promise: Promise
    call: Call[Any]


@dataclass(frozen=True, slots=True)
class _Batch:
    promise: Promise
    methods: Sequence[str]


def _keep(asked: _Asked, value: Any) -> None:
    try:
        result = asked.call.result(value)
    except RmacError as error:
        asked.promise.set_exception(error)
    except (KeyError, TypeError, ValueError) as error:
        asked.promise.set_exception(ProtocolError(f"{asked.call.method}: its answer is not as declared: {error!r}"))
    else:
        asked.promise.set_result(result)


class Exchange:
    """`ask` may be called by one thread at a time, `receive` by another one."""

    def __init__(self, hear: Callable[[str, Any], None]) -> None:
        self._hear = hear
        self._ids = itertools.count(1)
        self._waiting: dict[int, _Asked | _Batch] = {}
        self._partial = bytearray()
        self._seen = False

    def ask(self, call: Call[Any], promise: Promise) -> bytes:
        """The line to send. The promise is kept by `receive`, or broken by `end`."""
        number = next(self._ids)
        line = request(call, number)
        self._waiting[number] = _Asked(promise, call)
        return line.encode() + b"\n"

    def ask_batch(self, requests: Sequence[tuple[str, str]], promise: Promise) -> bytes:
        """Of each request its method and its parameters as JSON. The promise gets an `Outcome` of each."""
        numbers = list(itertools.islice(self._ids, len(requests)))
        parts = [
            f'{{"jsonrpc":"2.0","id":{number},"method":"{method}","params":{params}}}'
            for number, (method, params) in zip(numbers, requests)
        ]
        self._waiting[numbers[0]] = _Batch(promise, [method for method, _ in requests])
        return ("[" + ",".join(parts) + "]\n").encode()

    def receive(self, data: bytes) -> None:
        """Bytes as they came. Raises `ProtocolError` where these are no answers."""
        end = data.rfind(b"\n")
        if end < 0:
            self._partial += data
            if not self._seen and not self._partial.lstrip().startswith((b"{", b"[")):
                self._take(bytes(self._partial))  # what greets us otherwise may never end its line
            return
        lines = bytes(self._partial) + data[:end]
        self._partial[:] = data[end + 1 :]
        for line in lines.split(b"\n"):
            self._take(line)

    def end(self, error: Exception) -> None:
        """Breaks every promise that is left."""
        while self._waiting:
            self._waiting.popitem()[1].promise.set_exception(error)

    def _take(self, line: bytes) -> None:
        try:
            message = json.loads(line)
            if not isinstance(message, (dict, list)) or not message:
                raise ValueError
        except ValueError:
            raise ProtocolError(f"this is no RMAC appliance: it said {line[:60]!r}") from None
        self._seen = True
        if isinstance(message, list):
            self._batch_answered(message)
        elif "method" in message:
            self._hear(message["method"], message["params"])
        elif message.get("id") is None:
            error = message.get("error", {})
            raise ProtocolError(f"the appliance could not read what was sent: {error.get('message')} ({error.get('code')})")
        else:
            self._answered(message)

    def _answered(self, message: dict[str, Any]) -> None:
        asked = self._waiting.pop(message["id"], None)
        if isinstance(asked, _Batch):  # refused as a whole
            error = message.get("error", {"code": -32603, "message": "a batch had one answer"})
            asked.promise.set_result([refusal(method, error) for method in asked.methods])
        elif asked is None:
            raise ProtocolError(f"an answer to a request that nobody made: id {message['id']}")
        elif "error" in message:
            asked.promise.set_exception(refusal(asked.call.method, message["error"]))
        else:
            _keep(asked, message["result"])

    def _batch_answered(self, answers: list[dict[str, Any]]) -> None:
        answers.sort(key=lambda answer: int(answer["id"]))
        asked = self._waiting.pop(answers[0]["id"], None)
        if not isinstance(asked, _Batch) or len(asked.methods) != len(answers):
            raise ProtocolError(f"a batch of {len(answers)} answers that fits no request: first id {answers[0]['id']}")
        asked.promise.set_result(
            [refusal(method, answer["error"]) if "error" in answer else None for method, answer in zip(asked.methods, answers)]
        )

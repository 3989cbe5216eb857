"""Motion authority, and the operator's place, for as long as a `with` block lasts."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Callable
from types import TracebackType
from typing import Any

from rmac.errors import AuthorityRequired, ConnectionLost, Refused
from rmac.generated import calls
from rmac.generated.types import BlockingCaller
from rmac.wire.call import Call


class Renewal:
    """Keeps a lease that ends by silence, from a thread of its own."""

    def __init__(self, renew: Callable[[], object], every_s: float) -> None:
        self._ended = threading.Event()
        self._renew = renew
        self._every_s = every_s
        threading.Thread(target=self._run, name="rmac lease", daemon=True).start()

    def end(self) -> None:
        self._ended.set()

    def _run(self) -> None:
        with contextlib.suppress(ConnectionLost, Refused):  # who moves next is told
            while not self._ended.wait(self._every_s):
                self._renew()


class Authority:
    """Taken at the beginning of the block and given back at its end, which stops a machine that still moves, and drops
    what is queued: whoever leaves by an exception leaves a machine at rest. A block within another one of the same client
    stops the machine too, and leaves authority to the other."""

    def __init__(self, call: BlockingCaller, over: Callable[[], None], blocks: list[Authority]) -> None:
        self._call = call
        self._over = over
        self._blocks = blocks  # of this client, which last
        self._renewal: Renewal | None = None
        self.dropped_moves = 0  # of whoever had it before

    def __enter__(self) -> Authority:
        given = self._call(calls.Lease.acquire())
        self._blocks.append(self)
        self.dropped_moves = given["dropped_moves"]
        if given["timeout_s"] > 0:
            self._renewal = Renewal(lambda: self._call(calls.Lease.renew()), given["timeout_s"] / 3)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._renewal is not None:
            self._renewal.end()
        if self in self._blocks:
            self._blocks.remove(self)
        try:
            _give_back(self._call, calls.RMAC_CAM.StopNow() if self._blocks else calls.Lease.release(), error)
        finally:
            self._over()


class OperatorPlace:
    """Holds, resumes and overrides beside the program's client, and stops nothing when it ends."""

    def __init__(self, call: BlockingCaller) -> None:
        self._call = call
        self.held_by = ""  # who held the machine as the operator already

    def __enter__(self) -> OperatorPlace:
        self.held_by = self._call(calls.Post.acquire())["held_by"]
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        _give_back(self._call, calls.Post.release(), error)


def _give_back(call: BlockingCaller, ending: Call[Any], error: BaseException | None) -> None:
    """The end of a connection, or a long silence, gave it back already, and an error of the block is not hidden behind
    another one."""
    try:
        call(ending)
    except (ConnectionLost, AuthorityRequired):
        pass
    except Refused:
        if error is None:
            raise

"""What a program does between its moves; each stands in the queue in its turn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, SupportsIndex

from rmac.errors import InvalidValue
from rmac.generated import calls
from rmac.generated.queueing import QUEUEING
from rmac.geometry.numbers import scalar
from rmac.moves.move import Move
from rmac.wire.call import Call, encoded


class Request(Move):
    """Any method by name, in its turn: what queues a move keeps the id that it has in its parameters."""

    __slots__ = ("method", "queues", "move_id", "_params")

    def __init__(self, method: str, params: Mapping[str, object]) -> None:
        self.method = method
        self.queues = method in QUEUEING
        own = params.get("MoveID")
        self.move_id = int(own) if isinstance(own, SupportsIndex) else None  # numpy's too
        self._params = _encoded(method, params)

    def params(self, move_id: int) -> str:
        return self._params


class _Queued(Move):
    """Between moves; with an id of its own."""

    __slots__ = ("_rest",)

    def __init__(self, **params: object) -> None:
        self._rest = _encoded(type(self).__name__, {name: value for name, value in params.items() if value is not None})[1:]

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},{self._rest}'

    def rest(self, length: float) -> Move:
        return self  # begun and not done, it begins anew


class Dwell(_Queued):
    __slots__ = ()
    method = "RMAC_CAM.Dwell"

    def __init__(self, seconds: float) -> None:
        super().__init__(Time=scalar(seconds, "Dwell"))


class ProgramStop(_Queued):
    """M0, or M1 where `optional`: the program is held until somebody resumes it."""

    __slots__ = ()
    method = "RMAC_CAM.ProgramStop"

    def __init__(self, message: str = "", *, optional: bool = False) -> None:
        super().__init__(Message=message, Optional=optional)


class AwaitInput(_Queued):
    __slots__ = ()
    method = "RMAC_CAM.AwaitInput"

    def __init__(self, name: str, on: bool, within_s: float) -> None:
        super().__init__(Name=name, On=on, TimeOut=scalar(within_s, "AwaitInput: within_s"))


class InTurn(_Queued):
    """Calls that are made when the moves before them are done: outputs, coolant, spindle speeds."""

    __slots__ = ()
    method = "RMAC_CAM.InTurn"

    def __init__(self, *made: Call[Any]) -> None:
        super().__init__(Calls=[{"method": call.method, "params": call.given()} for call in made])


def _encoded(what: str, params: Mapping[str, object]) -> str:
    try:
        return encoded(params)
    except (ValueError, TypeError) as error:
        raise InvalidValue(f"{what}: {error}") from None


def output(name: str, on: bool) -> InTurn:
    """Switches an output of the machine in its turn."""
    return InTurn(calls.RMAC_CAM.SetOutput(name, on))


def spindle(rpm: float, number: int = 0) -> InTurn:
    """A spindle's speed from here on; what follows waits for it."""
    return InTurn(calls.RMAC_CAM.SetSpindleRPM(number, scalar(rpm, "spindle")))


def tool_change(number: int) -> Request:
    return Request("RMAC_CAM.DoToolChange", {"ToolNumber": number})


def item(given: Any) -> Move:
    """What a program may consist of besides moves: calls, as `calls.RMAC_CAM.SetFeedrate(1200)`, and requests as in a
    `.rmac` program."""
    if isinstance(given, Move):
        return given
    if isinstance(given, Call):
        return Request(given.method, given.given())
    if isinstance(given, Mapping) and "method" in given:
        return Request(given["method"], given.get("params", {}))
    raise InvalidValue(f"{given!r:.80} is no move: a program consists of moves, calls and requests")

"""One call as a value: what is asked, and how its answer is read. Nothing is sent by making one."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from rmac.errors import InvalidValue

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Call(Generic[T]):
    method: str
    params: Mapping[str, object]
    read: Callable[[Any], T] | None = None  # None: the answer is what it is

    def result(self, value: Any) -> T:
        return value if self.read is None else self.read(value)  # type: ignore[no-any-return]

    def given(self) -> dict[str, object]:
        """Its parameters but for those that were left out."""
        return {name: value for name, value in self.params.items() if value is not None}


def plain(value: object) -> object:
    """What json does not know: numpy's scalars and arrays, and values of this package that say what they are on the wire."""
    for convert in ("wire", "tolist"):
        if hasattr(value, convert):
            return getattr(value, convert)()
    raise TypeError(f"{type(value).__name__} has no form on the wire")


_encoder = json.JSONEncoder(allow_nan=False, separators=(",", ":"), default=plain)


def encoded(value: object) -> str:
    return _encoder.encode(value)


def request(call: Call[Any], request_id: int) -> str:
    """A request as JSON, without the end of its line."""
    try:
        return encoded({"jsonrpc": "2.0", "id": request_id, "method": call.method, "params": call.given()})
    except (ValueError, TypeError) as error:
        raise InvalidValue(f"{call.method}: {_blame(call.given()) or error}; nothing was sent") from None


def _blame(value: object, where: str = "") -> str:
    """Where in it a number is not finite."""
    if isinstance(value, float):
        return "" if math.isfinite(value) else f"{where} is {value!r}, and numbers must be finite"
    if isinstance(value, Mapping):
        parts = [(f"{where}.{name}" if where else str(name), part) for name, part in value.items()]
    elif isinstance(value, (list, tuple)):
        parts = [(f"{where}[{number}]", part) for number, part in enumerate(value)]
    elif hasattr(value, "wire") or hasattr(value, "tolist"):
        parts = [(where, plain(value))]
    else:
        return ""
    return next((told for place, part in parts if (told := _blame(part, place))), "")

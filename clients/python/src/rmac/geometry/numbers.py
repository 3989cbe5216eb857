"""Numbers of whatever kind, numpy's too, as finite floats; what is none is named."""

from __future__ import annotations

import math
from typing import Any

from rmac.errors import InvalidValue


def finite(values: Any, what: str) -> tuple[float, ...]:
    try:
        numbers = tuple(map(float, values))
    except (TypeError, ValueError, OverflowError):
        raise InvalidValue(f"{what} is {_short(values)}: give numbers, one a coordinate") from None
    if not all(map(math.isfinite, numbers)):
        raise InvalidValue(f"{what} is {_short(numbers)}: numbers must be finite")
    return numbers


def vector(values: Any, what: str, length: int = 3) -> tuple[float, ...]:
    numbers = finite(values, what)
    if len(numbers) != length:
        raise InvalidValue(f"{what} is {_short(numbers)}: it has {len(numbers)} numbers and needs {length}")
    return numbers


def scalar(value: Any, what: str) -> float:
    return finite((value,), what)[0]


def text(numbers: tuple[float, ...]) -> str:
    """As JSON, with all digits."""
    return "[" + ",".join(map(repr, numbers)) + "]"


def _short(value: object) -> str:
    told = repr(value)
    return told if len(told) <= 80 else told[:77] + "..."

"""Numbers of whatever kind, numpy's too, as finite floats; what is none is named."""

from __future__ import annotations

import math
from typing import Any

from rmac.errors import InvalidValue


def finite(values: Any, what: str) -> tuple[float, ...]:
    try:
        numbers = tuple(map(_number, values))
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


def positive(value: Any, what: str) -> float:
    number = scalar(value, what)
    if number <= 0:
        raise InvalidValue(f"{what} is {_short(value)}: it must be positive")
    return number


def whole(value: Any, what: str, least: int = 0) -> int:
    number = scalar(value, what)
    if number != int(number) or number < least:
        raise InvalidValue(f"{what} is {_short(value)}: give a whole number, {least} or more")
    return int(number)


def text(numbers: tuple[float, ...]) -> str:
    """As JSON, with all digits."""
    return "[" + ",".join(map(repr, numbers)) + "]"


def _number(value: Any) -> float:
    if type(value) is float:
        return value
    # Python would make numbers of the letters of a text, and numpy drops an imaginary part with a warning.
    if isinstance(value, (str, bytes)) or getattr(getattr(value, "dtype", None), "kind", "f") == "c":
        raise TypeError
    return float(value)


def _short(value: object) -> str:
    told = repr(value)
    return told if len(told) <= 80 else told[:77] + "..."

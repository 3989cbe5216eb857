"""Where the tool tip is and where the tool points: from the tip to the spindle."""

from __future__ import annotations

import math
from typing import Any

from rmac.errors import InvalidValue
from rmac.geometry.numbers import finite, text, vector

Point = tuple[float, float, float]
_UPRIGHT = (0.0, 0.0, 1.0)
_OFF_UNIT = 1e-3  # more is a mistake rather than rounding


class Pose:
    """A place in mm with a unit vector along the tool, or with a unit quaternion [w, x, y, z]. Not to be changed."""

    __slots__ = ("p", "axis", "q", "text")

    def __init__(self, p: Any, axis: Any = None, q: Any = None) -> None:
        self.p: Point = vector(p, "a place")  # type: ignore[assignment]
        self.q: tuple[float, ...] | None = None
        self.axis: tuple[float, ...] = _UPRIGHT
        if q is not None:
            if axis is not None:
                raise InvalidValue("a pose has a tool axis or a quaternion, not both")
            self.q = _unit(q, 4, "a quaternion")
            w, x, y, z = self.q
            self.axis = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
        elif axis is not None:
            self.axis = _unit(axis, 3, "a tool axis")
        turned = f'"q":{text(self.q)}' if self.q else f'"axis":{text(self.axis)}'
        self.text = f'{{"p":{text(self.p)},{turned}}}'

    def wire(self) -> dict[str, object]:
        turned: dict[str, object] = {"q": self.q} if self.q else {"axis": self.axis}
        return {"p": self.p, **turned}

    def __repr__(self) -> str:
        return f"Pose({self.p}, q={self.q})" if self.q else f"Pose({self.p}, {self.axis})"


def pose(value: Any, what: str = "a pose") -> Pose:
    """A `Pose` as it is; x y z with the tool upright; or x y z i j k."""
    if isinstance(value, Pose):
        return value
    numbers = finite(value, what)
    if len(numbers) == 3:
        return Pose(numbers)
    if len(numbers) == 6:
        return Pose(numbers[:3], numbers[3:])
    raise InvalidValue(f"{what} has {len(numbers)} numbers: give x y z, x y z i j k, or a rmac.Pose")


def _unit(values: Any, length: int, what: str) -> tuple[float, ...]:
    numbers = vector(values, what, length)
    norm = math.hypot(*numbers)
    if abs(norm - 1) > _OFF_UNIT:
        raise InvalidValue(f"{what} is {numbers}, of length {norm:g}: give one of length 1")
    return numbers

"""Types that the generated methods name. Written by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypedDict, TypeVar

from rmac.wire.call import Call

T = TypeVar("T")

# numpy's arrays are taken, too; without numpy nobody can say so more exactly.
Numbers = Sequence[float] | Any
Vector = Sequence[float] | Any


class WireFrame(TypedDict, total=False):
    """As the appliance gives it."""

    p: list[float]
    q: list[float]
    axis: list[float]


class OnTheWire(Protocol):
    """A value of this package that says what it is on the wire: `rmac.Pose`, `rmac.NurbsCurve`."""

    def wire(self) -> Any: ...


FrameLike = OnTheWire | WireFrame | Mapping[str, Any]
NurbsLike = OnTheWire | Mapping[str, Any]


class Joints(TypedDict):
    joints: Sequence[float]


class BlockingCaller(Protocol):
    def __call__(self, call: Call[T], /) -> T: ...


class AwaitingCaller(Protocol):
    async def __call__(self, call: Call[T], /) -> T: ...

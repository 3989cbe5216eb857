"""What the machine tells of itself as it happens."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Event:
    """`kind` is MoveStarted, MoveDone, Hit, Stopped, Fault, and so on (docs/protocol.md); `told` has all members, those of
    this kind alone too."""

    kind: str
    t_s: float
    cycle: int
    move_id: int
    message: str
    told: Mapping[str, Any]


def read_event(params: Mapping[str, Any]) -> Event:
    return Event(params["kind"], params["t_s"], params["cycle"], params.get("move_id", 0), params.get("message", ""), params)

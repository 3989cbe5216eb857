"""Who hears which topic, and what to ask the appliance for so that they do. Survives a lost connection. No I/O."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from rmac.errors import RmacError
from rmac.generated import calls
from rmac.wire.call import Call

Take = Callable[[Any], None]
Lost = Callable[[RmacError], None]


@dataclass(frozen=True, slots=True, eq=False)
class Hearer:
    topic: str
    rate_hz: float
    take: Take
    lost: Lost  # the connection ended


class Hearing:
    def __init__(self) -> None:
        self._hearers: tuple[Hearer, ...] = ()  # replaced as a whole: it is read by the thread that receives

    def add(self, hearer: Hearer) -> Call[bool]:
        self._hearers += (hearer,)
        return self._subscription(hearer.topic)

    def has(self, hearer: Hearer) -> bool:
        return any(one is hearer for one in self._hearers)

    def forget(self, hearer: Hearer) -> None:
        self._hearers = tuple(one for one in self._hearers if one is not hearer)

    def remove(self, hearer: Hearer) -> Call[bool]:
        self.forget(hearer)
        if any(one.topic == hearer.topic for one in self._hearers):
            return self._subscription(hearer.topic)
        return calls.Connection.unsubscribe([hearer.topic])

    def hear(self, topic: str, params: Any) -> None:
        for hearer in self._hearers:
            if hearer.topic == topic:
                hearer.take(params)

    def lost(self, error: RmacError) -> None:
        for hearer in self._hearers:
            hearer.lost(error)

    def subscriptions(self) -> list[Call[bool]]:
        """What a new connection is to be asked for."""
        return [self._subscription(topic) for topic in sorted({hearer.topic for hearer in self._hearers})]

    def _subscription(self, topic: str) -> Call[bool]:
        """A topic has one rate a connection; who wants less gets more."""
        return calls.Connection.subscribe([topic], max(one.rate_hz for one in self._hearers if one.topic == topic))

"""What `hello` answers, and whether this package fits the one who answers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rmac.errors import ProtocolError, VersionMismatch
from rmac.generated import API_VERSION
from rmac.wire.call import Call


@dataclass(frozen=True, slots=True)
class Greeting:
    server: str
    version: str
    connection: int  # its number at the appliance; counts on
    queue_capacity: int
    line_bytes: int
    cycle_hz: float
    units: Mapping[str, str]


def read_greeting(answer: Mapping[str, Any]) -> Greeting:
    try:
        limits = answer["limits"]
        return Greeting(
            answer["server"], answer["version"], answer["connection"],
            limits["queue_capacity"], limits["line_bytes"], limits["cycle_hz"], answer["units"],
        )
    except (KeyError, TypeError):
        raise ProtocolError(f"this is no RMAC appliance: it answered hello with {str(answer)[:80]}") from None


def hello(name: str) -> Call[Greeting]:
    return Call("hello", {"client": name}, read_greeting)


def check_version(version: str) -> None:
    """Before 1.0 minor versions may differ in methods; after it, major ones."""

    def series(text: str) -> list[str]:
        parts = text.split(".")
        return parts[:2] if parts[0] == "0" else parts[:1]

    if series(version) != series(API_VERSION):
        raise VersionMismatch(
            f"the appliance has version {version} of the API, and this package was made for {API_VERSION}: "
            "install the clients/python that came with the appliance, or connect with check=False and use what both have"
        )

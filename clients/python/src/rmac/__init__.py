"""Talks to an RMAC appliance. `rmac.connect` gives a blocking client, `rmac.aio.connect` one for asyncio."""

from rmac.client import Client, connect
from rmac.errors import (
    AuthorityHeld,
    AuthorityRequired,
    CannotConnect,
    ConnectionLost,
    InvalidValue,
    MachineRefused,
    NotAnswered,
    ProtocolError,
    Refused,
    RequestRefused,
    RmacError,
    VersionMismatch,
)
from rmac.generated import API_VERSION, calls
from rmac.machines import Joint, LoadedMachine, Machine
from rmac.wire.call import Call

__all__ = [
    "API_VERSION",
    "AuthorityHeld",
    "AuthorityRequired",
    "Call",
    "CannotConnect",
    "Client",
    "ConnectionLost",
    "InvalidValue",
    "Joint",
    "LoadedMachine",
    "Machine",
    "MachineRefused",
    "NotAnswered",
    "ProtocolError",
    "Refused",
    "RequestRefused",
    "RmacError",
    "VersionMismatch",
    "calls",
    "connect",
]

"""What can go wrong, one class each. Refusals carry the appliance's own message, which says what to do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar


class RmacError(Exception):
    """Everything that this package raises."""


class InvalidValue(RmacError, ValueError):
    """A value that cannot be sent: not finite, of a wrong shape, or no number. Nothing was sent."""


class CannotConnect(RmacError, ConnectionError):
    """No connection came about."""


class ConnectionLost(RmacError, ConnectionError):
    """The connection ended; what was asked and not answered may have been carried out or not."""


def asked_too_late(ended: RmacError, wait: str = "") -> ConnectionLost:
    """What to raise of a question that comes when the connection has ended already, by whatever: none of it was sent.
    `wait` stands before each call of the client in the advice."""
    return ConnectionLost(f"{ended}; nothing of this was sent: {wait}client.reconnect() connects again, {wait}client.state() tells then what the machine does")


class NotAnswered(RmacError, TimeoutError):
    """The answer did not come in time; it may come yet, and is dropped then."""


class ProtocolError(RmacError):
    """The other side does not speak the protocol, or this package does not."""


class VersionMismatch(RmacError):
    """The appliance has another version of the API than this package was generated from."""


class CannotResume(RmacError):
    """Where an interrupted program stands cannot be told for sure, so nothing of it is sent again."""


class Refused(RmacError):
    """The appliance answered with an error."""

    codes: ClassVar[tuple[int, ...]] = ()

    def __init__(self, method: str, error: Mapping[str, Any]) -> None:
        data = error.get("data") or {}
        self.method = method
        self.code: int = error["code"]
        self.message: str = error["message"]
        self.minor: int = data.get("minorCode", 0)
        self.minor_name: str = data.get("minorName", "")
        super().__init__(f"{method}: {self.message} ({self.code} {self.minor_name})".replace(" )", ")"))


class RequestRefused(Refused):
    """The request itself is wrong: unknown method, parameters that are missing, unknown, or out of range."""

    codes = (-32600, -32601, -32602)


class InternalError(Refused):
    """A defect of the appliance; please report it."""

    codes = (-32603,)


class AuthorityRequired(Refused):
    """The call moves or changes the machine: make it within `with client.authority():`."""

    codes = (-32040,)


class AuthorityHeld(Refused):
    """Another client holds motion authority; the message says who."""

    codes = (-32041,)


class RateTaken(Refused):
    """Another client already receives more than 100 samples a second."""

    codes = (-32042,)


class RequestTooLarge(Refused):
    """A line was longer than the appliance takes; it closes the connection."""

    codes = (-32043,)


class OperatorThere(Refused):
    """Another client is the operator; the message says who."""

    codes = (-32044,)


class MachineRefused(Refused):
    """The machine cannot, or must not, do this; one class a minor code below."""

    codes = (-32000,)


class UnknownMachineError(MachineRefused):
    codes = (-32001,)


class EmergencyStop(MachineRefused):
    codes = (-32002,)


class NoAir(MachineRefused):
    codes = (-32003,)


class TravelLimit(MachineRefused):
    codes = (-32004,)


class SpeedLimit(MachineRefused):
    codes = (-32005,)


class AccelerationLimit(MachineRefused):
    codes = (-32006,)


class ProbeNotArmed(MachineRefused):
    codes = (-32007,)


class ScaleError(MachineRefused):
    codes = (-32008,)


class PartNotFound(MachineRefused):
    codes = (-32009,)


class UnexpectedHit(MachineRefused):
    codes = (-32010,)


class CommunicationTimeout(MachineRefused):
    codes = (-32011,)


class ResponseTimeout(MachineRefused):
    codes = (-32012,)


class InvalidParameter(MachineRefused):
    codes = (-32013,)


class InvalidParameterValue(MachineRefused):
    codes = (-32014,)


class QueueFull(MachineRefused):
    codes = (-32015,)


class UnsupportedOperation(MachineRefused):
    codes = (-32016,)


class OtherRefusal(MachineRefused):
    codes = (-32017,)


def _by_code(kind: type[Refused]) -> dict[int, type[Refused]]:
    found = {code: kind for code in kind.codes}
    for narrower in kind.__subclasses__():
        found |= _by_code(narrower)
    return found


_BY_CODE = _by_code(Refused)


def refusal(method: str, error: Mapping[str, Any]) -> Refused:
    """The exception of an error object: by its code, or `Refused` where a later appliance has more of them."""
    return _BY_CODE.get(error["code"], Refused)(method, error)

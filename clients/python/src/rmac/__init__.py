"""Talks to an RMAC appliance. `rmac.connect` gives a blocking client, `rmac.aio.connect` one for asyncio."""

from rmac import errors
from rmac.animation import Animation, Body, MachineGeometry, Sample
from rmac.client import Client, connect
from rmac.errors import (
    AuthorityHeld,
    AuthorityRequired,
    CannotConnect,
    CannotResume,
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
from rmac.events import Event
from rmac.generated import API_VERSION, calls
from rmac.geometry.frame import Frame
from rmac.geometry.nurbs import NurbsCurve
from rmac.geometry.pose import Pose
from rmac.machines import Joint, LoadedMachine, Machine
from rmac.moves import (
    Arc,
    ArcThrough,
    AwaitInput,
    Dwell,
    InTurn,
    JointNurbs,
    Line,
    Move,
    MoveJoints,
    MoveTo,
    Nurbs,
    PoseNurbs,
    ProgramStop,
    output,
    polyline,
    spindle,
    tool_change,
)
from rmac.records import FlightRecord, Record
from rmac.run import Run
from rmac.streaming.progress import Interrupted, MachineStopped, MoveRefused
from rmac.wire.call import Call

__all__ = [
    "API_VERSION",
    "Animation",
    "Arc",
    "ArcThrough",
    "AuthorityHeld",
    "AuthorityRequired",
    "AwaitInput",
    "Body",
    "Call",
    "CannotConnect",
    "CannotResume",
    "Client",
    "ConnectionLost",
    "Dwell",
    "Event",
    "FlightRecord",
    "Frame",
    "InTurn",
    "Interrupted",
    "InvalidValue",
    "Joint",
    "JointNurbs",
    "Line",
    "LoadedMachine",
    "Machine",
    "MachineGeometry",
    "MachineRefused",
    "MachineStopped",
    "Move",
    "MoveJoints",
    "MoveRefused",
    "MoveTo",
    "NotAnswered",
    "Nurbs",
    "NurbsCurve",
    "Pose",
    "PoseNurbs",
    "ProgramStop",
    "ProtocolError",
    "Record",
    "Refused",
    "RequestRefused",
    "RmacError",
    "Run",
    "Sample",
    "VersionMismatch",
    "calls",
    "connect",
    "errors",
    "output",
    "polyline",
    "spindle",
    "tool_change",
]

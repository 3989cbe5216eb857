"""What a program consists of: moves, and what happens between them, as plain objects."""

from rmac.moves.between import AwaitInput, Dwell, InTurn, ProgramStop, Request, item, output, spindle, tool_change
from rmac.moves.curves import JointNurbs, Nurbs, PoseNurbs
from rmac.moves.lines import Arc, ArcThrough, Line, polyline
from rmac.moves.move import Move
from rmac.moves.positioning import MoveJoints, MoveTo

__all__ = [
    "Arc",
    "ArcThrough",
    "AwaitInput",
    "Dwell",
    "InTurn",
    "JointNurbs",
    "Line",
    "Move",
    "MoveJoints",
    "MoveTo",
    "Nurbs",
    "PoseNurbs",
    "ProgramStop",
    "Request",
    "item",
    "output",
    "polyline",
    "spindle",
    "tool_change",
]

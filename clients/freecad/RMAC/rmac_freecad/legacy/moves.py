"""Requests of an imported program as moves of the package `rmac`, so that a lost connection can be gone on from in their midst."""

import rmac
from rmac.geometry.nurbs import NurbsCurve
from rmac.geometry.pose import Pose
from rmac.moves import Request
from rmac.wire.call import Call


def move_of(method, read):
    """`read`: its parameters, but for the move's id. The move may be given an `index`."""
    make = _MAKERS.get(method)
    return _Request(method, read) if make is None else make(read)


def _numbered(kind):
    """Of the kinds of moves, those that know where in a program they stand."""
    return type(kind.__name__, (kind,), {"__slots__": ("index",)})


_Request = _numbered(Request)
_MoveTo, _Line, _Arc, _Nurbs = map(_numbered, (rmac.MoveTo, rmac.Line, rmac.Arc, rmac.Nurbs))
_Dwell, _ProgramStop, _AwaitInput, _InTurn = map(_numbered, (rmac.Dwell, rmac.ProgramStop, rmac.AwaitInput, rmac.InTurn))


def _pose(frame):
    return Pose(frame["p"], frame.get("axis"), frame.get("q"))


def _arc(read):
    center = read["CenterPoint"]
    return _Arc(_pose(read["StartPoint"]), _pose(read["EndPoint"]), center["p"], center["axis"],
                clockwise=read["RotSign"] < 0, closed=read["Closed"], turns=read.get("Turns", 0))  # fmt: skip


def _nurbs(read):
    curve = read["Nurbs"]
    return _Nurbs(NurbsCurve(curve["degree"], curve["knots"], curve["points"], curve.get("weights")))


_MAKERS = {
    "RMAC_CAM.MoveToPathTarget": lambda read: _MoveTo(_pose(read["TargetFrame"])),
    "RMAC_CAM.MoveAlongLine": lambda read: _Line(_pose(read["StartPoint"]), _pose(read["EndPoint"])),
    "RMAC_CAM.MoveAlongArc": _arc,
    "RMAC_CAM.MoveAlongNurbs": _nurbs,
    "RMAC_CAM.Dwell": lambda read: _Dwell(read["Time"]),
    "RMAC_CAM.ProgramStop": lambda read: _ProgramStop(read.get("Message", ""), optional=read["Optional"]),
    "RMAC_CAM.AwaitInput": lambda read: _AwaitInput(read["Name"], read["On"], read["TimeOut"]),
    "RMAC_CAM.InTurn": lambda read: _InTurn(*(Call(call["method"], call.get("params", {})) for call in read["Calls"])),
}

"""NURBS as moves; they go to the appliance as they are."""

from __future__ import annotations

from rmac.errors import InvalidValue
from rmac.geometry.nurbs import NurbsCurve
from rmac.geometry.pose import Point
from rmac.moves.move import Move


class Nurbs(Move):
    """Of the tool tip, in x y z; the tool keeps its axis."""

    __slots__ = ("curve",)
    method = "RMAC_CAM.MoveAlongNurbs"
    _coordinates = 3

    def __init__(self, curve: NurbsCurve) -> None:
        _require_curve(curve)
        if curve.dimension != self._coordinates:
            hint = "; give it a z first" if curve.dimension == 2 else ""
            raise InvalidValue(f"{type(self).__name__} needs {self._coordinates} coordinates, and this curve has {curve.dimension}{hint}")
        self.curve = curve

    @property
    def start(self) -> Point:  # type: ignore[override]
        return self.curve.points[0][:3]  # type: ignore[return-value]

    @property
    def end(self) -> Point:  # type: ignore[override]
        return self.curve.points[-1][:3]  # type: ignore[return-value]

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"Nurbs":{{{self.curve.text()}}}}}'

    def rest(self, length: float) -> Move | None:
        left = self.curve.rest(length, 3)
        return None if left is None else type(self)(left)


class PoseNurbs(Nurbs):
    """In x y z i j k: the tool turns along it."""

    __slots__ = ()
    method = "RMAC_CAM.MoveAlongNurbsND"
    _coordinates = 6

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"NurbsND":{{{self.curve.text()},"space":"pose"}}}}'


class JointNurbs(Move):
    """One coordinate a joint."""

    __slots__ = ("curve",)
    method = "RMAC_CAM.MoveAlongNurbsND"

    def __init__(self, curve: NurbsCurve) -> None:
        _require_curve(curve)
        self.curve = curve

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"NurbsND":{{{self.curve.text()},"space":"joint"}}}}'


def _require_curve(curve: object) -> None:
    if not isinstance(curve, NurbsCurve):
        raise InvalidValue(f"{curve!r:.80} is no curve: make a NurbsCurve of it first")

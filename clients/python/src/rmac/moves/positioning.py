"""From rest to rest, to a place."""

from __future__ import annotations

from typing import Any

from rmac.geometry.numbers import finite, text
from rmac.geometry.pose import Point, Pose, pose
from rmac.moves.move import Move


class MoveTo(Move):
    """The tool tip on a line from where the queue ends, from rest to rest."""

    __slots__ = ("target",)
    method = "RMAC_CAM.MoveToPathTarget"

    def __init__(self, target: Any) -> None:
        self.target = pose(target, "MoveTo")

    @property
    def end(self) -> Point:  # type: ignore[override]
        return self.target.p

    def params(self, move_id: int) -> str:
        return f'{{"MoveID":{move_id},"TargetFrame":{self.target.text}}}'

    def rest(self, length: float) -> Move:
        return self  # from wherever it was left


class MoveJoints(Move):
    """All joints together, from rest to rest: to one number a joint, or to a `Pose`."""

    __slots__ = ("target",)
    method = "RMAC_CAM.MoveToJointTarget"

    def __init__(self, target: Any) -> None:
        self.target: Pose | tuple[float, ...] = target if isinstance(target, Pose) else finite(target, "MoveJoints")

    def params(self, move_id: int) -> str:
        target = self.target.text if isinstance(self.target, Pose) else f'{{"joints":{text(self.target)}}}'
        return f'{{"MoveID":{move_id},"JointTargetFrame":{target}}}'

    def rest(self, length: float) -> Move:
        return self  # from wherever it was left

"""A move knows its method, its parameters as JSON, and where it begins and ends.

The appliance refuses a move that begins elsewhere than the one before it ends; one whose `start` is None begins wherever
the queue does, so it is sent only once everything before it was taken (rmac.streaming.gaps).
"""

from __future__ import annotations

import json
from typing import Any

from rmac.errors import CannotResume
from rmac.geometry.pose import Point


class Move:
    __slots__ = ()
    method = ""
    start: Point | None = None
    end: Point | None = None
    queues = True  # it stands in the queue, and counts there

    def params(self, move_id: int) -> str:
        raise NotImplementedError

    def request(self, move_id: int = 0) -> dict[str, Any]:
        """As a line of a `.rmac` program has it."""
        return {"method": self.method, "params": json.loads(self.params(move_id))}

    def rest(self, length: float) -> Move | None:
        """What is left of it once so much of its length was travelled: None where that is nothing. Raises `CannotResume`
        where that cannot be told."""
        raise CannotResume(f"{type(self).__name__} cannot be taken up in its midst")

    def __repr__(self) -> str:
        return f"{type(self).__name__}({json.dumps(self.request()['params'])[:120]})"

"""Records of what joints did, as numpy arrays: of the topic `joints`, and flight records. numpy is asked for only here."""

from __future__ import annotations

import array
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rmac.errors import RmacError
from rmac.generated import calls
from rmac.geometry.numbers import positive
from rmac.machines import Steps

_SCALARS = ("t_s", "cycle", "move_id", "moving", "s_mm", "feed_mm_s", "feed_actual_mm_s")
_VECTORS = ("pose", "q", "qd", "qdd", "a", "ad", "effort", "error")
_OF_SOME = ("truth",)  # which only simulated axes tell


@dataclass(frozen=True)
class Record:
    """One row a cycle. mm, or degrees where a joint turns. `lost` counts gaps: cycles that were due and did not come."""

    t_s: Any
    cycle: Any
    move_id: Any
    moving: Any
    s_mm: Any
    feed_mm_s: Any
    feed_actual_mm_s: Any
    pose: Any  # x y z i j k of the setpoint
    q: Any  # setpoints of the joints: positions, velocities, accelerations
    qd: Any
    qdd: Any
    a: Any  # measured positions and velocities
    ad: Any
    effort: Any
    error: Any
    lost: int
    truth: Any = None  # positions at the loads, whatever encoders measured: of simulated axes; None where nobody knows them

    def __len__(self) -> int:
        return len(self.t_s)


class Samples:
    """Rows as they come."""

    def __init__(self, rate_hz: float, cycle_hz: float) -> None:
        self._every = max(1, round(cycle_hz / positive(rate_hz, "rate_hz")))  # cycles between two of them
        self._rows = array.array("d")
        self._widths: list[int] = []
        self._cycle = -1
        self._lost = 0
        self._mixed = False

    def take(self, samples: Sequence[Mapping[str, Any]]) -> None:
        for sample in samples:
            row: list[float] = [sample[name] for name in _SCALARS]
            vectors = [sample[name] for name in _VECTORS] + [sample.get(name, []) for name in _OF_SOME]
            widths = [len(vector) for vector in vectors]
            for vector in vectors:
                row += vector
            self._mixed |= bool(self._widths) and widths != self._widths
            self._widths = widths
            self._rows.extend(row)
            self._lost += self._cycle >= 0 and sample["cycle"] > self._cycle + self._every
            self._cycle = sample["cycle"]

    def reach(self, cycle: int) -> bool:
        return self._cycle > cycle - self._every

    def record(self) -> Record:
        import numpy

        if self._mixed:
            raise RmacError("another machine was loaded while this was recorded: its joints are not those before")
        if not self._widths:
            raise RmacError("nothing came while this was recorded: is a machine loaded?")
        table = numpy.frombuffer(self._rows.tobytes()).reshape(-1, len(_SCALARS) + sum(self._widths))
        columns: dict[str, Any] = {name: table[:, number] for number, name in enumerate(_SCALARS)}
        for name in ("cycle", "move_id"):
            columns[name] = columns[name].astype(numpy.int64)
        columns["moving"] = columns["moving"].astype(bool)
        place = len(_SCALARS)
        for name, width in zip(_VECTORS + _OF_SOME, self._widths):
            columns[name] = table[:, place : place + width] if width else None
            place += width
        return Record(**columns, lost=self._lost)


@dataclass(frozen=True)
class FlightRecord:
    """The last seconds before a fault, cycle by cycle: `columns` by name, each an array (docs/flight-recorder.md)."""

    head: Mapping[str, Any]
    columns: Mapping[str, Any]


def read_flight_record(name: str) -> Steps:
    """Its text part by part."""
    parts: list[str] = []
    offset: int | None = 0
    while offset is not None:
        (part,) = yield [calls.FlightRecorder.Read(name, offset)]
        parts.append(part["text"])
        offset = part["next_offset"]
    return parse_flight_record("".join(parts))


def parse_flight_record(text: str) -> FlightRecord:
    import numpy

    head, names, *rows = text.splitlines()
    cells = [row.split(",") for row in rows]
    columns: dict[str, Any] = {}
    for number, column in enumerate(names.split(",")):
        values = [row[number] for row in cells]
        try:
            columns[column] = numpy.array([float(value) if value else numpy.nan for value in values])
        except ValueError:
            columns[column] = numpy.array(values)  # words, as of horizon_limit
    return FlightRecord(json.loads(head), columns)

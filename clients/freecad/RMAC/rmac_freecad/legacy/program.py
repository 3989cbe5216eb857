"""An imported program: as long as a file may be, so that its moves are made of its text when they are wanted."""

import functools
import json
import re
from array import array
from collections.abc import Sequence
from dataclasses import dataclass

from rmac_freecad.jobs import JobTool
from rmac_freecad.legacy.moves import move_of
from rmac_freecad.legacy.refusal import CodeRefused
from rmac_freecad.path import strokes_of

# As `rmac import --ids-are-lines` writes it. Parameters are kept but for the move's id: moves of one line share it there.
REQUEST = re.compile(rb'\{"jsonrpc":"2\.0","id":(\d+),"method":"([A-Za-z_.]+)","params":\{("MoveID":\d+,?)?(.*)\}\}\s*')
# Where it leads to: of `MoveToPathTarget`, and of `MoveAlongLine`, whose parameters begin with its start.
STRAIGHT = re.compile(r'^(?:"StartPoint":\{[^}]*\},"EndPoint"|"TargetFrame"):\{"p":\[([^,\]]+),([^,\]]+),([^,\]]+)\]')
CURVED = ("RMAC_CAM.MoveAlongArc", "RMAC_CAM.MoveAlongNurbs")


@dataclass(frozen=True)
class SourceLine:
    """Where in a file of another control something comes from."""

    file: str
    line: int

    def __str__(self):
        return f"{self.file}, line {self.line}"


class CodeProgram:
    """As `rmac_freecad.program.Program`, with lines of the file as places."""

    def __init__(self, file):
        self.file = file
        self.moves = _Moves(self)
        self._lines = array("L")
        self._kinds = array("B")
        self._methods = []  # by kind, with whether it has a move's id
        self._params = []

    def __len__(self):
        return len(self._params)

    def append_request(self, written):
        """A line of a `.rmac` program, as bytes."""
        request = REQUEST.fullmatch(written)
        if request is None or b'"MoveID"' in request[4]:
            raise CodeRefused(f"rmac import wrote {written[:80]!r}, which this add-on does not know: have both of one version", self.file)
        kind = (request[2].decode(), request[3] is not None)
        if kind not in self._methods:
            self._methods.append(kind)
        self._kinds.append(self._methods.index(kind))
        self._lines.append(int(request[1]))
        self._params.append(request[4].decode(errors="replace"))

    def params_of(self, index):
        """But for the move's id."""
        return json.loads("{" + self._params[index] + "}")

    def method_of(self, index):
        return self._methods[self._kinds[index]][0]

    def move(self, index):
        made = move_of(self.method_of(index), self.params_of(index))
        made.index = index
        return made

    @functools.cached_property
    def strokes(self):
        """Takes its time where it is long; the program is whole then."""
        return strokes_of(self)

    def ways(self):
        """As of `rmac_freecad.program.Program`, without making those moves that are straight."""
        return map(self._way, range(len(self)))

    def _way(self, index):
        straight = STRAIGHT.search(self._params[index])
        if straight is not None:
            return float(straight[1]), float(straight[2]), float(straight[3])
        return self.move(index) if self.method_of(index) in CURVED else None

    def place_of(self, index):
        return SourceLine(self.file, self._lines[index])

    def index_of(self, move):
        """None of a move that is none of this program's, as the way back onto its path."""
        return getattr(move, "index", None)

    def text(self):
        """As a `.rmac` program: one request a line. The ids count, as those of other programs here."""
        return "".join(map(self._request, range(len(self))))

    def _request(self, index):
        method, has_id = self._methods[self._kinds[index]]
        params = self._params[index]
        own = f'"MoveID":{index + 1}{"," if params else ""}' if has_id else ""
        return f'{{"jsonrpc":"2.0","id":{index + 1},"method":"{method}","params":{{{own}{params}}}}}\n'


class _Moves(Sequence):
    def __init__(self, program):
        self._program = program

    def __len__(self):
        return len(self._program)

    def __getitem__(self, index):
        indices = range(len(self))[index]  # of a slice a range
        return [self._program.move(one) for one in indices] if isinstance(index, slice) else self._program.move(indices)

    def __iter__(self):
        return map(self._program.move, range(len(self)))


def tools_in(program):
    """Those that it changes to, each once, in their order. How large they are it does not say."""
    found = {}
    for index in range(len(program)):
        if program.method_of(index) == "RMAC_CAM.DoToolChange":
            number = program.params_of(index)["ToolNumber"]
            found.setdefault(number, JobTool(number, str(program.place_of(index)), 0.0))
    return [tool for number, tool in found.items() if number != 0]  # 0 leaves the spindle empty

"""Has `rmac simulate` plan a program, and tells its findings at their place in the job."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field

REFUSED_LINE = re.compile(r"^rmac: standard input:(\d+): (.*)", re.S)


class SimulationRefused(Exception):
    """`place` tells where in the job, and `index` which move it is; None where that is the program as a whole. `why` is the
    appliance's message."""

    def __init__(self, why, place=None, index=None):
        super().__init__(f"{place}: {why}" if place else why)
        self.place = place
        self.index = index
        self.why = why


class NoProgram(SimulationRefused):
    """The command-line client, which simulates, is not there."""


class WouldStop(SimulationRefused):
    """The machine, by what its axes do."""


@dataclass(frozen=True)
class Found:
    cycle_time_s: float
    length_mm: float
    limited_by_s: dict  # by the limit that ruled
    move_limits: dict = field(default_factory=dict)  # by index of the move; those that did not move have none
    off_path_mm: float | None = None  # the farthest that the tip is beside its path as the axes bend and lag; None where nobody asked


def simulate(program, machine, tools, rmac="rmac", patience_s=600, part_frame=None, dynamics=False):
    """Gives up after `patience_s`. `tools` is the tool table, as `client.cam.GetTools()` gives it of the appliance; `rmac` the
    command-line client. `part_frame` as `client.cam.GetPartFrame()` gives it; the machine's own unless given. `dynamics`: what its axes
    make of it as well; refused where there is no model of one, or where they would stop the machine."""
    executable = shutil.which(rmac)
    if executable is None:
        raise NoProgram(f"the program {rmac} is not there; it comes with the appliance's package, or give its path as rmac=")
    with tempfile.TemporaryDirectory(prefix="rmac-simulate-") as folder:
        table = {key: tools[key] for key in ("Mounted", "Tools")}
        (pathlib.Path(folder) / f"{machine}.json").write_text(json.dumps(table))
        try:
            ended = subprocess.run(
                [executable, "--json", "simulate", "--by-move", *(["--dynamics"] if dynamics else []), "--machine", machine, "--tools", folder, "-"],
                input=_head(part_frame) + program.text(), capture_output=True, text=True, check=False, timeout=patience_s,
            )  # fmt: skip
        except subprocess.TimeoutExpired as late:
            raise SimulationRefused(f"the simulation on {machine} took longer than {patience_s} s; simulate a part of the job, or wait longer (patience_s=)") from late
    lines_before = 0 if part_frame is None else 1
    if ended.returncode != 0 and not (dynamics and ended.stdout):  # what the axes do may be found wrong
        raise _refusal(ended.stderr.strip(), program, lines_before)
    told = json.loads(ended.stdout)
    limits = {one["move_id"] - 1: one["limit"] for one in told["move_limits"] if one["limit"]}
    return Found(told["cycle_time_s"], told["length_mm"], told["limited_by_s"], limits, _off_path(told["dynamics"], program, lines_before) if dynamics else None)


def _off_path(axes, program, lines_before):
    stopped = axes["stopped"]
    if stopped:
        raise _refused_at(stopped["line"], f"the machine would stop: {stopped['why']}", program, lines_before, WouldStop)
    return axes["path_peak_mm"]


def _head(part_frame):
    """What comes before the program: a line, or none."""
    if part_frame is None:
        return ""
    return json.dumps({"jsonrpc": "2.0", "id": 0, "method": "RMAC_CAM.SetPartFrame", "params": {"PartFrame": part_frame}}) + "\n"


def _refusal(said, program, lines_before):
    line = REFUSED_LINE.match(said)
    return _refused_at(int(line[1]), line[2], program, lines_before) if line else SimulationRefused(said)


def _refused_at(line, why, program, lines_before, kind=SimulationRefused):
    """`line` of what was simulated; 0: before it began."""
    index = line - 1 - lines_before
    return kind(why, program.place_of(index), index) if index >= 0 else kind(why)

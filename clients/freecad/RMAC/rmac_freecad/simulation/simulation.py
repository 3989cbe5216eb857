"""Has `rmac simulate` plan a program, and tells its findings at their place in the job."""

import json
import pathlib
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass

REFUSED_LINE = re.compile(r"^rmac: standard input:(\d+): (.*)", re.S)


class SimulationRefused(Exception):
    """`place` tells where in the job, or is None where that is the program as a whole; `why` is the appliance's message."""

    def __init__(self, why, place=None):
        super().__init__(f"{place}: {why}" if place else why)
        self.place = place
        self.why = why


@dataclass(frozen=True)
class Found:
    cycle_time_s: float
    length_mm: float
    limited_by_s: dict  # by the limit that ruled


def simulate(program, machine, tools, rmac="rmac", patience_s=600):
    """Gives up after `patience_s`. `tools` is the tool table, as `client.cam.GetTools()` gives it of the appliance; `rmac` the command-line client."""
    executable = shutil.which(rmac)
    if executable is None:
        raise SimulationRefused(f"the program {rmac} is not there; it comes with the appliance's package, or give its path as rmac=")
    with tempfile.TemporaryDirectory(prefix="rmac-simulate-") as folder:
        table = {key: tools[key] for key in ("Mounted", "Tools")}
        (pathlib.Path(folder) / f"{machine}.json").write_text(json.dumps(table))
        try:
            ended = subprocess.run(
                [executable, "--json", "simulate", "--machine", machine, "--tools", folder, "-"],
                input=program.text(), capture_output=True, text=True, check=False, timeout=patience_s,
            )  # fmt: skip
        except subprocess.TimeoutExpired as late:
            raise SimulationRefused(f"the simulation on {machine} took longer than {patience_s} s; simulate a part of the job, or wait longer (patience_s=)") from late
    if ended.returncode != 0:
        raise _refusal(ended.stderr.strip(), program)
    told = json.loads(ended.stdout)
    return Found(told["cycle_time_s"], told["length_mm"], told["limited_by_s"])


def _refusal(said, program):
    line = REFUSED_LINE.match(said)
    return SimulationRefused(line[2], program.place_of(int(line[1]) - 1)) if line else SimulationRefused(said)

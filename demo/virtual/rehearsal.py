"""Programs simulated before any machine moves: `rmac simulate`, and what it told."""

import dataclasses
import functools
import json
import pathlib
import subprocess

import clamping
import numpy as np


@dataclasses.dataclass
class Rehearsal:
    told: dict  # as `rmac simulate --json` prints it
    warning: str
    page: pathlib.Path
    stock: pathlib.Path
    record: pathlib.Path

    @functools.cached_property
    def motion(self):
        """The record: times, MoveIDs and joints of each cycle."""
        table = np.loadtxt(self.record, delimiter=",", skiprows=1, usecols=[0, 1, *range(10, 15)])
        return table[:, 0], table[:, 1].astype(int), table[:, 2:]

    def finding(self):
        return self.told["collisions"][0]


def simulate(rmac, program, setup, tools, tree, resolution, name):
    """Leaves `NAME.html`, `NAME.stl` and `NAME.csv` beside the program."""
    page, stock, record = (program.with_name(name + ending) for ending in (".html", ".stl", ".csv"))
    words = ["--setup", setup, "--tools", tools, "--resolution", str(resolution), "--view", page, "--stock-out", stock, "--record", record, "--json"]
    done = subprocess.run([rmac, "simulate", program, "--machine", clamping.MACHINE, "--device-tree", tree, *words],
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)  # fmt: skip
    if not done.stdout.strip():
        raise RuntimeError(f"rmac simulate {program}: {done.stderr.strip() or 'it told nothing'}")
    return Rehearsal(json.loads(done.stdout), done.stderr.strip(), page, stock, record)

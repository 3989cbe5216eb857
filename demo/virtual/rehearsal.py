"""Programs simulated before any machine moves: `rmac simulate`, and what it told."""

import dataclasses
import json
import pathlib
import subprocess
import tempfile

import clamping
import numpy as np

TIME, MOVE, JOINTS = 0, 1, slice(10, 15)  # columns of a setpoint record


@dataclasses.dataclass
class Rehearsal:
    told: dict  # as `rmac simulate --json` prints it
    warning: str
    page: pathlib.Path
    stock: pathlib.Path | None  # surface of what is left
    times: np.ndarray  # of each cycle
    moves: np.ndarray
    joints: np.ndarray

    def finding(self):
        return self.told["collisions"][0]


def simulate(rmac, program, setup, tools, tree, resolution, with_surface):
    """Leaves a page beside the program, by its name, and where wanted the surface of what is left."""
    page, stock = program.with_suffix(".html"), program.with_suffix(".stl") if with_surface else None
    words = ["--device-tree", tree, "--setup", setup, "--tools", tools, "--resolution", str(resolution), "--view", page, "--json"]
    words += ["--stock-out", stock] if stock else []
    with tempfile.TemporaryDirectory() as folder:
        record = pathlib.Path(folder) / "record.csv"
        done = subprocess.run([rmac, "simulate", program, "--machine", clamping.MACHINE, "--record", record, *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)  # fmt: skip
        if not done.stdout.strip():
            raise RuntimeError(f"rmac simulate {program}: {done.stderr.strip() or 'it told nothing'}")
        table = np.loadtxt(record, delimiter=",", skiprows=1, usecols=[TIME, MOVE, *range(*JOINTS.indices(100))])
    return Rehearsal(json.loads(done.stdout), done.stderr.strip(), page, stock, table[:, 0], table[:, 1].astype(int), table[:, 2:])

"""What a demo records of a machine, through the Python package of clients/python."""

import array
import collections
import pathlib
import sys
import threading
import time

import numpy as np

from record import Record

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "clients/python/src"))
from rmac.hearing import Hearer  # noqa: E402

FULL_RATE_HZ = 1000
STILL_ROWS = 50  # of an idle machine that are kept before and after motion


class Recorder:
    """Rows of the topic `joints` while something moves, and a little before and after; hears them within a `with` block."""

    def __init__(self, client=None):
        self._client = client
        self._hearer = Hearer("joints", FULL_RATE_HZ, self._take, self._end)
        self._changed = threading.Condition()
        self._ended = None
        self.rows = array.array("d")
        self.width = self.joints = 0
        self.told = False  # where the loads truly are
        self.cycles = self.lost = 0
        self.last_cycle = None
        self.first_motion = None  # wall clock
        self._before = collections.deque(maxlen=STILL_ROWS)
        self._still = 0
        self._last_q = None

    def __enter__(self):
        self._client.hear(self._hearer)
        return self

    def __exit__(self, kind, error, trace):
        if error is None:
            self._catch_up()
        self._client.unhear(self._hearer)

    def _catch_up(self):
        """Until the samples of all that happened so far have come."""
        cycle = self._client.state()["cycle"]
        with self._changed:
            self._changed.wait_for(lambda: self._ended or (self.last_cycle or 0) >= cycle)
        if self._ended:
            raise self._ended

    def _take(self, params):
        with self._changed:
            for sample in params["samples"]:
                self.add(sample)
            self._changed.notify()

    def _end(self, error):
        with self._changed:
            self._ended = error
            self._changed.notify()

    def add(self, sample):
        q, measured = sample["q"], sample["a"] + sample.get("held", [])
        truth = sample.get("truth", []) + sample.get("held_truth", [])
        row = [sample["t_s"], sample["move_id"], sample["s_mm"], sample["feed_mm_s"]]
        row += sample["pose"] + q + sample["qd"] + sample["qdd"] + measured + truth
        if not self.width:
            self.width, self.joints, self.told = len(row), len(q), bool(truth)
        if self.last_cycle is not None and sample["cycle"] != self.last_cycle + 1:
            self.lost += 1
        self.last_cycle = sample["cycle"]
        self.cycles += 1
        moved = self._last_q is not None and q != self._last_q
        self._last_q = q
        if moved:
            if self.first_motion is None:
                self.first_motion = time.monotonic()
            for earlier in self._before:
                self.rows.extend(earlier)
            self._before.clear()
            self._still = 0
        self._still += not moved
        if moved or (self.rows and self._still <= STILL_ROWS):
            self.rows.extend(row)
        else:
            self._before.append(row)

    def record(self):
        if not self.rows:
            raise RuntimeError("nothing moved while the record was taken")
        if not self.told:
            raise RuntimeError("the machine does not tell where its loads truly are, which the demo's part is cut from: run it on simulated drives")
        return Record.from_table(np.frombuffer(self.rows).reshape(-1, self.width).copy(), self.joints)

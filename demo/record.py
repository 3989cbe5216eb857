"""The setpoint record: one row a cycle, as CSV. Lengths mm, time s, feed mm/s.

Columns: t_s, move_id, s_mm, feed_mm_s, x..k (tool tip and axis, part frame), q, qd, qdd (setpoints of the joints), a (as
the drives' encoders measured them) and truth (where the loads were, which simulated axes alone tell); the axes that a
mechanism holds still follow its joints in the latter two.
"""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Record:
    t: np.ndarray
    move: np.ndarray
    s: np.ndarray
    feed: np.ndarray
    pose: np.ndarray  # (rows, 6)
    q: np.ndarray  # (rows, joints)
    qd: np.ndarray
    qdd: np.ndarray
    a: np.ndarray  # (rows, joints + held axes)
    truth: np.ndarray  # as a

    @property
    def joints(self):
        return self.q.shape[1]

    @classmethod
    def from_table(cls, table, joints):
        setpoints = 10 + 3 * joints
        measured, odd = divmod(table.shape[1] - setpoints, 2)
        if odd or measured < joints:
            raise ValueError(f"a record of {joints} joints with {table.shape[1]} columns: there is no truth in it for each place that was measured; record it anew")
        parts = np.split(table, np.cumsum([1, 1, 1, 1, 6, joints, joints, joints, measured]), axis=1)
        t, move, s, feed = (p[:, 0] for p in parts[:4])
        return cls(t, move.astype(np.int64), s, feed, *parts[4:])

    def table(self):
        return np.column_stack([self.t, self.move, self.s, self.feed, self.pose, self.q, self.qd, self.qdd, self.a, self.truth])

    def header(self):
        names = ["t_s", "move_id", "s_mm", "feed_mm_s", "x", "y", "z", "i", "j", "k"]
        measured = self.a.shape[1]
        for prefix, count in (("q", self.joints), ("qd", self.joints), ("qdd", self.joints), ("a", measured), ("truth", measured)):
            names += [f"{prefix}{n + 1}" for n in range(count)]
        return names

    def write(self, path):
        """Every number with all its digits: third differences at the cycle must mean something."""
        with open(path, "w", encoding="ascii") as file:
            file.write(",".join(self.header()) + "\n")
            for row in self.table().tolist():
                row[1] = int(row[1])
                file.write(",".join(map(repr, row)) + "\n")

    @classmethod
    def read(cls, path):
        with open(path, encoding="ascii") as file:
            names = file.readline().strip().split(",")
            table = np.loadtxt(file, delimiter=",", ndmin=2)
        return cls.from_table(table, sum(name.startswith("qdd") for name in names))

    def without_long_rests(self, keep=50):
        """The record with long stretches of standstill (idle machine) cut to `keep` rows at each of their ends."""
        still = np.zeros(len(self.t), bool)
        still[1:] = np.all(np.diff(self.q, axis=0) == 0, axis=1)
        edges = np.flatnonzero(np.diff(np.concatenate([[0], still.astype(int), [0]])))
        chosen = np.ones(len(self.t), bool)
        for first, last in zip(edges[::2], edges[1::2]):
            if last - first > 2 * keep:
                chosen[first + keep : last - keep] = False
        return Record(*(getattr(self, f.name)[chosen] for f in dataclasses.fields(self)))

"""Programs with cutter radius compensation, made at random from a seed, for compare_rs274.py: contours of lines and arcs, tangent or
with corners, on both sides, with depths and rapids between, some of which the tool does not get into.

Moves are tangent but for rounding, or have corners of at least 0.05 rad: from 0.01 rad on a corner is none.
"""
import math
import random


class RadiusProgram:
    def __init__(self, seed: int) -> None:
        self.random = random.Random(f"radius {seed}")
        self.lines: list[str] = []
        self.at = (1.0, 2.0)
        self.unit = 1.0
        self.incremental = False
        self.direction = 0.0
        self.digits = self.random.choice([4, 8])
        self.lines.append("g21 g90 g17 g40 g80 g94 g54")
        self.lines.append("F600 G0 X1 Y2 Z30")
        if self.random.random() < 0.2:
            self.unit, self.digits = 25.4, 8
            self.lines += ["G20", "F20"]
        for _ in range(self.random.randint(1, 3)):
            self.contour()
        self.lines.append("M2")

    def contour(self) -> None:
        radius = self.random.choice([0.5, 1, 2, 3])
        self.lines.append("%s D%.4f" % (self.random.choice(["G41.1", "G42.1"]), 2 * radius / self.unit))
        self.direction = self.random.uniform(0, 2 * math.pi)
        self.line(radius * self.random.uniform(2, 5))
        for _ in range(self.random.randint(2, 12)):
            kind = self.random.random()
            if kind < 0.12:
                self.lines.append(self.random.choice(["G1", "G0"]) + " Z%.4f" % (self.random.uniform(-5, 30) / self.unit if not self.incremental else 0.5))
            elif kind < 0.18:
                self.incremental = not self.incremental
                self.lines.append("G91" if self.incremental else "G90")
            elif kind < 0.24:
                self.lines.append("F%d" % self.random.randint(5, 99))
            elif kind < 0.64:
                self.turn()
                self.line(radius * self.random.uniform(1.5, 8))
            else:
                if self.random.random() < 0.6:
                    self.turn()
                self.arc(radius * self.random.uniform(0.95, 6))
        self.lines.append("G40" + self.random.choice(["", " G1 X%.4f Y%.4f" % tuple(v / self.unit for v in self.next_start())]))
        if self.lines[-1] == "G40":
            self.lines.append("G90 G0 X%.4f Y%.4f" % tuple(v / self.unit for v in self.next_start()))
        else:
            self.lines[-1:] = ["G90", self.lines[-1]]
        self.incremental = False

    def next_start(self) -> tuple[float, float]:
        self.at = (round(self.random.uniform(-20, 20) / self.unit, 4) * self.unit, round(self.random.uniform(-20, 20) / self.unit, 4) * self.unit)
        return self.at

    def turn(self) -> None:
        angle = self.random.uniform(0.05, math.pi - 0.1)
        if self.random.random() < 0.5:
            angle = self.random.uniform(0.05, 1.2)
        self.direction += self.random.choice([1, -1]) * angle

    def end_words(self, end: tuple[float, float]) -> str:
        words = "".join(" %s%.*f" % (axis, self.digits, (e - (a if self.incremental else 0)) / self.unit) for axis, e, a in zip("XY", end, self.at))
        if self.random.random() < 0.2:
            words += " Z%.4f" % ((0.3 if self.incremental else self.random.uniform(-3, 3)) / self.unit)
        return words

    def line(self, length: float) -> None:
        end = (self.at[0] + length * math.cos(self.direction), self.at[1] + length * math.sin(self.direction))
        self.lines.append(self.random.choice(["G1", "G1", "G1", "G1", "G0"]) + self.end_words(end))
        self.at = self.written(end)

    def written(self, end: tuple[float, float]) -> tuple[float, float]:
        """Where the rounded words lead."""
        if not self.incremental:
            return (self.rounded(end[0]), self.rounded(end[1]))
        return (self.at[0] + self.rounded(end[0] - self.at[0]), self.at[1] + self.rounded(end[1] - self.at[1]))

    def rounded(self, value: float) -> float:
        return round(value / self.unit, self.digits) * self.unit

    def arc(self, radius: float) -> None:
        """Its begin goes on in the direction in which the contour went."""
        left = self.random.choice([1, -1])
        centre = (self.at[0] - left * radius * math.sin(self.direction), self.at[1] + left * radius * math.cos(self.direction))
        sweep = 2 * math.pi if self.random.random() < 0.1 else self.random.uniform(0.3, 5)
        begin = math.atan2(self.at[1] - centre[1], self.at[0] - centre[0])
        end = (centre[0] + radius * math.cos(begin + left * sweep), centre[1] + radius * math.sin(begin + left * sweep))
        if sweep > 6:
            end = self.at
        words = self.end_words(end)
        self.lines.append(("G3" if left > 0 else "G2") + words + " I%.*f J%.*f" % (self.digits, (centre[0] - self.at[0]) / self.unit, self.digits, (centre[1] - self.at[1]) / self.unit))
        self.at = self.written(end)
        self.direction += left * sweep

#!/usr/bin/env python3
"""Compares rmac-import with LinuxCNC's rs274 over generated programs: the same path and the same spindle, coolant and dwells in the
same order, to the four decimals that rs274 prints.

    apt-get download linuxcnc-uspace libboost-python1.74.0 && for d in *.deb; do dpkg -x $d x; done
    tests/legacy/compare_rs274.py --oracle x --import build/release/bin/rmac-import --programs 1000

rs274 is no part of ./test.sh: it is fetched. A program on which the two differ is kept, and the exit code is 1.
"""
import argparse
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import rotary_programs
from o_word_programs import OWordProgram
from radius_programs import RadiusProgram
from rotary_programs import RotaryProgram

START = (1.0, 2.0, 30.0)
TOLERANCE_MM = 3e-3  # of the four decimals, which are of an inch in many blocks: 25.4 times 0.00005, of a place and of an offset
PLANES = {"17": (0, 1, 2), "18": (2, 0, 1), "19": (1, 2, 0)}


class Program:
    """A program that both are to take, made at random. It keeps its own books of the position only to aim arcs."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.unit = 1.0
        self.lines = []
        self.feeds = self.random.sample(range(1, 1000), 999)
        self.plane = "17"
        self.incremental = False
        self.absolute_centres = False
        self.at = list(START)  # mm, in the coordinates of the program
        self.offset = [0.0, 0.0, 0.0]
        self.write("g21 g90 g17 g40 g80 g94 g54 g98 g64 p0.05")
        self.write("F%d G0 X%g Y%g Z%g" % (self.random.randint(50, 3000), *START))
        for _ in range(self.random.randint(5, 40)):
            self.random.choice([self.straight, self.straight, self.arc, self.arc, self.rounded_arc, self.radius_arc, self.mode, self.unit_change, self.shift,
                                self.switch, self.drill, self.parameters, self.polar, self.told, self.saved])()
        self.write(self.random.choice(["M2", "m30"]))

    def write(self, text):
        number = "N%d " % (len(self.lines) * 10) if self.random.random() < 0.2 else ""
        comment = self.random.choice(["", "", "", " (a comment)", " ; another"])
        self.lines.append(number + text + comment)

    def number(self, value):
        text = "%.4f" % (value / self.unit)
        style = self.random.randint(0, 7)
        if style == 0:
            part = "%.3f" % self.random.uniform(-3, 3)
            return "[%s + %s - [%s]]" % (part, text, part)
        if style == 1:
            return "[%s * 2 / 2]" % text
        return text

    def said(self, value):
        """The value that number() will say: what is written has four decimals."""
        return round(value / self.unit, 4) * self.unit

    def target(self, axes):
        """Words that go to a new place, and that place."""
        words, end = [], list(self.at)
        for axis in axes:
            wanted = self.random.uniform(-40, 40)
            delta = self.said(wanted - self.at[axis]) if self.incremental else None
            end[axis] = self.at[axis] + delta if self.incremental else self.said(wanted)
            words.append("XYZ"[axis] + self.number(delta if self.incremental else end[axis]))
        self.random.shuffle(words)
        return words, end

    def straight(self):
        words, end = self.target(self.random.sample(range(3), self.random.randint(1, 3)))
        self.write(self.random.choice(["G0 ", "G1 ", "g 0 1 "]) + " ".join(words))
        self.at = end

    def centre(self, centre):
        words = []
        for axis in PLANES[self.plane][:2]:
            value = centre[axis] if self.absolute_centres else centre[axis] - self.at[axis]
            words.append("IJK"[axis] + "%.7f" % (value / self.unit))
        return words

    def end_words(self, end):
        return ["XYZ"[axis] + "%.7f" % ((end[axis] - self.at[axis] if self.incremental else end[axis]) / self.unit) for axis in range(3)]

    def arc(self):
        first, second, normal = PLANES[self.plane]
        centre = list(self.at)
        radius, begin = self.random.uniform(1, 30), self.random.uniform(0, 2 * math.pi)
        centre[first] -= radius * math.cos(begin)
        centre[second] -= radius * math.sin(begin)
        full = self.random.random() < 0.2
        sweep = 0 if full else self.random.uniform(0.2, 6)
        end = list(self.at)
        if not full:
            end[first] = centre[first] + radius * math.cos(begin + sweep)
            end[second] = centre[second] + radius * math.sin(begin + sweep)
        if self.random.random() < 0.4:
            end[normal] += self.random.uniform(-5, 5)
        turns = " P%d" % self.random.randint(1, 4) if self.random.random() < 0.3 else ""
        self.write(self.random.choice(["G2 ", "G3 "]) + " ".join(self.end_words(end) + self.centre(centre)) + turns)
        self.at = end

    def rounded_arc(self):
        """With the digits that programs have, mostly nearly closed or of a short chord."""
        first, second, _ = PLANES[self.plane]
        digits = 4 if self.unit == 25.4 else 3
        step = self.unit * 10**-digits

        def rounded(value):
            return round(value / step) * step

        radius, begin = 10**self.random.uniform(-0.3, 2.5), self.random.uniform(0, 2 * math.pi)
        short = min(10**self.random.uniform(-1.2, 0) / radius, 1)
        sweep = self.random.choice([short, 2 * math.pi - short, self.random.uniform(short, 2 * math.pi - short)])
        code = self.random.choice(["G2 ", "G3 "])
        start = [rounded(v) for v in self.at]
        self.incremental, self.absolute_centres = False, False
        self.write("G90 G91.1 G1 " + " ".join("XYZ"[a] + "%.*f" % (digits, start[a] / self.unit) for a in range(3)))
        way = [rounded(-radius * math.cos(begin)), rounded(-radius * math.sin(begin))]
        angle = begin + (sweep if code == "G3 " else -sweep)
        end = list(start)
        end[first] = rounded(start[first] + way[0] + radius * math.cos(angle))
        end[second] = rounded(start[second] + way[1] + radius * math.sin(angle))
        self.write(code + " ".join("%s%.*f" % (letter, digits, value / self.unit) for letter, value in (
            ("XYZ"[first], end[first]), ("XYZ"[second], end[second]), ("IJK"[first], way[0]), ("IJK"[second], way[1]))))
        self.at = end

    def radius_arc(self):
        first, second, normal = PLANES[self.plane]
        end = list(self.at)
        end[first] += self.random.uniform(2, 20)
        end[second] += self.random.uniform(-20, 20)
        if self.random.random() < 0.4:
            end[normal] += self.random.uniform(-5, 5)
        chord = math.hypot(end[first] - self.at[first], end[second] - self.at[second])
        radius = chord * self.random.uniform(0.51, 3) * self.random.choice([1, -1])
        self.write(self.random.choice(["G2 ", "G3 "]) + " ".join(self.end_words(end)) + " R%.7f" % (radius / self.unit))
        self.at = end

    def mode(self):
        kind = self.random.randint(0, 4)
        if kind == 0:
            self.plane = self.random.choice(list(PLANES))
            self.write("G" + self.plane)
        elif kind == 1:
            self.incremental = not self.incremental
            self.write("G91" if self.incremental else "G90")
        elif kind == 2:
            self.absolute_centres = not self.absolute_centres
            self.write("G90.1" if self.absolute_centres else "G91.1")
        elif kind == 3:
            self.feed()
        else:
            self.write("G64 P%.4f" % (0.05 / self.unit))

    def unit_change(self):
        self.unit = 25.4 if self.unit == 1 else 1.0
        code = "G20" if self.unit == 25.4 else "G21"
        if self.random.random() < 0.5:  # counts in the unit before
            self.write("%s F%d" % (code, self.feeds.pop()))
        else:
            self.write(code)
            self.feed()

    def feed(self):
        """No number twice: rs274 restores none that is in force, though the unit is another."""
        self.write("F%d" % self.feeds.pop())

    def saved(self):
        """Modes that M72 restores, or the end of a sub with M73. An F in the unit that is restored: rs274 gives its number back."""
        self.feed()
        held = self.unit, self.plane, self.incremental, self.absolute_centres
        sub = "o<saved%d>" % len(self.lines) if self.random.random() < 0.5 else None
        self.write("%s sub\nM73" % sub if sub else "M70")
        for _ in range(self.random.randint(1, 5)):
            self.random.choice([self.straight, self.arc, self.mode, self.unit_change, self.switch])()
        self.write("{0} endsub\n{0} call".format(sub) if sub else "M72")
        self.unit, self.plane, self.incremental, self.absolute_centres = held

    def shift(self):
        if self.random.random() < 0.4:
            self.write("G92.1")
            self.at = [a + o for a, o in zip(self.at, self.offset)]
            self.offset = [0.0, 0.0, 0.0]
            return
        if self.random.random() < 0.4:
            self.local()
            return
        words = []
        for axis in self.random.sample(range(3), self.random.randint(1, 3)):
            value = self.said(self.random.uniform(-20, 20))
            words.append("XYZ"[axis] + "%.4f" % (value / self.unit))
            self.offset[axis] += self.at[axis] - value
            self.at[axis] = value
        self.write("G92 " + " ".join(words))

    def local(self):
        words = []
        for axis in self.random.sample(range(3), self.random.randint(1, 3)):
            value = self.said(self.random.uniform(-20, 20))
            words.append("XYZ"[axis] + "%.4f" % (value / self.unit))
            self.at[axis] += self.offset[axis] - value
            self.offset[axis] = value
        self.write("G52 " + " ".join(words))

    def switch(self):
        self.write(self.random.choice(["M3 S1000", "M4 S500", "M5", "M8", "M9", "G4 P0.25", "S1234", "M0", "M1", "m3 s200 m8"]))

    def drill(self):
        first, second, normal = PLANES[self.plane]
        back = self.random.choice(["G98", "G99"])
        code = self.random.choice(["G73", "G81", "G82", "G83", "G85", "G86", "G89"])
        if code == "G86":
            self.write("M3 S700")
        peck = " Q%.4f" % (self.random.uniform(1, 4) / self.unit)
        extra = {"G73": peck, "G82": " P0.1", "G83": peck, "G86": " P0.2", "G89": " P0.3"}.get(code, "")
        retract = self.random.uniform(0, 3) if not self.incremental else self.random.uniform(-3, 3)
        depth = retract - self.random.uniform(1, 9) if not self.incremental else -self.random.uniform(1, 9)
        axis = "XYZ"[normal]
        words, _ = self.target([first, second])
        repeats = " L%d" % self.random.randint(2, 5) if self.random.random() < 0.4 else ""
        if self.incremental and self.plane == "17" and math.hypot(*self.at[:2]) > 1:
            words = self.random.choice([["@%.4f" % (3 / self.unit)], ["^%.3f" % 50.5], ["@%.4f" % (2 / self.unit), "^-30"]])
        self.write("%s %s %s R%.4f %s%.4f%s%s" % (back, code, " ".join(words), retract / self.unit, axis, depth / self.unit, extra, repeats))
        for _ in range(self.random.randint(0, 2)):
            words, _ = self.target([first])
            self.write(" ".join(words))
        self.write("G80")
        self.incremental = False
        self.write("G90")
        self.at = [self.said(v) for v in (5, 6, 7)]
        self.write("G0 X%.4f Y%.4f Z%.4f" % tuple(v / self.unit for v in self.at))

    def parameters(self):
        index = self.random.randint(1, 30)
        a, b, c = (self.random.randint(-9, 9) for _ in range(3))
        operators = ["+", "-", "*", "MOD", "EQ", "NE", "GT", "GE", "LT", "LE", "AND", "OR", "XOR"]
        one, two = self.random.choice(operators), self.random.choice(operators)
        function = self.random.choice(["ABS", "SIN", "COS", "FIX", "FUP", "ROUND", "ATAN2", "SQRT"])
        last = {"ATAN2": "ATAN[%d.5]/[%d.25]" % (b, c), "SQRT": "SQRT[%d]" % abs(b)}.get(function, "%s[%d.5]" % (function, b))
        divisor = c or 3
        self.write("#%d=[%d %s %d %s %d] #<_a %d>=%s" % (index, a, one, b or 1, two, divisor, index, last))
        self.write("G90 G0 X[#%d / 7] Y#<_A%d> Z-[#%d ** 2 / 9]" % (index, index, index))
        # Where that is rs274 tells; here the next place is named whole.
        self.incremental = False
        self.at = [self.said(v) for v in (1, 2, 3)]
        self.write("G0 X%.4f Y%.4f Z%.4f" % tuple(v / self.unit for v in self.at))

    def polar(self):
        if self.plane != "17" or math.hypot(*self.at[:2]) < 0.01:
            return
        distance, angle = math.hypot(*self.at[:2]), math.atan2(self.at[1], self.at[0])
        words = []
        if self.random.random() < 0.7:
            value = self.said(self.random.uniform(1, 30))
            words.append("@%.4f" % (value / self.unit))
            distance = value + (distance if self.incremental else 0)
        if not words or self.random.random() < 0.7:
            degrees = round(self.random.uniform(-400, 400), 3)
            words.append("^%.3f" % degrees)
            angle = math.radians(degrees) + (angle if self.incremental else 0)
        self.write(self.random.choice(["G0 ", "G1 "]) + " ".join(words))
        self.at[:2] = [distance * math.cos(angle), distance * math.sin(angle)]

    def told(self):
        """What the control tells of itself becomes places."""
        names = ["metric", "imperial", "absolute", "incremental", "units_per_minute", "units_per_rev", "inverse_time", "ijk_absolute_mode",
                 "spindle_on", "spindle_cw", "spindle_rpm_mode", "flood", "mist", "feed_hold", "adaptive_feed", "lathe_radius_mode",
                 "retract_r_plane", "retract_old_z", "call_level"]
        tens = ["plane", "motion_mode", "coord_system", "rpm", "line"]
        self.write("#1=[#<_%s> + 2*#<_%s>] #2=[#<_%s> / 100] #3=#<_%s>" % (*self.random.sample(names, 2), self.random.choice(tens),
                                                                         self.random.choice("xyz")))
        self.incremental = False
        self.write("G90 G0 X#1 Y#2 Z#3")
        self.at = [self.said(v) for v in (2, 3, 4)]
        self.write("G0 X%.4f Y%.4f Z%.4f" % tuple(v / self.unit for v in self.at))


KINDS = {"moves": Program, "o-words": OWordProgram, "radius": RadiusProgram, "rotary": RotaryProgram}
TRIALS = 5
NUMBER = r"(-?[\d.]+)"


def oracle_path(program, options, folder):
    """Where rs274 says nothing, neither steps nor why not, it is asked again: on a busy computer it does now and then."""
    for _ in range(TRIALS):
        steps, words = asked_once(program, options, folder)
        if steps is not None or not (words == "" or words.endswith("executing")):
            break
    return steps, words


def asked_once(program, options, folder):
    environment = dict(os.environ, LD_LIBRARY_PATH=f"{options.oracle}/usr/lib:{options.oracle}/usr/lib/x86_64-linux-gnu",
                       PYTHONPATH=f"{options.oracle}/usr/lib/python3/dist-packages")
    done = subprocess.run([f"{options.oracle}/usr/bin/rs274", "-t", folder / "tool.tbl", "-g", program], cwd=folder, env=environment,
                          capture_output=True, text=True, timeout=60, check=False)
    if options.kind == "rotary":
        steps = rotary_programs.oracle_steps(done.stdout)
        return steps, "" if steps is not None else (done.stdout + done.stderr).strip()
    unit, g92, plane, rpm, direction, at, steps = 1.0, [0.0] * 3, "XY", 0.0, 0, None, []
    for line in done.stdout.splitlines():
        match = re.match(r"\s*\d+ N\S*\s+(\w+)\((.*)\)$", line)
        if not match:
            continue
        call, words = match.groups()
        values = [float(v) for v in re.findall(NUMBER, words)] if call not in ("COMMENT", "MESSAGE") else []
        if call == "USE_LENGTH_UNITS":
            unit = 25.4 if "INCHES" in words else 1.0
        elif call == "SET_G92_OFFSET":
            g92 = [v * unit for v in values[:3]]
        elif call == "SELECT_PLANE":
            plane = words[-2:]
        elif call in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            end = [v * unit + o for v, o in zip(values, g92)]
            steps.append(("rapid" if call == "STRAIGHT_TRAVERSE" else "line", end))
        elif call == "ARC_FEED":
            first, second, normal = {"XY": (0, 1, 2), "XZ": (2, 0, 1), "YZ": (1, 2, 0)}[plane]
            end, centre = [0.0] * 3, [None] * 3
            end[first], end[second], end[normal] = values[0] * unit + g92[first], values[1] * unit + g92[second], values[5] * unit + g92[normal]
            centre[first], centre[second] = values[2] * unit + g92[first], values[3] * unit + g92[second]
            steps.append(("arc", end, centre, int(values[4])))
        elif call == "DWELL":
            steps.append(("dwell", values[0]))
        elif call == "SET_SPINDLE_SPEED":
            rpm = values[-1]
            steps.append(("rpm", rpm * direction))
        elif call in ("START_SPINDLE_CLOCKWISE", "START_SPINDLE_COUNTERCLOCKWISE", "STOP_SPINDLE_TURNING"):
            direction = {"START_SPINDLE_CLOCKWISE": 1, "START_SPINDLE_COUNTERCLOCKWISE": -1}.get(call, 0)
            steps.append(("rpm", rpm * direction))
        elif call in ("FLOOD_ON", "FLOOD_OFF"):
            steps.append(("coolant", call == "FLOOD_ON"))
        elif call in ("PROGRAM_STOP", "OPTIONAL_PROGRAM_STOP"):
            steps.append(("stop", call != "PROGRAM_STOP"))
        elif call == "SET_FEED_RATE":
            steps.append(("feed", values[0] * unit))
        elif call == "PROGRAM_END":
            return steps, ""
    return None, (done.stdout + done.stderr).strip()


def our_path(program, options, folder):
    out = folder / "out.rmac"
    words = rotary_programs.WORDS if options.kind == "rotary" else []
    done = subprocess.run([options.importer, program, "-o", out, *words], capture_output=True, text=True, timeout=60, check=False)
    if done.returncode != 0:
        return None, done.stderr.strip()
    if options.kind == "rotary":
        return rotary_programs.our_steps(out.read_text()), ""
    steps, move = [], None
    for line in out.read_text().splitlines():
        request = json.loads(line)
        method, params = request["method"].split(".")[1], request.get("params", {})
        if method == "MoveToPathTarget":
            steps.append(("rapid", params["TargetFrame"]["p"]))
        elif method == "MoveAlongLine" and options.kind == "moves" and steps and steps[-1][0] == "arc" and params["MoveID"] == move:
            steps[-1] = (*steps[-1][:1], params["EndPoint"]["p"], *steps[-1][2:])  # from the arc's circle to the end that was written
        elif method == "MoveAlongLine":
            steps.append(("line", params["EndPoint"]["p"]))
        elif method == "MoveAlongArc":
            centre, normal = list(params["CenterPoint"]["p"]), params["CenterPoint"]["axis"].index(1)
            centre[normal] = None
            move = params["MoveID"]
            steps.append(("arc", params["EndPoint"]["p"], centre, params["RotSign"] * (1 + params.get("Turns", 0))))
        elif method == "Dwell":
            steps.append(("dwell", params["Time"]))
        elif method == "ProgramStop":
            steps.append(("stop", params["Optional"]))
        elif method == "SetFeedrate":
            steps.append(("feed", params["Feedrate"]))
        elif method == "InTurn":
            for call in params["Calls"]:
                name = call["method"].split(".")[1]
                steps.append(("rpm", call["params"]["RPM"]) if name == "SetSpindleRPM" else ("coolant", name == "TurnCoolantOn"))
    return steps, ""


def simplified(steps):
    """Without moves to where the tool is, and states told again; each feed move with its feed."""
    at, rpm, coolant, feed, result = None, 0.0, False, None, []
    for step in steps:
        kind = step[0]
        if kind == "feed":
            feed = step[1]
            continue
        if kind == "rpm":
            if step[1] == rpm:
                continue
            rpm = step[1]
            if result and result[-1][0] == "rpm":
                result.pop()  # S and M4 of one block: rs274 first tells the speed with the old direction
        elif kind == "coolant":
            if step[1] == coolant:
                continue
            coolant = step[1]
        elif kind in ("rapid", "line"):
            if at is not None and max(abs(a - b) for a, b in zip(at, step[1])) < TOLERANCE_MM:
                continue
        if kind in ("rapid", "line", "arc"):
            at = step[1]
        result.append(step + ((feed,) if kind in ("line", "arc") else ()))
    # What one block switches stands in no order.
    for i in range(len(result) - 1):
        if result[i][0] == "coolant" and result[i + 1][0] == "rpm":
            result[i], result[i + 1] = result[i + 1], result[i]
    return result


def halfway(start, arc):
    """The place in the middle of an arc, without its whole turns: a centre that is off along a short chord hardly moves it."""
    _, end, centre, turns = arc[:4]
    first, second = [a for a in range(3) if centre[a] is not None]
    if centre[0] is not None and centre[2] is not None:
        first, second = 2, 0
    radius = math.hypot(start[first] - centre[first], start[second] - centre[second])
    begin, last = (math.atan2(p[second] - centre[second], p[first] - centre[first]) for p in (start, end))
    sweep = (last - begin if turns > 0 else begin - last) % (2 * math.pi)
    if sweep * radius < TOLERANCE_MM or (2 * math.pi - sweep) * radius < TOLERANCE_MM:
        return None  # a full turn or none: four decimals do not tell
    angle = begin + math.copysign(sweep / 2, turns)
    return [centre[first] + radius * math.cos(angle), centre[second] + radius * math.sin(angle)]


def same_arc(at, a, b):
    """What evening the centre moves is about as much as the radii differ."""
    ends = (math.dist([p for p, c in zip(place, a[2]) if c is not None], [c for c in a[2] if c is not None]) for place in (at, a[1]))
    off = abs(next(ends) - next(ends))
    one, two = halfway(at, a), halfway(at, b)
    near = one is None or two is None or math.dist(one, two) < 2 * off + 2 * TOLERANCE_MM
    return near and same(a[1], b[1]) and a[3] == b[3] and same(a[4:], b[4:])


def differs(theirs, ours):
    """The number of the first step that differs."""
    at = START
    for i, (a, b) in enumerate(zip(theirs, ours)):
        if not (same_arc(at, a, b) if a[0] == b[0] == "arc" else same(a, b)):
            return i
        if a[0] in ("rapid", "line", "arc"):
            at = b[1]
    return None


def same(a, b):
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, float) or isinstance(b, float):
        return a is not None and b is not None and abs(a - b) < TOLERANCE_MM + 2e-6 * abs(a)
    return a == b


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--oracle", required=True, help="the folder into which linuxcnc-uspace was unpacked")
    parser.add_argument("--import", dest="importer", required=True, help="the program rmac-import")
    parser.add_argument("--programs", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=list(KINDS), default="moves", help="what the programs are made of (default: moves)")
    options = parser.parse_args()
    options.oracle = pathlib.Path(options.oracle).resolve()
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rmac-rs274-"))
    (folder / "tool.tbl").write_text("T1 P1 Z0 D3\n")
    differ = compared = steps = both_refuse = 0
    for seed in range(options.seed, options.seed + options.programs):
        program = folder / f"{seed}.ngc"
        program.write_text("\n".join(KINDS[options.kind](seed).lines) + "\n")
        theirs, their_words = oracle_path(program, options, folder)
        ours, our_words = our_path(program, options, folder)
        if theirs is None and ours is None:
            both_refuse += 1
            program.unlink()
            continue
        if theirs is None or ours is None:
            differ += 1
            print(f"{program}: rs274: {their_words or 'takes it'}; rmac-import: {our_words or 'takes it'}")
            continue
        if options.kind != "rotary":
            theirs, ours = simplified(theirs), simplified(ours)
        compared += 1
        steps += len(ours)
        wrong = (rotary_programs.differs if options.kind == "rotary" else differs)(theirs, ours)
        if wrong is None and len(theirs) == len(ours):
            program.unlink()
            continue
        differ += 1
        wrong = min(len(theirs), len(ours)) if wrong is None else wrong
        print(f"{program}: step {wrong}:\n  rs274       {theirs[wrong - 1:wrong + 2]}\n  rmac-import {ours[wrong - 1:wrong + 2]}")
    print(f"{compared} programs of {steps} steps compared, {both_refuse} refused by both, {differ} differ")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())

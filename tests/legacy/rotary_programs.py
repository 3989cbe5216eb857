"""Programs for a machine whose axis A turns the part about X, and what rs274 and rmac-import make of them: places of the machine, X Y Z A,
and how long each feed move takes."""
import json
import math
import random
import re

CENTRE = (0.0, 3.0, -20.0)  # mm, a point on A
START = (1.0, 2.0, 30.0)
WORDS = ["--rotary", "A", "--rotary-centre", ",".join("%g" % c for c in CENTRE)]
DEGREE = 5  # of the splines that rmac-import writes
SAMPLES = 24  # of each of their pieces
SAME = 4e-3  # mm and degrees: rs274 prints four decimals, which are of an inch in many blocks
RAPID = 3000  # mm/min, which no program here has as its feed


class RotaryProgram:
    """Lines, arcs, indexes and moves with A beside X, Y and Z, in both units, distances and kinds of feed."""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.unit, self.incremental, self.inverse = 1.0, False, False
        self.at, self.a = list(START), 0.0
        self.lines = ["g21 g90 g17 g40 g80 g94 g54 g98 g64 p0.05", "F%d G0 X%g Y%g Z%g A0" % (self.random.randint(50, 2000), *START)]
        for _ in range(self.random.randint(5, 30)):
            self.random.choice([self.straight, self.straight, self.index, self.together, self.together, self.on_axis, self.arc, self.mode, self.feed])()
        self.lines.append("M2")

    def written(self, axis, wanted):
        digits = "%.4f" % ((wanted - self.at[axis] if self.incremental else wanted) / self.unit)
        self.at[axis] = float(digits) * self.unit + (self.at[axis] if self.incremental else 0)
        return "XYZ"[axis] + digits

    def turned(self):
        way = self.random.choice([self.random.uniform(-180, 180), 90, -90, self.random.uniform(-900, 900), 360])
        digits = "%.3f" % (way if self.incremental else self.a + way)
        self.a = float(digits) + (self.a if self.incremental else 0)
        return "A" + digits

    def block(self, *words):
        code = self.random.choice(["G0", "G1", "G1"])
        words = list(words)
        self.random.shuffle(words)
        self.lines.append(" ".join([code, *words]) + self.inverse_feed(code))

    def inverse_feed(self, code):
        return " F%.3f" % self.random.uniform(0.5, 20) if self.inverse and code != "G0" else ""

    def places(self, axes):
        return [self.written(axis, self.random.uniform(-40, 40)) for axis in axes]

    def straight(self):
        self.block(*self.places(self.random.sample(range(3), self.random.randint(1, 3))))

    def index(self):
        self.block(self.turned())

    def together(self):
        self.block(*self.places(self.random.sample(range(3), self.random.randint(1, 3))), self.turned())

    def on_axis(self):
        """The tip on the axis, and turning there."""
        self.incremental = False
        self.lines.append("G90 G0 Y%.5f Z%.5f" % (CENTRE[1] / self.unit, CENTRE[2] / self.unit))
        if self.unit == 1:
            self.at[1:] = CENTRE[1:]
            self.block(self.turned())
        self.straight()

    def arc(self):
        radius, begin = self.random.uniform(1, 30), self.random.uniform(0, 2 * math.pi)
        centre = [self.at[0] - radius * math.cos(begin), self.at[1] - radius * math.sin(begin)]
        end = begin + self.random.uniform(0.2, 6)
        way = [c - p for c, p in zip(centre, self.at)]
        words = ["%s%.7f" % ("XY"[i], ((centre[i] + radius * (math.cos, math.sin)[i](end)) - (self.at[i] if self.incremental else 0)) / self.unit)
                 for i in range(2)]
        for i in range(2):
            self.at[i] = centre[i] + radius * (math.cos, math.sin)[i](end)
        code = self.random.choice(["G2", "G3"])
        self.lines.append("G91.1 %s %s I%.7f J%.7f" % (code, " ".join(words), way[0] / self.unit, way[1] / self.unit) + self.inverse_feed(code))

    def mode(self):
        if self.random.random() < 0.5:
            self.incremental = not self.incremental
            self.lines.append("G91" if self.incremental else "G90")
        else:
            self.unit = 25.4 if self.unit == 1 else 1.0
            self.lines.append("G20" if self.unit != 1 else "G21")
            if not self.inverse:
                self.lines.append("F%d" % self.random.randint(5, 2000))

    def feed(self):
        self.inverse = not self.inverse and self.random.random() < 0.7
        self.lines.append("G93" if self.inverse else "G94 F%d" % self.random.randint(5, 2000))


def minutes(begin, end, feed, unit):
    """Of a straight move: F is of X, Y and Z, or of A where they stand."""
    way = math.dist(begin[:3], end[:3])
    return way / feed if way > SAME else abs(end[3] - begin[3]) * unit / feed if feed else None


def oracle_steps(text):
    """("rapid", X Y Z A) and ("feed", X Y Z A, minutes, the place halfway along an arc), or None where a program is refused."""
    at, unit, feed, steps = [*START, 0.0], 1.0, 0.0, []
    for line in text.splitlines():
        match = re.match(r"\s*\d+ N\S*\s+(\w+)\((.*)\)$", line)
        if not match:
            continue
        call, words = match.groups()
        if call == "USE_LENGTH_UNITS":
            unit = 25.4 if "INCHES" in words else 1.0
        elif call == "SET_FEED_RATE":
            feed = float(words) * unit
        elif call in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED"):
            values = [float(v) for v in words.split(",")]
            end = [v * unit for v in values[:3]] + values[3:4]
            if math.dist(end, at) > SAME:
                steps.append(("rapid", end) if call == "STRAIGHT_TRAVERSE" else ("feed", end, minutes(at, end, feed, unit), None))
            at = end
        elif call == "ARC_FEED":
            values = [float(v) for v in words.split(",")]
            end = [values[0] * unit, values[1] * unit, values[5] * unit, at[3]]
            centre = [values[2] * unit, values[3] * unit]
            radius = math.dist(centre, at[:2])
            begin, last = (math.atan2(p[1] - centre[1], p[0] - centre[0]) for p in (at, end))
            sweep = (last - begin) * values[4] % (2 * math.pi)
            half = begin + values[4] * sweep / 2
            middle = [centre[0] + radius * math.cos(half), centre[1] + radius * math.sin(half), at[2], at[3]]
            steps.append(("feed", end, radius * sweep / feed, middle))
            at = end
        elif call == "PROGRAM_END":
            return steps
    return None


def in_machine(tip, axis, a_before):
    """X Y Z A of a pose on the part, with A next to what it was."""
    angle = math.degrees(math.atan2(-axis[1], axis[2]))
    angle = a_before + (angle - a_before + 180) % 360 - 180
    sine, cosine = math.sin(math.radians(angle)), math.cos(math.radians(angle))
    y, z = tip[1] - CENTRE[1], tip[2] - CENTRE[2]
    return [tip[0], CENTRE[1] + cosine * y + sine * z, CENTRE[2] - sine * y + cosine * z, angle]


def spline_points(nurbs):
    """De Boor's algorithm, evenly over the parameter."""
    knots = [k for k, times in zip(nurbs["knots"], nurbs["multiplicities"]) for _ in range(times)]
    pieces = len(nurbs["knots"]) - 1
    for sample in range(1, SAMPLES * pieces + 1):
        at = sample / SAMPLES
        span = DEGREE + 3 * min(int(at), pieces - 1)
        points = [list(nurbs["points"][span - DEGREE + i]) for i in range(DEGREE + 1)]
        for level in range(1, DEGREE + 1):
            for i in range(DEGREE, level - 1, -1):
                low, high = knots[span - DEGREE + i], knots[span + 1 + i - level]
                share = (at - low) / (high - low)
                points[i] = [(1 - share) * p + share * q for p, q in zip(points[i - 1], points[i])]
        yield points[-1]


def arc_way(params):
    """Sixteen poses, and the length."""
    start, end, centre = (params[k] for k in ("StartPoint", "EndPoint", "CenterPoint"))
    normal = [params["RotSign"] * v for v in centre["axis"]]
    arm, last = ([p - c for p, c in zip(frame["p"], centre["p"])] for frame in (start, end))
    across = [normal[1] * arm[2] - normal[2] * arm[1], normal[2] * arm[0] - normal[0] * arm[2], normal[0] * arm[1] - normal[1] * arm[0]]
    climb = dot(last, normal)
    sweep = math.atan2(dot(last, across), dot(last, arm)) % (2 * math.pi)
    whole = math.acos(max(-1.0, min(1.0, dot(start["axis"], end["axis"]))))
    poses = []
    for sample in range(1, 17):
        share = sample / 16
        tip = [c + math.cos(share * sweep) * p + math.sin(share * sweep) * q + share * climb * v
               for c, p, q, v in zip(centre["p"], arm, across, normal)]
        axis = [(math.sin((1 - share) * whole) * p + math.sin(share * whole) * q) / math.sin(whole)
                for p, q in zip(start["axis"], end["axis"])] if whole > 1e-9 else end["axis"]
        poses.append((end["p"] if sample == 16 else tip) + axis)
    return poses, math.hypot(math.sqrt(dot(arm, arm)) * sweep, climb)


def dot(a, b):
    return sum(p * q for p, q in zip(a, b))


def way_of(method, params, tip):
    """Poses on the part of a move from `tip`, and how long that is."""
    if method == "MoveAlongArc":
        return arc_way(params)
    if method == "MoveAlongNurbsND":
        poses = list(spline_points(params["NurbsND"]))
        return poses, sum(math.dist(p[:3], q[:3]) for p, q in zip([tip] + poses, poses))
    frame = next(params[key] for key in ("EndPoint", "TargetFrame", "JointTargetFrame") if key in params)
    return [frame["p"] + frame["axis"]], math.dist(frame["p"], tip)


def our_steps(text):
    """The same of a .rmac program; moves of one line are one step. ValueError where the way between its ends is not straight in the machine."""
    at, tip, feed, steps, move = [*START, 0.0], list(START), 0.0, [], None
    for line in text.splitlines():
        request = json.loads(line)
        method, params = request["method"].split(".")[1], request["params"]
        feed = params.get("Feedrate", feed)
        if not method.startswith("Move"):
            continue
        poses, length = way_of(method, params, tip)
        begin, way = at, []
        for pose in poses:
            at = in_machine(pose[:3], pose[3:], at[3])
            way.append(at)
        tip = poses[-1][:3]
        planar = method == "MoveAlongArc" and abs(params["CenterPoint"]["axis"][0]) < 0.5
        if not planar:
            require_straight(begin, at, way, params["MoveID"])
        time = (length if length > 1e-3 or at[3] == begin[3] else abs(at[3] - begin[3])) / feed
        if params["MoveID"] == move and not planar and steps[-1][0] == ("rapid" if feed == RAPID else "feed"):
            time += steps.pop()[2]
        if math.dist(begin, at) > SAME or params["MoveID"] == move:
            steps.append(("rapid" if feed == RAPID else "feed", at, time, way[7] if planar else None))
        move = params["MoveID"]
    return steps


def require_straight(begin, end, way, line):
    """In X Y Z A together, as the machine goes it."""
    squares = math.dist(begin, end) ** 2
    for place in way if squares > SAME else []:
        share = dot([p - b for p, b in zip(place, begin)], [e - b for e, b in zip(end, begin)]) / squares
        off = max(abs(b + share * (e - b) - p) for p, b, e in zip(place, begin, end))
        if off > 1e-4:
            raise ValueError(f"line {line} leaves its way by {off:g}")


def differs(theirs, ours):
    """The number of the first step that differs, or None."""
    for number, (a, b) in enumerate(zip(theirs, ours)):
        near = all(abs(p - q) < SAME for p, q in zip(a[1], b[1]))
        if a[0] == "feed" and b[0] == "rapid":
            near = near and b[2] > a[2]  # as fast as anything goes
        elif near and a[0] == b[0] == "feed":
            near = abs(a[2] - b[2]) < 2e-3 * a[2] + 1e-5 and (a[3] is None or b[3] is None or math.dist(a[3], b[3]) < 4 * SAME)
        elif a[0] != b[0]:
            near = False
        if not near:
            return number
    return None if len(theirs) == len(ours) else min(len(theirs), len(ours))

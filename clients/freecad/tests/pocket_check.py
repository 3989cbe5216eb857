"""What a program clears of a pocket, told by FreeCAD's chords of the face and by points: shares nothing with what made it."""

import math
import random

import FreeCAD
import numpy as np
import Part
import rmac_freecad  # noqa: F401  finds the package rmac

import rmac  # isort: skip

CHORD_MM = 1e-4  # that FreeCAD's chords of a wall may be off
SPACING_MM = 0.05  # of places along moves
DOWN_MM = 1e-9


def points_of(move):
    """x y z along it."""
    a, b = np.array(move.start), np.array(move.end)
    if isinstance(move, rmac.Nurbs):
        curve, knots = move.curve, sorted(set(move.curve.knots))
        spline = Part.BSplineCurve()
        spline.buildFromPolesMultsKnots([FreeCAD.Vector(*p) for p in curve.points], [curve.knots.count(k) for k in knots], knots, False, curve.degree)
        count = int(spline.length() / SPACING_MM) + 8
        return np.array([tuple(spline.value(float(t))) for t in np.linspace(knots[0], knots[-1], count)])
    if isinstance(move, rmac.Arc):
        centre = np.array(move.center.p)
        begin, end = (math.atan2(*(place - centre)[[1, 0]]) for place in (a, b))
        sense = -1 if move.clockwise else 1
        sweep = 2 * math.pi if move.closed else sense * (end - begin) % (2 * math.pi)
        radius = math.dist(a[:2], centre[:2])
        part = np.linspace(0, 1, int(sweep * radius / SPACING_MM) + 8)
        way = begin + sense * sweep * part
        return np.column_stack([centre[0] + radius * np.cos(way), centre[1] + radius * np.sin(way), a[2] + (b[2] - a[2]) * part])
    part = np.linspace(0, 1, int(math.dist(a, b) / SPACING_MM) + 2)[:, None]
    return a + part * (b - a)


class Flat:
    """A face as seen from above."""

    def __init__(self, face):
        self._a, self._b = [], []
        for edge in face.Edges:
            points = np.array([(p.x, p.y) for p in edge.discretize(Deflection=CHORD_MM)])
            self._a.append(points[:-1])
            self._b.append(points[1:])
        self._a, self._b = np.concatenate(self._a), np.concatenate(self._b)
        self.low, self.high = self._a.min(0), self._a.max(0)

    def away(self, places):
        return away_from(self._a, self._b, places)

    def inside(self, places):
        x, y = places.T + 1.1e-7  # no place is as high as a corner
        odd = np.zeros(len(x), bool)
        for (ax, ay), (bx, by) in zip(self._a, self._b):
            if ay != by:
                odd ^= ((y < ay) != (y < by)) & (x < ax + (y - ay) * (bx - ax) / (by - ay))
        return odd

    def places(self, count, seed):
        """At random, in it."""
        chance = np.random.default_rng(seed)
        found = chance.uniform(self.low, self.high, (count * 4, 2))
        return found[self.inside(found)][:count]

    def centres(self, radius, apart):
        """Places of a grid where the tool touches no wall at least, its middle among them."""
        xs, ys = (np.append(np.arange(a, b, apart), (a + b) / 2) for a, b in zip(self.low, self.high))
        grid = np.array([(x, y) for x in xs for y in ys])
        grid = grid[self.inside(grid)]
        return grid[self.away(grid) >= radius - CHORD_MM / 10]


def away_from(a, b, places):
    least = np.full(len(places), np.inf)
    for p, q in zip(a, b):
        along = q - p
        square = along @ along
        part = np.clip((places - p) @ along / square, 0, 1) if square > 0 else np.zeros(len(places))
        least = np.minimum(least, np.hypot(*(places - p - part[:, None] * along).T))
    return least


def nearest_of(others, places):
    return np.concatenate([np.sqrt(((places[i : i + 200, None] - others) ** 2).sum(2).min(1)) for i in range(0, len(places), 200)])


class Cut:
    """A program, move by move."""

    def __init__(self, program, top):
        self.moves = [move for move in program.moves if move.end is not None]
        self.feeds = [move for move in self.moves if isinstance(move, (rmac.Line, rmac.Arc, rmac.Nurbs))]
        self._top = top

    def gouge(self, flat, radius):
        """Levels repeat each other's ways: each is looked at once."""
        once = {}
        for move in self.feeds:
            if min(move.start[2], move.end[2]) < self._top - DOWN_MM:
                once.setdefault((type(move), *np.round((*move.start[:2], *move.end[:2]), 6)), move)
        places = np.concatenate([points_of(move) for move in once.values()])[:, :2]
        if not flat.inside(places).all():
            return math.inf
        return float((radius - flat.away(places)).max())

    def level(self, z):
        """Moves that are level there."""
        return [move for move in self.feeds if abs(move.start[2] - z) < DOWN_MM and abs(move.end[2] - z) < DOWN_MM]

    def floors(self):
        """Z of what is cut level, from above."""
        return sorted({round(move.end[2], 9) for move in self.feeds if abs(move.start[2] - move.end[2]) < DOWN_MM}, reverse=True)

    def uncut(self, places, radius, z):
        """How far beyond the tool's reach places stay at that level, at most."""
        least = np.full(len(places), np.inf)
        for move in self.level(z):
            way = np.array([move.start, move.end]) if isinstance(move, rmac.Line) else points_of(move)
            least = np.minimum(least, away_from(way[:-1, :2], way[1:, :2], places))
        return float((least - radius).max(initial=-math.inf))

    def slopes(self):
        """In degrees, of whatever goes down aslant."""
        found = []
        for move, points in zip(self.feeds, map(points_of, self.feeds)):
            flat, down = np.hypot(*np.diff(points[:, :2], axis=0).T), -np.diff(points[:, 2])
            if math.dist(move.start[:2], move.end[:2]) > 1e-9 or isinstance(move, rmac.Arc):
                found.append(np.degrees(np.arctan2(down, flat)))
        return np.concatenate(found)

    def plunges(self):
        """Where it goes straight down to, at feed."""
        return [move.end for move in self.feeds if math.dist(move.start[:2], move.end[:2]) < 1e-9 and not isinstance(move, rmac.Arc)]


def seeded_face(seed):
    """Rounded rectangles, L shapes, islands, splines, turned anyhow."""
    chance = random.Random(seed)
    kind = ("rectangle", "ell", "island", "islands", "spline", "star", "spline island", "mouth")[seed % 8]
    width, height = chance.uniform(24, 40), chance.uniform(18, 30)
    if kind == "spline":
        face = blob(chance, 14)
    elif kind == "star":
        turns = [2 * math.pi * (number + chance.uniform(-0.2, 0.2)) / 10 for number in range(10)]
        corners = [at(r * math.cos(t), r * math.sin(t)) for t, r in zip(turns, (chance.uniform(9, 12), 19) * 5)]
        face = Part.Face(Part.makePolygon([*corners, corners[0]]))
    else:
        face = rounded(width, height, chance.uniform(0.5, 6))
        if kind == "ell":
            face = face.fuse(rounded(height / 2, width, chance.uniform(0.3, 3))).removeSplitter()
        elif kind == "mouth":
            face = face.fuse(rounded(width + 15, chance.uniform(4.5, 7), 0.4, 0, height / 3)).removeSplitter()
        elif kind != "rectangle":
            count = 1 if kind == "island" else 2
            for number in range(count):
                island = blob(chance, 2.5) if kind == "spline island" and number else rounded(chance.uniform(3, 6), chance.uniform(3, 6), 0.8)
                island.rotate(at(0, 0), at(0, 0, 1), chance.uniform(0, 90))
                island.translate(at(width * (number + 1) / (count + 1), height * chance.uniform(0.35, 0.65)))
                face = face.cut(island)
    face = face.Faces[0]
    face.rotate(at(0, 0), at(0, 0, 1), chance.uniform(0, 360))
    return kind, face


def whole_face(seed):
    """Rectangles and circles of whole millimetres, joined and cut out; with a tool's radius, and values that divide them."""
    chance, faces = random.Random(seed), []
    while len(faces) != 1:
        face = Part.makePlane(chance.randint(16, 34), chance.randint(10, 26))
        for _ in range(chance.randint(0, 2)):
            face = face.fuse(Part.makePlane(chance.randint(4, 14), chance.randint(4, 30), at(chance.randint(0, 28), chance.randint(0, 12)))).removeSplitter()
        for _ in range(chance.randint(0, 3)):
            place = at(chance.randint(3, 26), chance.randint(3, 18))
            square = Part.makePlane(chance.randint(2, 6), chance.randint(2, 6), place)
            face = face.cut(square if chance.random() < 0.6 else Part.Face(Part.Wire(Part.Circle(place, at(0, 0, 1), chance.randint(1, 4)).toShape())))
        faces = face.Faces
    radius = chance.choice((1.0, 1.5, 2.0))
    given = {"radius_mm": radius, "step_over_mm": chance.choice((0.5, 0.75, 1.0, 1.5, 1.9)) * radius, "depth_mm": 1.0, "ramp_deg": 10.0,
             "order": chance.choice(("inside out", "outside in")), "entry": chance.choice(("helix", "ramp"))}  # fmt: skip
    return faces[0], radius, given


def at(x, y, z=0.0):
    return FreeCAD.Vector(x, y, z)


def rounded(width, height, radius, x=0.0, y=0.0):
    box = Part.makeBox(width, height, 1, at(x, y))
    upright = [edge for edge in box.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.5]
    box = box.makeFillet(min(radius, width / 2.1, height / 2.1), upright)
    return next(face for face in box.Faces if face.BoundBox.ZMin == face.BoundBox.ZMax and abs(face.BoundBox.ZMin) < 1e-9)


def blob(chance, size):
    curve = Part.BSplineCurve()
    turns = [2 * math.pi * number / 7 for number in range(7)]
    curve.interpolate([at(r * math.cos(t), r * math.sin(t)) for t, r in ((t, size * chance.uniform(0.75, 1.25)) for t in turns)], PeriodicFlag=True)
    return Part.Face(Part.Wire(curve.toShape()))

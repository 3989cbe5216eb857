"""The demo from the model to the measured and corrected part, with the world that the user of FreeCAD does not see."""

import dataclasses
import json

import numpy as np

import designer
import inspection
import pictures
import session as sessions
import verdict
import world

# What nobody in FreeCAD knows: how the part lies on the measuring machine, and what is wrong with two tools.
PLACE_OFF = (0.11, -0.09, 0.05, 0.05)  # mm, and degrees about Z
END_MILL_LONGER_MM = 0.05  # than its table says: the pocket becomes deeper
DRILL_WIDER_MM = 0.03  # in diameter
# The part as designed, of blocks: x, y, z of two corners. What is above the first one is the free-form face.
BODY = ((-30, -20, -12, 0, 20, -6.5), (0, -20, -12, 30, 20, -4), (0, -20, -5, 5, 20, 0), (25, -20, -5, 30, 20, 0), (5, -20, -5, 25, -7.5, 0),
        (5, 7.5, -5, 25, 20, 0), (11, -2, -5, 19, 2, 0))  # fmt: skip
BEYOND_MM = 20.0  # so far a simulated bore reaches out of the part: a tip above it touches nothing
PARAMETERS = ("PocketDepth", "HoleDiameter")


@dataclasses.dataclass
class Truth:
    """What the simulated world knows, and the verdict holds the session against."""

    places: list
    off: np.ndarray  # of the part as cut, along the normal, at each place that was measured
    on_face: np.ndarray  # the same at many places of the free-form face, from setpoints: the paths alone
    pocket_depth: float
    hole_diameter: float
    place_off: tuple = PLACE_OFF


def tell(address, rmac_program, tree, out, scallop_mm, say):
    step_file = out / "part.step"
    designed = designer.draw()
    designer.write_step(designed, step_file)
    user = sessions.Session(address, rmac_program, say, scallop_mm)
    user.open(step_file)
    user.select()
    user.plan()
    user.take()
    user.dry_run()
    user.machine_part()
    say("The simulated world takes the part to the measuring machine")
    inspected = inspection.Inspection(user)
    places = inspected.places()
    truth = carry(user, tree, places)
    inspected.measure_part(places)
    inspected.correct()
    inspected.measure_again(places)
    inspected.correct_parameters(designed, PARAMETERS)
    user.close()
    sessions.save(user.part.Document, out / "part.FCStd")
    rows, line = verdict.judge(user, inspected, truth, json.loads((verdict.HERE / "bounds.json").read_text()))
    (out / "figures.json").write_text(json.dumps({"line": line, "rows": [list(row) for row in rows]}, indent=1) + "\n")
    verdict.print_table(rows, say)
    (out / "report.html").write_text(pictures.report_html(user, rows, pictures.draw(user, inspected, out), line["ok"]), encoding="utf-8")
    return line


def cuts_of(user, column):
    """Of the machine that was taken, three slides: where each cutter was, as it really is. `column`: `truth`, or `q` as it was to be."""
    drill = user.found.holes[0].diameter_mm / 2 + DRILL_WIDER_MM / 2
    kinds = {"sweep": (sessions.BALL_RADIUS, True, 0.0), "pocket": (sessions.FLAT_RADIUS, False, END_MILL_LONGER_MM), "holes": (drill, False, 0.0),
             "profile": (sessions.FLAT_RADIUS, False, END_MILL_LONGER_MM)}  # fmt: skip
    tips = {name: world.tips_of(getattr(record, column), sessions.MILL_ZERO, sessions.LENGTH_MM + kinds[name][2]) for name, record in user.records.items()}
    return {name: world.Cut(tips[name], radius, ball) for name, (radius, ball, _) in kinds.items()}


def carry(user, tree, places):
    cuts = cuts_of(user, "truth")
    points, normals = (np.array([getattr(place, key) for place in places]) for key in ("point", "normal"))
    holes = {name for hole in user.found.holes for name in hole.faces}
    others = np.array([place.face not in holes for place in places])
    off = np.zeros(len(places))
    off[others] = world.finished(world.as_cut(points[others], normals[others], list(cuts.values())))
    off[others] = world.flattened([place.face for place, other in zip(places, others) if other], normals[others], off[others])
    bores = as_drilled(user.found.holes, cuts["holes"])
    for number in np.flatnonzero(~others):
        off[number] = off_bore(points[number], normals[number], min(bores, key=lambda bore: np.hypot(bore[0] - points[number][0], bore[1] - points[number][1])))
    at = [sum(pair) for pair in zip(inspection.ZERO, PLACE_OFF)]
    world.clamp(tree, (*at, PLACE_OFF[3]), points[others], normals[others], off[others], bores, BODY, inspection.TIP_RADIUS)
    floor = np.array([place.face == user.found.recesses[0].floor for place in places])
    return Truth(places, off, on_face(user), user.found.recesses[0].top - user.found.recesses[0].z - float(off[floor].mean()), 2 * cuts["holes"].radius_mm)


def as_drilled(holes, cut):
    """x, y, radius, bottom, top of each, by where the drill was at its lowest."""
    tips = cut.tips
    found = []
    for hole in holes:
        near = tips[(np.hypot(tips[:, 0] - hole.x, tips[:, 1] - hole.y) < 0.5) & (tips[:, 2] < hole.bottom + 1)]
        if not len(near):
            raise RuntimeError(f"no drill came to the hole at X {hole.x:g} Y {hole.y:g}")
        x, y = near[:, :2].mean(0)
        found.append((x, y, cut.radius_mm, hole.bottom - BEYOND_MM, hole.top + BEYOND_MM))
    return found


def off_bore(point, normal, bore):
    """Along a normal that looks at the axis."""
    away = np.array(bore[:2]) - point[:2]
    along = away @ normal[:2]
    return along - np.sqrt(bore[2] ** 2 - (away @ away - along**2))


def on_face(user, count=1500, seed=5):
    """Random places of the free-form face, away from its border by the ball's radius, against the setpoints alone: what the paths leave. Where
    the ball does not get to is left out by its distance from the step."""
    chance = np.random.default_rng(seed)
    face = user.part.Shape.getElement(user.found.free_form[0])
    a, b, c, d = face.ParameterRange
    points, normals = [], []
    while len(points) < count:
        u, v = chance.uniform(a, b), chance.uniform(c, d)
        place = face.valueAt(u, v)
        if face.isPartOfDomain(u, v) and place.x < designer.STEP_X - sessions.BALL_RADIUS - 0.5:
            points.append(tuple(place))
            normals.append(tuple(face.normalAt(u, v)))
    return world.as_cut(np.array(points), np.array(normals), [cuts_of(user, "q")["sweep"]])

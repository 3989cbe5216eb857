"""Whether the demo's figures are within their bounds."""

import pathlib

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
SURE = 3  # standard deviations
CORNERS = np.array([(x, y, z) for x in (-30, 30) for y in (-20, 20) for z in (-12, 0)], float)
# Table 6-1 of the dissertation: steps, minutes that they take longer than the direct way, and files that are handed on.
CONVENTIONAL = (("CAD designer creates part", 0, ""), ("sends to tool path planner", 5, "model"), ("searches and selects a machine", 0, ""), ("generates tool paths", 0, ""),
                ("post-processes to M&G codes", 2, "M&G code"), ("sends M&G files to machine operator", 5, "M&G code"),
                ("operator loads M&G file on the machine", 5, "M&G code"), ("runs program", 0, ""))  # fmt: skip
DIRECT = ("open the STEP file", "search and select a machine", "make the tool paths", "load the machine that fits, set part frame and tools")


def frame_and_length():
    """From joints of the mill to tips in the part, by the tool table."""
    import session

    return np.array(session.MILL_ZERO) + [0, 0, session.LENGTH_MM]


def corner_error(fit, place_off):
    """How far the fit lays the part's corners from where they are."""
    turn = np.radians(place_off[3])
    truth = CORNERS @ np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]).T + place_off[:3]
    return np.linalg.norm(_moved(fit.placement, CORNERS) - truth, axis=1)


def _moved(placement, points):
    import FreeCAD

    return np.array([tuple(placement.multVec(FreeCAD.Vector(*map(float, point)))) for point in points])


def measuring_errors(off, truth_off):
    """Of each place: the deviation that was measured less the one of the part as it was cut."""
    return np.asarray(off) - np.asarray(truth_off)


def judge(user, inspected, truth, bounds):
    """Rows (what, value, bound, fine), and the figures with whether all are fine."""
    rows, line = [], {}

    def row(key, what, value, unit="", bound=None, form=".2f", fine=None):
        limit = bounds.get(key) if bound is None else bound
        fine = (limit is None or value <= limit) if fine is None else fine
        rows.append((what, f"{value:{form}} {unit}".strip() if isinstance(value, float) else f"{value} {unit}".strip(), "" if limit is None else f"{limit:g} {unit}".strip(), bool(fine)))
        line[key] = round(value, 4) if isinstance(value, float) else value

    found = user.found
    row("recognised", "Free-form faces, pockets, islands, holes found in the STEP file", [len(found.free_form), len(found.recesses), sum(one.islands for one in found.recesses), len(found.holes)],
        fine=[len(found.free_form), len(found.recesses), found.recesses[0].islands, len(found.holes)] == [1, 1, 1, 4])  # fmt: skip
    row("moves", "Moves that were sent and done", sum(len(program) for program in user.programs.values()))
    row("cycle_time_s", "Cycle time, by the dry run", sum(one.cycle_time_s for one in user.dry.values()), "s")
    row("gouge_um", "Free-form face, paths: cut into by", 1000 * max(0.0, -float(truth.on_face.min())), "µm", form=".3f")
    row("scallop_share", "Free-form face, paths: highest scallop of what was asked", float(truth.on_face.max()) / user.scallop_mm, form=".3f")
    free, datums = (truth.off[_chosen(truth, names)] for names in (found.free_form, {one.place.face for one in inspected.datums}))
    row("datums_off_um", "Part as cut off the model: flat datums, worst", 1000 * float(np.abs(datums).max()), "µm")
    row("face_deep_um", "  free-form face, deepest place that was measured", 1000 * max(0.0, -float(free.min())), "µm")
    row("face_high_um", "  free-form face, highest place, above the scallop asked", 1000 * max(0.0, float(free.max()) - user.scallop_mm), "µm")
    row("places", "Places measured", len(inspected.touched))
    row("before_rms_um", "Off the model as the part was taken to lie, rms", 1000 * inspected.before.rms, "µm")
    row("before_worst_um", "  worst", 1000 * abs(inspected.before.worst), "µm")
    row("after_rms_um", "Off the model where it was found to lie, rms", 1000 * inspected.after.rms, "µm")
    row("after_worst_um", "  worst (scallops, and the pocket is deeper)", 1000 * abs(inspected.after.worst), "µm")
    corners = corner_error(inspected.fit, truth.place_off)
    row("placement_error_um", "Corners of the part off where the fit lays them, worst", 1000 * float(corners.max()), "µm")
    stated = SURE * max(inspected.fit.uncertainty_at(corner) for corner in CORNERS)
    row("placement_stated_um", "  stated uncertainty there, three standard deviations", 1000 * stated, "µm", fine=float(corners.max()) <= stated)
    turn = abs(np.degrees(inspected.fit.turn[2]) - truth.place_off[3])
    row("turn_error_deg", "Turn about Z off", float(turn), "°", form=".4f")
    row("undo", "Model's placement corrected, undone in one step, and redone", "yes" if inspected.moved and inspected.undone else "no", fine=inspected.moved and inspected.undone)
    errors = 1000 * measuring_errors(inspected.again.off, truth.off)
    row("measuring_error_um", "Measured again in the corrected frame: off what was cut, worst place", float(np.abs(errors).max()), "µm")
    for name, old, new, sure, true in zip(inspected.parameters.names, inspected.parameters.nominal, inspected.parameters.values, inspected.parameters.uncertainty, (truth.pocket_depth, truth.hole_diameter)):
        row(f"{name}_error_um", f"{name}: {old:g} mm corrected to {new:.4f} ± {2 * sure:.4f} mm, off what was cut", 1000 * abs(new - true), "µm", bounds["parameter_error_um"])
    row("corrected_rms_um", "Off the corrected master model, rms; but for the free-form face", 1000 * inspected.corrected.of([*inspected.sized(), *(one.place.face for one in inspected.datums)]).rms, "µm")
    planning, rest = user.steps.seconds("make the tool paths"), sum(user.steps.seconds(name) for name in DIRECT if name != "make the tool paths")
    row("planning_s", "Direct way: paths planned in", planning, "s")
    row("rest_s", "  file, search, comparing, loading, set-up, in", rest, "s")
    row("send_to_motion_s", "  first move sent to first motion", user.first_motion - user.sent, "s")
    row("model_to_motion_s", "  all from the file to the first motion, dry run included", user.first_motion - user.began, "s")
    row("steps", "  steps of Table 6-1, against 8 of the conventional way", 4)
    ok = all(fine for *_, fine in rows)
    return rows, {"ok": ok, **line}


def _chosen(truth, names):
    return np.array([place.face in names for place in truth.places])


def print_table(rows, say):
    width = max(len(what) for what, *_ in rows)
    for what, value, bound, fine in rows:
        say(f"  {what:<{width}}  {value}{f'  (bound {bound})' if bound else ''}{'' if fine else '   <-- NOT FINE'}")

"""Faces of an object in the document become a program."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import Part as FreeCADPart

import rmac
from rmac_freecad.jobs.mover import Mover
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.program import Place, Program
from rmac_freecad.surfaces import fit
from rmac_freecad.surfaces.beginning import begin_program, check_tool
from rmac_freecad.surfaces.five import Leaning, lean_of
from rmac_freecad.surfaces.five import sweep as lean_sweep
from rmac_freecad.surfaces.links import Links
from rmac_freecad.surfaces.sweep import Swept, sweep

ABOVE_MM = 5.0  # of the part, where nothing else is said
OVER_MM = 0.5  # of the place where it plunges: from there on at its own feed


def read_faces(
    feature, names, mill, *, scallop_mm, feed_mm_min, rapid_mm_min, plunge_mm_min=None, tolerance_mm=0.005, along=0.0, steepest_deg=None,
    lead_deg=None, tilt_deg=None, axis=None, clearance_mm=None, tool=None, rpm=None,
):  # fmt: skip
    """A program that sweeps faces of an object, "Face3", in the document's own coordinates; and texts of what it leaves out. `along` is
    the direction of the passes in degrees from X, or "u" or "v" of each face. The tool's axis is along Z, unless `lead_deg` or
    `tilt_deg` lean it against the face's normal, or an `axis` is given that it keeps: that takes five axes, and `along` may be "level".
    With the `axis` "matched" the lead of a bull nose or flat end goes with the face's curvature, and is `lead_deg` at least.
    With `tool`, a number, and `rpm` it begins with them. Raises `JobRefused`."""
    _check_speeds({"rapid_mm_min": rapid_mm_min})
    swept = plan_faces(
        feature.Label, placed_shape(feature), names, mill, scallop_mm=scallop_mm, feed_mm_min=feed_mm_min, plunge_mm_min=plunge_mm_min,
        tolerance_mm=tolerance_mm, along=along, steepest_deg=steepest_deg, lead_deg=lead_deg, tilt_deg=tilt_deg, axis=axis,
        clearance_mm=clearance_mm, tool=tool, rpm=rpm,
    )  # fmt: skip
    return swept.program(feature.Label, rapid_mm_min), swept.left_out


def plan_faces(
    label, shape, names, mill, *, scallop_mm, feed_mm_min, plunge_mm_min=None, tolerance_mm=0.005, along=0.0, steepest_deg=None, lead_deg=None,
    tilt_deg=None, axis=None, clearance_mm=None, tool=None, rpm=None,
):  # fmt: skip
    """As `read_faces`, of a shape that nobody changes, before anybody knows the machine's rapids. Takes its time; touches no document."""
    feeds = {"feed_mm_min": feed_mm_min, "plunge_mm_min": feed_mm_min if plunge_mm_min is None else plunge_mm_min}
    _check_speeds({**feeds, **({} if rpm is None else {"rpm": rpm})})
    check_tool(tool)
    if isinstance(names, str) or not isinstance(names, Iterable):
        raise JobRefused(f"faces are given as {names!r}: give a list of names, as ['Face1']")
    targets = [_index(label, shape, name) for name in dict.fromkeys(names)]
    if not targets:
        raise JobRefused(f"no face of {label} was named; give names such as Face1")
    lean = lean_of(lead_deg, tilt_deg, axis)
    clear = _clear(shape.BoundBox.ZMax, clearance_mm, mill.radius_mm if lean else 0.0)
    if lean:
        swept = lean_sweep(shape, targets, mill, lean, scallop_mm=scallop_mm, tolerance_mm=tolerance_mm, along=along, steepest_deg=steepest_deg, clear_mm=clear)
        return LeaningSweep(swept, feeds, tool, rpm)
    gentle = {} if steepest_deg is None else {"steepest_deg": steepest_deg}
    _, drop, swept = sweep(shape, targets, mill, scallop_mm=scallop_mm, tolerance_mm=tolerance_mm, along=along, **gentle)
    return Sweeping(swept, Links(drop, mill), clear, feeds, tool, rpm)


def _clear(top, clearance_mm, beside_mm):
    """Height of the tip where it crosses; a leaning mill reaches so much below it."""
    clear = top + ABOVE_MM + beside_mm if clearance_mm is None else clearance_mm
    if not math.isfinite(clear) or clear < top + 2 * OVER_MM + beside_mm:
        below = f", and up to {beside_mm:g} mm of it are below its tip where it leans" if beside_mm else ""
        raise JobRefused(f"clearance_mm is {clear!r}: the part is as high as {top:g} mm, and the mill is to pass {2 * OVER_MM:g} mm above it{below}")
    return clear


@dataclass(frozen=True)
class Sweeping:
    swept: Swept
    links: Links
    clear: float
    feeds: dict
    tool: int | None
    rpm: float | None

    @property
    def left_out(self):
        return self.swept.left_out

    @property
    def told(self):
        """For people: how many passes, and what is left."""
        return _told(self.swept)

    def program(self, label, rapid_mm_min):
        _check_speeds({"rapid_mm_min": rapid_mm_min})
        writer = _Writer(label, self.links, self.clear, {**self.feeds, "rapid_mm_min": rapid_mm_min})
        writer.begin(self.tool, self.rpm)
        for number, one in enumerate(self.swept.passes, 1):
            writer.cut(number, one.stretches if number % 2 else _reversed(one.stretches))
        writer.end(self.rpm)
        return writer.program


@dataclass(frozen=True)
class LeaningSweep:
    swept: Leaning
    feeds: dict
    tool: int | None
    rpm: float | None

    @property
    def left_out(self):
        return self.swept.left_out

    @property
    def told(self):
        """As that of `Sweeping`; and how many passes a ball end would take, where the lead is matched."""
        balls = self.swept.ball_passes
        return _told(self.swept, "" if balls is None else f" instead of {balls} with a ball end of the same radius and scallop")

    def program(self, label, rapid_mm_min):
        _check_speeds({"rapid_mm_min": rapid_mm_min})
        return self.swept.program(label, {**self.feeds, "rapid_mm_min": rapid_mm_min}, self.tool, self.rpm)


def _told(swept, compared=""):
    passes = f"{len(swept.passes)} passes{compared}"
    return f"{passes}; left out: {'; '.join(swept.left_out)}." if swept.left_out else f"{passes}, and nothing is left out."


def _check_speeds(speeds):
    for name, value in speeds.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value) or value <= 0:
            raise JobRefused(f"{name} is {value!r}: give a number that is more than 0")


def placed_shape(feature):
    """As it stands in the document, whatever parts and bodies it is in."""
    shape = FreeCADPart.getShape(feature).copy()
    if shape.isNull() or not shape.Faces:
        raise JobRefused(f"{feature.Label} has no faces")
    shape.Placement = feature.getGlobalPlacement() * feature.Placement.inverse() * shape.Placement
    return shape


def _index(label, shape, name):
    number = name[4:] if isinstance(name, str) and name.startswith("Face") else ""
    if not number.isdigit() or not 1 <= int(number) <= len(shape.Faces):
        raise JobRefused(f"{label} has no face {name!r}; it has Face1 to Face{len(shape.Faces)}")
    return int(number) - 1


def _reversed(stretches):
    return [[(knots[0] + knots[-1] - knots[::-1], poles[::-1]) for knots, poles in curves[::-1]] for curves in stretches[::-1]]


class _Writer:
    def __init__(self, label, links, clear, feeds):
        self.program = Program()
        self._label, self._clear = label, clear
        self._feed, self._plunge = feeds["feed_mm_min"], feeds["plunge_mm_min"]
        self._mover = Mover(self.program, feeds["rapid_mm_min"])
        self._links = links
        self._at = None

    def begin(self, tool, rpm):
        begin_program(self.program, self._label, tool, rpm)

    def cut(self, number, stretches):
        for curves in stretches:
            self._go_to(curves[0][1][0], number)
            for knots, poles in curves:
                self._along(knots, poles, fit.DEGREE, Place(self._label, number, "pass"))

    def end(self, rpm):
        place = Place(self._label, 1, "end")
        self._mover.rapid({"Z": self._clear}, place)
        if rpm is not None:
            self.program.append(rmac.spindle(0), place)

    def _go_to(self, begin, number):
        place = Place(self._label, number, "link")
        poles = None if self._at is None else self._links.between(self._at, begin)
        if poles is None:
            self._over(begin, Place(self._label, number, "retract"))
        elif len(poles) == 2:
            self._mover.line(dict(zip("XYZ", begin.tolist())), self._feed, place)
        else:
            self._along([0, 0, 0, 0, 1, 1, 1, 1], poles, 3, place)

    def _over(self, begin, place):
        x, y, z = begin.tolist()
        if self._at is not None:
            self._mover.rapid({"Z": self._clear}, place)
        self._mover.rapid({"X": x, "Y": y, "Z": self._clear}, place)
        self._mover.rapid({"Z": min(z + OVER_MM, self._clear)}, place)
        self._mover.line({"Z": z}, self._plunge, place)

    def _along(self, knots, poles, degree, place):
        self._mover.follow(rmac.NurbsCurve(degree, knots, poles), self._feed, place)
        self._at = poles[-1]

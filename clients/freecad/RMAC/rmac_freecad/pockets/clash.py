"""What of the part the tool would cut above the outline of a pocket, which knows its own walls alone: overhangs, bridges, roofs, a floor that is higher."""

from dataclasses import dataclass

import numpy as np
import Part
from FreeCAD import Vector

from rmac_freecad.jobs.standing import below_top
from rmac_freecad.pockets.area import CHORD_MM, swath
from rmac_freecad.pockets.refusal import PocketRefused
from rmac_freecad.pockets.tracks import SideTrack

GOUGE_MM = 1e-3
ABOVE_MM = 1e-3  # of the face itself, whose walls begin there
GRID = 48  # places along each parameter of a bent face
SLICES = 8
MOST_POINTS = 400  # of an edge


@dataclass(frozen=True)
class Surroundings:
    """Of the face that is cleared: the solids that it belongs to, where they stand, and whether the part is higher anywhere."""

    shape: Part.Shape
    face: str
    is_floor: bool


def check_part(outline, levels, pocket):
    """Raises `PocketRefused` where the tool would cut into the part, or cross through it."""
    around = outline.around
    if around is None:
        return
    wrong = below_top("the part", pocket.safe_mm, around.shape.BoundBox.ZMax)
    if wrong:
        raise PocketRefused(wrong)
    bottom = pocket.top_mm - pocket.depth_mm
    if around.is_floor and bottom < outline.z - GOUGE_MM:
        deepest = f"a depth of {pocket.top_mm - outline.z:.4g} mm" if pocket.top_mm > outline.z else "a higher top"
        raise PocketRefused(
            f"it would be cut to Z {bottom:.4g}, {outline.z - bottom:.4g} mm into this floor of the part; give {deepest}, or draw what is deeper into the part", edge=around.face
        )
    _check_above(outline, levels, around)


def _check_above(outline, levels, around):
    loops = [loop for level in levels for loop in level]
    radius = levels[0][0].distance
    reach = radius - GOUGE_MM - (CHORD_MM if any(isinstance(track, SideTrack) for loop in loops for track in loop.tracks) else 0)
    low, high = outline.wall.box
    cleared = swath(loops)
    for number, face in enumerate(around.shape.Faces, 1):
        box = face.BoundBox
        if box.ZMax < outline.z + 2 * ABOVE_MM or box.XMin > high[0] or box.YMin > high[1] or box.XMax < low[0] or box.YMax < low[1]:
            continue
        points = _points(face, outline.z + ABOVE_MM, radius / 4)
        points = points[(points[:, 2] > outline.z + ABOVE_MM) & ((points[:, :2] > low) & (points[:, :2] < high)).all(1)]
        if not len(points):
            continue
        into = reach - cleared.nearest(points[:, :2])[1]
        if into.max() > 0:
            x, y, z = points[into.argmax()]
            raise PocketRefused(
                f"there, at Z {z:.4g}, the part is above what is cleared, and the tool would cut {into.max() + radius - reach:.4g} mm into it; "
                "clear what is open from above alone, by a sketch, or turn the part over",
                (x, y), f"Face{number}")  # fmt: skip
    for loop in loops:
        x, y = map(float, loop.tracks[0].at(0.0))
        upwards = Part.makeLine(Vector(x, y, outline.z + 10 * ABOVE_MM), Vector(x, y, around.shape.BoundBox.ZMax + 1))
        if around.shape.distToShape(upwards)[0] < GOUGE_MM:
            raise PocketRefused("the part covers it there from above, and the tool does not get in", (x, y), around.face)


def _points(face, low, apart):
    """Of its edges, of slices across it where it is flat, and all over it where it is bent."""
    found = [_along(edge, apart) for edge in face.Edges if not edge.Degenerated]
    if isinstance(face.Surface, Part.Plane):
        bottom, top = max(face.BoundBox.ZMin, low), face.BoundBox.ZMax
        if top - bottom > ABOVE_MM:
            heights = bottom + (top - bottom) * (np.arange(SLICES) + 0.5) / SLICES
            edges = [edge for z in heights for wire in face.slice(Vector(0, 0, 1), float(z)) for edge in wire.Edges]
            found += [_along(edge, apart) for edge in edges]
    else:
        a, b, c, d = face.ParameterRange
        places = [(u, v) for u in np.linspace(a, b, GRID).tolist() for v in np.linspace(c, d, GRID).tolist()]
        found.append([face.valueAt(u, v) for u, v in places if face.isPartOfDomain(u, v)])
    return np.array([tuple(point) for some in found for point in some]).reshape(-1, 3)


def _along(edge, apart):
    return edge.discretize(int(min(max(edge.Length / apart, 2), MOST_POINTS)) + 1)

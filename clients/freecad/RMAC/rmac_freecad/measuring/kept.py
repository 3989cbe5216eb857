"""What was measured, in the document and saved with it: points, their faces, and how far they are off."""

import datetime

import numpy as np
from FreeCAD import Vector

from rmac_freecad.measuring.measuring import Touched
from rmac_freecad.measuring.places import Place
from rmac_freecad.measuring.refusal import MeasuringRefused
from rmac_freecad.surfaces.machining import placed_shape

GROUP = "Measured"
READ_ONLY = 1  # FreeCAD's editor mode
SAME_MM = 1e-5
# Name, type, and what it is. Lists have one entry a place.
PROPERTIES = (
    ("Part", "App::PropertyLinkGlobal", "That was measured"),
    ("Face", "App::PropertyStringList", "On which the place is"),
    ("Nominal", "App::PropertyVectorList", "mm, the place on the model"),
    ("Normal", "App::PropertyVectorList", "Out of the material"),
    ("Point", "App::PropertyVectorList", "mm, where the surface was"),
    ("Deviation", "App::PropertyFloatList", "mm along the normal: more material is more"),
    ("Tip", "App::PropertyFloat", "mm, radius of the tip"),
    ("Machine", "App::PropertyString", "That measured it"),
    ("When", "App::PropertyString", ""),
    ("PartFrame", "App::PropertyFloatList", "In which it lay: x, y, z in mm, and w, x, y, z of its turn"),
    ("Stood", "App::PropertyFloatList", "The part as it was then, in figures"),
    ("Corrected", "App::PropertyString", "By it"),
)  # fmt: skip


class Measured:
    """Of FreeCAD's objects; all that it is are its properties."""

    def __init__(self, feature):
        feature.Proxy = self

    def execute(self, feature):
        """It stays what was measured, whatever becomes of the part."""

    def __getstate__(self):
        return None

    def __setstate__(self, state):
        return None


def is_measured(feature):
    return isinstance(getattr(feature, "Proxy", None), Measured)


def measured_in(document):
    return [] if document is None else [one for one in document.Objects if is_measured(one)]


def keep_measured(part, plan, touched, machine, part_frame, when=None):
    """In the part's document, in one step that can be undone."""
    document = part.Document
    document.openTransaction(f"Measured {part.Label}")
    kept = document.addObject("App::FeaturePython", "Measured")
    Measured(kept)
    for name, kind, what in PROPERTIES:
        kept.addProperty(kind, name, GROUP, what)
        kept.setEditorMode(name, READ_ONLY)
    when = when or datetime.datetime.now()
    kept.Label = f"{part.Label}, measured {when:%H:%M:%S}"
    kept.Part, kept.Tip, kept.Machine, kept.When = part, plan.tip_radius_mm, machine, when.isoformat(" ", "seconds")
    kept.Face = [one.place.face for one in touched]
    kept.Nominal, kept.Normal, kept.Point = ([*map(_vector, points)] for points in zip(*((one.place.point, one.place.normal, one.measured) for one in touched)))
    kept.Deviation = [one.off_mm for one in touched]
    kept.PartFrame = [*part_frame["p"], *part_frame["q"]]
    kept.Stood = _figures(plan.stood)
    kept.purgeTouched()
    document.commitTransaction()
    return kept


def touched_of(kept):
    """As `measure` gave it."""
    return [Touched(Place(face, tuple(point), tuple(normal)), tuple(measured)) for face, point, normal, measured in zip(kept.Face, kept.Nominal, kept.Normal, kept.Point)]


def part_frame_of(kept):
    return {"p": list(kept.PartFrame[:3]), "q": list(kept.PartFrame[3:])}


def part_of(kept):
    """The part and its shape, both as they were when they were measured; refused where they are not."""
    part = kept.Part
    if part is None:
        raise MeasuringRefused(f"the part of {kept.Label} is gone; undo that it was deleted, or measure the part that there is")
    shape = placed_shape(part)
    then, now = np.array(kept.Stood), np.array(_figures(shape))
    if then.shape != now.shape or not np.allclose(then[:2], now[:2], rtol=1e-7, atol=1e-6) or not np.allclose(then[2::4], now[2::4], rtol=1e-6, atol=1e-6):
        raise MeasuringRefused(f"{part.Label} was changed since it was measured: its faces are others; undo that, or measure it anew")
    if not np.allclose(then, now, rtol=0, atol=SAME_MM):
        raise MeasuringRefused(f"{part.Label} does not stand where it stood when it was measured: it was moved, or corrected already; undo that, or measure it anew")
    return part, shape


def _vector(point):
    return Vector(*map(float, point))


def _figures(shape):
    """Volume and area, and of each face its area and its middle: what tells a shape that was changed, and one that stands elsewhere."""
    return [shape.Volume, shape.Area, *(value for face in shape.Faces for value in (face.Area, *face.CenterOfMass))]

"""The object of a document that sweeps faces: it follows them when they change."""

from rmac_freecad.jobs.cut_object import CutObject, add_cut_object
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.jobs.standing import stand_of
from rmac_freecad.surfaces.five import MATCHED
from rmac_freecad.surfaces.machining import ABOVE_MM, placed_shape, plan_faces
from rmac_freecad.surfaces.mill import Mill

GROUP = "Sweep"
MILLS = ("ball end", "bull nose", "flat end")
ALONG = {"direction": None, "u of each face": "u", "v of each face": "v", "level": "level"}
THREE, FIVE, FITTED = AXES = ("along Z", "by lead and tilt", "matched to the face")
# Name, type, value before anybody gives one, and what it is. Lengths are mm, speeds mm/s whatever unit FreeCAD shows.
PROPERTIES = (
    ("Faces", "App::PropertyLinkSub", None, "Of one object"),
    ("Tool", "App::PropertyInteger", 1, "Its number in the machine's table"),
    ("Mill", "App::PropertyEnumeration", list(MILLS), "Its end"),
    ("Diameter", "App::PropertyLength", 5.0, "Of the mill"),
    ("Corner", "App::PropertyLength", 0.5, "Radius of a bull nose's corner"),
    ("Scallop", "App::PropertyDistance", 0.05, "At most so much stands between passes"),
    ("Tolerance", "App::PropertyDistance", 0.005, "At most so far above the lowest place of the mill"),
    ("Along", "App::PropertyEnumeration", list(ALONG), "Where passes go"),
    ("Direction", "App::PropertyAngle", 0.0, "Of the passes, from X"),
    ("Steepest", "App::PropertyAngle", 80.0, "Faces are cut where they are no steeper, with the axis along Z"),
    ("Axis", "App::PropertyEnumeration", list(AXES), "Of the mill; by lead and tilt takes a machine with five axes and a ball end, matched to the face one and a bull nose or flat end"),
    ("Lead", "App::PropertyAngle", 0.0, "Of the axis against the face's normal, to where the mill goes; where it is matched, the least of it, 3 degrees where it is 0"),
    ("Tilt", "App::PropertyAngle", 20.0, "Of the axis against the face's normal, to the left of that"),
    ("Safe", "App::PropertyDistance", ABOVE_MM, "Z where the tool crosses"),
    ("Feed", "App::PropertySpeed", 10.0, "Along passes"),
    ("FeedDown", "App::PropertySpeed", 100 / 60, "Straight down"),
    ("SpindleSpeed", "App::PropertyFloat", 800.0, "Turns a minute"),
)


class SweepFeature(CutObject):
    def check(self, feature):
        _mill_of(feature)

    def planning(self, feature):
        """What a thread may call, for the plan. The object is looked at now."""
        base, names = feature.Faces if feature.Faces else (None, ())
        if base is None:
            raise JobRefused("its faces are gone; make it anew")
        mill, settings, last = _mill_of(feature), _settings_of(feature), self.last
        given = tuple(names), mill, settings, stand_of(base)
        if last is not None and last[0] == given:
            return lambda: last[1]
        label, shape = base.Label, placed_shape(base)

        def plan():
            self.last = given, plan_faces(label, shape, names, mill, **settings)
            return self.last[1]

        return plan

    def told(self, plan):
        return plan.told


def is_sweep(feature):
    return isinstance(getattr(feature, "Proxy", None), SweepFeature)


def sweeps(document):
    return [] if document is None else [one for one in document.Objects if is_sweep(one)]


def sweep_of(document, base, names):
    """Refused, the document stays as it is. In one step that can be undone."""
    top = placed_shape(base).BoundBox.ZMax
    document.openTransaction("Sweep faces")
    feature = add_cut_object(document, "FaceSweep", SweepFeature, GROUP, PROPERTIES)
    feature.Label = f"Faces of {base.Label}"
    feature.Faces = (base, list(names))
    feature.Safe = top + ABOVE_MM
    document.commitTransaction()
    return feature


def _mill_of(feature):
    radius = feature.Diameter.Value / 2
    return Mill(radius, {"ball end": radius, "bull nose": feature.Corner.Value, "flat end": 0.0}[feature.Mill])


def _settings_of(feature):
    along = ALONG[feature.Along] or feature.Direction.Value
    leans = {
        THREE: {"steepest_deg": feature.Steepest.Value},
        FIVE: {"lead_deg": feature.Lead.Value, "tilt_deg": feature.Tilt.Value},
        FITTED: {"axis": MATCHED, "lead_deg": feature.Lead.Value or None},
    }[feature.Axis]
    return {"scallop_mm": feature.Scallop.Value, "tolerance_mm": feature.Tolerance.Value, "along": along, **leans, "clearance_mm": feature.Safe.Value,
            "feed_mm_min": round(feature.Feed.Value * 60, 9), "plunge_mm_min": round(feature.FeedDown.Value * 60, 9), "tool": feature.Tool, "rpm": feature.SpindleSpeed}  # fmt: skip

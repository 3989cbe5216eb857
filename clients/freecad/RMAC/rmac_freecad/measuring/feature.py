"""The object of a document that says where a part is to be measured: places on its faces, which it follows when they change."""

from dataclasses import dataclass

from rmac_freecad.jobs.cut_object import CutObject, add_cut_object
from rmac_freecad.measuring.measuring import SPEED_MM_S
from rmac_freecad.measuring.places import places_on
from rmac_freecad.measuring.refusal import MeasuringRefused
from rmac_freecad.surfaces.machining import placed_shape

GROUP = "Measure"
ABOVE_MM = 10.0
# Name, type, value before anybody gives one, and what it is. Lengths are mm, speeds mm/s whatever unit FreeCAD shows.
PROPERTIES = (
    ("Faces", "App::PropertyLinkSubGlobal", None, "Of one object"),
    ("Count", "App::PropertyInteger", 4, "Places on each face, at most"),
    ("Edge", "App::PropertyDistance", 2.0, "So far off the edges of the face, at least"),
    ("Tip", "App::PropertyDistance", 1.0, "Radius of the probe's tip"),
    ("Clearance", "App::PropertyDistance", 2.0, "So far off the face the probe begins, and goes back to"),
    ("Safe", "App::PropertyDistance", ABOVE_MM, "Z where the probe crosses"),
    ("Lowest", "App::PropertyDistance", 0.0, "The tip goes no lower: what the part stands on, and as far down as the stylus gets"),
    ("Speed", "App::PropertySpeed", SPEED_MM_S, "Between places; it touches as slowly as the machine says"),
)


@dataclass(frozen=True)
class Plan:
    places: tuple
    tip_radius_mm: float
    clearance_mm: float
    safe_mm: float
    speed_mm_s: float
    stood: object  # the shape as it stood

    @property
    def ways(self):
        """What `measure` takes beside the places."""
        return {"tip_radius_mm": self.tip_radius_mm, "clearance_mm": self.clearance_mm, "safe_mm": self.safe_mm, "speed_mm_s": self.speed_mm_s}


class MeasureFeature(CutObject):
    def check(self, feature):
        _faces(feature)

    def planning(self, feature):
        """What a thread may call, for the plan. The object is looked at now."""
        (base, names), given, last = _faces(feature), _given(feature), self.last
        if last is not None and last[0] == given:
            return lambda: last[1]
        _, _, count, edge, lowest, speed, ways = given
        shape, ways = placed_shape(base), dict(zip(("tip_radius_mm", "clearance_mm", "safe_mm"), ways))

        def plan():
            places = places_on(shape, names, count=count, edge_mm=edge, between_mm=(lowest, float("inf")), **ways)
            self.last = given, Plan(tuple(places), **ways, speed_mm_s=speed, stood=shape)
            return self.last[1]

        return plan

    def is_current(self, feature):
        """Whether what was planned last is for the part where it stands now: a group that is moved tells its parts nothing."""
        return self.last is not None and self.last[0] == _given(feature)

    def told(self, plan):
        """For people: how many there are."""
        faces = list(dict.fromkeys(place.face for place in plan.places))
        return f"{len(plan.places)} places on {len(faces)} face{'' if len(faces) == 1 else 's'}. Look at the way in the 3D view; nothing moves before Measure."


def is_measure(feature):
    return isinstance(getattr(feature, "Proxy", None), MeasureFeature)


def measure_of(document, base, names):
    """Of faces of one object. In one step that can be undone."""
    box = placed_shape(base).BoundBox
    document.openTransaction("Measure a part")
    feature = add_cut_object(document, "Measure", MeasureFeature, GROUP, PROPERTIES)
    feature.Label = f"Places on {base.Label}"
    feature.Faces = (base, list(names))
    feature.Safe, feature.Lowest = box.ZMax + ABOVE_MM, box.ZMin
    document.commitTransaction()
    return feature


def _faces(feature):
    base, names = feature.Faces if feature.Faces else (None, ())
    if base is None:
        raise MeasuringRefused("the part is gone on which there were to be places; select faces of a part, and open this anew")
    names = [name for name in names if name]
    there = len(base.Shape.Faces)
    gone = next((name for name in names if not name[4:].isdigit() or not 1 <= int(name[4:]) <= there), None)
    if gone is not None or not names:
        what = f"{gone} of {base.Label} is gone" if gone else f"the faces of {base.Label} are gone"
        raise MeasuringRefused(f"{what}: the part was changed since they were selected, and has Face1 to Face{there}; select faces anew")
    return base, names


def _given(feature):
    """All that a plan is made from, but for the shape, of which FreeCAD tells."""
    base, names = _faces(feature)
    ways = feature.Tip.Value, feature.Clearance.Value, feature.Safe.Value
    return tuple(base.getGlobalPlacement().Matrix.A), tuple(names), feature.Count, feature.Edge.Value, feature.Lowest.Value, feature.Speed.Value, ways

"""The object of a document that drills holes: it follows its part or sketch when that changes."""

from collections import Counter

import Part
from FreeCAD import Vector

from rmac_freecad.holes.chosen import Source, diameters_of, holes_of, room_of
from rmac_freecad.holes.drilling import ENDS, FLAT_DEG, Drilling, check
from rmac_freecad.holes.plan import plan_holes
from rmac_freecad.jobs.cut_object import CutObject, add_cut_object
from rmac_freecad.jobs.refusal import JobRefused

GROUP = "Drilling"
ABOVE_MM = 5.0
ONE_GO, PECKS, CHIPS = CYCLES = ("in one go", "in pecks", "breaking chips")
# Name, type, value before anybody gives one, and what it is. Lengths are mm, speeds mm/s whatever unit FreeCAD shows.
PROPERTIES = (
    ("Holes", "App::PropertyLinkSubList", None, "Faces or circular edges of holes, parts or sketches as a whole, circles and points"),
    ("Diameters", "App::PropertyFloatList", None, "Of the holes that are drilled, mm; 0 is points"),
    ("Tool", "App::PropertyInteger", 1, "Its number in the machine's table"),
    ("Diameter", "App::PropertyLength", 5.0, "Of the drill"),
    ("Point", "App::PropertyAngle", 118.0, "Angle of the drill's point; 180° is flat"),
    ("Reach", "App::PropertyDistance", 0.0, "How far the drill goes into a hole, as its flutes do; 0: not known, and not looked at"),
    ("End", "App::PropertyEnumeration", list(ENDS), "What gets to the end of the hole's wall. As drawn: the shoulder where the point has room below, else the tip"),
    ("Depth", "App::PropertyDistance", 0.0, "Below the top, of the tip or the shoulder; 0: as deep as the hole is. Circles and points need it"),
    ("Beyond", "App::PropertyDistance", 0.5, "So much deeper where the hole goes through"),
    ("Cycle", "App::PropertyEnumeration", list(CYCLES), "In pecks it comes out each time; breaking chips it stays in the hole"),
    ("Peck", "App::PropertyDistance", 3.0, "At most so deep at once"),
    ("Dwell", "App::PropertyFloat", 0.0, "Seconds at the bottom"),
    ("Above", "App::PropertyDistance", 1.0, "Above the hole: down to there as quick as may be, and from there on at the feed"),
    ("Safe", "App::PropertyDistance", ABOVE_MM, "Z where the tool crosses; over the part where that is in the way"),
    ("Feed", "App::PropertySpeed", 100 / 60, "Down"),
    ("SpindleSpeed", "App::PropertyFloat", 800.0, "Turns a minute"),
    ("Predrill", "App::PropertyBool", False, "Drills holes that are wider than the drill, too"),
)


class DrillFeature(CutObject):
    _found = None  # sources and their holes, which settings do not change

    def check(self, feature):
        sources_of(_chosen(feature))
        check(settings_of(feature))

    def planning(self, feature):
        """What a thread may call, for the plan. The object is looked at now."""
        sources, settings, diameters, last = sources_of(_chosen(feature)), settings_of(feature), tuple(feature.Diameters), self.last
        check(settings)
        known = self._found
        if known is not None and (len(known[0]) != len(sources) or not all(a.is_same(b) for a, b in zip(known[0], sources))):
            known = None
        own = () if known else [one.copied() for one in sources]
        if last is not None and known is not None and last[0] == (settings, diameters):
            return lambda: last[1]

        def plan():
            holes, room = known[1:] if known else (holes_of(own), room_of(own))
            self._found = sources, holes, room
            self.last = (settings, diameters), plan_holes(holes, settings, room, diameters)
            return self.last[1]

        return plan

    def know(self, sources, holes):
        """What was found already."""
        if holes is not None:
            self._found = sources, holes, room_of(sources)

    def told(self, plan):
        return plan.told

    def __setstate__(self, state):
        super().__setstate__(state)
        self._found = None


def is_drilling(feature):
    return isinstance(getattr(feature, "Proxy", None), DrillFeature)


def drillings(document):
    return [] if document is None else [one for one in document.Objects if is_drilling(one)]


def drilling_of(document, chosen):
    """`chosen`: pairs of an object and names of its faces, edges and vertices, or none for all of it. Refused, the document stays as it is. In
    one step that can be undone. It drills what most holes are as wide as."""
    sources = sources_of(chosen)
    most, found = _commonest(sources)
    document.openTransaction("Drill holes")
    feature = add_cut_object(document, "Drilling", DrillFeature, GROUP, PROPERTIES)
    feature.Proxy.know(sources, found)
    feature.Label = f"Holes of {chosen[0][0].Label}"
    feature.Holes = [(one, tuple(names) or ("",)) for one, names in chosen]
    feature.Diameters = [most]
    feature.Diameter = most or 5.0
    feature.Safe = max(shape.BoundBox.ZMax for one in sources for shape in (one.shape, one.around) if shape is not None) + ABOVE_MM
    if not any(one.shape.Solids for one in sources):
        feature.Depth = 1.0
    document.commitTransaction()
    return feature


def _commonest(sources):
    """The diameter, and the holes: None of parts as a whole, which take their time."""
    if all(one.shape.Solids and not one.names for one in sources):
        diameters, found = [one for source in sources for one in diameters_of(source)], None
    else:
        found = holes_of(sources)
        diameters = [hole.diameter_mm for hole in found if not hole.obstacle] or [hole.diameter_mm for hole in found]
    if not diameters:
        raise JobRefused(f"{sources[0].label} has no hole whose wall is a cylinder")
    return Counter(round(one, 6) for one in diameters).most_common(1)[0][0], found


def sources_of(chosen):
    if not chosen:
        raise JobRefused("its holes are gone; make it anew")
    return [Source(one.Label, _placed(one), tuple(name for name in names if name), _around(one), _points(one)) for one, names in chosen]


def settings_of(feature):
    peck = 0.0 if feature.Cycle == ONE_GO else feature.Peck.Value
    if feature.Cycle == PECKS and not peck > 0:
        raise JobRefused(f"a peck of {peck:g} mm is none; give more than 0")
    return Drilling(feature.Tool, feature.Diameter.Value, round(feature.Feed.Value * 60, 9), feature.SpindleSpeed, feature.Safe.Value, peck, feature.Beyond.Value,
                    feature.Cycle == CHIPS, feature.Dwell, min(feature.Point.Value, FLAT_DEG), feature.End, feature.Depth.Value, feature.Above.Value,
                    feature.Reach.Value, feature.Predrill)  # fmt: skip


def _chosen(feature):
    return [(one, names) for one, names in feature.Holes or ()]


def _placed(one):
    """As it stands in the document, whatever parts and bodies it is in; sharing what is compared by."""
    shape = Part.getShape(one)
    if shape.isNull():
        raise JobRefused(f"{one.Label} has no shape; select parts with holes, or sketches")
    if hasattr(one, "getGlobalPlacement"):
        shape.Placement = one.getGlobalPlacement() * one.Placement.inverse() * shape.Placement
    elif (group := one.getParentGeoFeatureGroup()) is not None:  # a link has none of its own
        shape.Placement = group.getGlobalPlacement() * shape.Placement
    return shape


def _around(one):
    """The body that a sketch is in, which may be in the way."""
    body = one.getParentGeoFeatureGroup() if not Part.getShape(one).Solids else None
    shape = None if body is None or not body.isDerivedFrom("PartDesign::Body") or Part.getShape(body).isNull() else _placed(body)
    return shape if shape is not None and shape.Solids else None


def _points(one):
    """Of a sketch, where FreeCAD has each of them as one of construction."""
    if not one.isDerivedFrom("Sketcher::SketchObject"):
        return ()
    place = one.getGlobalPlacement()
    return tuple(tuple(place.multVec(Vector(part.X, part.Y, part.Z))) for part in one.Geometry if isinstance(part, Part.Point))

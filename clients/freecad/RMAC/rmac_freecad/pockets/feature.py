"""The object of a document that clears a pocket: it follows its face or sketch when that changes."""

from rmac_freecad.jobs.cut_object import CutObject, add_cut_object
from rmac_freecad.jobs.standing import below_top, stand_of, top_around
from rmac_freecad.pockets.outline import outline_of
from rmac_freecad.pockets.pocket import ENTRIES, ORDERS, Pocket, check, plan_pocket
from rmac_freecad.pockets.refusal import PocketRefused

GROUP = "Pocket"
ABOVE_MM = 5.0
# Name, type, value before anybody gives one, and what it is. Lengths are mm, speeds mm/s whatever unit FreeCAD shows.
PROPERTIES = (
    ("Base", "App::PropertyLinkSub", None, "A level face, whose inner wires are islands, or a closed sketch"),
    ("Tool", "App::PropertyInteger", 1, "Its number in the machine's table"),
    ("Diameter", "App::PropertyLength", 5.0, "Of the tool"),
    ("Top", "App::PropertyDistance", 0.0, "Z of the material's surface"),
    ("Depth", "App::PropertyDistance", 1.0, "Below the top"),
    ("StepDown", "App::PropertyDistance", 1.0, "At most so deep a level"),
    ("StepOver", "App::PropertyDistance", 2.0, "From loop to loop; more than half the diameter leaves something, for which loops are added"),
    ("Safe", "App::PropertyDistance", ABOVE_MM, "Z where the tool crosses"),
    ("Feed", "App::PropertySpeed", 10.0, "Along loops"),
    ("FeedDown", "App::PropertySpeed", 100 / 60, "Down slopes"),
    ("SpindleSpeed", "App::PropertyFloat", 800.0, "Turns a minute"),
    ("Entry", "App::PropertyEnumeration", list(ENTRIES), "Down by a helix where it has room, or by a ramp along the first loop"),
    ("Ramp", "App::PropertyAngle", 3.0, "So steep"),
    ("Order", "App::PropertyEnumeration", list(ORDERS), "Of the loops"),
    ("Climb", "App::PropertyBool", True, "Walls are to the right of the tool"),
)


class PocketFeature(CutObject):
    def check(self, feature):
        outline_in(feature)
        check(settings_of(feature))

    def planning(self, feature):
        """What a thread may call, for the plan. The object is looked at now."""
        settings, last = settings_of(feature), self.last
        outline = outline_in(feature)
        base = feature.Base[0]
        wrong = below_top(base.Label, settings.safe_mm, top_around(base))
        if wrong:
            raise PocketRefused(wrong)
        given = settings, stand_of(base)
        if last is not None and last[0] == given:
            return lambda: last[1]

        def plan():
            self.last = given, plan_pocket(outline, settings)
            return self.last[1]

        return plan

    def told(self, plan):
        """For people: what is left."""
        text = f"The pocket has {plan.outline.wall.area():.4g} mm²"
        if not plan.unreached and not plan.missed:
            return f"{text}, and the tool gets everywhere."
        left = [f"the tool does not get into {_spots(plan.unreached)}"] if plan.unreached else []
        return f"{text}; {'; '.join([*left, *([f'loops leave {_spots(plan.missed)}'] if plan.missed else [])])}."


def _spots(spots):
    """The largest ones with their places."""
    told = ", ".join(f"{spot.area_mm2:.2g} mm² at X {spot.place[0]:.4g} Y {spot.place[1]:.4g}" for spot in spots[:4])
    return f"{sum(spot.area_mm2 for spot in spots):.3g} mm² of it: {told}{f', and {len(spots) - 4} more' if len(spots) > 4 else ''}"


def is_pocket(feature):
    return isinstance(getattr(feature, "Proxy", None), PocketFeature)


def pockets(document):
    return [] if document is None else [one for one in document.Objects if is_pocket(one)]


def pocket_of(document, base, face=""):
    """`base`: an object, and of it the name of a face, or a sketch as a whole. Refused, the document stays as it is. In one step that can be
    undone."""
    outline = outline_of(base, face)
    document.openTransaction("Clear a pocket")
    feature = add_cut_object(document, "FacePocket", PocketFeature, GROUP, PROPERTIES)
    feature.Label = f"Pocket of {base.Label}"
    feature.Base = (base, [face] if face else [""])
    top = top_above(base, outline.z) if face else outline.z
    feature.Top, feature.Depth, feature.Safe = top, top - outline.z or 1.0, max(top, top_around(base)) + ABOVE_MM
    document.commitTransaction()
    return feature


def top_above(base, z):
    """A pocket that is there already is as deep as its floor is below the part's top; a top face itself has to be told how deep."""
    shape = base.Shape.copy()
    shape.Placement = base.getGlobalPlacement()
    top = shape.BoundBox.ZMax
    return top if top > z + 1e-6 else z


def outline_in(feature):
    base, names = feature.Base if feature.Base else (None, ())
    if base is None:
        raise PocketRefused("its face or sketch is gone; make it anew")
    return outline_of(base, names[0] if names else "")


def settings_of(feature):
    return Pocket(feature.Tool, feature.Diameter.Value / 2, feature.Top.Value, feature.Depth.Value, feature.StepDown.Value, feature.StepOver.Value,
                  feature.Safe.Value, round(feature.Feed.Value * 60, 9), round(feature.FeedDown.Value * 60, 9), feature.SpindleSpeed, feature.Entry,
                  feature.Ramp.Value, feature.Order, feature.Climb)  # fmt: skip

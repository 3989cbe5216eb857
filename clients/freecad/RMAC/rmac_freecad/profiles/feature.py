"""The object of a document that cuts along edges or a sketch: it follows them when they change."""

from rmac_freecad.jobs.cut_object import CutObject, add_cut_object
from rmac_freecad.jobs.standing import below_top, top_around
from rmac_freecad.profiles.contour import contour_of, edges_of
from rmac_freecad.profiles.profile import SIDES, Profile, read_profile
from rmac_freecad.profiles.refusal import ProfileRefused

GROUP = "Profile"
ABOVE_MM = 5.0
# Name, type, value before anybody gives one, and what it is. Lengths are mm, speeds mm/s whatever unit FreeCAD shows.
PROPERTIES = (
    ("Edges", "App::PropertyLinkSubList", None, "Edges, or a sketch as a whole: one contour"),
    ("Side", "App::PropertyEnumeration", list(SIDES), "Of the contour as it goes: closed ones go counter-clockwise"),
    ("Turned", "App::PropertyBool", False, "The other way round"),
    ("Tool", "App::PropertyInteger", 1, "Its number in the machine's table"),
    ("Diameter", "App::PropertyLength", 5.0, "Of the tool"),
    ("Top", "App::PropertyDistance", 0.0, "Z of the material's surface"),
    ("Bottom", "App::PropertyDistance", -1.0, "Z of the last pass"),
    ("Step", "App::PropertyLength", 1.0, "At most so deep a pass"),
    ("Safe", "App::PropertyDistance", ABOVE_MM, "Z where the tool crosses"),
    ("Feed", "App::PropertySpeed", 10.0, "Along the contour"),
    ("FeedDown", "App::PropertySpeed", 100 / 60, "Straight down, and along ramps"),
    ("SpindleSpeed", "App::PropertyFloat", 800.0, "Turns a minute"),
    ("Ramp", "App::PropertyAngle", 0.0, "At most so steep down along the contour; 0 is straight down"),
    ("Lead", "App::PropertyLength", 0.0, "Radius of quarter circles in and out, beside a contour; 0 is none"),
)


class EdgeProfile(CutObject):
    def check(self, feature):
        program_of(feature, 1.0)


def is_profile(feature):
    return isinstance(getattr(feature, "Proxy", None), EdgeProfile)


def profiles(document):
    return [] if document is None else [one for one in document.Objects if is_profile(one)]


def profile_of(document, chosen):
    """`chosen`: pairs of an object and names of its edges, or none for all of them. Refused, the document stays as it is. In one step that
    can be undone."""
    contour = contour_of(_edges(chosen))
    document.openTransaction("Cut along edges")
    feature = add_cut_object(document, "EdgeProfile", EdgeProfile, GROUP, PROPERTIES)
    feature.Label = f"Along {chosen[0][0].Label}"
    feature.Edges = [(one, tuple(names) or ("",)) for one, names in chosen]
    feature.Top, feature.Bottom, feature.Safe = contour.z, contour.z - 1, max(contour.z, *(top_around(one) for one, _ in chosen)) + ABOVE_MM
    document.commitTransaction()
    return feature


def settings_of(feature):
    return Profile(feature.Tool, feature.Diameter.Value, feature.Side, feature.Top.Value, feature.Bottom.Value, feature.Step.Value, feature.Safe.Value,
                   round(feature.Feed.Value * 60, 9), round(feature.FeedDown.Value * 60, 9), feature.SpindleSpeed, feature.Ramp.Value, feature.Turned,
                   feature.Lead.Value)  # fmt: skip


def program_of(feature, rapid_mm_min):
    """As `jobs.read_job` does of a job."""
    for one, _ in feature.Edges:
        wrong = below_top(one.Label, feature.Safe.Value, top_around(one))
        if wrong:
            raise ProfileRefused(wrong)
    return read_profile(feature.Label, _edges(feature.Edges), settings_of(feature), rapid_mm_min=rapid_mm_min)


def _edges(chosen):
    several = len(chosen) > 1
    return [
        (f"{one.Label}.{name}" if several else name, edge) for one, names in chosen for name, edge in edges_of(one, [name for name in names if name])
    ]

"""A contour cut along in passes, as a program."""

import math
from dataclasses import dataclass

import rmac
from rmac_freecad.profiles.contour import contour_of
from rmac_freecad.profiles.leads import with_leads
from rmac_freecad.profiles.offset import beside
from rmac_freecad.profiles.refusal import ProfileRefused
from rmac_freecad.program import Program
from rmac_freecad.program.tool_number import is_tool_number

SIDES = ("on", "left", "right", "inside", "outside")
MOST_PASSES = 10_000
NUMBERS = (
    ("tool's diameter", "diameter_mm"), ("top", "top_mm"), ("bottom", "bottom_mm"), ("step", "step_mm"), ("height to cross at", "safe_mm"), ("feed", "feed_mm_min"),
    ("feed down", "plunge_mm_min"), ("spindle speed", "spindle_rpm"), ("ramp", "ramp_deg"), ("lead", "lead_mm"),
)  # fmt: skip


@dataclass(frozen=True)
class Profile:
    """Depths are Z, in the document's coordinates."""

    tool: int
    diameter_mm: float
    side: str  # one of SIDES
    top_mm: float
    bottom_mm: float
    step_mm: float  # at most so deep a pass
    safe_mm: float  # where the tool crosses
    feed_mm_min: float
    plunge_mm_min: float
    spindle_rpm: float
    ramp_deg: float = 0.0  # at most so steep along the contour; 0: straight down
    turned: bool = False  # the other way round
    lead_mm: float = 0.0  # radius of quarter circles in and out beside a contour; 0: none


@dataclass(frozen=True)
class EdgePlace:
    label: str
    edge: str
    z_mm: float  # where it ends

    def __str__(self):
        return f"{self.label}, {self.edge}, Z {self.z_mm:.4g}"


def read_profile(label, edges, profile, *, rapid_mm_min):
    """`edges` as of `contour_of`. Raises `ProfileRefused`."""
    _check(profile)
    contour = contour_of(edges)
    if profile.turned:
        contour = contour.turned()
    distance = _distance(profile, contour)
    way = beside(contour, distance) if distance else contour
    if profile.lead_mm:
        way = with_leads(contour, way, distance, profile.lead_mm)
    return _Passes(label, way, profile, rapid_mm_min).program


def _check(profile):
    if profile.side not in SIDES:
        raise ProfileRefused(f"the side is {profile.side}; it is one of {', '.join(SIDES)}")
    for what, name in NUMBERS:
        value = getattr(profile, name)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise ProfileRefused(f"the {what} ({name}) is {'not given' if value is None else repr(value)}; give a number")
    for what, value in (("step", profile.step_mm), ("feed", profile.feed_mm_min), ("feed down", profile.plunge_mm_min), ("spindle speed", profile.spindle_rpm)):
        if not value > 0:
            raise ProfileRefused(f"the {what} is {value:g}; it is more than 0")
    if not is_tool_number(profile.tool):
        raise ProfileRefused(f"the tool's number is {profile.tool!r}; it is 1 or more")
    if profile.side != "on" and not profile.diameter_mm > 0:
        raise ProfileRefused("the tool's diameter is 0; beside a contour it is more")
    if not profile.bottom_mm < profile.top_mm < profile.safe_mm:
        raise ProfileRefused(f"the bottom, Z {profile.bottom_mm:g}, is below the top, Z {profile.top_mm:g}, and that below the height to cross at, Z {profile.safe_mm:g}")
    if not 0 <= profile.ramp_deg < 90:
        raise ProfileRefused(f"the ramp is {profile.ramp_deg:g}° steep; it is 0 to 90°, and 0 is straight down")
    if (profile.top_mm - profile.bottom_mm) / profile.step_mm > MOST_PASSES:
        raise ProfileRefused(f"more than {MOST_PASSES} passes of {profile.step_mm:g} mm would be needed; give a larger step")
    if not 0 <= profile.lead_mm:
        raise ProfileRefused(f"the lead is {profile.lead_mm:g} mm; it is the radius of a quarter circle, or 0 for none")
    if profile.lead_mm and (profile.side == "on" or profile.ramp_deg):
        raise ProfileRefused("a lead is for ways beside a contour that go straight down; have no ramp, and another side than on, or no lead")


def _distance(profile, contour):
    """To the left of the contour as it goes."""
    if profile.side == "on":
        return 0.0
    radius = profile.diameter_mm / 2
    if profile.side in ("left", "right"):
        return radius if profile.side == "left" else -radius
    if not contour.closed:
        raise ProfileRefused(f"an open contour has no {profile.side}; the side is on, left or right of it")
    return radius if (profile.side == "inside") != profile.turned else -radius


class _Passes:
    def __init__(self, label, way, profile, rapid_mm_min):
        self.program = Program()
        self._label, self._way, self._profile, self._rapid = label, way, profile, rapid_mm_min
        self._at = None
        self._feed = None
        self._first = EdgePlace(label, way.pieces[0].name, profile.top_mm)
        self._begin()
        (self._ramp if profile.ramp_deg else self._plunge)(self._levels())
        self._up()
        self.program.append(rmac.spindle(0), self._first)

    def _levels(self):
        top, bottom = self._profile.top_mm, self._profile.bottom_mm
        count = math.ceil((top - bottom) / self._profile.step_mm - 1e-9)
        return [top + (bottom - top) * number / count for number in range(1, count + 1)]

    def _begin(self):
        self.program.append(rmac.tool_change(self._profile.tool), self._first)
        self.program.append(rmac.spindle(self._profile.spindle_rpm), self._first)
        self._cross()

    def _cross(self):
        self._at = (*self._way.pieces[0].start, self._profile.safe_mm)
        self._set_feed(self._rapid)
        self.program.append(rmac.MoveTo(self._at), self._first)

    def _up(self):
        self._at = (*self._at[:2], self._profile.safe_mm)
        self._set_feed(self._rapid)
        self.program.append(rmac.MoveTo(self._at), self._first)

    def _down(self, z):
        """At the feed down, straight."""
        end = (*self._at[:2], z)
        self._set_feed(self._profile.plunge_mm_min)
        self.program.append(rmac.Line(self._at, end), self._first)
        self._at = end

    def _plunge(self, levels):
        for number, z in enumerate(levels):
            if number and not self._way.closed:
                self._up()
                self._cross()
            self._down(z)
            self._along(self._way, z, self._profile.feed_mm_min)

    def _ramp(self, levels):
        """Down once along the contour for each level; then flat: once around, or back to where it began."""
        steepest = math.degrees(math.atan2(self._profile.top_mm - levels[0], self._way.length))
        if steepest > self._profile.ramp_deg:
            raise ProfileRefused(
                f"each pass goes down by {self._profile.top_mm - levels[0]:.4g} mm along {self._way.length:.4g} mm of contour, which is {steepest:.3g}° steep; "
                f"have a smaller step, or a ramp that may be steeper than {self._profile.ramp_deg:g}°"
            )
        self._down(self._profile.top_mm)
        for z in levels:
            self._along(self._way, z, self._profile.plunge_mm_min)
            if not self._way.closed:
                self._along(self._way.turned(), z, self._profile.feed_mm_min)
        if self._way.closed:
            self._along(self._way, levels[-1], self._profile.feed_mm_min)

    def _along(self, way, z, feed):
        """From where the tool is, evenly to that depth."""
        self._set_feed(feed)
        begin_z, gone = self._at[2], 0.0
        for number, piece in enumerate(way.pieces, 1):
            gone += piece.length
            last = number == len(way.pieces)
            end_z = z if last else begin_z + (z - begin_z) * gone / way.length
            end = (*(way.pieces[0].start if last and way.closed else piece.end), end_z)
            self.program.append(piece.move(self._at, end), EdgePlace(self._label, piece.name, end_z))
            self._at = end

    def _set_feed(self, feed):
        if feed != self._feed:
            self.program.append(rmac.calls.RMAC_CAM.SetFeedrate(feed), self._first)
            self._feed = feed

"""Profiles, pockets and sweeps: what each is made of, and its fields."""

import FreeCADGui

from rmac_freecad.pockets import PocketRefused, is_pocket, pocket_of
from rmac_freecad.pockets import feature as pocket_feature
from rmac_freecad.profiles import is_profile, profile_of
from rmac_freecad.profiles import feature as profile_feature
from rmac_freecad.surfaces import feature as sweep_feature
from rmac_freecad.surfaces import is_sweep, sweep_of
from rmac_freecad.window.dialog import OnlyOne
from rmac_freecad.window.operations.chosen_faces import chosen_faces
from rmac_freecad.window.operations.operation_dialog import OperationDialog
from rmac_freecad.window.operations.planned_view import PocketView, SweepView
from rmac_freecad.window.profiles.command import chosen_edges
from rmac_freecad.window.profiles.profile_view import ProfileView
from rmac_freecad.window.session import session

TOOL = (("Tool", "Tool"), ("Diameter", "Diameter"))
SPEEDS = (("Feed", "Feed"), ("FeedDown", "Feed down"), ("SpindleSpeed", "Spindle"))
POCKET = (*TOOL, ("Top", "Top"), ("Depth", "Depth"), ("StepDown", "Step-down"), ("StepOver", "Step-over"), ("Safe", "Cross at"), *SPEEDS,
          ("Entry", "Entry"), ("Ramp", "Angle of entry"), ("Order", "Order"), ("Climb", "Climb"))  # fmt: skip
SWEEP = (*TOOL, ("Mill", "Mill"), ("Corner", "Corner"), ("Scallop", "Scallop"), ("Tolerance", "Tolerance"), ("Safe", "Cross at"), *SPEEDS,
         ("Along", "Passes along"), ("Direction", "Direction"), ("Steepest", "Steepest"), ("Axis", "Axis"), ("Lead", "Lead"), ("Tilt", "Tilt"))  # fmt: skip
PROFILE = (*TOOL, ("Side", "Side"), ("Turned", "Turned"), ("Top", "Top"), ("Bottom", "Bottom"), ("Step", "Step-down"), ("Safe", "Cross at"), *SPEEDS,
           ("Ramp", "Ramp"), ("Lead", "Lead"))  # fmt: skip


class PocketDialog(OperationDialog):
    def __init__(self, here):
        super().__init__(here, "Clear a pocket", pocket_feature.PROPERTIES, POCKET, _pocket, is_pocket, PocketView)


class SweepDialog(OperationDialog):
    def __init__(self, here):
        super().__init__(here, "Sweep faces", sweep_feature.PROPERTIES, SWEEP, _sweep, is_sweep, SweepView)


class ProfileDialog(OperationDialog):
    def __init__(self, here):
        super().__init__(here, "Cut along edges", profile_feature.PROPERTIES, PROFILE, _profile, is_profile, ProfileView)


def _pocket(document):
    chosen = FreeCADGui.Selection.getSelectionEx()
    if len(chosen) != 1:
        raise PocketRefused("select one face, or one closed sketch" if chosen else "nothing is selected; select a level face, or a closed sketch")
    names = [name for name in chosen[0].SubElementNames if name]
    if len(names) > 1 or (names and not names[0].startswith("Face")):
        raise PocketRefused(f"{chosen[0].Object.Label}.{names[0]} is no single face; select one face, or a closed sketch")
    if not names and not chosen[0].Object.isDerivedFrom("Sketcher::SketchObject"):
        raise PocketRefused(f"{chosen[0].Object.Label} is no sketch; select a face of it")
    return pocket_of(document, chosen[0].Object, names[0] if names else "")


def _sweep(document):
    return sweep_of(document, *chosen_faces())


def _profile(document):
    return profile_of(document, chosen_edges())


show_pocket, show_sweep, show_profile = OnlyOne(PocketDialog), OnlyOne(SweepDialog), OnlyOne(ProfileDialog)


def show_for(feature):
    """To change its values."""
    FreeCADGui.Selection.clearSelection()
    FreeCADGui.Selection.addSelection(feature)
    (show_pocket if is_pocket(feature) else show_sweep if is_sweep(feature) else show_profile)(session())

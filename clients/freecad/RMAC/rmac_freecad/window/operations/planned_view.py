"""A pocket, or swept faces, in the tree and the 3D view."""

from rmac_freecad.path import strokes_of
from rmac_freecad.window.object_view import ObjectView


class PlannedView(ObjectView):
    def reading(self, feature, rmac):
        """It is executed whenever something changes, and asks for this itself."""
        plan, label = feature.Proxy.planning(feature), feature.Label
        return lambda: strokes_of(plan().program(label, 1.0))

    def doubleClicked(self, view):
        from rmac_freecad.window.operations.operations import show_for

        show_for(view.Object)
        return True


class PocketView(PlannedView):
    PICTURE = "pocket"


class SweepView(PlannedView):
    PICTURE = "sweep"

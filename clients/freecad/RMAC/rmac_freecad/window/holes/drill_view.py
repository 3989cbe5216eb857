"""Drilled holes in the tree and the 3D view."""

from rmac_freecad.window.operations.planned_view import PlannedView


class DrillView(PlannedView):
    PICTURE = "drill"

    def doubleClicked(self, view):
        from rmac_freecad.window.holes.drill_dialog import show_for

        show_for(view.Object)
        return True

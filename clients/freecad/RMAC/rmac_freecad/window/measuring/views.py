"""Where a part is to be measured, and where it was, in the tree and the 3D view."""

from rmac_freecad.measuring.kept import touched_of
from rmac_freecad.measuring.strokes import strokes_of_places, strokes_of_touched
from rmac_freecad.window.object_view import ObjectView
from rmac_freecad.window.operations.planned_view import PlannedView
from rmac_freecad.window.session import session


class PlacesView(PlannedView):
    PICTURE = "measure"

    def reading(self, feature, rmac):
        plan = feature.Proxy.planning(feature)

        def read():
            found = plan()
            return strokes_of_places(found.places, found.tip_radius_mm, found.clearance_mm, found.safe_mm)

        return read

    def doubleClicked(self, view):
        from rmac_freecad.window.measuring.measure_dialog import show_for

        show_for(view.Object)
        return True


class MeasuredView(ObjectView):
    """As it was done; it is compared by a double click."""

    PICTURE = "measured"

    def reading(self, feature, rmac):
        touched, tip = touched_of(feature), feature.Tip
        return lambda: strokes_of_touched(touched, tip)

    def _show(self, strokes):
        super()._show(strokes)
        self.path.show_done(len(strokes))

    def doubleClicked(self, view):
        from rmac_freecad.window.measuring.compare_dialog import show_for

        show_for(view.Object, session())
        return True

"""A profile of edges in the tree and the 3D view."""

from rmac_freecad.path import strokes_of
from rmac_freecad.profiles import program_of
from rmac_freecad.window.object_view import ObjectView


class ProfileView(ObjectView):
    PICTURE = "profile"

    def reading(self, feature, rmac):
        """The document is looked at now. It is executed whenever something changes, and asks for this itself."""
        program = program_of(feature, 1.0)
        return lambda: strokes_of(program)

    def doubleClicked(self, view):
        from rmac_freecad.window.operations.operations import show_for

        show_for(view.Object)
        return True

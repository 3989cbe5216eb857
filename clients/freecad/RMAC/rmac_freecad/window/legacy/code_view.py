"""A file of another control in the tree and the 3D view."""

from rmac_freecad.legacy import reading
from rmac_freecad.window.object_view import ObjectView


class CodeView(ObjectView):
    WATCHED = frozenset({"Source", "FileName", "Language", "Unit", "Rapid", "Approach", "AssumeG43", "BlockDelete", "Further"})
    PICTURE = "legacy"

    def reading(self, feature, rmac):
        read = reading(feature, rmac=rmac, unchanged=False)
        return lambda: read().strokes

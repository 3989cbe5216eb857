"""A program in the 3D view: coloured by what was cut, or by what limited it."""

from pivy import coin

from rmac_freecad.path import DONE, LATER, colour_of_limit

WIDTH_PIXELS = 3


class PathView:
    def __init__(self, strokes, scene):
        """`strokes` as `strokes_of` gives them; `scene`: a group, as the view's root, `view.getSceneGraph()`."""
        self._scene = scene
        self._strokes = strokes
        self._coloured = 0  # strokes that show as done
        self._material = coin.SoMaterial()
        self._root = coin.SoSeparator()
        for node in (self._style(), self._binding(), self._material, self._points(), self._lines()):
            self._root.addChild(node)
        self._paint([LATER] * len(self._strokes))
        scene.addChild(self._root)

    def colour(self, number):
        """Of a stroke."""
        return tuple(self._material.diffuseColor[number].getValue())

    def show_limits(self, move_limits):
        """`move_limits`: by the move's index, as `simulation.Found` has them."""
        self._coloured = 0
        self._paint([colour_of_limit(move_limits.get(stroke.index, "")) for stroke in self._strokes])

    def show_done(self, moves):
        """So many moves of the program are done. The first call for a run takes other colours off."""
        if self._coloured == 0:
            self._paint([LATER] * len(self._strokes))
        first = self._coloured
        while self._coloured < len(self._strokes) and self._strokes[self._coloured].index < moves:
            self._coloured += 1
        if self._coloured > first:
            self._material.diffuseColor.setValues(first, self._coloured - first, [DONE] * (self._coloured - first))

    def remove(self):
        self._scene.removeChild(self._root)

    def _paint(self, colours):
        self._material.diffuseColor.setValues(0, len(colours), colours)

    def _points(self):
        coordinates = coin.SoCoordinate3()
        points = [point for stroke in self._strokes for point in stroke.points]
        coordinates.point.setValues(0, len(points), points)
        return coordinates

    def _lines(self):
        lines = coin.SoLineSet()
        counts = [len(stroke.points) for stroke in self._strokes]
        lines.numVertices.setValues(0, len(counts), counts)
        return lines

    def _binding(self):
        binding = coin.SoMaterialBinding()
        binding.value = coin.SoMaterialBinding.PER_FACE  # one colour a stroke
        return binding

    def _style(self):
        style = coin.SoDrawStyle()
        style.lineWidth = WIDTH_PIXELS
        return style

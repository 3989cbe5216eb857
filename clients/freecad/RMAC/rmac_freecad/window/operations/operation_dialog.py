"""An operation on what is selected: beside its values and its preview, a dry run, and the cut. Nothing moves before Cut is pressed."""

from rmac_freecad.window.dialog import button
from rmac_freecad.window.operations.object_dialog import ObjectDialog
from rmac_freecad.window.running.machining_dialog import show as show_machining


class OperationDialog(ObjectDialog):
    def __init__(self, *what):
        super().__init__(*what)
        self.simulate_button = button("Dry run", self.simulate, "Plans it as the machine would cut it; moves nothing")
        self.cut_button = button("Cut…", self.cut, "Sends it to the machine, which begins at once where nothing speaks against it")
        self.lay_out(self.simulate_button, self.cut_button, below=self.made_below())

    def made_below(self):
        """What else a kind of it shows, below the buttons."""
        return ()

    def simulate(self):
        self.apply(lambda: show_machining(self.session).simulate())

    def cut(self):
        self.apply(lambda: show_machining(self.session).cut())

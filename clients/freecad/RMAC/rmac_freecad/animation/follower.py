"""Has the machine in a document follow the one that the appliance tells of."""

import FreeCAD

import rmac
from rmac.hearing import Hearer
from rmac_freecad.animation.model import ABOUT_PART, MachineModel, surfaces_of

RATE_HZ = 60


def answer_now(what, done, failed):
    """For scripts, which may wait: as `Station.ask`, here and now."""
    done(what())


class Follower:
    """Hears the topic `animation` within a `with` block; `update`, by the thread of the document as often as it likes, moves
    the objects to where the machine was last. Another machine is drawn when it is loaded. `told` says what is shown, or what is missing."""

    def __init__(self, client, document, about=ABOUT_PART, ask=answer_now):
        """`ask(what, done, failed)`: as `Station.ask`."""
        self._client, self._document, self._about, self._ask = client, document, about, ask
        self._document_name = document.Name
        self._latest = None  # read and written whole
        self._asked = None  # the geometry that is asked for, or drawn
        self._hearer = Hearer("animation", RATE_HZ, self._take, self._lose)
        self.model = None
        self.told = ""
        self.lost = None
        self.gone = False  # somebody took it out of the document

    def __enter__(self):
        self.begin()
        return self

    def __exit__(self, kind, error, trace):
        self.end()

    def begin(self):
        """Waits for the appliance."""
        self._client.hear(self._hearer)

    def end(self):
        """What is drawn stays as it is. Waits for the appliance."""
        try:
            self._client.unhear(self._hearer)
        except rmac.ConnectionLost:
            pass

    def update(self):
        """Whether something was moved."""
        latest = self._latest
        if latest is None or self.lost is not None or self.gone:
            return False
        if latest.geometry != self._asked:
            self._asked = latest.geometry
            self._clear(latest.missing)
            self._ask(self._describe, self._draw, self._fail)
        if self.model is None or self.model.geometry.number != latest.geometry or not latest.samples:
            return False
        if not self.model.there:
            self.model, self.gone = None, True
            self.told = "the machine was taken out of the document"
            return False
        self.model.place(latest, latest.samples[-1])
        return True

    def _describe(self):
        geometry = self._client.geometry()
        return geometry, surfaces_of(self._client, geometry)

    def _draw(self, described):
        geometry, surfaces = described
        self._clear(geometry.missing)
        self._asked = geometry.number
        if self._document_closed():
            self.gone = True
        elif geometry.bodies:
            self.model = MachineModel(self._document, geometry, surfaces, self._about)
            self.told = geometry.machine

    def _document_closed(self):
        return self._document_name not in FreeCAD.listDocuments()

    def _clear(self, told):
        if self.model is not None:
            self.model.remove()
        self.model = None
        self.told = told

    def _fail(self, error):
        self.told = str(error)

    def _take(self, params):
        self._latest = rmac.animation.read_animation(params)

    def _lose(self, error):
        self.lost = error
        self.told = str(error)

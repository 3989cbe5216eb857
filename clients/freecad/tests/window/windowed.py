"""What the tests of the window share: an appliance, dialogs under a session of their own, and waiting without sleeping."""

import os
import sys
import time
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import FreeCADGui
import PathScripts.PathProfile as PathProfile
from appliance import BUILD, Appliance
from path_job import operation_of, plate_job
from PySide import QtCore, QtGui
from rmac_freecad.station import Settings
from rmac_freecad.window.session import Session

import rmac  # isort: skip

MACHINE = "DMACXYZ"
BOUND_S = int(os.environ.get("RMAC_WAIT_S", "120"))  # for a computer that is busy; what is waited for takes a second or two


def process_until(condition, what):
    """Lets the window work until then. The session's timer wakes it up. `what` may be made when it is told."""
    until = time.monotonic() + BOUND_S
    while not condition():
        if time.monotonic() > until:
            raise AssertionError(f"within {BOUND_S} s it did not come to this: {what() if callable(what) else what}")
        QtGui.QApplication.processEvents(QtCore.QEventLoop.WaitForMoreEvents)


class WindowTest(unittest.TestCase):
    PACE = "as-fast-as-computed"
    MACHINE = MACHINE

    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(cls.made_appliance())
        cls.address = f"127.0.0.1:{cls.appliance.port}"
        with rmac.connect(cls.address, "set-up") as client, client.authority():
            client.load(cls.MACHINE)

    @classmethod
    def made_appliance(cls):
        return Appliance(pace=cls.PACE)

    def setUp(self):
        self.settings = Settings("User parameter:BaseApp/Preferences/Mod/RMACTests")
        self.settings.address = self.address
        self.settings.rmac = str(BUILD / "bin/rmac")
        self.session = Session(self.settings)
        self.addCleanup(self.session.close)
        self.dialogs = []
        self.addCleanup(self.close_dialogs)

    def close_dialogs(self):
        for dialog in self.dialogs:
            dialog.hide()

    def connect(self, name="other"):
        return self.enterContext(rmac.connect(self.address, name))

    def job(self):
        job = plate_job(self)
        job.Tools.Group[0].SpindleSpeed = 800  # the machine's spindle has 1000
        job.Document.recompute()
        return job

    def profile(self):
        """A job that cuts around the plate."""
        job = self.job()
        operation_of(job, PathProfile, "Profile")
        return job

    def stand_before_a_box(self, name, height):
        """The workbench, a part frame, a tool, and a document with a box; nothing is selected."""
        FreeCADGui.activateWorkbench("RmacWorkbench")
        with self.connect("set-up") as client:
            self.free(client)
            with client.authority():
                client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
                client.cam.SetTool(1, 0.0, 2.5)
        self.document = FreeCAD.newDocument(name)
        self.addCleanup(lambda: self.document and FreeCAD.closeDocument(self.document.Name))
        self.box = self.document.addObject("Part::Box", "Box")
        self.box.Length, self.box.Width, self.box.Height = 30, 20, height
        self.document.recompute()
        FreeCADGui.Selection.clearSelection()

    def free(self, client):
        """Until nobody has authority and nothing moves: what the test before left is over."""
        with client.states() as states:
            while next(states)["authority"]:
                pass
        client.at_rest()

    def opened(self, dialog):
        self.dialogs.append(dialog)
        dialog.show()
        dialog.activateWindow()
        return dialog

    def press(self, button):
        process_until(button.isEnabled, f"{button.text()} may be pressed")
        button.click()

    def shown(self, dialog):
        """The strokes of its path, or of its places, in the document, once they are there."""
        process_until(lambda: dialog.preview_button.isEnabled() or dialog.message.refused, lambda: dialog.message.text())
        self.assertIsNone(dialog.message.refused, dialog.message.text())
        return dialog.feature.ViewObject.Proxy.path._strokes

    def refused(self, dialog, *words):
        """Waits for a message of something refused, and holds it against words that must stand in it."""
        process_until(lambda: dialog.message.refused is not None, lambda: f"a refusal with {words}; the dialog says {dialog.message.text()!r}")
        for word in words:
            self.assertIn(word, dialog.message.text())

    def told(self, dialog, word):
        process_until(lambda: word in dialog.message.text() or dialog.message.refused is not None, lambda: f"the dialog says {word!r}, not {dialog.message.text()!r}")
        self.assertIn(word, dialog.message.text())

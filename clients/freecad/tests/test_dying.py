"""A FreeCAD that is killed, or crashes, while it moves the machine leaves none that moves."""

import os
import pathlib
import subprocess
import sys
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import rmac_freecad  # noqa: F401  finds the package rmac
from appliance import Appliance

import rmac  # isort: skip

PROGRAM = pathlib.Path(__file__).with_name("dying.py")
FREECAD = os.environ.get("RMAC_FREECADCMD", "freecadcmd")


class DyingTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance(pace="real-time"))
        cls.address = f"127.0.0.1:{cls.appliance.port}"

    def killed_while_it_moves(self, moves):
        with rmac.connect(self.address, "watch") as watch:
            with watch.authority():
                watch.load("DMACXYZ")
            environment = {**os.environ, "RMAC_ADDRESS": self.address, "RMAC_MOVES": moves, "FREECAD_USER_HOME": FreeCAD.getUserAppDataDir()}
            child = subprocess.Popen([FREECAD, PROGRAM], env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
            try:
                with watch.states() as states:
                    self.assertTrue(any(state["pose"][0] > 1 and state["moving"] for state in states))
                    child.kill()
                    child.wait()
                    rested = next(state["t_s"] for state in states if not state["moving"] and state["authority"] == "")
                    after = [next(states) for _ in range(20)]
            finally:
                child.kill()
                child.wait()
        self.assertGreater(after[-1]["t_s"], rested)
        self.assertFalse(any(state["moving"] or state["moves_in_buffer"] for state in after))
        self.assertLess(after[-1]["pose"][0], 39)

    def test_while_a_button_is_held(self):
        self.killed_while_it_moves("jog")

    def test_while_it_measures(self):
        self.killed_while_it_moves("measure")

    def test_in_mid_cut(self):
        self.killed_while_it_moves("cut")


if __name__ == "__main__":
    unittest.main()

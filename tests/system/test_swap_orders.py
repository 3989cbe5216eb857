"""Every order of loading any two mechanisms of the shipped tree: over each other, with and without unloading between."""

import unittest

from appliance import BUILD, Appliance
from client import Refused

# TarusXYZCA's drives hang on CAN; its twin has simulated ones of the same manners.
NAMES = sorted(file.parent.name for file in (BUILD / "drivers").rglob("device.json") if file.parent.name != "TarusXYZCA")
# A CMM over a machine that has no probe is refused, and says so; on its own it has one.
NO_PROBE = {"BenchXYZ"}


def round_trip():
    """A way from mechanism to mechanism that goes once from each to each other."""
    for first, name in enumerate(NAMES):
        for other in NAMES[first + 1:]:
            yield name
            yield other
    yield NAMES[0]


class SwapOrders(unittest.TestCase):
    def setUp(self):
        self.operator = self.enterContext(Appliance()).client("operator")
        self.operator.call("authority.acquire")

    def load(self, name):
        self.operator.call("Device.Load", Name=name)
        state = self.operator.state()
        self.assertEqual((state["mechanism"], state["state"]), (name, "Idle"))

    def test_each_goes_in_over_each(self):
        in_force = None
        for name in round_trip():
            with self.subTest(over=in_force, name=name):
                if name == "CMM" and in_force in NO_PROBE:
                    self.assertIn("no probe", self.operator.refusal("Device.Load", Name=name).message)
                    self.assertEqual(self.operator.state()["mechanism"], in_force)
                    self.operator.call("Device.Unload")
                self.load(name)
            in_force = name

    def test_each_goes_in_behind_each(self):
        for name in round_trip():
            with self.subTest(name=name):
                self.load(name)
                self.operator.call("Device.Unload")

    def test_what_cannot_come_up_leaves_the_old_one_in_force(self):
        self.load("CMM")
        with self.assertRaisesRegex(Refused, "can0.*CMM"):
            self.operator.call("Device.Load", Name="TarusXYZCA")
        self.assertEqual(self.operator.state()["mechanism"], "CMM")
        self.assertEqual(self.operator.state()["state"], "Idle")


if __name__ == "__main__":
    unittest.main()

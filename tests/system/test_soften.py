"""rmac load --soften and rmac tune, where the gains do not fit the axes."""

import json
import math
import pathlib
import tempfile
import unittest

from appliance import Appliance, wait_for_rest
from bending_mill import TuningTest, device_of, rigid


class Soften(TuningTest):
    def test_tune_begins_softly_where_the_gains_do_not_fit(self):
        """With gains which were made for axes that are rigid, and of another mass."""
        for hz, heavier, joints in ((346, 3, (0, 2)), (274, 1, (0,)), (600, 1 / 3, (2,))):
            with self.subTest(hz=hz, heavier=heavier), tempfile.TemporaryDirectory() as folder, \
                    self.bending(hz, {}, heavier, load=False) as appliance:
                refused = appliance.rmac("load", "DMACXYZ")
                self.assertEqual(refused.returncode, 1)
                self.assertIn("stability: on the model of its axes, where encoders are sound", refused.stderr)
                self.assertIn("softer by 8, and their joints", self.rmac(appliance, "load", "DMACXYZ", "--soften", "8"))
                client = appliance.client()
                for joint in joints:
                    words = ("tune", str(joint), "--travel", "20", "-o", str(pathlib.Path(folder, "tune.png")))
                    found = json.loads(self.rmac(appliance, "--json", *words, "--apply"))
                    seen = min(hz, 1000 - hz)  # by samples at 1 kHz
                    self.assertAlmostEqual(found["resonances"][0]["frequency"] / seen, 1, delta=0.02)
                    self.assertTrue(found["elsewhere"]["stable"])
                    self.assertGreater(found["proposed"]["bandwidth_hz"], found["before"]["bandwidth_hz"])
                client.call("authority.acquire")
                for way in (20, -20, 3, -3):
                    for joint in (0, 2):
                        client.call("RMAC_CAM.JogJoint", JntNum=joint, Distance=way)
                        wait_for_rest(client)
                        while client.state()["state"] == "Running":  # It follows the motion by a cycle or two.
                            pass
                        self.assertEqual(client.state()["state"], "Idle")

    def test_a_lower_resonance_takes_a_softer_beginning(self):
        """As of a machining centre with gains for rigid axes: what swings still is said so, and the next step holds."""
        appliance = Appliance(own_tree=True, flight_recorder={"seconds": 30})
        with device_of(appliance, "SuginoXYZ") as device:
            axes = dict(device["DigitalControlInterface"]["Parameters"])
            rigid(device, **axes)
        with appliance, tempfile.TemporaryDirectory() as folder:
            refused = appliance.rmac("load", "SuginoXYZ", "--soften", "8")
            self.assertEqual(refused.returncode, 1)
            self.assertIn("`rmac load --soften 8`, or by more where it swings then, too", refused.stderr)
            self.rmac(appliance, "load", "SuginoXYZ", "--soften", "16")
            words = ("tune", "0", "--travel", "40", "-o", str(pathlib.Path(folder, "tune.png")))
            found = json.loads(self.rmac(appliance, "--json", *words, "--apply"))
        motor, load = axes["inertia_kg_m2"][0] - axes["load_inertia_kg_m2"][0], axes["load_inertia_kg_m2"][0]
        hz = math.sqrt(axes["stiffness_nm_rad"][0] * (1 / motor + 1 / load)) / (2 * math.pi)
        self.assertAlmostEqual(found["resonances"][0]["frequency"] / hz, 1, delta=0.02)
        self.assertTrue(found["elsewhere"]["stable"])
        self.assertGreaterEqual(found["proposed"]["gain_margin_db"], 6)
        self.assertGreaterEqual(found["proposed"]["phase_margin_deg"], 30)


if __name__ == "__main__":
    unittest.main()

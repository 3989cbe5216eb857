"""rmac load --soften and rmac tune, where the gains do not fit the axes."""

import json
import pathlib
import tempfile
import unittest

from appliance import wait_for_rest
from bending_mill import TuningTest


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
                while client.state()["state"] == "Running":  # It follows the last motion by a cycle or two.
                    pass
                self.assertEqual(client.state()["state"], "Idle")


if __name__ == "__main__":
    unittest.main()

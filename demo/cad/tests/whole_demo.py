"""The demo as a whole, with higher scallops than by hand: FreeCAD without a window, and a daemon of its own."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

from appliance import BUILD, Appliance  # noqa: E402

DEMO = pathlib.Path(__file__).resolve().parents[1]
SCALLOP_MM = 0.2
BOUND_S = 600


class Whole(unittest.TestCase):
    def test_from_the_step_file_to_the_corrected_model_every_figure_is_within_its_bound(self):
        with tempfile.TemporaryDirectory() as folder, Appliance(own_tree=True) as appliance:
            out = pathlib.Path(folder)
            ended = subprocess.run(
                ["/usr/bin/python3", "-B", DEMO / "start.py", "--address", f"127.0.0.1:{appliance.port}", "--tree", appliance.tree, "--out", out, "--rmac", BUILD / "bin/rmac",
                 "--scallop", str(SCALLOP_MM), "--no-picture"],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=BOUND_S, check=False)  # fmt: skip
            told = f"{ended.stdout}\n{ended.stderr}"
            self.assertEqual(ended.returncode, 0, told)
            line = json.loads(ended.stdout.splitlines()[-1])
            self.assertTrue(line["ok"], told)
            self.assertGreater(line["before_rms_um"], 50, "the part was clamped off, and nothing found it")
            self.assertGreater(line["scallop_share"], 0.9, "lower scallops than were asked for take time for nothing")
            self.assertIn("every figure within its bound", (out / "report.html").read_text(encoding="utf-8"))

    def test_without_an_appliance_it_says_so_and_ends_with_1(self):
        with tempfile.TemporaryDirectory() as folder:
            ended = subprocess.run(
                ["/usr/bin/python3", "-B", DEMO / "start.py", "--address", "127.0.0.1:1", "--tree", folder, "--out", folder, "--rmac", BUILD / "bin/rmac", "--no-picture"],
                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=BOUND_S, check=False)  # fmt: skip
        self.assertEqual(ended.returncode, 1)
        line = json.loads(ended.stdout.splitlines()[-1])
        self.assertFalse(line["ok"])
        self.assertIn("127.0.0.1:1", line["error"])


if __name__ == "__main__":
    unittest.main()

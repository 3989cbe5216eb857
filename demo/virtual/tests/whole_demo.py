"""The demo as a whole, with sweeps farther apart and rays coarser than by hand, and a daemon of its own."""

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
STEP_MM, RESOLUTION_MM = 5, 0.25
BOUND_S = 600


def run(*words):
    return subprocess.run(["/usr/bin/python3", "-B", DEMO / "run_virtual.py", *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=BOUND_S, check=False)


def here(port, out):
    return ["--port", str(port), "--out", out, "--rmac", BUILD / "bin/rmac", "--device-tree", BUILD / "drivers", "--step", str(STEP_MM), "--resolution", str(RESOLUTION_MM)]


class Whole(unittest.TestCase):
    def setUp(self):
        self.out = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory(prefix="rmac-test-")))

    def test_the_first_program_is_found_and_held_and_the_second_cuts_what_was_predicted(self):
        with Appliance() as appliance:
            self.assertEqual(run("--tools", appliance.folder / "state/tools").returncode, 0)
            ended = run(*here(appliance.port, self.out))
        told = f"{ended.stdout}\n{ended.stderr}"
        self.assertEqual(ended.returncode, 0, told)
        line = json.loads(ended.stdout.splitlines()[-1])
        self.assertTrue(line["ok"], told)
        self.assertGreater(line["collision_mm"], 5, "the stud is 13 mm higher than the holder's lower end where it is nearest")
        self.assertAlmostEqual(line["machined_off_by_rays_rms_um"] / line["machined_off_rms_um"], 1, delta=0.3, msg="two ways to know the same")
        self.assertGreater(line["machined_off_um"], 1, "the simulated axes have following errors, and the machined part none of them")
        for name in ("first.html", "second.html", "second.stl", "machined.stl", "virtual.png", "record.csv"):
            self.assertGreater((self.out / name).stat().st_size, 1000, name)

    def test_without_an_appliance_it_says_so_and_ends_with_1(self):
        ended = run(*here(1, self.out))
        self.assertEqual(ended.returncode, 1)
        line = json.loads(ended.stdout.splitlines()[-1])
        self.assertFalse(line["ok"])
        self.assertIn("127.0.0.1:1", line["error"])


if __name__ == "__main__":
    unittest.main()

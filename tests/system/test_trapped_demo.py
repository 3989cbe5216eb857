"""The demo's headlight at real pace, with a trap around every cycle of the servo thread."""

import json
import sys
import tempfile
import unittest

from appliance import BUILD, SOURCE, Appliance

sys.path.insert(0, str(SOURCE / "demo"))
import toolpaths  # noqa: E402

PROGRAM = BUILD / "bin/rmacd_trapped"
HEADLIGHT_CYCLES = 280_000


@unittest.skipUnless(PROGRAM.exists(), "a sanitizer brings its own malloc and locks")
class TrappedDemo(unittest.TestCase):
    def test_servo_thread_neither_allocates_nor_locks_nor_calls_the_system(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        toolpaths.make(folder)
        appliance = Appliance(pace="real-time", program=PROGRAM)
        with appliance:
            for machine, program in (("DMACXYZ", "sweep"), ("DMACXY", "rim")):
                loaded = appliance.rmac("load", machine)
                self.assertEqual(loaded.returncode, 0, loaded.stderr)
                cut = appliance.rmac("run", f"{folder}/headlight-{program}.rmac", bound_s=600)
                self.assertEqual(cut.returncode, 0, cut.stderr)
        told = [line for line in appliance.log if line.startswith("trap: ")]
        self.assertEqual(len(told), 1, appliance.log)
        caught = json.loads(told[0].removeprefix("trap: "))
        self.assertGreater(caught["cycles"], HEADLIGHT_CYCLES)
        self.assertEqual({kind: caught[kind] for kind in ("allocations", "locks", "system_calls", "first")},
                         {"allocations": 0, "locks": 0, "system_calls": 0, "first": ""})
        if not caught["catches_system_calls"]:
            self.skipTest("this kernel has no syscall user dispatch: calls were not caught")


if __name__ == "__main__":
    unittest.main()

"""Verification runs modules of strangers: what one of them tries reaches neither the daemon nor the computer."""

import json
import pathlib
import shutil
import subprocess
import unittest

from appliance import BUILD, Appliance

FOLDER = "mill/3-axis/Bad"
VERIFY = BUILD / "bin/rmac-verify"
# What is refused because it was tried; the words name the deed.
REFUSED = {
    "KillsParent": ("confinement", "asks the system for kill"),
    "KillsItsGroup": ("confinement", "asks the system for kill"),
    "Forks": ("confinement", "asks the system for clone"),
    "CallsStopNow": ("confinement", "asks the system for socket"),
    "Traces": ("confinement", "asks the system for ptrace"),
    "Reports": ("report",),
}
# What just has no effect.
CONTAINED = ("WritesFile", "WritesMemory")


class Confinement(unittest.TestCase):
    """DMACXYZ is loaded, and beside it in the tree there is Bad: the same machine with kinematics that mean harm."""

    def setUp(self):
        self.appliance = self.enterContext(Appliance(own_tree=True, own_verdicts=True))
        self.folder = self.appliance.tree / FOLDER
        shutil.copytree(self.appliance.tree / "mill/3-axis/DMACXYZ", self.folder)
        self.written = self.appliance.folder / "written"

    def choose(self, deed):
        shutil.copy(BUILD / "bad_modules" / deed / "HostileKinematics.so", self.folder)
        file = self.folder / "device.json"
        device = json.loads((self.appliance.tree / "mill/3-axis/DMACXYZ/device.json").read_text())
        device["MechanismName"] = "Bad"
        device.pop("MechanismID", None)
        device["Kinematics"] = {"Module": "HostileKinematics", "Parameters": {
            "daemon": self.appliance.process.pid, "port": self.appliance.port, "file": str(self.written)}}
        file.unlink()  # The copy may be read-only.
        file.write_text(json.dumps(device))

    def processes(self):
        """Of the daemon, besides itself."""
        children = pathlib.Path(f"/proc/{self.appliance.process.pid}/task").glob("*/children")
        return [child for file in children for child in file.read_text().split()]

    def test_hostile_modules_reach_neither_the_daemon_nor_the_computer(self):
        operator = self.appliance.operator("DMACXYZ")
        self.choose("None")
        operator.call("DeviceDriverManager.Rescan")
        self.assertTrue(operator.call("Device.Verify", Name="Bad")["ok"])
        stops = operator.state()["last_stop"]
        for deed, words in REFUSED.items():
            with self.subTest(deed):
                self.choose(deed)
                report = operator.call("Device.Verify", Name="Bad")
                self.assertFalse(report["ok"])
                refusal, = [module["counter_example"] for module in report["modules"] if not module["ok"]]
                for word in words:
                    self.assertIn(word, json.dumps(refusal))
                self.assertIn("in create", json.dumps(refusal))
                self.assertEqual(self.processes(), [])
        for deed in CONTAINED:
            with self.subTest(deed):
                self.choose(deed)
                operator.call("Device.Verify", Name="Bad")
                self.assertFalse(self.written.exists())
                self.assertEqual(self.processes(), [])
        state = operator.state()
        self.assertEqual((state["mechanism"], state["last_stop"]), ("DMACXYZ", stops))

    def test_nothing_runs_where_it_cannot_be_kept_apart(self):
        self.choose("WritesFile")
        done = subprocess.run(
            ["unshare", "--user", "--map-root-user", "sh", "-c",
             'echo 0 > /proc/sys/user/max_user_namespaces && exec "$@"', "sh", VERIFY, self.folder,
             "--modules", self.appliance.tree / "modules"],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        for word in ("REFUSED", "cannot be kept apart", "user_namespaces"):
            self.assertIn(word, done.stdout)
        self.assertFalse(self.written.exists())


if __name__ == "__main__":
    unittest.main()

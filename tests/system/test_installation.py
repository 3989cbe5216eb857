"""What cmake --install puts where, and what systemd says of the units."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE

# Highest exposure, tenths, that `systemd-analyze security` may give. The daemon's was 20 without the namespaces and mounts
# in which it confines modules that are being verified.
DAEMON_EXPOSURE, CAN_EXPOSURE = 26, 18


class Installation(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = cls.enterClassContext(tempfile.TemporaryDirectory())
        environment = os.environ | {"DESTDIR": folder}
        subprocess.run(["cmake", "--install", BUILD, "--prefix", "/usr"], env=environment, check=True,
                       stdout=subprocess.DEVNULL)
        cls.root = pathlib.Path(folder)

    def one(self, pattern):
        found = sorted(self.root.glob(pattern))
        self.assertEqual(len(found), 1, f"{pattern}: {found}")
        return found[0]

    def test_programs_drivers_and_units_are_where_debian_expects_them(self):
        self.one("usr/sbin/rmacd")
        self.one("usr/bin/rmac")
        self.one("usr/libexec/rmac/rmac-verify")
        self.one("usr/libexec/rmac/rmac-search")
        self.one("usr/bin/rmac-import")
        self.one("usr/bin/rmac-vdrive")
        self.one("usr/bin/rmac-vmodbus")
        self.one("usr/share/rmac/rmac-vdrive.eds")
        self.one("usr/lib/**/rmac/drivers/mill/3-axis/DMACXYZ/device.json")
        self.one("usr/lib/**/rmac/drivers/mill/3-axis/DMACXYZ/DMACXYZKinematics.so")
        self.one("usr/lib/**/rmac/drivers/modules/modbus/delta-vfd-b.json")
        self.one("usr/lib/systemd/system/rmacd.service")
        self.one("usr/lib/systemd/system/rmac-can@.service")
        self.one("usr/lib/sysusers.d/rmac.conf")
        self.one("usr/include/rmac/sdk/module.hpp")
        self.one("etc/rmac/rmacd.json")
        self.assertEqual(sorted(path.name for path in self.one("etc/rmac/drives").iterdir()),
                         sorted(path.name for path in (SOURCE / "etc/drives").iterdir()))
        self.one("etc/rmac/materials.json")
        for part in ("page.html", "page.css", "page.js", "three.min.js", "OrbitControls.js", "three-licence.txt"):
            self.one(f"usr/libexec/rmac/view/{part}")
        self.one("usr/share/rmac/drive.schema.json")
        self.one("etc/rmac/can-can0.conf.example")

    def test_installed_daemon_accepts_the_installed_configuration(self):
        done = subprocess.run([self.one("usr/sbin/rmacd"), "--check", "--config", self.one("**/etc/rmac/rmacd.json")],
                              capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_installed_client_simulates_on_the_installed_drivers(self):
        move = {"jsonrpc": "2.0", "id": 1, "method": "RMAC_CAM.MoveToJointTarget",
                "params": {"MoveID": 1, "JointTargetFrame": {"joints": [1, 2, 3]}}}
        done = subprocess.run([self.one("usr/bin/rmac"), "--json", "simulate", "-", "--machine", "BenchXYZ"],
                              input=json.dumps(move), capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(json.loads(done.stdout)["moves"], 1)

    def test_another_prefix_has_everything_below_it(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run(["cmake", "--install", BUILD, "--prefix", "/opt/rmac"], env=os.environ | {"DESTDIR": folder},
                           check=True, stdout=subprocess.DEVNULL)
            root = pathlib.Path(folder)
            self.assertEqual([str(path.relative_to(root)) for path in root.rglob("*")
                              if path.is_file() and not path.is_relative_to(root / "opt/rmac")], [])
            unit = (root / "opt/rmac/lib/systemd/system/rmacd.service").read_text()
            self.assertIn("\nExecStart=/opt/rmac/sbin/rmacd --config /opt/rmac/etc/rmac/rmacd.json\n", unit)
            for file in ("rmacd.json", "can-can0.conf.example"):
                self.assertTrue((root / "opt/rmac/etc/rmac" / file).is_file(), file)

    def test_nothing_of_the_tests_is_installed(self):
        self.assertEqual([str(path) for path in self.root.rglob("*test*")], [])

    def units(self, folder):
        """The installed units as systemd would see them: with the daemon at a path that exists here."""
        daemon = self.one("usr/sbin/rmacd")
        for unit in ("rmacd.service", "rmac-can@.service"):
            text = (self.root / "usr/lib/systemd/system" / unit).read_text()
            lines = [f"ExecStart={daemon}" if row.startswith("ExecStart=") and "rmacd" in row else row
                     for row in text.splitlines()]
            (folder / unit).write_text("\n".join(lines) + "\n")
        (folder / "rmac-can@can0.service").write_text((folder / "rmac-can@.service").read_text())

    @unittest.skipUnless(shutil.which("systemd-analyze"), "systemd-analyze is not installed")
    def test_units_are_valid_and_confined(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.units(folder)
            for unit, exposure in (("rmacd.service", DAEMON_EXPOSURE), ("rmac-can@can0.service", CAN_EXPOSURE)):
                verified = subprocess.run(["systemd-analyze", "verify", "--man=no", folder / unit],
                                          capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual((verified.returncode, verified.stderr), (0, ""), unit)
                rated = subprocess.run(["systemd-analyze", "security", "--offline=true", "--no-pager",
                                        f"--threshold={exposure}", folder / unit],
                                       capture_output=True, text=True, timeout=60, check=False)
                self.assertEqual(rated.returncode, 0, rated.stdout)


if __name__ == "__main__":
    unittest.main()

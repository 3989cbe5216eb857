"""The Python package `rmac` (clients/python) against the daemon: connecting, authority, machines, and that what is generated is current."""

import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest

from appliance import SOURCE, Appliance

PACKAGE = SOURCE / "clients/python"
sys.path[:0] = [str(PACKAGE / "src"), str(PACKAGE)]

import generate  # noqa: E402
import rmac  # noqa: E402
from rmac.errors import SpeedLimit  # noqa: E402


class PythonClientTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())

    def client(self, name="test"):
        return self.enterContext(rmac.connect(f"127.0.0.1:{self.appliance.port}", name))

    def test_generated_methods_are_those_of_the_appliance(self):
        document = self.client().connection.discover()
        self.assertEqual(generate.stale(document), [], "write them again: clients/python/generate.py ADDRESS of a running rmacd")
        described = {method["name"]: method for method in document["methods"]}
        typed = {f"{interface}.{name}" for interface in ("DeviceDriverManager", "Device", "RMAC_Config", "RMAC_CAM")
                 for name in vars(getattr(rmac.calls, interface)) if not name.startswith("_")}
        dissertation = {name for name, method in described.items() if method["x-origin"] == "dissertation"}
        self.assertEqual(len(dissertation), 143)
        self.assertLessEqual(dissertation, typed)

    def test_the_unix_socket_is_as_good(self):
        with rmac.connect(f"unix:{self.appliance.folder}/state/rmacd.sock") as client:
            self.assertEqual(client.greeting.server, "rmacd")

    def test_machines_are_found_with_their_characteristics(self):
        client = self.client()
        every = len(client.machines())
        client.drivers.OpenDeviceDriverDatabase()
        self.assertEqual(every, client.drivers.GetTotalNumberOfRecords())
        found = client.machines("Type = 'Mill' AND NumberOfJoints = 5 AND SpindleHorsePower > 5")
        self.assertEqual([machine.name for machine in found], ["TarusXYZCA"])
        self.assertEqual((found[0].joints, found[0].type), (5, "Mill"))
        self.assertEqual(client.machines("Name = 'nobody'"), [])
        with self.assertRaises(rmac.Refused):
            client.machines("nonsense here")

    def test_a_loaded_machine_tells_its_joints(self):
        client = self.client()
        with client.authority():
            machine = client.load("DMACXYZ", virtual=True)
            self.assertEqual(machine, client.machine())
            self.assertEqual([(joint.lowest, joint.highest) for joint in machine.joints], [(-50, 50)] * 3)
            client.device.Unload()
        with self.assertRaises(rmac.MachineRefused):
            client.machine()

    def test_a_second_client_is_told_who_has_authority_and_may_stop(self):
        first, second = self.client("first"), self.client("second")
        with first.authority():
            with self.assertRaisesRegex(rmac.AuthorityHeld, "first"), second.authority():
                self.fail("both have authority")
            with self.assertRaises(rmac.AuthorityRequired):
                second.device.Load("DMACXYZ")
            self.assertTrue(second.cam.StopNow())
        with second.authority():
            self.assertIn("second", first.state()["authority"])

    def test_a_block_of_authority_within_another_one_leaves_it_authority(self):
        client = self.client()
        with client.authority():
            with client.authority():
                client.load("DMACXYZ", virtual=True)
            self.assertNotEqual(client.state()["authority"], "")
            client.device.Unload()
        self.assertEqual(client.state()["authority"], "")

    def test_a_rate_that_is_none_is_told(self):
        client = self.client()
        for rate_hz in (0, -1, math.nan, math.inf, "100"):
            with self.assertRaisesRegex(rmac.InvalidValue, "rate_hz"):
                client.record(rate_hz)

    def test_a_refusal_has_the_class_of_its_minor_code(self):
        client = self.client()
        with client.authority():
            client.load("DMACXYZ", virtual=True)
            with self.assertRaisesRegex(SpeedLimit, "above the maximum of 2000"):
                client.cam.SetFeedrate(3000)
            with self.assertRaisesRegex(rmac.RequestRefused, "fast"):
                client.call(rmac.Call("RMAC_CAM.SetFeedrate", {"Feedrate": "fast"}))

    def test_an_error_leaves_authority_and_is_not_hidden(self):
        client = self.client()
        with self.assertRaisesRegex(ValueError, "mine"), client.authority():
            raise ValueError("mine")
        self.assertEqual(client.state()["authority"], "")

    def test_named_values_and_properties_have_types(self):
        client = self.client()
        with client.authority():
            self.assertIs(client.cam.StatusMajorCode(0), True)
            self.assertEqual(client.cam.StatusMajorCode().name, "MACHINE_SUCCESS")
            client.load("DMACXYZ", virtual=True)
            self.assertEqual(client.device.Machine_GetMechanismJntTypes(0).name, "DMAC_LIN_JNT")

    def test_threads_share_a_client(self):
        client = self.client()
        wrong = []

        def ask(number):
            for _ in range(50):
                if client.call(rmac.Call("hello", {"client": f"n{number}"}))["server"] != "rmacd":
                    wrong.append(number)

        threads = [threading.Thread(target=ask, args=(number,)) for number in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_pip_installs_it(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(PACKAGE, pathlib.Path(folder) / "python", ignore=shutil.ignore_patterns("__pycache__"))
            done = subprocess.run(
                ["/usr/bin/python3", "-m", "pip", "install", "--quiet", "--no-index", "--no-build-isolation", "--no-deps",
                 "--target", f"{folder}/installed", f"{folder}/python"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            said = subprocess.run(["/usr/bin/python3", "-I", "-c", f"import sys; sys.path.insert(0, '{folder}/installed'); import rmac; print(rmac.API_VERSION)"],
                                  capture_output=True, text=True, check=True).stdout
        self.assertEqual(said.strip(), rmac.API_VERSION)


class LeaseThatEndsBySilenceTest(unittest.TestCase):
    def test_authority_is_renewed_for_as_long_as_its_block_lasts(self):
        with Appliance(lease_timeout_s=1) as appliance, rmac.connect(f"127.0.0.1:{appliance.port}") as client:
            watcher = rmac.connect(f"127.0.0.1:{appliance.port}", "watcher")
            with client.authority(), watcher:
                # Two leases' time without a call of ours: the machine's own clock tells when that is over.
                until = watcher.state()["t_s"] + 2.5
                while (state := watcher.state())["t_s"] < until:
                    self.assertIn("python", state["authority"])


if __name__ == "__main__":
    unittest.main()

"""The daemon's own command line, its readiness and its end."""

import json
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, Appliance

RMACD = BUILD / "bin" / "rmacd"
DONE, FAILED, USAGE = 0, 1, 2


def rmacd(*words):
    return subprocess.run([RMACD, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60,
                          check=False)


class CommandLine(unittest.TestCase):
    def check(self, settings):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            file.write(settings if isinstance(settings, str) else json.dumps(settings))
            file.flush()
            return rmacd("--check", "--config", file.name)

    def test_shipped_configuration_is_valid(self):
        done = rmacd("--check", "--config", str(SOURCE / "etc" / "rmacd.json"))
        self.assertEqual(done.returncode, DONE, done.stderr)

    def test_bad_value_names_key_and_range(self):
        done = self.check({"listen": {"port": 70000}})
        self.assertEqual(done.returncode, FAILED)
        for word in ("/listen/port", "70000", "65535"):
            self.assertIn(word, done.stderr)

    def test_unknown_key_is_an_error(self):
        done = self.check({"lisen": {}})
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("lisen", done.stderr)

    def test_address_of_the_network_is_refused_with_the_reason(self):
        done = self.check({"listen": {"address": "0.0.0.0"}})
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("authenticated", done.stderr)

    def test_wrong_description_of_a_drive_is_told_by_check(self):
        with tempfile.TemporaryDirectory() as folder:
            def describe(name, **changes):
                (pathlib.Path(folder) / name).write_text(json.dumps(
                    {"Name": "a", "Manual": "b", "Tried": "never", "VendorId": 1, "ProductCode": 2} | changes))
            describe("sound.json")
            done = self.check({"drives_folder": folder})
            self.assertEqual(done.returncode, DONE, done.stderr)
            describe("wrong.json", ProductCode=3, SdoTimeout=0)
            describe("double.json")
            done = self.check({"drives_folder": folder})
            self.assertEqual(done.returncode, FAILED)
            for word in ("wrong.json: /SdoTimeout is 0; allowed is a number from 0.01 to 60 (s)", "double.json and ",
                         "sound.json are for the same drive"):
                self.assertIn(word, done.stderr)

    def test_unknown_option_is_a_usage_error(self):
        self.assertEqual(rmacd("--nonsense").returncode, USAGE)


class LifeCycle(unittest.TestCase):
    def test_service_manager_is_told_of_readiness_and_end(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as manager:
            address = os.path.join(folder, "notify")
            manager.bind(address)
            manager.settimeout(60)
            config = os.path.join(folder, "rmacd.json")
            with open(config, "w", encoding="utf-8") as file:
                json.dump({"listen": {"port": 0}, "state_folder": "state",
                           "real_time": {"lock_memory": False}}, file)
            environment = os.environ | {"NOTIFY_SOCKET": address, "WATCHDOG_USEC": "200000"}
            with subprocess.Popen([RMACD, "--config", config], env=environment, stdin=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL) as daemon:
                try:
                    self.read_until(manager, "READY=1")
                    self.read_until(manager, "WATCHDOG=1")
                    self.read_until(manager, "WATCHDOG=1")
                    daemon.terminate()
                    self.read_until(manager, "STOPPING=1")
                    self.assertEqual(daemon.wait(timeout=60), DONE)
                finally:
                    daemon.kill()

    def test_hang_up_stops_the_machine_on_its_path_and_ends(self):
        with Appliance(pace="real-time") as appliance:
            client = appliance.client()
            client.call("authority.acquire")
            client.call("Device.Load", Name="BenchXYZ")
            client.call("RMAC_CAM.SetFeedrate", Feedrate=600)
            client.call("RMAC_CAM.MoveToXYZ", MoveID=1, x=40, y=0, z=0, Speed=10)
            client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
            client.call("subscribe", topics=["state"], rate_hz=50)
            client.wait_note("state", lambda state: state["moving"])
            appliance.process.send_signal(signal.SIGPIPE)
            appliance.process.send_signal(signal.SIGHUP)
            self.assertEqual(appliance.process.wait(timeout=60), DONE)
        self.assertIn("SIGHUP: stopping the machine and ending", "".join(appliance.log))
        self.assertIn("the machine is stopped on its path", "".join(appliance.log))

    def test_without_tcp_clients_come_by_the_unix_socket_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            config = os.path.join(folder, "rmacd.json")
            with open(config, "w", encoding="utf-8") as file:
                json.dump({"listen": {"tcp": False, "unix_socket": "s"}, "state_folder": "state",
                           "real_time": {"lock_memory": False}}, file)
            with subprocess.Popen([RMACD, "--config", config], stdin=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                  text=True) as daemon:
                try:
                    line = next(line for line in daemon.stderr if "listens on" in line)
                    self.assertTrue(line.rstrip().endswith("listens on " + os.path.join(folder, "s")), line)
                    done = subprocess.run([BUILD / "bin" / "rmac", "--socket", os.path.join(folder, "s"), "status"],
                                          capture_output=True, text=True, timeout=60, check=False)
                    self.assertEqual(done.returncode, DONE, done.stderr)
                    sockets = {os.readlink(f"/proc/{daemon.pid}/fd/{fd}") for fd in os.listdir(f"/proc/{daemon.pid}/fd")}
                    with open(f"/proc/{daemon.pid}/net/tcp", encoding="ascii") as table:
                        inodes = {f"socket:[{row.split()[9]}]" for row in table.readlines()[1:]}
                    self.assertFalse(sockets & inodes)
                    daemon.terminate()
                    self.assertEqual(daemon.wait(timeout=60), DONE)
                finally:
                    daemon.kill()

    def test_wrong_description_of_a_drive_is_nothing_to_a_machine_without_it(self):
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "wrong.json").write_text("{")
            with Appliance(drives_folder=folder) as appliance:
                client = appliance.client()
                client.call("authority.acquire")
                client.call("Device.Load", Name="BenchXYZ")
                self.assertEqual(client.state()["state"], "Idle")

    def test_state_folder_belongs_to_one_daemon(self):
        with Appliance() as appliance:
            other = json.loads(appliance.configuration.read_text())
            other["listen"]["unix_socket"] = "other.sock"
            config = appliance.folder / "other.json"
            config.write_text(json.dumps(other))
            refused = rmacd("--config", str(config))
            self.assertEqual(refused.returncode, FAILED)
            self.assertIn(f"in use by another rmacd (process {appliance.process.pid})", refused.stderr)
            self.assertFalse((appliance.folder / "other.sock").exists())
            self.assertEqual(appliance.client().state()["state"], "Idle")

    def read_until(self, manager, word):
        while word not in manager.recv(4096).decode().splitlines():
            pass

    def test_discover_lists_every_function_once(self):
        spec = json.loads((SOURCE / "tests/unit/gateway/api/fixtures/rmac_api.json").read_text())
        wanted = {f"{function['interface']}.{function['name']}" for function in spec["functions"]}
        with Appliance() as appliance:
            document = appliance.client().call("rpc.discover")
        names = [method["name"] for method in document["methods"]]
        self.assertEqual(len(names), len(set(names)))
        self.assertEqual(wanted - set(names), set())


class AtRest(unittest.TestCase):
    def test_an_idle_machine_in_virtual_time_is_looked_at_no_more_often_than_one_in_real_time(self):
        """By how often the daemon's main thread runs in a cycle; on a busy computer that is rarer still."""
        appliance = self.enterContext(Appliance())
        self.assertEqual(appliance.rmac("load", "DMACXYZ").returncode, 0)
        client = appliance.client()
        client.call("subscribe", topics=["state"], rate_hz=5)

        def switches():
            lines = pathlib.Path(f"/proc/{appliance.process.pid}/status").read_text().splitlines()
            return sum(int(line.split(":")[1]) for line in lines if "ctxt_switches" in line)

        seen = [(client.wait_note("state")["cycle"], switches()) for _ in range(7)][1:]  # the first note comes at once
        per_cycle = [(more - switched) / (later - cycle) for (cycle, switched), (later, more) in zip(seen, seen[1:])]
        self.assertLess(min(per_cycle), 2, per_cycle)


if __name__ == "__main__":
    unittest.main()

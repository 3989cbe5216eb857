"""Starts the built rmacd for a test, on its simulated bus, in a folder and on a port of its own."""

import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import tempfile
import threading

from client import Client

BUILD = pathlib.Path(os.environ["RMAC_BUILD"])
SOURCE = pathlib.Path(os.environ["RMAC_SOURCE"])
START_BOUND_S = 60.0
STOP_BOUND_S = 60.0
LISTENS = re.compile(r"127\.0\.0\.1:(\d+)")


class Appliance:
    """A context manager. It fails the test when the daemon dies, exits with another code than `ends_with`, or a sanitizer
    complains."""

    def __init__(self, pace="as-fast-as-computed", own_tree=False, own_verdicts=False, program=BUILD / "bin/rmacd",
                 **configuration):
        self._folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.folder = pathlib.Path(self._folder.name)
        self.program = program
        self.tree = BUILD / "drivers"
        if own_tree:
            self.tree = self.folder / "drivers"
            shutil.copytree(BUILD / "drivers", self.tree)
        settings = {
            "listen": {"address": "127.0.0.1", "port": 0},
            "state_folder": "state",
            "device_tree": str(self.tree),
            "pace": pace,
            "real_time": {"degraded_allowed": True, "lock_memory": False},
        }
        settings.update(configuration)
        # What one of the build's appliances verified another one need not; a verdict says for which files it holds.
        verified = BUILD / "verified"
        verified.mkdir(exist_ok=True)
        state = self.folder / settings["state_folder"]
        state.mkdir(exist_ok=True)
        if not own_verdicts and not (state / "verified").exists():
            (state / "verified").symlink_to(verified)
        self.configuration = self.folder / "rmacd.json"
        self.configuration.write_text(json.dumps(settings))
        self.log = []
        self._logged = threading.Condition()
        self.clients = []
        self.port = None
        self.ends_with = 0

    def __enter__(self):
        self.process = subprocess.Popen(
            [self.program, "--config", self.configuration],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            errors="backslashreplace")
        lines = queue.Queue()
        self._reader = threading.Thread(target=self._read_log, args=(lines,))
        self._reader.start()
        while self.port is None:
            line = lines.get(timeout=START_BOUND_S)
            if line is None:
                raise AssertionError("rmacd ended at once:\n" + "".join(self.log))
            if (match := LISTENS.search(line)) is not None:
                self.port = int(match.group(1))
        return self

    def __exit__(self, kind, error, trace):
        for client in self.clients:
            client.close()
        code = self.end()
        log = "".join(self.log)
        self._folder.cleanup()
        if error is not None:
            print(f"--- rmacd's log, exit code {code}:\n{log}---")
        elif code != self.ends_with or "Sanitizer" in log or "runtime error:" in log:
            raise AssertionError(f"rmacd ended with {code}:\n{log}")

    def end(self):
        """Ends the daemon; returns its exit code. Its log is complete then."""
        self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(timeout=STOP_BOUND_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
            code = self.process.wait()
        self._reader.join()
        return code

    def _read_log(self, lines):
        for line in self.process.stderr:
            with self._logged:
                self.log.append(line)
                self._logged.notify_all()
            lines.put(line)
        self.process.stderr.close()
        lines.put(None)

    def wait_for_log(self, text):
        """Until a line of the daemon's log holds `text`."""
        with self._logged:
            if not self._logged.wait_for(lambda: any(text in line for line in self.log), START_BOUND_S):
                raise AssertionError(f"rmacd did not log \"{text}\":\n" + "".join(self.log))

    def client(self, name="test", **options):
        client = Client(self.port, name, **options)
        self.clients.append(client)
        return client

    def operator(self, machine="DMACXYZ"):
        """A client that holds authority over a loaded machine, which stands at home.

        A drive stands where it stands, to the encoder's count; the first path begins at zero exactly."""
        client = self.client("operator")
        client.call("authority.acquire")
        client.call("Device.Load", Name=machine)
        client.call("RMAC_CAM.Home")
        wait_for_rest(client)
        while client.state()["state"] != "Idle":  # The state follows the last motion by a cycle or two.
            pass
        return client

    def rmac(self, *words, bound_s=120, **options):
        """Runs the command line client to its end."""
        return subprocess.run(
            [BUILD / "bin" / "rmac", "--port", str(self.port), *words],
            stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=bound_s, check=False, **options)


def pose(x, y, z):
    return {"p": [x, y, z], "axis": [0, 0, 1]}


def line(start, end, move_id=1):
    """Parameters of MoveAlongLine."""
    return {"MoveID": move_id, "StartPoint": pose(*start), "EndPoint": pose(*end)}


def wait_for_rest(client):
    """The state once nothing moves and nothing is queued."""
    client.call("subscribe", topics=["state"], rate_hz=100)
    state = client.state()
    while state["moving"] or state["moves_in_buffer"] > 0:
        client.wait_note("state")
        state = client.state()
    client.call("unsubscribe", topics=["state"])
    client.notes.clear()
    return state


def run_to_rest(client):
    """Starts the cycle and returns the state when the queue is done."""
    client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
    return wait_for_rest(client)

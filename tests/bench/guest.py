"""What the scenarios of the appliance share, inside the emulated machine: the installed appliance, its drives, and waiting for things."""

import contextlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "system"))
import client  # noqa: E402

BENCH = pathlib.Path(__file__).parent
PREFIX = pathlib.Path("/usr/local")
TREE = PREFIX / "lib/rmac/drivers"
CONFIGURATION = PREFIX / "etc/rmac/rmacd.json"
RUN = pathlib.Path("/run/bench")
PORT = 7402
HEARTBEAT_MS = 50
COUNTS_PER_REVOLUTION = 131072
PITCH_MM = 5
HAS_GPIO = pathlib.Path(os.environ.get("GPIO_SIM", "/none")).exists()


def call(*words):
    done = subprocess.run([str(word) for word in words], text=True, capture_output=True)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}: exit code {done.returncode}: {done.stderr}")
    return done.stdout


def rmac(*words):
    return call("rmac", "--port", PORT, *words)


def wait_for(what, reached, seconds=30.0, look_s=0.02):
    end = time.monotonic() + seconds
    while not (found := reached()):
        if time.monotonic() > end:
            raise SystemExit(f"{what}: waited {seconds} s")
        time.sleep(look_s)
    return found


def chosen(kind, kinds):
    """The one that was asked for, or all."""
    if kind not in ("", *kinds):
        raise SystemExit(f"there is no kind {kind}, only {', '.join(kinds)}")
    return [kind] if kind else kinds


def install(build):
    """What `cmake --install` made for this scenario, into this machine: in memory, and with it what the programs are linked with, because a page
    that had to come from the host in mid-cycle would cost cycles."""
    RUN.mkdir()
    scenario = pathlib.Path(sys.argv[0]).name.removesuffix("-guest.py")
    shutil.copytree(build / f"tests/bench/{scenario}.root", "/", dirs_exist_ok=True)
    for program in ("sbin/rmacd", "bin/rmac", "bin/rmac-vdrive", "bin/rmac-vmodbus", "libexec/rmac/rmac-verify"):
        for library in re.findall(r"=> (/\S+)", call("ldd", PREFIX / program)):
            pathlib.Path(library).read_bytes()


def on_buses(mechanism, change):
    """Has an installed machine drive what hangs on buses: its axes are those of vcan0; `change` says the rest. Returns its device.json."""
    (file,) = TREE.glob(f"*/*/{mechanism}/device.json")
    device = json.loads(file.read_text())
    for actuator in device["Actuators"]:
        actuator["Bus"] = "vcan0"
        actuator.pop("Cogging", None)
    for joint in device["Joints"] + device["HeldJoints"]:  # a bus answers one cycle later than the simulated drives do: softer gains
        joint["Gains"] = [400, 15000, 6.5]
        joint["ServoControlLaw"]["Parameters"] = {"rest_band": 0.002}  # nothing hangs on these drives; they stick, and would hunt
        for absent in ("ForceSensor", "ForceControl", "Resonances", "LowPass"):
            joint.pop(absent, None)
    change(device)
    file.write_text(json.dumps(device))
    (file.parent / "canopen").mkdir(exist_ok=True)
    shutil.copy(PREFIX / "share/rmac/rmac-vdrive.eds", file.parent / "canopen")
    return file


def make_can(*names):
    for name in names:
        call("ip", "link", "add", "dev", name, "type", "vcan")


def emergency_stop_on_gpio(device):
    device["DigitalIOInterface"] = {
        "Module": "GPIOInterface", "Inputs": {"EmergencyStop": 0}, "Outputs": {"Coolant": 0},
        "Parameters": {"chip": "io", "input_0": "!estop-nc estop-no", "output_0": "coolant"}}


def make_gpio():
    call("bash", BENCH / "simulated-gpio.sh")
    press(False)


def press(pressed):
    """The two contacts of the emergency stop: line 0 opens, line 1 closes."""
    chip = next(pathlib.Path("/sys/devices/platform").glob("gpio-sim.*/gpiochip*"))
    for line, up in ((0, not pressed), (1, pressed)):
        (chip / f"sim_gpio{line}/pull").write_text("pull-up" if up else "pull-down")


_watcher = []


def answers():
    """Whether the appliance does: the connection stays for `status`, because a program a look would take the emulated processor's time."""
    while _watcher:
        _watcher.pop().close()
    with contextlib.suppress(OSError):
        _watcher.append(client.Client(PORT, "watcher"))
    return bool(_watcher)


def operator():
    """A connection of its own with motion authority, once the appliance answers."""
    def connected():
        with contextlib.suppress(OSError):
            return client.Client(PORT, "operator")
        return None

    connection = wait_for("the appliance answers", connected)
    connection.call("authority.acquire")
    return connection


def status():
    return _watcher[0].state()


class Peer:
    """A program that takes commands and prints what becomes of them."""

    def __init__(self, name, words):
        self.log = RUN / f"{name}.log"
        self.commands = RUN / f"{name}.commands"
        os.mkfifo(self.commands)
        # A drive answers in time whatever else its processor does.
        self.process = subprocess.Popen(["chrt", "--fifo", "40", *words, "--commands", self.commands], stdout=self.log.open("w"))

    def tell(self, command):
        self.commands.write_text(command + "\n")

    def ask(self, command, pattern):
        """Every match of the pattern in what it printed since, once there is one."""
        before = len(self.log.read_text())
        self.tell(command)
        return wait_for(f"an answer to {command}", lambda: re.findall(pattern, self.log.read_text()[before:], re.MULTILINE))


class Drives(Peer):
    def __init__(self, interface, *nodes, name=None):
        super().__init__(name or interface, ["rmac-vdrive", interface, *map(str, nodes)])
        self._read = 0
        self._changes = []

    def changes(self, after=0.0):
        """(time, node, state, position), as they came."""
        text = self.log.read_text()
        whole = text.rfind("\n") + 1
        rows = re.findall(r"^(\S+) node (\d+) (\S+) at (\S+)$", text[self._read:whole], re.MULTILINE)
        self._read = whole
        self._changes += [(float(t), int(node), state, float(position)) for t, node, state, position in rows]
        return [change for change in self._changes if change[0] > after]

    def states(self):
        return {node: state for _, node, state, _ in self.changes()}

    def in_state(self, state, after=0.0):
        """{node: (time, position)} of the first time after `after` that each came into it."""
        first = {}
        for t, node, entered, position in self.changes(after):
            if entered == state:
                first.setdefault(node, (t, position))
        return first

    def stops_after(self, moment, seconds=5):
        """When each went into quick stop, ms after the moment."""
        wait_for("every drive stops", lambda: self.in_state("quick-stop", moment).keys() == self.states().keys(), seconds)
        return {node: (t - moment) * 1e3 for node, (t, _) in self.in_state("quick-stop", moment).items()}

    def positions_mm(self):
        return {int(node): float(shaft) / COUNTS_PER_REVOLUTION * PITCH_MM
                for node, shaft in self.ask("all status", r"^node (\d+) .* shaft at (\S+)$")}


def axes_alone(*nodes, **parameters):
    """What `on_buses` does to a machine for figures: axes on vcan0, and nothing else on any bus."""
    def change(device):
        device["Spindles"] = []
        device["DigitalIOInterface"] = {"Module": "SimulatedIOInterface"}
        device["DigitalControlInterface"] = {
            "Module": "CANopenInterface",
            "Parameters": {"vcan0.node": list(nodes), "eds": "rmac-vdrive", "heartbeat_ms": HEARTBEAT_MS, "tpdo": "6041:00/16 6064:00/32"} | parameters}
    return change


def diagonal(seconds):
    """A program that goes to and fro along a diagonal of DMACXYZ, for so long and a little longer."""
    def move(number):
        near, far = [-40, -40, -40], [40, 40, 40]
        start, end = (near, far) if number % 2 else (far, near)
        return {"MoveID": number, "StartPoint": {"p": start, "axis": [0, 0, 1]}, "EndPoint": {"p": end, "axis": [0, 0, 1]}}

    feed_mm_min, length_mm = 2000, 80 * 3**0.5
    moves = int(seconds * feed_mm_min / 60 / length_mm) + 4
    requests = [("RMAC_CAM.SetFeedrate", {"Feedrate": feed_mm_min}),
                ("RMAC_CAM.MoveToPathTarget", {"MoveID": 0, "TargetFrame": {"p": [-40, -40, -40], "axis": [0, 0, 1]}}),
                *(("RMAC_CAM.MoveAlongLine", move(number)) for number in range(1, moves))]
    file = RUN / "diagonal.rmac"
    file.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}) + "\n"
                            for number, (method, params) in enumerate(requests)))
    return file


class Figures:
    """A line of JSON each, as it is known."""

    def __init__(self):
        self.good = True

    def at_most(self, name, value, target, unit, note=""):
        self._tell(name, value, unit, f"<= {target:g}", value <= target, note)

    def inform(self, name, value, unit, note=""):
        self._tell(name, value, unit, "", True, note)

    def _tell(self, name, value, unit, target, good, note):
        self.good &= good
        print(json.dumps({"name": name, "value": value, "unit": unit, "target": target, "ok": good, "note": note}), flush=True)


def milliseconds(times):
    return ", ".join(f"{ms:.1f} ms" for ms in times)


def stop_by_emergency(*drives):
    before = time.monotonic()
    press(True)
    late_ms = [ms for bus in drives for ms in bus.stops_after(before).values()]
    print(f"emergency stop: quick stop after {milliseconds(late_ms)}")
    assert max(late_ms) <= 20, "an edge acts in the cycle after it"
    wait_for("the machine says so", lambda: status()["state"] == "EmergencyStop")


def check_emergency_stop(*drives):
    """Of a machine at rest: it is stopped, and holds again once the stop is released and the machine reset."""
    stop_by_emergency(*drives)
    person = operator()
    assert "release it" in person.refusal("RMAC_CAM.Reset").message
    press(False)
    time.sleep(0.1)  # longer than the debounce time
    person.call("RMAC_CAM.Reset")
    person.close()
    wait_for("the drives hold again", lambda: status()["state"] == "Idle" and all(
        set(bus.states().values()) == {"operation-enabled"} for bus in drives))

#!/usr/bin/python3
"""Inside the emulated machine: rmacd drives the example mill over vcan0 (three axes) and vcan1 (its spindle)."""

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

BUILD = pathlib.Path(sys.argv[1])
RUN = pathlib.Path("/run/bench")
TREE = RUN / "drivers"
HEARTBEAT_MS = 50
COUNTS_PER_REVOLUTION = 131072
HAS_GPIO = pathlib.Path(os.environ.get("GPIO_SIM", "/none")).exists()


def call(*words):
    return subprocess.run([str(word) for word in words], check=True, text=True, capture_output=True).stdout


def rmac(*words):
    return call(BUILD / "bin/rmac", "--host", "127.0.0.1", "--port", 7402, *words)


def wait_for(what, reached, seconds=30.0):
    end = time.monotonic() + seconds
    while not reached():
        if time.monotonic() > end:
            raise SystemExit(f"{what}: waited {seconds} s")
        time.sleep(0.02)


def press(pressed):
    """The two contacts of the emergency stop: line 0 opens, line 1 closes."""
    chip = next(pathlib.Path("/sys/devices/platform").glob("gpio-sim.*/gpiochip*"))
    for line, up in ((0, not pressed), (1, pressed)):
        (chip / f"sim_gpio{line}/pull").write_text("pull-up" if up else "pull-down")


def state():
    return json.loads(rmac("status", "--json"))["state"]


def check_emergency_stop(*drives):
    before = time.monotonic()
    press(True)
    wait_for("every drive stops", lambda: all(
        any(t > before and drive == node and change == "quick-stop" for t, drive, change, _ in bus.changes())
        for bus in drives for node in bus.states()), 5)
    late_ms = [(next(t for t, drive, change, _ in bus.changes() if t > before and drive == node and change == "quick-stop") - before) * 1e3
               for bus in drives for node in bus.states()]
    print("emergency stop: quick stop after " + ", ".join(f"{ms:.1f} ms" for ms in late_ms))
    assert max(late_ms) <= 20, "an edge acts in the cycle after it"
    wait_for("the machine says so", lambda: state() == "EmergencyStop")
    operator = client.Client(7402, "operator")
    operator.call("authority.acquire")
    assert "release it" in operator.refusal("RMAC_CAM.Reset").message
    press(False)
    time.sleep(0.1)  # longer than the debounce time
    operator.call("RMAC_CAM.Reset")
    operator.close()
    wait_for("the drives hold again", lambda: state() == "Idle" and all(
        set(bus.states().values()) == {"operation-enabled"} for bus in drives))


def prepare():
    for name in ("vcan0", "vcan1"):
        call("ip", "link", "add", "dev", name, "type", "vcan")
        call("ip", "link", "set", name, "txqueuelen", 256, "up")
    call("ip", "link", "set", "lo", "up")
    folder = TREE / "mill/3-axis/DMACXYZ"
    shutil.copytree(BUILD / "drivers/mill/3-axis/DMACXYZ", folder)
    shutil.copytree(BUILD / "drivers/modules", TREE / "modules")
    device = json.loads((folder / "device.json").read_text())
    for actuator in device["Actuators"]:
        actuator["Bus"] = "vcan0"
    device["Spindles"][0].update(Bus="vcan1", Axis=0)
    for joint in device["Joints"]:  # a bus answers one cycle later than the simulated drives do: softer gains
        joint["Gains"] = [400, 15000, 6.5]
        joint["ServoControlLaw"].pop("Parameters", None)  # nothing hangs on these drives
    for axis, turn in enumerate((2, 2, 1)):
        device["Actuators"][axis]["HomingTurn"] = turn
    device["DigitalControlInterface"] = {
        "Module": "CANopenInterface",
        "Parameters": {"vcan0.node": [1, 2, 3], "vcan1.node": 4, "vcan1.mode": 3, "vcan0.homing_method": [7, 8, 10],
                       "vcan1.velocity_units_per_rpm": COUNTS_PER_REVOLUTION / 60, "eds": "rmac-vdrive",
                       "heartbeat_ms": HEARTBEAT_MS}}
    if HAS_GPIO:
        call("bash", pathlib.Path(__file__).parent / "simulated-gpio.sh")
        device["DigitalIOInterface"] = {
            "Module": "GPIOInterface", "Inputs": {"EmergencyStop": 0}, "Outputs": {"Coolant": 0},
            "Parameters": {"chip": "io", "input_0": "!estop-nc estop-no", "output_0": "coolant"}}
        press(False)
    (folder / "canopen").mkdir()
    (folder / "canopen/rmac-vdrive.eds").write_text(call(BUILD / "bin/rmac-vdrive", "--print-eds"))
    (folder / "device.json").write_text(json.dumps(device))
    (RUN / "rmacd.json").write_text(json.dumps({
        "listen": {"address": "127.0.0.1", "port": 7402}, "state_folder": str(RUN / "state"), "device_tree": str(TREE)}))
    return folder / "device.json"


class Drives:
    def __init__(self, interface, *nodes):
        self.log = RUN / f"{interface}.log"
        self.commands = RUN / f"{interface}.commands"
        os.mkfifo(self.commands)
        # A drive answers in time whatever else its processor does.
        self.process = subprocess.Popen(["chrt", "--fifo", "40", BUILD / "bin/rmac-vdrive", "--commands", self.commands, interface, *map(str, nodes)],
                                        stdout=self.log.open("w"))

    def tell(self, command):
        self.commands.write_text(command + "\n")

    def changes(self):
        """(time, node, state, position), as they came."""
        rows = re.findall(r"^(\S+) node (\d+) (\S+) at (\S+)$", self.log.read_text(), re.MULTILINE)
        return [(float(t), int(node), state, float(position)) for t, node, state, position in rows]

    def states(self):
        return {node: state for _, node, state, _ in self.changes()}


def main():
    device = prepare()
    print(call(BUILD / "bin/rmac", "bus", "load", device))
    table = Drives("vcan0", 1, 2, 3)
    head = Drives("vcan1", "--spindle", 4)
    print(call(BUILD / "bin/rmac", "bus", "scan", "vcan0", "--eds", device.parent / "canopen"))
    found = json.loads(call(BUILD / "bin/rmac", "--json", "bus", "scan", "vcan0", "--eds", device.parent / "canopen"))
    assert [(node["node"], node["name"], node["files"]) for node in found] == [
        (node, "rmac-vdrive", ["rmac-vdrive.eds"]) for node in (1, 2, 3)], found
    print(call(BUILD / "bin/rmac", "bus", "store", "vcan0", 2))
    daemon = subprocess.Popen([BUILD / "bin/rmacd",
                               "--config", RUN / "rmacd.json"])
    wait_for("the daemon answers", lambda: subprocess.run(
        [BUILD / "bin/rmac", "--port", "7402", "status", "--json"], capture_output=True).returncode == 0)
    rmac("load", "DMACXYZ")
    print("loaded:", table.states(), head.states())
    rmac("home")
    joints = json.loads(rmac("status", "--json"))["joints"]
    print("homed:", joints, {change for *_, change, _ in table.changes()})
    assert all(abs(joint) < 1 for joint in joints), "each stands near its home, which is its zero"
    if HAS_GPIO:
        check_emergency_stop(table, head)
    rmac("jog", "--joint", 0, "--distance", 5)
    status = json.loads(rmac("status", "--json"))
    print("after a jog of 5 mm:", json.dumps(status)[:600])
    assert set(table.states().values()) == {"operation-enabled"}, table.states()

    scan = subprocess.run([BUILD / "bin/rmac", "bus", "scan", "vcan0"], capture_output=True, text=True)
    assert scan.returncode == 1 and "a machine runs on this bus" in scan.stderr, scan
    table.tell("1 status")
    wait_for("the drives answer a command", lambda: "node 1 operational operation-enabled" in table.log.read_text())
    rmac("jog", "--joint", 0, "--distance", -50)  # to -45
    jog = subprocess.Popen([BUILD / "bin/rmac", "--port", "7402", "jog", "--joint", "0", "--distance", "90"])
    wait_for("the jog is under way", lambda: json.loads(rmac("status", "--json"))["joints"][0] > -44)
    killed = time.monotonic()
    daemon.kill()
    jog.wait()
    def stops_now():
        return [(t, node, position) for drives in (table, head) for t, node, state, position in drives.changes()
                if state == "quick-stop" and t > killed]

    wait_for("all drives stop", lambda: len(stops_now()) == 4, 5)
    stops = stops_now()
    late_ms = [(t - killed) * 1e3 for t, _, _ in stops]
    x_mm = next(position for _, node, position in stops if node == 1) / COUNTS_PER_REVOLUTION * 5
    print(f"killed at {x_mm:.3f} mm of X; quick stop after " + ", ".join(f"{ms:.1f} ms" for ms in late_ms))
    assert len(stops) == 4 and max(late_ms) <= 2 * HEARTBEAT_MS
    assert -44.9 < x_mm < 44.9, "it was not killed in mid-move"
    print("ok")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""Inside the emulated machine: the appliance dies in each of four ways, again and again, while it moves; how long each drive takes to stop.
The argument is the build folder, how many deaths of each kind, and of which kind alone, if not of every one."""

import ctypes
import json
import os
import pathlib
import random
import signal
import subprocess
import sys
import time

from guest import HEARTBEAT_MS, RUN, Drives, Figures, axes_alone, call, chosen, install, make_can, on_buses, operator, wait_for

WANTED = 200
BUILD, COUNT, KIND = sys.argv[1].split(",")
KINDS = chosen(KIND, ("sigkill", "sigstop", "hung_loop", "cut_cable"))
NODES = (1, 2, 3)
PTRACE_SEIZE, PTRACE_INTERRUPT, WALL = 0x4206, 0x4207, 0x40000000


def prepare():
    install(pathlib.Path(BUILD))
    make_can("vcan0")
    call("ip", "link", "set", "vcan0", "txqueuelen", 256, "up")
    call("ip", "link", "set", "lo", "up")
    on_buses("DMACXYZ", axes_alone(*NODES))
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state"), "autoload": {"mechanism": "DMACXYZ"},
                                                "flight_recorder": {"seconds": 0.1}}))


class Appliance:
    def __init__(self, drives):
        begun = time.monotonic()
        self.process = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=(RUN / "rmacd.log").open("a"))
        wait_for("the drives hold", lambda: drives.in_state("operation-enabled", begun).keys() == set(NODES), 60)
        self.client = operator()
        self.held = 0  # a thread

    def move(self):
        """Joint 0 is under way, to one side or back."""
        joint = self.client.state()["joints"][0]
        self.client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=-40 - joint if joint > 0 else 40 - joint)
        wait_for("the jog is under way", lambda: abs(self.client.state()["feed_actual_mm_min"]) > 600 or abs(
            self.client.state()["joints"][0] - joint) > 1)

    def servo_thread(self):
        """The one thread that is scheduled by SCHED_FIFO at 80."""
        for task in pathlib.Path(f"/proc/{self.process.pid}/task").iterdir():
            if "SCHED_FIFO" in call("chrt", "--pid", task.name) and "priority: 80" in call("chrt", "--pid", task.name):
                return int(task.name)
        raise SystemExit("there is no servo thread")

    def end(self):
        self.client.close()
        self.process.kill()
        # Whoever holds a thread is told of its end, and the process ends only then.
        while self.held:
            _, status = os.waitpid(self.held, WALL)
            if os.WIFSIGNALED(status) or os.WIFEXITED(status):
                self.held = 0
        self.process.wait()


def hang(appliance, thread):
    """Holds one thread where it is; the others go on."""
    appliance.held = thread
    libc = ctypes.CDLL(None, use_errno=True)
    for request in (PTRACE_SEIZE, PTRACE_INTERRUPT):
        if libc.ptrace(request, thread, None, None) != 0:
            raise OSError(ctypes.get_errno(), "ptrace")


class Witness:
    """Sees every SYNC on the bus by the kernel's clock, as long as the bus is there."""

    def __init__(self):
        self._log = RUN / "sync.log"
        self._candump = subprocess.Popen(["candump", "-L", "vcan0,080:7FF"], stdout=self._log.open("w"), stderr=subprocess.DEVNULL)

    def last(self):
        self._candump.terminate()
        self._candump.wait()
        stamp = self._log.read_text().splitlines()[-1].split()[0].strip("()")
        return float(stamp) - time.time() + time.monotonic()


def die(kind, drives, random_number):
    """One death: ms until each drive stops."""
    appliance = Appliance(drives)
    witness = Witness() if kind == "cut_cable" else None
    thread = appliance.servo_thread() if kind == "hung_loop" else 0
    appliance.move()
    time.sleep(random_number.uniform(0, 2 * HEARTBEAT_MS / 1000))
    died = time.monotonic()
    if kind == "sigkill":
        appliance.process.kill()
    elif kind == "sigstop":
        appliance.process.send_signal(signal.SIGSTOP)
    elif kind == "hung_loop":
        hang(appliance, thread)
    else:  # which takes the kernel tenths of a second at times, while frames still pass
        call("ip", "link", "set", "vcan0", "down")
        died = witness.last()
    late_ms = drives.stops_after(died)
    if kind == "cut_cable":
        call("ip", "link", "set", "vcan0", "up")
    appliance.end()
    return list(late_ms.values())


def main():
    prepare()
    drives = Drives("vcan0", *NODES)
    figures = Figures()
    random_number = random.Random(1)
    count = int(COUNT)
    for kind in KINDS:
        late_ms = sorted(ms for _ in range(count) for ms in die(kind, drives, random_number))
        assert len(late_ms) == count * len(NODES)
        note = f"{count} deaths in mid-move, {len(late_ms)} stops" + ("" if count >= WANTED else f"; {WANTED} wanted")
        figures.at_most(f"death_{kind}_quick_stop_max", round(late_ms[-1], 1), 2 * HEARTBEAT_MS, "ms", note)
        figures.inform(f"death_{kind}_quick_stop_median", round(late_ms[len(late_ms) // 2], 1), "ms")
    sys.exit(0 if figures.good else 1)


main()

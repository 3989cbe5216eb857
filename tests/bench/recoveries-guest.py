#!/usr/bin/python3
"""Inside the emulated machine: the bus of an appliance in mid-move goes away and comes back, again and again: its interface goes down, its controller is
off the bus, a drive is reset by somebody else, a drive's program is killed and started again. How soon all drives are operational again, what the
appliance's processor time is meanwhile, and that nothing moves before a person says so. The argument is the build folder, how many
of each kind, and of which kind alone, if not of every one."""

import json
import pathlib
import random
import subprocess
import sys
import time

import can
from guest import HEARTBEAT_MS, RUN, Drives, Figures, axes_alone, call, chosen, install, make_can, on_buses, operator, wait_for

WANTED = 20
BUILD, COUNT, KIND = sys.argv[1].split(",")
KINDS = chosen(KIND, ("interface_down", "bus_off", "node_reset", "drive_restarted"))
LAST = 3  # the node with a program of its own
LOOK_S = 0.5
FEED_MM_MIN = 1200
STANDS_COUNTS = 300  # 0.01 mm
BACK_MS = 2000
MOST_TIMES_NORMAL = 1.2
BUS_OFF, RESTARTED = 0x40, 0x100  # linux/can/error.h


def prepare():
    install(pathlib.Path(BUILD))
    make_can("vcan0")
    call("ip", "link", "set", "vcan0", "txqueuelen", 256, "up")
    call("ip", "link", "set", "lo", "up")
    on_buses("DMACXYZ", axes_alone(1, 2, LAST))
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state"), "flight_recorder": {"seconds": 0}}))


def used_s(process):
    """Processor time of all its threads."""
    return sum(int(task.joinpath("schedstat").read_text().split()[0]) for task in pathlib.Path(f"/proc/{process.pid}/task").iterdir()) / 1e9


class Appliance:
    def __init__(self):
        self.process = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=(RUN / "rmacd.log").open("w"))
        self.client = operator()
        self.client.call("Device.Load", Name="DMACXYZ")
        self.client.call("RMAC_CAM.SetFeedrate", Feedrate=FEED_MM_MIN)

    def move(self):
        """Joint 0 is under way, to one side or back, and will be for longer than it is looked at."""
        joint = self.client.state()["joints"][0]
        self.client.call("RMAC_CAM.JogPath", Direction=[-1 if joint > 0 else 1, 0, 0], Distance=40)
        wait_for("the jog is under way", lambda: abs(self.client.state()["joints"][0] - joint) > 1)

    def load(self, meanwhile=lambda: None):
        """Its processor time over a while, as a share of it, and what came of what is done meanwhile."""
        begun, used = time.monotonic(), used_s(self.process)
        result = meanwhile()
        time.sleep(max(0, begun + LOOK_S - time.monotonic()))
        return (used_s(self.process) - used) / (time.monotonic() - begun), result

    def reset(self):
        self.client.call("RMAC_CAM.Reset")
        wait_for("it is ready again", lambda: self.client.state()["state"] == "Idle")


class Bus:
    """What an engineer's adapter on the same bus hears and sends."""

    def __init__(self):
        self._bus = can.Bus(interface="socketcan", channel="vcan0", can_filters=[{"can_id": 0x700, "can_mask": 0x780}])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._bus.shutdown()

    def reset_node(self, node):
        self._bus.send(can.Message(arbitration_id=0, data=[0x81, node], is_extended_id=False))

    def report(self, error_class):
        """What the driver of a controller tells every socket."""
        self._bus.send(can.Message(arbitration_id=error_class, data=bytes(8), is_error_frame=True, is_extended_id=False))

    def wait_operational(self, anew):
        """When each node's heartbeat says so; those of `anew` must have said something else before."""
        waited = {1, 2, LAST}
        left = set()
        end = time.monotonic() + 5 * BACK_MS / 1000
        while waited:
            message = self._bus.recv(1.0)
            if time.monotonic() > end:
                raise SystemExit(f"nodes {waited} are not operational")
            if message is None:
                continue
            node = message.arbitration_id - 0x700
            if message.is_error_frame or node not in waited:  # what came before the filter was set, too
                continue
            if message.data[0] != 5:
                left.add(node)
            elif node in left or node not in anew:
                waited.remove(node)
        return time.monotonic()


class Plant:
    """The drives of nodes 1 and 2, and those of node 3, whose program may be killed."""

    def __init__(self):
        self.stays = Drives("vcan0", 1, 2)
        self._started = 0
        self.start_last()

    def start_last(self):
        self._started += 1
        self.last = Drives("vcan0", LAST, name=f"last{self._started}")

    def kill_last(self):
        self.last.process.kill()
        self.last.process.wait()

    def positions(self):
        return {node: float(shaft) for drives in (self.stays, self.last)
                for node, shaft in drives.ask("all status", r"^node (\d+) .* shaft at (\S+)$")}


def set_link(state):
    call("ip", "link", "set", "vcan0", state)


def go_away(kind, appliance, plant):
    """The bus goes away and comes back: the appliance's processor time meanwhile, and ms until every drive is operational."""
    if kind == "node_reset":
        with Bus() as bus:
            begun = time.monotonic()
            bus.reset_node(LAST)
            load, back = appliance.load(lambda: bus.wait_operational({LAST}))
        return load, (back - begun) * 1e3
    if kind == "drive_restarted":
        plant.kill_last()
        load, _ = appliance.load()
        with Bus() as bus:
            begun = time.monotonic()
            plant.start_last()
            return load, (bus.wait_operational({LAST}) - begun) * 1e3
    if kind == "bus_off":
        with Bus() as bus:
            bus.report(BUS_OFF)
    set_link("down")
    load, _ = appliance.load()
    set_link("up")
    begun = time.monotonic()
    with Bus() as bus:
        if kind == "bus_off":
            bus.report(RESTARTED)
        return load, (bus.wait_operational({1, 2, LAST}) - begun) * 1e3


def recover(kind, appliance, plant, random_number):
    """Processor time in mid-move and while the bus is away, and ms until every drive is operational again."""
    appliance.move()
    time.sleep(random_number.uniform(0, 2 * HEARTBEAT_MS / 1000))
    normal, _ = appliance.load()
    assert appliance.client.state()["moving"], "the jog ended before its time"
    away, back_ms = go_away(kind, appliance, plant)
    time.sleep(LOOK_S)  # in quick stop they still brake
    before = plant.positions()
    time.sleep(1)
    after = plant.positions()
    assert all(abs(after[node] - before[node]) <= STANDS_COUNTS for node in after), (kind, before, after)
    now = appliance.client.state()
    assert now["state"] == "Faulted" and not now["moving"], (kind, now)
    appliance.reset()
    return normal, away, back_ms


def main():
    prepare()
    plant = Plant()
    appliance = Appliance()
    figures = Figures()
    random_number = random.Random(1)
    count = int(COUNT)
    for kind in KINDS:
        normal, away, back_ms = zip(*(recover(kind, appliance, plant, random_number) for _ in range(count)))
        note = f"{count} times in mid-move" + ("" if count >= WANTED else f"; {WANTED} wanted")
        figures.at_most(f"recovery_{kind}_max", round(max(back_ms), 1), BACK_MS, "ms", note)
        figures.at_most(f"recovery_{kind}_processor_time", round(sum(away) / sum(normal), 2), MOST_TIMES_NORMAL, "times normal", note)
    sys.exit(0 if figures.good else 1)


main()

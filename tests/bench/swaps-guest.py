#!/usr/bin/python3
"""Inside the emulated machine: the adapter of a spindle is swapped, CANopen on vcan1 for Modbus and back, again and again, while three axes hold on
vcan0 at 1 kHz and a client follows every cycle. The argument is the build folder and how many swaps."""

import json
import pathlib
import re
import subprocess
import sys
import threading

from guest import COUNTS_PER_REVOLUTION, PORT, RUN, Drives, Figures, Peer, axes_alone, call, client, install, make_can, on_buses, operator

WANTED = 1000
PERIOD_S = 0.001
BUILD, COUNT = sys.argv[1].split(",")
NODES = (1, 2, 3)


def spindle(**choice):
    def change(device):
        spindles = device["Spindles"]
        axes_alone(*NODES, **{f"{choice['Bus']}.{name}": value for name, value in choice["Parameters"].items()})(device)
        device["Spindles"] = [spindles[0] | {"Bus": choice["Bus"], "Axis": 0, "RatedTorque": 0}]
    return change


def prepare():
    install(pathlib.Path(BUILD))
    call("ip", "link", "set", "lo", "up")
    make_can("vcan0", "vcan1")
    for name in ("vcan0", "vcan1"):
        call("ip", "link", "set", name, "txqueuelen", 256, "up")
    on_buses("DMACXYZ", spindle(Bus="vcan1", Parameters={
        "node": 4, "mode": 3, "velocity_units_per_rpm": COUNTS_PER_REVOLUTION / 60, "eds": "rmac-vdrive"}))
    on_buses("DMACXY", spindle(Bus="spindle0", Parameters={
        "interface": "ModbusInterface", "device": str(RUN / "spindle"), "bit_rate": 19200, "slave": [1], "map": "delta-vfd-b", "rpm_per_hz": 60}))
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state")}))


class Follower(threading.Thread):
    """Takes every cycle that it is sent, and looks at none."""

    def __init__(self):
        super().__init__(daemon=True)
        self._client = client.Client(PORT, "follower")
        self._client.call("subscribe", topics=["drives"], rate_hz=1000)

    def run(self):
        while self._client._input.readline():
            pass


def resident_kib(process):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{process.pid}/status").read_text()).group(1))


def main():
    prepare()
    axes, head = Drives("vcan0", *NODES), Drives("vcan1", "--spindle", 4)
    Peer("spindle0", ["rmac-vmodbus", "1=delta-vfd-b", "--pty", RUN / "spindle"])
    daemon = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=(RUN / "rmacd.log").open("w"))
    person = operator()
    for name in ("DMACXY", "DMACXYZ"):  # so that both are verified
        person.call("Device.Load", Name=name)
    Follower().start()
    log = RUN / "vcan0.sync"
    witness = subprocess.Popen(["candump", "-L", "vcan0,080:7FF"], stdout=log.open("w"))
    begun = person.state()
    memory = []
    swaps = int(COUNT)
    for turn in range(swaps):
        person.call("Device.Load", Name=("DMACXY", "DMACXYZ")[turn % 2])
        memory.append(resident_kib(daemon))
    ended = person.state()
    witness.terminate()
    witness.wait()
    times = [float(line.split()[0].strip("()")) for line in log.read_text().splitlines()]
    gaps_s = [b - a for a, b in zip(times, times[1:])]
    assert len(gaps_s) > 0.99 * (ended["cycle"] - begun["cycle"]), (len(gaps_s), begun["cycle"], ended["cycle"])
    assert set(axes.states().values()) == {"operation-enabled"} and head.changes(), "the axes hold throughout, the spindle comes and goes"
    figures = Figures()
    note = f"{swaps} swaps in {len(gaps_s)} cycles" + ("" if swaps >= WANTED else f"; {WANTED} wanted")
    figures.at_most("adapter_swap_sync_gap_max", round(max(gaps_s) * 1e3, 3), 1.5 * PERIOD_S * 1e3, "ms", note)
    settled = memory[len(memory) // 5:]
    figures.at_most("adapter_swap_memory_growth", settled[-1] - settled[0], 1024, "KiB", "over the last four fifths")
    figures.inform("adapter_swap_missed_cycles", ended["deadline_misses"] - begun["deadline_misses"], "cycles")
    sys.exit(0 if figures.good else 1)


main()

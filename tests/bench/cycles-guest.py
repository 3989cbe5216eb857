#!/usr/bin/python3
"""Inside the emulated machine: the appliance moves three axes at 1 kHz, then six at 500 Hz, on one bus. Counts missed cycles, and compares SYNC, as
candump saw it, with what cyclictest sees meanwhile. The argument is the build folder and how many seconds each."""

import json
import pathlib
import re
import subprocess
import sys

from guest import PITCH_MM, RUN, Drives, Figures, answers, axes_alone, call, diagonal, install, make_can, on_buses, status, wait_for

WANTED_S = 600
BUILD, SECONDS = sys.argv[1].split(",")
SECONDS = int(SECONDS)
WITNESS_US = 997  # a period of its own, so that its wake-ups meet those of the servo loop at each distance
MOST_US = 2000


def six_axes(device):
    """Three more drives behind screws like the others', which hold their joints."""
    axes_alone(1, 2, 3, 4, 5, 6)(device)
    device["ActuatorMap"] = {"Module": "TransmissionMap", "Parameters": {"transmissions": "screw screw screw screw screw screw"} | {
        f"t{number}": [PITCH_MM, 1] for number in range(1, 7)}}
    for joint in device["Joints"]:
        joint.update(Gains=[100, 2000, 4.0], MaxFollowingError=5)
    device["HeldJoints"] = [dict(joint, Name=joint["Name"] + "2") for joint in device["Joints"]]
    device["Actuators"] += [dict(actuator, Axis=actuator["Axis"] + 3) for actuator in device["Actuators"]]


def prepare():
    install(pathlib.Path(BUILD))
    call("ip", "link", "set", "lo", "up")


def quantile(values, part):
    ordered = sorted(values)
    return ordered[min(int(part * len(ordered)), len(ordered) - 1)]


def latencies_us(histogram):
    """cyclictest's histogram as one value a wake-up."""
    return [int(late) for late, count in re.findall(r"^(\d{6}) (\d+)", histogram, re.MULTILINE) for _ in range(int(count))]


def measure(figures, name, nodes, period_s, change):
    interface = f"vcan{len(nodes)}"
    make_can(interface)
    call("ip", "link", "set", interface, "txqueuelen", 256, "up")

    def on_this_bus(device):
        change(device)
        for actuator in device["Actuators"]:
            actuator["Bus"] = interface
        parameters = device["DigitalControlInterface"]["Parameters"]
        parameters[f"{interface}.node"] = parameters.pop("vcan0.node")

    file = on_buses("DMACXYZ", on_this_bus)
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state"), "period_s": period_s}))
    print(call("rmac", "bus", "load", "--period", period_s, file))
    drives = Drives(interface, *nodes)
    daemon = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=(RUN / "rmacd.log").open("w"))
    wait_for("the daemon answers", answers)
    run = subprocess.Popen(["rmac", "run", diagonal(SECONDS), "--machine", "DMACXYZ"], stdout=subprocess.DEVNULL, stderr=(RUN / "run.log").open("w"))
    wait_for("it moves", lambda: status()["move_id"] >= 1, 120)
    log = (RUN / f"{interface}.sync").open("w")
    witness = subprocess.Popen(["candump", "-L", f"{interface},080:7FF"], stdout=log)
    begun = status()
    tester = subprocess.run(["cyclictest", "--quiet", "--mlockall", "--threads=1", "--priority=90", f"--interval={WITNESS_US}",
                             f"--loops={SECONDS * 1_000_000 // WITNESS_US}", f"--histogram={MOST_US}"], text=True, capture_output=True)
    ended = status()
    witness.terminate()
    witness.wait()
    assert run.poll() is None and ended["state"] == "Running" and ended["move_id"] > begun["move_id"], ended
    cycles = ended["cycle"] - begun["cycle"]
    times = [float(line.split()[0].strip("()")) for line in (RUN / f"{interface}.sync").read_text().splitlines()]
    off_us = [abs(b - a - period_s) * 1e6 for a, b in zip(times, times[1:])]
    plain_us = latencies_us(tester.stdout)
    assert len(off_us) > 0.99 * cycles and plain_us, (len(off_us), cycles, tester)
    note = f"{cycles} cycles in {cycles * period_s:.0f} s" + ("" if SECONDS >= WANTED_S else f"; {WANTED_S} s wanted")
    figures.at_most(f"missed_cycles_{name}", ended["deadline_misses"] - begun["deadline_misses"], 0, "cycles", note)
    figures.at_most(f"sync_gaps_{name}", sum(off > 500_000 * period_s for off in off_us), 0, "gaps", "over 1.5 periods, seen by candump")
    sync_us, bare_us = quantile(off_us, 0.999), quantile(plain_us, 0.999)
    figures.at_most(f"sync_jitter_p999_above_cyclictest_{name}", round(sync_us - bare_us, 1), 50, "us",
                    f"SYNC {sync_us:.0f} us, cyclictest {bare_us:.0f} us, {len(plain_us)} wake-ups; largest {max(off_us):.0f} and {max(plain_us)} us")
    subprocess.run(["rmac", "stop"], check=True, capture_output=True)
    run.wait()
    for process in (daemon, drives.process):
        process.terminate()
        process.wait()


def main():
    prepare()
    figures = Figures()
    measure(figures, "3_axes_1khz", (1, 2, 3), 0.001, axes_alone(1, 2, 3))
    measure(figures, "6_axes_500hz", range(1, 7), 0.002, six_axes)
    sys.exit(0 if figures.good else 1)


main()

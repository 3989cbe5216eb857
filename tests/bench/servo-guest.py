#!/usr/bin/python3
"""Inside the emulated machine: the appliance moves six joints on the simulated bus at 4 kHz. Counts missed cycles, and tells where the servo thread's time
goes. The argument is the build folder and how many seconds."""

import json
import pathlib
import subprocess
import sys

from guest import PITCH_MM, RUN, TREE, Figures, answers, call, diagonal, install, rmac, status, wait_for

WANTED_S = 60
PERIOD_S = 0.00025
BUILD, SECONDS = sys.argv[1].split(",")
SECONDS = int(SECONDS)


def six_joints():
    """Three more drives behind screws like the others', which hold their joints."""
    (file,) = TREE.glob("*/*/DMACXYZ/device.json")
    device = json.loads(file.read_text())
    device["ActuatorMap"] = {"Module": "TransmissionMap", "Parameters": {"transmissions": " ".join(["screw"] * 6)} | {
        f"t{number}": [PITCH_MM, 1] for number in range(1, 7)}}
    for joint in device["Joints"]:
        for absent in ("ForceSensor", "ForceControl"):
            joint.pop(absent, None)
    device["HeldJoints"] = [dict(joint, Name=joint["Name"] + "2") for joint in device["Joints"]]
    device["Actuators"] += [dict(actuator, Axis=actuator["Axis"] + 3) for actuator in device["Actuators"]]
    device["Spindles"] = []
    device["DigitalControlInterface"] = {"Module": "SimulatedInterface", "Parameters": {
        "axes": 6, "spindle": -1, "gravity_nm": [0, 0, 0.0937] * 2}}
    file.write_text(json.dumps(device))


def main():
    figures = Figures()
    install(pathlib.Path(BUILD))
    call("ip", "link", "set", "lo", "up")
    six_joints()
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state"), "period_s": PERIOD_S, "real_time": {"degraded_allowed": False}}))
    daemon = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=(RUN / "rmacd.log").open("w"))
    wait_for("the daemon answers", answers)
    run = subprocess.Popen(["rmac", "run", diagonal(SECONDS), "--machine", "DMACXYZ"], stdout=subprocess.DEVNULL, stderr=(RUN / "run.log").open("w"))
    wait_for("it moves", lambda: status()["move_id"] >= 1, 120)
    begun = status()
    wait_for("the time is over", lambda: status()["cycle"] >= begun["cycle"] + SECONDS / PERIOD_S, 2 * SECONDS + 10, look_s=0.5)
    ended = status()
    assert run.poll() is None and ended["state"] == "Running" and ended["move_id"] > begun["move_id"], ended
    print(rmac("cycles"))
    times = json.loads(rmac("cycles", "--json"))
    cycles = ended["cycle"] - begun["cycle"]
    note = f"{cycles} cycles of {1e6 * PERIOD_S:.0f} us" + ("" if SECONDS >= WANTED_S else f"; {WANTED_S} s wanted")
    figures.at_most("missed_cycles_6_joints_4khz", ended["deadline_misses"] - begun["deadline_misses"], 0, "cycles", note)
    for part in ("wake_up", "compute", "bus"):
        told = times[part]
        figures.inform(f"{part}_p999_6_joints_4khz", told["p999_us"], "us", f"median {told['median_us']}, largest {told['largest_us']}")
    subprocess.run(["rmac", "stop"], check=True, capture_output=True)
    run.wait()
    daemon.terminate()
    daemon.wait()
    sys.exit(0 if figures.good else 1)


main()

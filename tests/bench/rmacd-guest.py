#!/usr/bin/python3
"""Inside the emulated machine: rmacd drives the example mill over vcan0 (three axes) and vcan1 (its spindle)."""

import json
import pathlib
import subprocess
import sys
import time

from guest import (COUNTS_PER_REVOLUTION, HAS_GPIO, HEARTBEAT_MS, PITCH_MM, RUN, Drives, answers, call, check_emergency_stop,
                   emergency_stop_on_gpio, install, make_can, make_gpio, milliseconds, on_buses, operator, rmac, status, wait_for)


def change(device):
    device["Spindles"][0].update(Bus="vcan1", Axis=0, RatedTorque=0)
    for axis, turn in enumerate((2, 2, 1)):
        device["Actuators"][axis]["HomingTurn"] = turn
    device["DigitalControlInterface"] = {
        "Module": "CANopenInterface",
        "Parameters": {"vcan0.node": [1, 2, 3], "vcan1.node": 4, "vcan1.mode": 3, "vcan0.homing_method": [7, 8, 10],
                       "vcan1.velocity_units_per_rpm": COUNTS_PER_REVOLUTION / 60, "eds": "rmac-vdrive",
                       "heartbeat_ms": HEARTBEAT_MS}}
    if HAS_GPIO:
        emergency_stop_on_gpio(device)


def prepare():
    install(pathlib.Path(sys.argv[1]))
    make_can("vcan0", "vcan1")
    for name in ("vcan0", "vcan1"):
        call("ip", "link", "set", name, "txqueuelen", 256, "up")
    call("ip", "link", "set", "lo", "up")
    if HAS_GPIO:
        make_gpio()
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state")}))
    return on_buses("DMACXYZ", change)


def check_scan(sheets):
    print(call("rmac", "bus", "scan", "vcan0", "--eds", sheets))
    found = json.loads(call("rmac", "--json", "bus", "scan", "vcan0", "--eds", sheets))
    assert [(node["node"], node["name"], node["files"], pathlib.Path(node["drive"]).name) for node in found] == [
        (node, "rmac-vdrive", ["rmac-vdrive.eds"], "rmac-vdrive.json") for node in (1, 2, 3)], found


def check_objects(device):
    """One object at a time, while nobody runs the bus."""
    def sdo(*words):
        return subprocess.run(["rmac", "--json", "bus", "sdo", *map(str, words)], text=True, capture_output=True)

    def read(*words):
        return json.loads(call("rmac", "--json", "bus", "sdo", "read", "vcan0", *words))

    print(call("rmac", "bus", "sdo", "read", "vcan0", 2, "6041", "--machine", device))
    assert read(2, "1008")["value"] == "rmac-vdrive", "segmented"
    assert read(3, "0x1018:4")["value"] == 3
    before = read(2, "6085", "--machine", device)
    assert before["type"] == "UNSIGNED32", before
    call("rmac", "bus", "sdo", "write", "vcan0", 2, "6085", before["value"] + 1)
    assert read(2, "6085")["value"] == before["value"] + 1
    call("rmac", "bus", "sdo", "write", "vcan0", 2, "6085h:00", "u32", before["value"])
    for why, words in (("object does not exist", ("read", "vcan0", 2, "5FFF")), ("node 9 does not answer", ("read", "vcan0", 9, "6041")),
                       ("rmac bus move", ("write", "vcan0", 2, "6040", "0x0F"))):
        refused = sdo(*words)
        print(refused.stderr.strip())
        assert refused.returncode == 1 and why in refused.stderr, refused


def check_trace(device):
    """What passes while a machine runs: heard by itself, and from what candump recorded meanwhile."""
    recorded, witnessed = RUN / "trace.log", RUN / "candump.log"
    with witnessed.open("w") as log:
        witness = subprocess.Popen(["candump", "-L", "vcan0"], stdout=log)
        heard = call("rmac", "bus", "trace", "vcan0", "--machine", device, "--seconds", 2, "--record", recorded)
        witness.terminate()
        witness.wait()
    print(heard[:600])
    for words in ("SYNC", "RPDO1 node 1: Controlword", "TPDO1 node 3: Statusword", "(operation enabled)", "heartbeat node 127: operational"):
        assert words in heard, words
    lines = recorded.read_text().splitlines()
    assert [line.split("  ")[0] for line in heard.splitlines()] == lines
    assert set(lines) <= set(witnessed.read_text().splitlines()), "as candump writes it, to the microsecond"
    again = call("rmac", "bus", "trace", "--file", recorded, "--machine", device)
    assert again == heard, "what is recorded is told alike"


def node_now(number):
    """What `rmac bus state` tells of a node of vcan0."""
    report = json.loads(rmac("--json", "bus", "state"))
    (bus,) = [bus for bus in report["buses"] if bus["interface"] == "vcan0"]
    assert bus["cycles"] > 0 and bus["sent"] > bus["cycles"] and bus["unsent"] == bus["overflowed"] == 0, bus
    (node,) = [node for node in bus["nodes"] if node["node"] == number]
    return node


def bad_nodes():
    return {bus["name"]: bus["nodes_bad"] for bus in status()["buses"]}


def reset(person):
    person.call("RMAC_CAM.Reset")
    wait_for("the machine holds again", lambda: status()["state"] == "Idle")


def check_state(table):
    """A drive that trips and one that goes mute, seen while the machine is loaded: in `rmac bus state`, in the topic `state`, as events, and in the
    flight record of the fault."""
    fine = node_now(2)
    assert (fine["state"], fine["lost"], fine["emergency_count"]) == ("operational", 0, 0), fine
    assert fine["answers"] > 100 and 0 < fine["jitter_mean_s"] <= fine["jitter_most_s"], fine
    assert bad_nodes() == {"vcan0": [], "vcan1": []}, bad_nodes()
    watcher = operator()
    watcher.call("subscribe", topics=["events"])

    table.tell("2 trip 0x7305")
    fault = watcher.wait_note("events", lambda event: event["kind"] == "Fault")
    told = watcher.wait_note("events", lambda event: event["kind"] == "Bus" and "7305h" in event["message"])
    print("event:", told["message"])
    (emergency,) = [each for each in node_now(2)["emergencies"] if each["code"] == 0x7305]
    shown = rmac("bus", "state")
    print(shown)
    assert "node 2: EMCY 7305h (" + emergency["text"] in shown, shown
    wait_for("the flight record is written",
             lambda: fault["record"] in [record["name"] for record in watcher.call("FlightRecorder.List")["records"]])
    assert "EMCY 7305h" in rmac("bus", "state", "--record", fault["record"]), "as it was when the machine stopped"
    reset(watcher)

    table.tell("3 mute on")
    watcher.wait_note("events", lambda event: event["kind"] == "Fault")
    lost = watcher.wait_note("events", lambda event: event["kind"] == "Bus" and "node 3" in event["message"])
    print("event:", lost["message"])
    wait_for("the topic tells of node 3", lambda: bad_nodes()["vcan0"] == [3])
    away = node_now(3)
    assert away["state"] != "operational" and away["lost"] == 1 and away["missed_answers"] > 0, away
    table.tell("3 mute off")
    wait_for("node 3 is back", lambda: bad_nodes()["vcan0"] == [])
    assert (node_now(3)["state"], node_now(3)["recovered"]) == ("operational", 1), node_now(3)
    reset(watcher)
    watcher.close()


def main():
    device = prepare()
    print(call("rmac", "bus", "load", device))
    table = Drives("vcan0", 1, 2, 3)
    head = Drives("vcan1", "--spindle", 4)
    check_scan(device.parent / "canopen")
    print(call("rmac", "bus", "store", "vcan0", 2))
    check_objects(device)
    daemon = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"])
    wait_for("the daemon answers", answers)
    rmac("load", "DMACXYZ")
    print("loaded:", table.states(), head.states())
    rmac("home")
    joints = status()["joints"]
    print("homed:", joints, {change for *_, change, _ in table.changes()})
    assert all(abs(joint) < 1 for joint in joints), "each stands near its home, which is its zero"
    if HAS_GPIO:
        check_emergency_stop(table, head)
    rmac("jog", "--joint", 0, "--distance", 5)
    print("after a jog of 5 mm:", json.dumps(status())[:600])
    assert set(table.states().values()) == {"operation-enabled"}, table.states()

    check_trace(device)
    check_state(table)
    scan = subprocess.run(["rmac", "bus", "scan", "vcan0"], capture_output=True, text=True)
    assert scan.returncode == 1 and "a machine runs on this bus" in scan.stderr, scan
    table.ask("1 status", "^node 1 operational operation-enabled")
    rmac("jog", "--joint", 0, "--distance", -50)  # to -45
    jog = subprocess.Popen(["rmac", "jog", "--joint", "0", "--distance", "90"])
    wait_for("the jog is under way", lambda: status()["joints"][0] > -44)
    killed = time.monotonic()
    daemon.kill()
    jog.wait()
    late_ms = [*table.stops_after(killed).values(), *head.stops_after(killed).values()]
    x_mm = table.in_state("quick-stop", killed)[1][1] / COUNTS_PER_REVOLUTION * PITCH_MM
    print(f"killed at {x_mm:.3f} mm of X; quick stop after {milliseconds(late_ms)}")
    assert len(late_ms) == 4 and max(late_ms) <= 2 * HEARTBEAT_MS
    assert -44.9 < x_mm < 44.9, "it was not killed in mid-move"
    print("ok")


if __name__ == "__main__":
    main()

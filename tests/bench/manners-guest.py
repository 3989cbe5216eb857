#!/usr/bin/python3
"""Inside the emulated machine: the appliance boots with a stranger's drive on its first axis, whatever that drive's manners, moves 1 mm and stops, or
refuses the machine with a reason that a commissioner can act on. A line of JSON for each manner, and a table. The argument is the build folder, and
which kinds alone, or which scenarios by a part of their names, joined by +, if not every one."""

import contextlib
import json
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import time

from guest import BENCH, CONFIGURATION, COUNTS_PER_REVOLUTION, PITCH_MM, RUN, Drives, call, client, install, make_can, on_buses, operator, wait_for

sys.path.insert(0, str(BENCH / "strangers"))
import lss_scenarios  # noqa: E402
import scenarios  # noqa: E402
from scenarios import HEARTBEAT_MS, KINDS, LSS, MOVES, REFUSED  # noqa: E402

BUILD, KIND = sys.argv[1].split(",", 1)
PERIOD_S = 0.002
AT_REST_MM = 0.01
JOG_MM = 1


def machine(scenario):
    """Three axes whose drives close their loops, or of which the first one's gets torques."""
    def change(device):
        device["Spindles"] = []
        device["DigitalIOInterface"] = {"Module": "SimulatedIOInterface"}
        modes = [scenario.mode, 8, 8]
        for joint, mode in zip(device["Joints"], modes):
            if mode == 8:
                joint.pop("ServoControlLaw", None), joint.pop("Gains", None)
        device["DigitalControlInterface"] = {"Module": "CANopenInterface", "Parameters": {
            "node": [1, 2, 3], "mode": modes, "tpdo": "6041:00/16 6064:00/32", "heartbeat_ms": HEARTBEAT_MS} | scenario.parameters}
    return change


def describe(says):
    """Has the library of drives know the stranger by its 1018h; or not, where it says nothing."""
    file = CONFIGURATION.parent / "drives/stranger.json"
    file.unlink(missing_ok=True)
    if says:
        identity = {"VendorId": "2A5h", "ProductCode": "402h"}
        file.write_text(json.dumps({"Name": "stranger", "Manual": "tests/bench/strangers", "Tried": "never"} | identity | says))


class Stranger:
    def __init__(self, options):
        self._log = RUN / "stranger.log"
        self._process = subprocess.Popen(["chrt", "--fifo", "40", "/usr/bin/python3", "-B", BENCH / "strangers/drive.py", "vcan0", "1", *shlex.split(options)],
                                         stdout=self._log.open("w"), stderr=subprocess.STDOUT)

    def end(self):
        """What it says of itself."""
        self._process.send_signal(signal.SIGTERM)
        self._process.wait()
        lines = self._log.read_text().splitlines()
        print("\n".join("  drive: " + line for line in lines[-30:]))
        return json.loads(lines[-1])


class Appliance:
    def __init__(self):
        self.log = RUN / "rmacd.log"
        self.process = subprocess.Popen(["rmacd", "--config", RUN / "rmacd.json"], stderr=self.log.open("w"))
        self.client = operator()

    def end(self):
        self.client.close()
        self.process.terminate()
        self.process.wait()
        print("\n".join("  rmacd: " + line for line in self.log.read_text().splitlines()))


def jog(person):
    before = person.state()["joints"][0]
    person.call("RMAC_CAM.JogJoint", JntNum=0, Distance=JOG_MM)

    def over():
        now = person.state()
        return now if now["state"] != "Running" and not now["moving"] and now["moves_in_buffer"] == 0 else None

    wait_for("it begins", lambda: person.state()["moving"] or abs(person.state()["joints"][0] - before) > AT_REST_MM, 5)
    now = wait_for("it is over", over, 10)
    time.sleep(0.1)
    return person.state()["joints"][0] - before, now


@contextlib.contextmanager
def sent_meanwhile(frame):
    sender = subprocess.Popen(["sh", "-c", f"while :; do cansend vcan0 {frame}; sleep 0.1; done"]) if frame else None
    try:
        yield
    finally:
        if sender:
            sender.kill()
            sender.wait()


def load(person, scenario):
    """The reason why it is refused, or none."""
    try:
        with sent_meanwhile(scenario.meanwhile):
            person.call("Device.Load", Name="DMACXYZ")
    except client.Refused as refused:
        return refused.message
    return ""


def try_out(person, scenario):
    """(verdict, text, seconds of the load)"""
    begun = time.monotonic()
    reason = load(person, scenario)
    took = time.monotonic() - begun
    if reason and scenario.reset and "reset" in reason:
        answer = person.ask("RMAC_CAM.Reset")
        again = load(person, scenario)
        reason = again and f"{reason} | after a reset ({answer.get('error', {}).get('message', 'taken')}): {again}"
    if reason:
        return REFUSED, reason, took
    try:
        moved, now = jog(person)
    except (client.Refused, SystemExit) as error:
        return "fails", f"{error}; {json.dumps(person.state())[:700]}", took
    good = abs(moved - JOG_MM) <= AT_REST_MM and now["state"] == "Idle"
    return (MOVES if good else "fails"), "" if good else f"moved {moved:.3f} mm; {json.dumps(now)[:700]}", took


def run(scenario):
    print(f"--- {scenario.name}: {scenario.options}", flush=True)
    on_buses("DMACXYZ", machine(scenario))
    describe(scenario.described)
    call("ip", "link", "set", "vcan0", "up")
    others = Drives("vcan0", 2, 3, name="others")
    stranger = Stranger(scenario.options)
    appliance = Appliance()
    verdict, text, took = try_out(appliance.client, scenario)
    log = appliance.log.read_text()
    notes = [line for line in log.splitlines() if "node 1" in line]
    appliance.end()
    told = stranger.end()
    others.process.kill()
    others.process.wait()
    others.commands.unlink()
    if verdict == MOVES and abs(told["position"] / COUNTS_PER_REVOLUTION * PITCH_MM - JOG_MM) > AT_REST_MM:
        verdict, text = "fails", f"the drive itself stands at {told['position']} counts"
    too_often = {count: told[count] for count, most in scenario.at_most.items() if told.get(count, 0) > most}
    if too_often:
        verdict, text = "fails", f"the drive itself counts {too_often}"
    ok = verdict == scenario.verdict and (re.search(scenario.text, text if verdict == REFUSED else log, re.DOTALL) is not None)
    return {"manner": scenario.name, "ok": ok, "verdict": verdict, "wanted": scenario.verdict, "load_s": round(took, 1), "text": text,
            "notes": notes[:4], "known": scenario.known}


def run_lss(name, options, serials, act, known):
    print(f"--- {name}: {options}", flush=True)
    nodes = subprocess.Popen(["chrt", "--fifo", "40", "/usr/bin/python3", "-B", BENCH / "strangers/lss_nodes.py", "vcan0", *options.split(),
                              *map(str, serials)], stdout=subprocess.PIPE, text=True)
    nodes.stdout.readline()
    begun = time.monotonic()
    good, text = act()
    nodes.kill()
    nodes.wait()
    return {"manner": name, "ok": good, "verdict": "as it must" if good else "fails", "wanted": "as it must", "load_s": round(time.monotonic() - begun, 1),
            "text": text, "notes": [], "known": known}


def chosen():
    """Of each word of KIND, a kind or a part of a name: scenarios of drives, and those of LSS."""
    words = KIND.split("+") if KIND else KINDS
    drives, nodes = [], []
    for word in words:
        part = "" if word in KINDS else word.replace("_", " ")
        found = [s for kind in KINDS for s in scenarios.of(kind) if (part in s.name if part else kind == word)]
        found_nodes = [s for s in lss_scenarios.SCENARIOS if (part in s[0] if part else word == LSS)]
        if not found and not found_nodes:
            raise SystemExit(f"there is no manner {word}, and no kind of them; kinds: {', '.join(KINDS)}")
        drives += found
        nodes += found_nodes
    return drives, nodes


def prepare():
    install(pathlib.Path(BUILD))
    make_can("vcan0")
    call("ip", "link", "set", "vcan0", "txqueuelen", 256, "up")
    call("ip", "link", "set", "lo", "up")
    (RUN / "rmacd.json").write_text(json.dumps({"state_folder": str(RUN / "state"), "period_s": PERIOD_S, "flight_recorder": {"seconds": 0}}))


def main():
    prepare()
    (file,) = pathlib.Path("/usr/local/lib/rmac/drivers").glob("*/*/DMACXYZ/device.json")
    original = file.read_text()
    rows = []
    drives, nodes = chosen()
    for scenario in drives:
        file.write_text(original)
        with contextlib.suppress(FileNotFoundError):
            (RUN / "stranger.log").unlink()
        rows.append(run(scenario))
        print(json.dumps(rows[-1]), flush=True)
    for scenario in nodes:
        rows.append(run_lss(*scenario))
        print(json.dumps(rows[-1]), flush=True)
    print(f"{'manner':<52} {'wanted':<8} {'verdict':<8} {'load':>6}  text")
    for row in rows:
        mark = "FAILED " if not row["ok"] and not row["known"] else "MENDED " if row["ok"] and row["known"] else f"KNOWN ({row['known']}) " if row["known"] else ""
        print(f"{row['manner']:<52} {row['wanted']:<8} {row['verdict']:<8} {row['load_s']:>5} s  {mark}{row['text'] or '; '.join(row['notes'])}"[:400])
    # What is known to fail and passes is to be taken off the list.
    sys.exit(0 if all(row["ok"] != bool(row["known"]) for row in rows) else 1)


main()

#!/usr/bin/python3
"""Inside the emulated machine, under systemd: the installed appliance cuts the demo's headlight over vcan0 (three axes), a Modbus spindle behind
a pseudo-terminal and GPIO signals: its first sweeps, because all of it would take the emulation most of an hour. It is killed in mid-cut, and held so
that systemd's watchdog has to kill it; each time it comes back, and nothing moves by that. Then the emergency stop stops it in mid-cut."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

from guest import (CONFIGURATION, HEARTBEAT_MS, PREFIX, RUN, Drives, Peer, answers, call, emergency_stop_on_gpio, install,
                   make_can, make_gpio, milliseconds, on_buses, rmac, status, stop_by_emergency, wait_for)

BUILD = pathlib.Path(sys.argv[1])
SWEEP = BUILD / "tests/bench/headlight/headlight-sweep.rmac"
FIRST_CUT = 3  # the first move that cuts: before it the tool comes down
CUTS_MM_MIN = 1500  # of 2000
DAEMON = "rmacd.service"
STANDS_MM = 0.01
SPINDLE_TIME_OUT_S = 1  # what a spindle drive is set to, so that it stops when nobody talks to it


def change(device):
    device["Spindles"][0].update(Bus="spindle0", Axis=0, RatedTorque=0)
    device["DigitalControlInterface"] = {
        "Module": "CANopenInterface",
        "Parameters": {"vcan0.node": [1, 2, 3], "eds": "rmac-vdrive", "heartbeat_ms": HEARTBEAT_MS,
                       "spindle0.interface": "ModbusInterface", "spindle0.device": str(RUN / "spindle"), "spindle0.bit_rate": 19200,
                       "spindle0.slave": [1], "spindle0.map": "delta-vfd-b", "spindle0.rpm_per_hz": 60}}
    emergency_stop_on_gpio(device)


def give(path):
    """What the daemon may open, as its user. Its unit lets it see no devices; the drop-in is what docs/gpio.md and docs/modbus.md say."""
    shutil.chown(path, "rmac", "rmac")
    return f"DeviceAllow={path} rw\n"


def prepare():
    install(BUILD)
    call("systemd-sysusers")
    call("ip", "link", "set", "lo", "up")
    for mechanism in ("DMACXYZ", "DMACXY"):
        on_buses(mechanism, change)
    configuration = json.loads(CONFIGURATION.read_text())
    CONFIGURATION.write_text(json.dumps(configuration | {"autoload": {"mechanism": "DMACXYZ"}}))
    (PREFIX / "etc/rmac/can-vcan0.conf").write_text("BITRATE=\nRESTART_MS=0\nTXQUEUELEN=256\n")
    make_can("vcan0")
    make_gpio()
    spindle = Peer("spindle0", ["rmac-vmodbus", "1=delta-vfd-b", "--pty", RUN / "spindle", "--ramp", "20",
                                "--time-out", str(SPINDLE_TIME_OUT_S)])
    terminal = wait_for("the spindle's line", lambda: (RUN / "spindle").exists() and (RUN / "spindle").resolve())
    folder = pathlib.Path(f"/etc/systemd/system/{DAEMON}.d")
    folder.mkdir()
    (folder / "devices.conf").write_text("[Service]\nPrivateDevices=no\n" + give(terminal) + give(next(pathlib.Path("/dev").glob("gpiochip*"))))
    call("systemctl", "daemon-reload")
    call("systemctl", "start", "rmac-can@vcan0")
    return spindle


def unit(name):
    return call("systemctl", "show", "--value", "--property", name, DAEMON).strip()


def at_work():
    """Loaded, at rest and enabled, so that nothing but a person's word is missing."""
    if unit("ActiveState") != "active" or not answers():
        return None
    now = status()
    if now["state"] == "Faulted":
        raise SystemExit(f"the machine faulted: {now['last_stop']}")
    return now if now["mechanism"] and now["state"] == "Idle" and not now["moving"] else None


def turns(spindle):
    return float(spindle.ask("1 status", r"at (\S+) of")[-1])


def begin_cut():
    """The program, under way in its first cut."""
    cut = subprocess.Popen(["rmac", "run", SWEEP], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def cutting():
        if cut.poll() is not None:
            raise SystemExit(f"the cut ended: {cut.communicate()[1]}")
        now = status()
        return now if now["move_id"] >= FIRST_CUT and now["feed_actual_mm_min"] > CUTS_MM_MIN else None

    now = wait_for("the tool cuts", cutting, 120, 0.1)
    assert now["outputs"] & 1 and now["spindle_rpm"][0] > 900, now
    return cut, now


def die(drives, spindle, how):
    """In mid-cut, by that signal: every drive stops in time, the spindle by itself, systemd brings the daemon back, and nothing moves."""
    restarts = int(unit("NRestarts"))
    daemon = int(unit("MainPID"))
    cut, now = begin_cut()
    died = time.monotonic()
    os.kill(daemon, how)
    late_ms = drives.stops_after(died)
    time.sleep(0.5)  # in quick stop they still brake; the daemon is back a second after its death at the earliest
    standing = drives.positions_mm()
    print(f"{how.name} in move {now['move_id']} at {now['feed_actual_mm_min']:.0f} mm/min: quick stop after {milliseconds(late_ms.values())}")
    assert len(late_ms) == 3 and max(late_ms.values()) <= 2 * HEARTBEAT_MS
    wait_for("the spindle stops", lambda: turns(spindle) == 0, SPINDLE_TIME_OUT_S + 5, 0.2)
    print(f"the spindle stands {time.monotonic() - died:.1f} s after it; restarts until then {int(unit('NRestarts')) - restarts}")
    back = wait_for("systemd brings the daemon back", lambda: int(unit("NRestarts")) > restarts and at_work(), 90, 1)
    print(f"back after {time.monotonic() - died:.1f} s, restarts {unit('NRestarts')}: {back['mechanism']} {back['state']}")
    assert cut.wait() == 1, "its client must say that the cut did not end"
    before = drives.positions_mm()
    time.sleep(3)
    after = drives.positions_mm()
    assert turns(spindle) == 0
    off_mm = max(abs(where[node] - standing[node]) for where in (before, after) for node in standing)
    print(f"nothing moved by itself: joints within {off_mm * 1e3:.1f} um of where the drives stopped, 3 s after it came back")
    assert off_mm <= STANDS_MM
    assert status()["moves_in_buffer"] == 0


def cut_part(seconds):
    _, before = begin_cut()
    misses = before["deadline_misses"]
    time.sleep(seconds)
    now = status()
    assert now["state"] == "Running" and now["move_id"] > before["move_id"], now
    print(f"cut on for {seconds} s: moves {before['move_id']} to {now['move_id']}, {now['deadline_misses'] - misses} deadlines missed")


def lift():
    rmac("jog", "--joint", 2, "--distance", 20)


def main():
    spindle = prepare()
    drives = Drives("vcan0", 1, 2, 3)
    call("systemctl", "start", DAEMON)
    wait_for("the appliance is at work", at_work, 60, 0.5)
    print("started:", call("systemctl", "is-active", DAEMON, "rmac-can@vcan0").split(), drives.states())
    die(drives, spindle, signal.SIGKILL)
    lift()
    die(drives, spindle, signal.SIGSTOP)
    lift()
    cut_part(3)
    stop_by_emergency(drives)
    print("ok")


if __name__ == "__main__":
    try:
        main()
    except BaseException:
        print(subprocess.run(["journalctl", "-u", "rmac*", "--no-pager", "-n", "60", "-o", "short-monotonic"], capture_output=True, text=True).stdout)
        raise

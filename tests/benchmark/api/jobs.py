"""An hour of jobs in real pace beside 50 subscribers, one of which stalls: nothing grows, and no cycle is missed."""

import os
import sys
import time

from appliance import Appliance, line, wait_for_rest
from bare_thread import BareThread
from crowd import Crowd, connect
from figures import Figures
from footprint import add_growth, footprint, growth_kib

SUBSCRIBERS = 50
MOVES = 100
EVERY_S = 10.0


def job(operator):
    """One that a shop would send: a spindle, a hundred lines, coolant, and the cycle's end."""
    operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=600)
    operator.call("RMAC_CAM.TurnCoolantOn")
    for number in range(MOVES):
        x = 4 * (number % 2)
        operator.call("RMAC_CAM.MoveAlongLine", **line((x, 0, 0), (4 - x, 0, 0), number))
    operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
    wait_for_rest(operator)
    operator.call("RMAC_CAM.TurnCoolantOff")
    operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=0)


def measure(figures, hours):
    with Appliance(pace="real-time", real_time={"degraded_allowed": True, "lock_memory": True},
                   listen={"address": "127.0.0.1", "port": 0, "unix_socket": "crowd.sock"}) as appliance:
        unix_socket = appliance.folder / "crowd.sock"
        operator = appliance.operator()
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=2000)
        sockets = connect(appliance.port, unix_socket, SUBSCRIBERS)
        crowd = Crowd(sockets)
        crowd.start()
        first = operator.state()
        computer = BareThread()
        began = time.monotonic()
        next_print, prints, jobs = 0.0, [], 0
        while (elapsed := time.monotonic() - began) < 3600 * hours:
            job(operator)
            jobs += 1
            if elapsed >= next_print:
                next_print += EVERY_S
                prints.append(footprint(appliance.process))
        missed = operator.state()["deadline_misses"] - first["deadline_misses"]
        missed_by_computer = computer.misses()
        cut_off = crowd.stalled_is_cut_off()
        crowd.end()
        for client in sockets:
            client.close()
        degraded = any("warning" in text for text in appliance.log)
    settled = prints[max(1, len(prints) // 10):]  # the warm-up is a tenth
    cases = f"{hours:g} h, {jobs} jobs of {MOVES} moves, {SUBSCRIBERS} subscribers"
    figures.add("jobs_memory_growth", growth_kib(settled, lambda _, made: made.at_s / 3600), "KiB/h", 1024, cases)
    add_growth(figures, "jobs", settled, cases)
    figures.add("jobs_cycles_missed", missed, "cycles", 0,
                f"load average {os.getloadavg()[2]:.1f}" + (", this system grants no real time" if degraded else ""))
    if missed_by_computer is not None:
        figures.add("jobs_missed_by_the_computer", missed_by_computer, "cycles", None,
                    "by a process that only sleeps, at the highest priority, meanwhile")
    figures.add("jobs_cycles_lost", crowd.gaps, "gaps", 0, "in what the subscriber of every cycle was sent")
    figures.add("jobs_readers_cut_off", crowd.lost, "clients", 0, f"of those that read; {crowd.lines} notes in all")
    figures.add("jobs_stalled_kept", 0 if cut_off else 1, "clients", 0, "the one that does not read")


def hours_of(words):
    if "--hours" in words:
        return float(words[words.index("--hours") + 1])
    return 1 / 60 if "--quick" in words else 1.0


def main():
    figures = Figures()
    measure(figures, hours_of(sys.argv[1:]))
    sys.exit(0 if figures.table() else 1)


main()

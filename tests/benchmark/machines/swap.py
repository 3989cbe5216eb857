"""Swaps a three-axis machine for a five-axis one and back, on a running appliance with clients: what it costs, and what it disturbs.

The five-axis machine's kinematics is there in two builds, which are put into its folder in turn: each swap must bring the build that lies there.
A swap's time is counted in servo cycles, from the first one of the mechanism that goes in to the one in which it is in force with every drive
enabled. Loading and checking its modules comes before that, beside the loop, and is told apart from it."""

import os
import shutil
import statistics
import sys
import threading
import time

from appliance import BUILD, Appliance
from figures import Figures

THREE, FIVE = "SuginoXYZ", "SuginoXYZAC"
FIVE_FOLDER = "mill/5-axis/SuginoXYZAC"
SHARED_DRIVES = 3
ENABLED_MASK, ENABLED = 0x6F, 0x27
PERIOD_MS = 1.0


class Watcher(threading.Thread):
    """Another client: follows every cycle's drives, and the events."""

    def __init__(self, client):
        super().__init__()
        self._client = client
        self._cycle = None
        self._lock = threading.Condition()
        self._drives = 0
        self._ends = False
        self.began = []  # cycle of the first sample of each mechanism
        self.loaded = []  # cycle of each event that tells of one
        self.gaps = self.disabled = 0
        self.first_misses = self.misses = None

    def run(self):
        self._client.call("subscribe", topics=["drives", "events"], rate_hz=1000)
        while not self._ends:
            note = self._client._read_note()
            with self._lock:
                if note["method"] == "events" and note["params"]["kind"] == "Mechanism":
                    self.loaded.append(note["params"]["cycle"])
                elif note["method"] == "drives":
                    for sample in note["params"]["samples"]:
                        self._take(sample)
                self._lock.notify_all()

    def _take(self, sample):
        if self._cycle is not None and sample["cycle"] != self._cycle + 1:
            self.gaps += 1
        self._cycle = sample["cycle"]
        words = sample["statusword"]
        if len(words) != self._drives:
            self._drives = len(words)
            self.began.append(sample["cycle"])
        if any(word & ENABLED_MASK != ENABLED for word in words[:SHARED_DRIVES]):
            self.disabled += 1
        self.misses = sample["deadline_misses"]
        if self.first_misses is None:
            self.first_misses = self.misses

    def wait_for(self, swaps):
        """Until so many swaps were seen from both sides."""
        with self._lock:
            self._lock.wait_for(lambda: len(self.began) > swaps and len(self.loaded) >= swaps, timeout=60)

    def end(self):
        self._ends = True
        self.join()


def rss_kib(process):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))


def mapped_modules(process):
    with open(f"/proc/{process.pid}/maps", encoding="utf-8") as maps:
        return len({line.split()[5] for line in maps if "/rmac-module-" in line})


def put(build, folder):
    """As an update would: the file that is there is replaced, never written into."""
    unfinished = folder / "ChainKinematics.so.new"
    shutil.copy(BUILD / "bench_modules" / build / "ChainKinematics.so", unfinished)
    os.replace(unfinished, folder / "ChainKinematics.so")


def kinematics_build(client):
    modules = client.call("Device.GetModules")["modules"]
    return next(module["build_id"] for module in modules if module["role"] == "kinematics")


def measure(figures, rounds):
    with Appliance(pace="real-time", own_tree=True, real_time={"degraded_allowed": True, "lock_memory": True}) as appliance:
        folder = appliance.tree / FIVE_FOLDER
        operator = appliance.client("operator")
        operator.call("authority.acquire")
        for build in ("one", "two"):  # so that both are verified
            put(build, folder)
            operator.call("Device.Load", Name=FIVE)
        operator.call("Device.Load", Name=THREE)
        shared_build = kinematics_build(operator)
        watcher = Watcher(appliance.client("watcher"))
        watcher.start()
        watcher.wait_for(0)
        wrong, calls_ms, memory = 0, [], []
        started = time.perf_counter()
        for turn in range(rounds):
            build = ("one", "two")[turn % 2]
            put(build, folder)
            for name, wanted in ((FIVE, build), (THREE, shared_build)):
                began = time.perf_counter()
                operator.call("Device.Load", Name=name)
                calls_ms.append(1000 * (time.perf_counter() - began))
                wrong += kinematics_build(operator) != wanted
            memory.append((rss_kib(appliance.process), mapped_modules(appliance.process)))
        swaps = 2 * rounds
        watcher.wait_for(swaps)
        missed = watcher.misses - watcher.first_misses
        # As long again without a swap: what the computer makes a machine miss that is left alone.
        time.sleep(time.perf_counter() - started)
        missed_alone = watcher.misses - watcher.first_misses - missed
        watcher.end()
        times_ms = [PERIOD_MS * (loaded - began) for began, loaded in zip(watcher.began[1:], watcher.loaded)]
        degraded = [line.strip() for line in appliance.log if "warning" in line]

    cases = f"{swaps} swaps"
    settled = memory[len(memory) // 5:]
    figures.add("swap_three_to_five_axes", statistics.median(times_ms), "ms", 20, cases)
    figures.add("swap_slowest", max(times_ms), "ms", None, cases)
    figures.add("swap_with_loading", statistics.median(calls_ms), "ms", None, "median of the call, modules loaded and checked")
    figures.add("swap_cycles_missed", missed, "cycles", 0,
                "deadlines that passed" + (": this system grants no real time" if degraded else ""))
    figures.add("swap_cycles_missed_alone", missed_alone, "cycles", None, "in as much time after it, without a swap")
    figures.add("swap_cycles_lost", watcher.gaps, "gaps", 0, "in what the other client was sent")
    figures.add("swap_shared_drives_off", watcher.disabled, "cycles", 0, "in which a drive of both was not enabled")
    figures.add("swap_wrong_builds", wrong, "swaps", 0, "the kinematics' build id is not that of the file")
    figures.add("swap_memory_growth", settled[-1][0] - settled[0][0], "KiB", 1024, "over the last four fifths")
    figures.add("swap_modules_left_mapped", settled[-1][1] - settled[0][1], "modules", 0)


def main():
    rounds = 25 if "--quick" in sys.argv[1:] else 500
    figures = Figures()
    measure(figures, rounds)
    sys.exit(0 if figures.table() else 1)


main()

"""Mechanism after mechanism, with and without unloading between: what stays behind of each."""

import itertools
import statistics
import sys
import time

from appliance import Appliance
from figures import Figures
from footprint import add_growth, footprint, growth_kib

NAMES = ("DMACXY", "DMACXYZ", "DMACXYZA", "SuginoXYZ", "SuginoXYZAC", "TarusXYZCATwin")


def measure(figures, swaps):
    with Appliance() as appliance:
        operator = appliance.client("operator")
        operator.call("authority.acquire")
        names = itertools.cycle(NAMES)
        times_ms, prints = [], []
        warm_up = max(2 * len(NAMES), swaps // 10)
        for swap in range(warm_up + swaps):
            if swap % 3 == 0 and swap > 0:
                operator.call("Device.Unload")
            began = time.perf_counter()
            operator.call("Device.Load", Name=next(names))
            if swap >= warm_up:
                times_ms.append(1000 * (time.perf_counter() - began))
                # Of one machine alone: another has more joints, and threads of its own.
                if (swap + 1) % len(NAMES) == 0:
                    prints.append(footprint(appliance.process))
    times_ms.sort()
    cases = f"{swaps} swaps among {len(NAMES)} machines, a third after unloading"
    figures.add("swap_median", statistics.median(times_ms), "ms", None, cases)
    figures.add("swap_p99", times_ms[int(0.99 * swaps)], "ms", None, cases)
    figures.add("swaps_memory_growth", growth_kib(prints, lambda number, _: number * len(NAMES) / 1000), "KiB", 1024, "a thousand swaps")
    add_growth(figures, "swaps", prints, cases)


def main():
    figures = Figures()
    measure(figures, 60 if "--quick" in sys.argv[1:] else 1000)
    sys.exit(0 if figures.table() else 1)


main()

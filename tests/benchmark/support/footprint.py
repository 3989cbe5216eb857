"""What a process holds, and whether it grows."""

import dataclasses
import os
import time


@dataclasses.dataclass
class Footprint:
    at_s: float
    memory_kib: int
    descriptors: int
    threads: int


def footprint(process):
    with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
        words = {line.split(":")[0]: line.split(":")[1] for line in status}
    return Footprint(time.monotonic(), int(words["VmRSS"].split()[0]), len(os.listdir(f"/proc/{process.pid}/fd")),
                     int(words["Threads"]))


def growth_kib(footprints, along):
    """KiB for each unit of `along`, which gives a number for each footprint: the slope of the straight line nearest to all."""
    numbers = [along(number, print_) for number, print_ in enumerate(footprints)]
    middle = sum(numbers) / len(numbers)
    spread = sum((number - middle) ** 2 for number in numbers)
    return sum((number - middle) * print_.memory_kib for number, print_ in zip(numbers, footprints)) / spread


def add_growth(figures, prefix, footprints, cases):
    """Descriptors and threads at the end against those after the warm-up."""
    first, last = footprints[0], footprints[-1]
    figures.add(f"{prefix}_descriptors_left", last.descriptors - first.descriptors, "files", 0, cases)
    figures.add(f"{prefix}_threads_left", last.threads - first.threads, "threads", 0, cases)

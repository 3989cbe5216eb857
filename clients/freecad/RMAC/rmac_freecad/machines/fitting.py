"""Simulates a job on each machine, and ranks those that can cut it by time."""

from dataclasses import dataclass

from rmac_freecad.jobs import read_job
from rmac_freecad.simulation import Found, SimulationRefused, simulate


@dataclass(frozen=True)
class Fit:
    machine: str
    found: Found


class NoMachineFits(Exception):
    """`why` tells of each machine why not, by its name."""

    def __init__(self, why):
        told = "".join(f"\n{name}: {refused}" for name, refused in why.items()) or " none was found"
        super().__init__(f"no machine can cut this job:{told}")
        self.why = why


def fitting(job, machines, tools, rmac="rmac"):
    """`machines` as `client.machines(where)` finds them; `tools` is the table that each of them is taken to have. The
    quickest first."""
    fits, why = [], {}
    for machine in machines:
        program = read_job(job, rapid_mm_min=machine.max_feed_mm_min)
        try:
            fits.append(Fit(machine.name, simulate(program, machine.name, tools, rmac)))
        except SimulationRefused as refused:
            why[machine.name] = refused
    if not fits:
        raise NoMachineFits(why)
    return sorted(fits, key=lambda fit: fit.found.cycle_time_s)

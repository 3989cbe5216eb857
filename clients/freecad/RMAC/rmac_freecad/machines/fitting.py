"""Simulates a job on each machine, and ranks those that can cut it by time."""

from dataclasses import dataclass

from rmac_freecad.jobs import read_job
from rmac_freecad.simulation import Found, NoProgram, SimulationRefused, simulate


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
    fits, why = compare(programs_for(job, machines), tools, rmac)
    if not fits:
        raise NoMachineFits(why)
    return fits


def programs_for(job, machines):
    """By the machines' names: rapids are as fast as each may go. Reads the document, so by FreeCAD's own thread."""
    by_feed = {}
    for feed in {machine.max_feed_mm_min for machine in machines}:
        by_feed[feed] = read_job(job, rapid_mm_min=feed)
    return {machine.name: by_feed[machine.max_feed_mm_min] for machine in machines}


def compare(programs, tools, rmac="rmac"):
    """Those that can, the quickest first, and why the others cannot. Takes its time; touches no document. `NoProgram` where nothing
    can be simulated here."""
    fits, why = [], {}
    for machine, program in programs.items():
        try:
            fits.append(Fit(machine, simulate(program, machine, tools, rmac)))
        except NoProgram:
            raise
        except SimulationRefused as refused:
            why[machine] = refused
    return sorted(fits, key=lambda fit: fit.found.cycle_time_s), why

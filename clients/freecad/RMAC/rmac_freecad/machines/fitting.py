"""Simulates a job on each machine, and ranks those that can cut it by time and accuracy."""

from dataclasses import dataclass

from rmac_freecad.jobs import read_job
from rmac_freecad.simulation import Found, NoProgram, SimulationRefused, WouldStop, simulate


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


def fitting(job, machines, tools, rmac="rmac", within_mm=None):
    """`machines` as `client.machines(where)` finds them; `tools` is the table that each of them is taken to have. Those
    that keep `within_mm` of the path come first, the quickest at the top; behind them the others, the most accurate first."""
    fits, why = compare(programs_for(job, machines), tools, rmac, within_mm)
    if not fits:
        raise NoMachineFits(why)
    return fits


def programs_for(job, machines):
    """By the machines' names: rapids are as fast as each may go. Reads the document, so by FreeCAD's own thread."""
    by_feed = {}
    for feed in {machine.max_feed_mm_min for machine in machines}:
        by_feed[feed] = read_job(job, rapid_mm_min=feed)
    return {machine.name: by_feed[machine.max_feed_mm_min] for machine in machines}


def compare(programs, tools, rmac="rmac", within_mm=None):
    """Those that can, as `fitting` ranks them, and why the others cannot. Takes its time; touches no document. `NoProgram` where nothing
    can be simulated here."""
    fits, why = [], {}
    for machine, program in programs.items():
        try:
            fits.append(Fit(machine, _found(program, machine, tools, rmac)))
        except NoProgram:
            raise
        except SimulationRefused as refused:
            why[machine] = refused
    return sorted(fits, key=lambda fit: _rank(fit.found, within_mm)), why


def _found(program, machine, tools, rmac):
    """Without accuracy where there is no model of the machine's axes."""
    try:
        return simulate(program, machine, tools, rmac, dynamics=True)
    except SimulationRefused as refused:
        if isinstance(refused, (NoProgram, WouldStop)) or refused.place is not None:
            raise
        return simulate(program, machine, tools, rmac)


def _rank(found, within_mm):
    off_mm = float("inf") if found.off_path_mm is None else found.off_path_mm
    if within_mm is None or off_mm <= within_mm:
        return 0, found.cycle_time_s, off_mm
    return 1, off_mm, found.cycle_time_s

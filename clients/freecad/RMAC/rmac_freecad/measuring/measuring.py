"""Has a machine with a probe touch places of a part, and tells what it found."""

import math
from dataclasses import dataclass

import rmac
from rmac_freecad.measuring.places import Place
from rmac_freecad.measuring.prober import Prober
from rmac_freecad.measuring.refusal import MeasuringRefused

SPEED_MM_S = 20.0


@dataclass(frozen=True)
class Touched:
    place: Place
    measured: tuple  # where the surface was, in the part frame that was in force

    @property
    def off_mm(self):
        """Along the normal: more material is more."""
        return sum((a - b) * n for a, b, n in zip(self.measured, self.place.point, self.place.normal))


def measure(client, places, *, tip_radius_mm, clearance_mm, safe_mm, speed_mm_s=SPEED_MM_S, told=lambda done: None):
    """One by one, in their order; waits, with authority, so that the machine stops when this ends in whatever way. A machine that has a probe
    is loaded. Coordinates are of the part frame in force. `told(done)` after each place. Raises `MeasuringRefused` with the place and the
    machine's reason."""
    _check(places, tip_radius_mm=tip_radius_mm, clearance_mm=clearance_mm, safe_mm=safe_mm, speed_mm_s=speed_mm_s)
    if not client.state()["mechanism"]:
        raise MeasuringRefused("no machine is loaded; load one with a probe, or CMM over the mill that is loaded")
    touched = []
    with client.authority(), client.events() as events:
        try:
            prober = Prober(client, events, tip_radius_mm, clearance_mm, safe_mm, speed_mm_s)
            for place in places:
                touched.append(Touched(place, prober.touch(place)))
                told(len(touched))
            prober.leave()
        except (MeasuringRefused, rmac.RmacError) as error:
            raise MeasuringRefused(f"{_where(places, len(touched))}: {_why(error)}", places[min(len(touched), len(places) - 1)]) from error
    return touched


def _where(places, done):
    if done == len(places):
        return f"behind the last of {done} places"
    x, y, z = places[done].point
    return f"place {done + 1} of {len(places)}, on {places[done].face} at X {x:.4g}, Y {y:.4g}, Z {z:.4g}"


def _why(error):
    if isinstance(error, rmac.ConnectionLost):
        return f"{error}. The machine comes to rest by itself then; look where the probe stands, and measure anew"
    return error.message if isinstance(error, rmac.Refused) else str(error)


def _check(places, **values):
    if not places:
        raise MeasuringRefused("there is no place to be measured")
    for number, place in enumerate(places, 1):
        if not all(math.isfinite(value) for value in (*place.point, *place.normal)):
            raise MeasuringRefused(f"place {number}, on {place.face}, is no place: {place.point}")
    for name, value in values.items():
        if not math.isfinite(value) or (value <= 0 and name != "safe_mm"):
            raise MeasuringRefused(f"{name} is {value:g}; give {'a number' if name == 'safe_mm' else 'more than 0'}")

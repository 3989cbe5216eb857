"""Has a machine with a probe touch places of a part, by the command-line client, and tells what it found."""

import contextlib
import json
import math
import pathlib
import shutil
import subprocess
import tempfile
from dataclasses import dataclass

from rmac.errors import ConnectionLost
from rmac_freecad.measuring.places import Place
from rmac_freecad.measuring.refusal import MeasuringRefused


@dataclass(frozen=True)
class Touched:
    place: Place
    measured: tuple  # where the surface was, in the part frame that was in force

    @property
    def off_mm(self):
        """Along the normal: more material is more."""
        return sum((a - b) * n for a, b, n in zip(self.measured, self.place.point, self.place.normal))


def measure(client, places, *, tip_radius_mm, clearance_mm, safe_mm, speed_mm_s=20.0, rmac="rmac", patience_s=3600):
    """One by one, in their order; waits. A machine that has a probe is loaded, and this client gives its authority away for as long:
    the command-line client takes it. Coordinates are of the part frame in force. Raises `MeasuringRefused` with the machine's reason."""
    executable = shutil.which(rmac)
    if executable is None:
        raise MeasuringRefused(f"the program {rmac} is not there, which measures; it comes with the appliance's package, or give its path as rmac=")
    if not places:
        raise MeasuringRefused("there is no place to be measured")
    if not client.state()["mechanism"]:
        raise MeasuringRefused("no machine is loaded; load one with a probe, or CMM over the mill that is loaded")
    with tempfile.TemporaryDirectory(prefix="rmac-measure-") as folder:
        plan = pathlib.Path(folder) / "plan.json"
        plan.write_text(json.dumps(_plan(places, tip_radius_mm, clearance_mm, safe_mm, speed_mm_s)))
        with client.events() as events:
            try:
                ended = subprocess.run(
                    [executable, *_where(client.address), "--json", "measure", str(plan)],
                    stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=patience_s,
                )  # fmt: skip
            except subprocess.TimeoutExpired as late:
                raise MeasuringRefused(f"measuring {len(places)} places took longer than {patience_s} s") from late
            hits = _hits(client, events)
    if ended.returncode != 0:
        place = places[min(hits, len(places) - 1)]
        where = ", ".join(f"{axis} {value:.4g}" for axis, value in zip("XYZ", place.point))
        raise MeasuringRefused(f"place {hits + 1} of {len(places)}, on {place.face} at {where}: {ended.stderr.strip().removeprefix('rmac: ')}")
    points = json.loads(ended.stdout)["points"]
    return [Touched(place, tuple(point["measured"])) for place, point in zip(places, points, strict=True)]


def _hits(client, events):
    """How many came before the connection's end, of which the client that measured tells, too."""
    try:
        client.state()  # events that came before its answer are here
    except ConnectionLost:
        hits = 0
        with contextlib.suppress(ConnectionLost):
            for event in events:
                hits += event.kind == "Hit"
        return hits
    return sum(event.kind == "Hit" for event in events.so_far())


def _plan(places, tip_radius, clearance, safe, speed):
    features = {}
    for number, place in enumerate(places):
        if not all(math.isfinite(value) for value in (*place.point, *place.normal)):
            raise MeasuringRefused(f"place {number + 1}, on {place.face}, is no place: {place.point}")
        features.setdefault(place.face, []).append({"Point": list(place.point), "Normal": list(place.normal)})
    if [place.face for place in places] != [name for name, points in features.items() for _ in points]:
        raise MeasuringRefused("places of one face follow each other; sort them by face")
    return {"SafeHeight": safe, "TipRadius": tip_radius, "Clearance": clearance, "Speed": speed,
            "Features": [{"Name": name, "Points": points} for name, points in features.items()]}  # fmt: skip


def _where(address):
    return [f"--socket={address.path}"] if address.path else [f"--host={address.host}", f"--port={address.port}"]

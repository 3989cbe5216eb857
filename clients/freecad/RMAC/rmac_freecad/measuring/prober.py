"""A probe led to places and back, step by step, as `rmac measure` leads it."""

from rmac_freecad.measuring.refusal import MeasuringRefused


class Prober:
    """`events` are those of `client`, which has authority; all that a stop, a fault or a lost connection has to say is raised."""

    def __init__(self, client, events, tip_radius_mm, clearance_mm, safe_mm, speed_mm_s):
        self._client, self._events = client, events
        self._tip, self._clearance, self._safe, self._speed = tip_radius_mm, clearance_mm, safe_mm, speed_mm_s
        self._id = max(0, client.state()["move_id"])
        client.start_cycle()
        events.so_far()  # what was before; a stop from here on is told
        state = client.at_rest()
        if state["state"] == "Idle":
            raise MeasuringRefused("the machine was stopped before it began")
        self._at = tuple(state["pose"][:3])

    def touch(self, place):
        """Up, across, down and onto it, and back. Where the surface was."""
        tip = _along(place.point, place.normal, self._tip)
        over = _along(tip, place.normal, self._clearance)
        for way in ((*self._at[:2], self._safe), (*over[:2], self._safe), over):
            self._go(self._client.cam.MoveToXYZ, way)
        hit = self._go(self._client.cam.AutoMeasure, tip)
        self._at = over
        if hit is None:
            raise MeasuringRefused("it was measured, and no hit was told")
        return _along(hit, place.normal, -self._tip)

    def leave(self):
        self._go(self._client.cam.MoveToXYZ, (*self._at[:2], self._safe))

    def _go(self, call, to):
        """Until it is done. Where the tip's centre was at the hit, if there was one."""
        self._id += 1
        call(self._id, *to, self._speed)
        hit = None
        for event in self._events:
            if event.kind in ("Fault", "Stopped"):
                raise MeasuringRefused(event.message)
            if event.kind == "Hit" and "pose" in event.told:
                hit = tuple(event.told["pose"][:3])
            if event.kind == "MoveDone" and event.move_id == self._id:
                return hit


def _along(point, normal, by):
    return tuple(a + by * b for a, b in zip(point, normal))

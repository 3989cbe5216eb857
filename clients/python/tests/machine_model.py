"""A machine as the protocol describes it, for tests: a queue that joins moves, refuses, fills and empties by chance."""

import json

from rmac.errors import refusal

FULL = {"code": -32015, "message": "the queue is full"}
APART = {"code": -32014, "message": "does not join on"}
WRONG = {"code": -32004, "message": "beyond travel"}


class MachineModel:
    def __init__(self, draw, capacity, beyond=lambda place: False):
        self.draw, self.capacity, self.beyond = draw, capacity, beyond
        self.end = (0.0, 0.0, 0.0)
        self.queue, self.done, self.taken, self.most = [], [], [], 0
        self.cycle, self.move_id = 10, 0
        self.waiting = []  # batches that were sent and not carried out
        self.stopping, self.stopped = 0, None  # so many cycles yet; the event, at rest
        self.refusing = 0  # so many batches that had been read when the queue was full

    def send(self, batch):
        self.waiting.append(batch)

    def carry_out(self):
        """The first batch that waits; gives its outcomes."""
        outcomes = []
        refusing = self.refusing > 0
        self.refusing = max(0, self.refusing - 1)
        for method, params in self.waiting.pop(0):
            error = FULL if refusing else self._add(method, json.loads(params))
            if error is FULL and not refusing:
                refusing, self.refusing = True, self.draw.randint(0, len(self.waiting))
            outcomes.append(refusal(method, error) if error else None)
        return outcomes

    def _add(self, method, params):
        target = params.get("TargetFrame") or params["EndPoint"]
        if len(self.queue) >= self.capacity:
            return FULL
        if "StartPoint" in params and max(abs(a - b) for a, b in zip(params["StartPoint"]["p"], self.end)) > 1e-3:
            return APART
        if self.beyond(target["p"]):
            return WRONG
        self.end = tuple(target["p"])
        self.queue.append(params["MoveID"])
        self.taken.append(params["MoveID"])
        self.most = max(self.most, len(self.queue))
        return None

    def work(self):
        """Does some of what is queued."""
        self.cycle += self.draw.randint(1, 20)
        if self.stopping:
            self.stopping -= 1
            self.stopped = {"cycle": self.cycle, "message": "after a StopNow"}
            return
        for _ in range(self.draw.randint(0, len(self.queue))):
            self.move_id = self.queue.pop(0)
            self.done.append(self.move_id)
        if self.queue:
            self.move_id = self.queue[0]

    def stop(self):
        """Drops the queue; the move that is under way is not done, and nothing is begun any more. It tells so some cycles later."""
        self.queue.clear()
        self.capacity = 0
        self.stopping = self.draw.randint(1, 6)
        self.tells_at = self.cycle + self.draw.randint(0, 9)

    def state(self):
        if self.stopping or self.stopped:
            if self.cycle < self.tells_at:
                return self._state("Running", self.draw.choice(("", "moves", "dwell")), None, self.draw.random() < 0.5)
            stands = not self.stopping
            return self._state("Idle" if stands else "Stopping", "", self.stopped if stands else None, not stands and self.draw.random() < 0.5)
        return self._state("Running", "" if self.queue else "moves", None, bool(self.queue))

    def _state(self, state, waits_for, last_stop, moving):
        return {
            "cycle": self.cycle, "move_id": self.move_id, "moves_in_buffer": len(self.queue), "moving": moving,
            "waits_for": waits_for, "state": state, "last_stop": last_stop, "last_error": None, "mechanism": "M",
        }

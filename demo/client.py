"""A CAM program's side of the wire: JSON-RPC 2.0, one object a line over TCP, with the standard library and numpy."""

import array
import collections
import json
import socket
import threading
import time

import numpy as np

from record import Record

STILL_ROWS = 50  # of an idle machine that are kept before and after motion


class Refused(Exception):
    """The appliance answered with an error."""

    def __init__(self, method, error):
        self.error = error
        self.minor = error.get("data", {}).get("minorName", "")
        super().__init__(f"{method} was refused: {error['message']} ({error['code']} {self.minor})")


class Recorder:
    """Rows of the `joints` topic while something moves, and a little before and after."""

    def __init__(self):
        self.rows = array.array("d")
        self.width = self.joints = 0
        self.cycles = self.lost = 0
        self.last_cycle = None
        self.first_motion = None  # wall clock
        self._before = collections.deque(maxlen=STILL_ROWS)
        self._still = 0
        self._last_q = None

    def add(self, sample):
        q, measured = sample["q"], sample["a"] + sample.get("held", [])
        row = [sample["t_s"], sample["move_id"], sample["s_mm"], sample["feed_mm_s"]]
        row += sample["pose"] + q + sample["qd"] + sample["qdd"] + measured
        if not self.width:
            self.width, self.joints = len(row), len(q)
        if self.last_cycle is not None and sample["cycle"] != self.last_cycle + 1:
            self.lost += 1
        self.last_cycle = sample["cycle"]
        self.cycles += 1
        moved = self._last_q is not None and q != self._last_q
        self._last_q = q
        if moved:
            if self.first_motion is None:
                self.first_motion = time.monotonic()
            for earlier in self._before:
                self.rows.extend(earlier)
            self._before.clear()
            self._still = 0
        self._still += not moved
        if moved or (self.rows and self._still <= STILL_ROWS):
            self.rows.extend(row)
        else:
            self._before.append(row)

    def record(self):
        if not self.rows:
            raise RuntimeError("nothing moved while the record was taken")
        return Record.from_table(np.frombuffer(self.rows).reshape(-1, self.width).copy(), self.joints)


class Client:
    def __init__(self, host, port, name="headlight demo"):
        self._socket = socket.create_connection((host, port), timeout=10)
        self._socket.settimeout(None)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._next_id = 0
        self._answers = {}
        self._changed = threading.Condition()
        self._closed = None
        self.events = []
        self.recorder = None
        threading.Thread(target=self._read, daemon=True).start()
        self.greeting = self.call("hello", client=name, version="1")

    def _read(self):
        try:
            with self._socket.makefile("rb", buffering=1 << 20) as lines:
                for line in lines:
                    self._take(json.loads(line))
            reason = "the appliance closed the connection"
        except (OSError, ValueError, KeyError) as error:
            reason = f"the connection broke: {error!r}"
        with self._changed:
            self._closed = reason
            self._changed.notify_all()

    def _take(self, message):
        if message.get("method") == "joints":
            recorder = self.recorder
            if recorder is not None:
                for sample in message["params"]["samples"]:
                    recorder.add(sample)
            with self._changed:
                self._changed.notify_all()
        elif message.get("method") == "events":
            self.events.append(message["params"])
        elif "id" in message:
            with self._changed:
                self._answers[message["id"]] = message
                self._changed.notify_all()

    def _wait(self, condition, seconds, what):
        with self._changed:
            if not self._changed.wait_for(lambda: condition() or self._closed, seconds):
                raise TimeoutError(f"{what} did not come within {seconds:.0f} s")
            if self._closed and not condition():
                raise ConnectionError(f"{self._closed} while waiting for {what}")

    def send(self, method, parameters):
        """Sends without waiting; `answer` collects what comes back."""
        self._next_id += 1
        request = {"jsonrpc": "2.0", "id": self._next_id, "method": method, "params": parameters}
        self._socket.sendall((json.dumps(request) + "\n").encode())
        return self._next_id, method

    def answer(self, sent, seconds=60):
        number, method = sent
        self._wait(lambda: number in self._answers, seconds, f"the answer to {method}")
        message = self._answers.pop(number)
        if "error" in message:
            raise Refused(method, message["error"])
        return message["result"]

    def call(self, method, **parameters):
        return self.answer(self.send(method, parameters))

    def run(self, requests, window=64):
        """Sends a program, up to `window` requests ahead of their answers; the first refusal ends it."""
        waiting = collections.deque()
        try:
            for request in requests:
                waiting.append(self.send(request["method"], request["params"]))
                if len(waiting) >= window:
                    self.answer(waiting.popleft())
            while waiting:
                self.answer(waiting.popleft())
        except Refused:
            self.call("RMAC_CAM.StopNow")
            raise

    def wait_until_done(self, seconds=3600, poll_s=0.05):
        """Until the queue is empty and the machine rests, and the record has caught up. Returns the state then."""
        deadline = time.monotonic() + seconds
        stopping = False  # as every cycle does at its end, too
        while True:
            state = self.call("RMAC_CAM.GetState")
            stopping |= state["state"] == "Stopping"
            stopped_short = stopping and state["state"] == "Idle" and state["moves_in_buffer"] > 0
            if stopped_short or state["state"] not in ("Idle", "Running", "Stopping"):
                told = "; ".join(str(e.get("message", e)) for e in self.events[-3:])
                raise RuntimeError(f"the machine went to {state['state']} at move {state['move_id']}: {told}")
            if state["moves_in_buffer"] == 0 and not state["moving"]:
                break
            if time.monotonic() > deadline:
                raise TimeoutError(f"the machine still works on move {state['move_id']} after {seconds} s")
            time.sleep(poll_s)
        if self.recorder is not None:
            self._wait(lambda: (self.recorder.last_cycle or 0) >= state["cycle"], 120, "the record of the last cycle")
        return state

    def close(self):
        self._socket.close()

"""A JSON-RPC client for tests: newline-framed TCP, standard library only."""

import collections
import itertools
import json
import socket
import time

ANSWER_BOUND_S = 150.0  # loading a machine verifies it first, in a process of low priority
NOTE_BOUND_S = 100.0  # of notes that come and do not match: the test fails before the whole file is out of time


class Refused(Exception):
    """The appliance answered with an error."""

    def __init__(self, method, error):
        super().__init__(f"{method}: {error['code']} {error['message']}")
        self.code = error["code"]
        self.message = error["message"]
        self.minor = error.get("data", {}).get("minorName")


class Client:
    """One connection. Notifications that arrive while an answer is awaited wait in `notes`."""

    def __init__(self, port, name="test", hello=True):
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=ANSWER_BOUND_S)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._input = self._socket.makefile("rb")
        self._ids = itertools.count(1)
        self.notes = collections.deque()
        self.greeting = self.call("hello", client=name) if hello else None

    def close(self):
        self._input.close()
        self._socket.close()

    def send_bytes(self, data):
        self._socket.sendall(data)

    def read_line(self):
        """The next line as JSON, or None when the appliance closed the connection."""
        line = self._input.readline()
        return json.loads(line) if line else None

    def exchange(self, text):
        """Sends one raw line and returns the next answer, whatever its id."""
        self.send_bytes(text.encode() + b"\n")
        return self._next_answer()

    def ask(self, method, **params):
        """The whole answer, result or error."""
        request_id = next(self._ids)
        request = {"jsonrpc": "2.0", "id": request_id, "method": method, "params": params}
        self.send_bytes(json.dumps(request).encode() + b"\n")
        while True:
            answer = self._next_answer()
            if answer.get("id") == request_id:
                return answer

    def call(self, method, **params):
        """The result, or `Refused`."""
        answer = self.ask(method, **params)
        if "error" in answer:
            raise Refused(method, answer["error"])
        return answer["result"]

    def refusal(self, method, **params):
        """The error that the call must end in."""
        answer = self.ask(method, **params)
        if "error" not in answer:
            raise AssertionError(f"{method} was accepted: {answer}")
        return Refused(method, answer["error"])

    def state(self):
        return self.call("RMAC_CAM.GetState")

    def wait_note(self, topic, matches=lambda params: True, within_s=NOTE_BOUND_S):
        """The parameters of the first notification of `topic` that matches; earlier ones are dropped."""
        until = time.monotonic() + within_s
        last = None
        while True:
            note = self.notes.popleft() if self.notes else self._read_note()
            if note["method"] == topic:
                if matches(note["params"]):
                    return note["params"]
                last = note["params"]
            if time.monotonic() > until:
                raise AssertionError(f"no note of {topic} matched within {within_s} s; the last one: {last}")

    def _read_note(self):
        message = self._read_message()
        if "method" not in message:
            raise AssertionError(f"an answer that nobody waits for: {message}")
        return message

    def _next_answer(self):
        while True:
            message = self._read_message()
            if "method" not in message:
                return message
            self.notes.append(message)

    def _read_message(self):
        message = self.read_line()
        if message is None:
            raise ConnectionError("the appliance closed the connection")
        return message

"""Many subscribers on one thread: they read what they are sent, and look whether a cycle is missing; one stalls."""

import json
import selectors
import socket
import threading
import time

TOPICS = ["state", "joints", "drives", "events"]


class Crowd(threading.Thread):
    """`sockets`: connected. The first is told every cycle, the others 20 times a second; the last, which never reads, 100 times."""

    def __init__(self, sockets):
        super().__init__(daemon=True)
        self._stalled = sockets[-1]
        self._selector = selectors.DefaultSelector()
        self._buffers = {}
        self._ends = False
        self.lines = 0
        self.gaps = 0
        self.lost = 0  # readers that were cut off
        self._cycle = None
        for number, client in enumerate(sockets):
            self._send(client, "hello", {"client": f"subscriber {number}"})
            rate_hz = 1000 if number == 0 else 100 if client is self._stalled else 20
            self._send(client, "subscribe", {"topics": TOPICS, "rate_hz": rate_hz})
            if client is not self._stalled:
                client.setblocking(False)
                self._selector.register(client, selectors.EVENT_READ, number == 0)
                self._buffers[client] = b""

    @staticmethod
    def _send(client, method, params):
        client.sendall(json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params}).encode() + b"\n")

    def run(self):
        while not self._ends:
            for key, _ in self._selector.select(timeout=0.2):
                self._read(key.fileobj, watches=key.data)

    def _read(self, client, watches):
        try:
            data = client.recv(1 << 18)
        except BlockingIOError:
            return
        if not data:
            self.lost += 1
            self._selector.unregister(client)
            return
        *lines, self._buffers[client] = (self._buffers[client] + data).split(b"\n")
        self.lines += len(lines)
        if watches:
            for line in lines:
                self._watch(json.loads(line))

    def _watch(self, note):
        if note.get("method") != "drives":
            return
        for sample in note["params"]["samples"]:
            if self._cycle is not None and sample["cycle"] != self._cycle + 1:
                self.gaps += 1
            self._cycle = sample["cycle"]

    def stalled_is_cut_off(self):
        """Reads what the stalled one was left: true when its connection has ended behind that, and not merely goes on."""
        self._stalled.settimeout(1)
        give_up = time.monotonic() + 5
        try:
            while time.monotonic() < give_up:
                if not self._stalled.recv(1 << 18):
                    return True
        except ConnectionResetError:
            return True
        except TimeoutError:
            pass
        return False

    def end(self):
        self._ends = True
        self.join()


def connect(port, unix_socket, count):
    """So many connections, half of them over each: no user or address has more than its share."""
    made = []
    for number in range(count):
        if number % 2 == 0:
            made.append(socket.create_connection(("127.0.0.1", port), timeout=60))
        else:
            client = socket.socket(socket.AF_UNIX)
            client.connect(str(unix_socket))
            made.append(client)
    return made

"""The other side of a connection, as a test wants it to behave: a thread that says what it is told to."""

import json
import socket
import threading

from rmac.generated import API_VERSION

GREETING = {
    "server": "rmacd", "version": API_VERSION, "connection": 1, "units": {},
    "limits": {"queue_capacity": 10000, "line_bytes": 8388608, "cycle_hz": 1000.0},
}


class Peer:
    """Answers each request by `answers(request)`: a value to send as the result, bytes to send as they are, or None, which
    closes the connection."""

    def __init__(self, answers=lambda request: GREETING):
        self.answers = answers
        self.requests = []
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, kind, error, trace):
        self._listener.shutdown(socket.SHUT_RDWR)
        self._listener.close()
        self._thread.join()

    def _serve(self):
        try:
            while True:
                connection, _ = self._listener.accept()
                with connection, connection.makefile("rb") as lines:
                    self._answer(connection, lines)
        except OSError:
            pass

    def _answer(self, connection, lines):
        try:
            for line in lines:
                request = json.loads(line)
                self.requests.append(request)
                answer = self.answers(request)
                if answer is None:
                    return
                if not isinstance(answer, bytes):
                    answer = json.dumps({"jsonrpc": "2.0", "id": request["id"], "result": answer}).encode() + b"\n"
                connection.sendall(answer)
        except OSError:
            pass

"""Authority over the machine for as long as it is moved by hand."""

import threading


class Hand:
    def __init__(self, connect):
        """`connect()` gives the client, connected."""
        self._connect = connect
        self._lock = threading.Lock()
        self._client = None
        self._authority = None

    def client(self):
        """The client, with authority; raises `rmac.AuthorityHeld` where another one has it. By threads that may wait."""
        with self._lock:
            client = self._connect()
            if self._authority is None or self._client is not client:
                authority = client.authority()
                authority.__enter__()
                self._client, self._authority = client, authority
            return client

    def leave(self):
        """Gives authority back, which stops a machine that still moves."""
        with self._lock:
            authority, self._authority, self._client = self._authority, None, None
            if authority is not None:
                authority.__exit__(None, None, None)

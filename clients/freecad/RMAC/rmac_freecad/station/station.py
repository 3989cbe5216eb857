"""One connection, and threads that wait for its answers: the window itself never does."""

import queue
import threading

import rmac
from rmac.hearing import Hearer

STATE_RATE_HZ = 20


class NotConnected(rmac.RmacError):
    """Nothing was asked of the appliance yet."""


class Station:
    """What came of a question is kept until the thread of the window takes it by `deliver`. `state` is what the machine told
    last, as the topic `state` has it; None without a connection."""

    def __init__(self, name="FreeCAD"):
        self._name = name
        self._client = None
        self._connecting = threading.Lock()
        self._come = queue.SimpleQueue()
        self._listeners = []
        self.state = None
        self.stops = 0  # so often it was asked to stop: what was to begin then does not

    @property
    def connected(self):
        return self._client is not None and self._client.lost is None

    @property
    def client(self):
        """The connection; `NotConnected` before there was one."""
        if self._client is None:
            raise NotConnected("there is no connection to the appliance; choose Select machine")
        return self._client

    def connect(self, address):
        """Waits for the appliance: not to be called by the window. A connection to the same address that lasts is kept."""
        with self._connecting:
            if self.connected and str(self._client.address) == str(rmac.address.parse_address(address)):
                return self._client
            self.disconnect()
            client = rmac.connect(address, self._name)
            client.hear(Hearer("state", STATE_RATE_HZ, self._hear, lambda error: self._lose(client, error)))
            self._client = client
            return client

    def disconnect(self):
        """Stops what this station moves: authority ends with its connection."""
        client, self._client = self._client, None
        self.state = None
        if client is not None:
            client.close()

    def on_loss(self, listener):
        """`listener(error)`, by `deliver`, when the connection is lost."""
        self._listeners.append(listener)

    def ask(self, what, done=None, failed=None):
        """`what()` by a thread of its own, since a stop must wait behind nothing; then `done(answer)` or `failed(error)` by
        `deliver`."""
        threading.Thread(target=self._carry_out, args=(what, done, failed), name="rmac question", daemon=True).start()

    def tell(self, listener, *what):
        """From any thread: has `deliver` call it."""
        self._come.put((listener, what))

    def deliver(self):
        """By the thread of the window, again and again."""
        while not self._come.empty():
            listener, what = self._come.get()
            listener(*what)

    def stop(self, address, done=None, failed=None):
        """Whoever moves the machine: anybody who is connected may stop it."""
        self.stops += 1
        self.ask(lambda: self.connect(address).cam.StopNow(), done, failed)

    def _hear(self, state):
        self.state = state

    def _lose(self, client, error):
        if client is not self._client:
            return  # it was closed from here
        self.state = None
        for listener in self._listeners:
            self.tell(listener, error)

    def _carry_out(self, what, done, failed):
        try:
            answer = what()
        except Exception as error:  # whatever it is, the one who asked tells the user
            if failed is not None:
                self.tell(failed, error)
        else:
            if done is not None:
                self.tell(done, answer)

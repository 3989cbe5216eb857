"""The SDO server of canopen_node.py with the manners of servers: what it leaves out, what it adds, and when it answers."""

import collections

from dictionary import Abort
from canopen_node import MUX, SdoServer

UNKNOWN_COMMAND = 0x05040001


class StrangeServer(SdoServer):
    def __init__(self, dictionary, manners):
        super().__init__(dictionary)
        self._manners = manners
        dictionary.blocks, dictionary.sizes = not manners.no_blocks, not manners.no_sizes

    def upload(self, request):
        size = len(self.objects.read(self.key))
        if self._manners.expedited_only and not 0 < size <= 4:
            raise Abort(UNKNOWN_COMMAND)
        if self._manners.always_segmented and 0 < size <= 4:
            self.data, self.step = self.objects.read(self.key), self.upload_segment
            told = 0 if self._manners.no_sizes else size
            yield bytes([0x40 | (told > 0)]) + self.mux + told.to_bytes(4, "little")
            return
        for answer in super().upload(request):
            if self._manners.no_sizes and answer[0] & 2:
                answer = b"\x42" + answer[1:]
            if self._manners.stale_bytes and answer[0] & 3 == 3:
                answer = answer[:4 + size] + bytes([0xA5] * (4 - size))
            yield answer

    def download(self, request):
        if self._manners.expedited_only and not request[0] & 2:
            raise Abort(UNKNOWN_COMMAND)
        for answer in super().download(request):
            yield answer[:4] + b"\xA5" * 4 if self._manners.stale_bytes else answer


class Mailbox:
    """Requests one after the other, each with its time; `due(now)` gives the answers whose time has come."""

    def __init__(self, server, manners):
        self._server, self._manners = server, manners
        self._requests = collections.deque()  # (not before, request)
        self._ignored = self._answered = 0
        self._wrong = manners.sdo_wrong_index_once
        self._busy_until = 0.0
        self.requests = 0

    @property
    def next_at(self):
        return self._requests[0][0] if self._requests else None

    def take(self, request, now):
        self.requests += 1
        if self._ignored < self._manners.sdo_ignore_first:
            self._ignored += 1
            return
        if request[0] == 0x80:
            if not self._manners.sdo_deaf_to_abort:
                self._requests.clear()
                self._busy_until = now
            list(self._server.handle(request))
            return
        if self._requests and self._manners.sdo_deaf_to_abort and not self._manners.sdo_queues:
            return
        self._busy_until = max(self._busy_until, now) + self._manners.sdo_delay_ms / 1000
        self._requests.append((self._busy_until, request))

    def due(self, now):
        while self._requests and self._requests[0][0] <= now:
            for answer in self._server.handle(self._requests.popleft()[1]):
                yield from self._sent(answer)

    def _sent(self, answer):
        self._answered += 1
        if self._manners.sdo_lose_every and self._answered % self._manners.sdo_lose_every == 0:
            return
        if self._wrong and answer[0] >> 5 in (2, 3) and answer[MUX] != bytes(3):
            self._wrong = False
            answer = answer[:1] + bytes([answer[1] ^ 1]) + answer[2:]
        yield answer
        if self._manners.sdo_twice:
            yield answer

#!/usr/bin/python3
"""A CANopen node on python3-can, written after the standards and after nothing of this repository: the master's independent peer in the
emulated machine. CiA 301: NMT, boot-up and heartbeat, SDO server (expedited, segmented, block with CRC and the switch to segments). CiA 305:
LSS slave. A word a node: NODE:SERIAL, or SERIAL alone for one without a node id."""

import sys
import time

import can

VENDOR, PRODUCT, REVISION = 0x2A5, 0x80000077, 0x00010002
NO_NODE = 255
DATA, READ_ONLY, WRITE_ONLY, WORD, OPTIONS, TIMING = 0x2000, 0x2002, 0x2003, 0x2004, 0x2001, 0x2005
MUX = slice(1, 4)


class Abort(Exception):
    """The server's, by its code in table 22 of CiA 301."""


def number(data):
    return int.from_bytes(data, "little")


def crc(data):
    """Polynomial x^16 + x^12 + x^5 + 1, beginning with 0 (CiA 301, 7.2.4.3.16)."""
    value = 0
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1 ^ 0x1021 if value & 0x8000 else value << 1) & 0xFFFF
    return value


class Objects:
    """The dictionary: bytes by (index, sub-index)."""

    def __init__(self, serial):
        self.serial = serial
        self.values = {
            (0x1000, 0): bytes(4), (0x1001, 0): bytes(1), (0x1008, 0): b"a node in Python, on python3-can",
            (0x1010, 0): bytes([1]), (0x1010, 1): (1).to_bytes(4, "little"), (0x1017, 0): bytes(2), (0x1018, 0): bytes([4]),
            **{(0x1018, i + 1): part.to_bytes(4, "little") for i, part in enumerate(self.identity)},
            (DATA, 0): b"", (READ_ONLY, 0): bytes(2), (WRITE_ONLY, 0): bytes(2), (WORD, 0): bytes(2), (TIMING, 0): bytes([255]),
            # How the server goes about it: segments in a block, whether it knows blocks, whether it tells sizes, whether it has a CRC.
            (OPTIONS, 0): bytes([4]), (OPTIONS, 1): bytes([127]), (OPTIONS, 2): bytes([1]), (OPTIONS, 3): bytes([1]), (OPTIONS, 4): bytes([1])}

    @property
    def identity(self):
        return VENDOR, PRODUCT, REVISION, self.serial

    def option(self, sub):
        return self.values[OPTIONS, sub][0]

    def find(self, key):
        if key in self.values:
            return self.values[key]
        raise Abort(0x06090011 if any(index == key[0] for index, _ in self.values) else 0x06020000)

    def read(self, key):
        value = self.find(key)
        if key[0] == WRITE_ONLY:
            raise Abort(0x06010001)
        return value

    def write(self, key, data):
        before = self.find(key)
        if key[0] not in (0x1010, 0x1017, DATA, OPTIONS, WRITE_ONLY, WORD) or (key[1] == 0 and key[0] in (0x1010, OPTIONS)):
            raise Abort(0x06010002)
        if key[0] == 0x1010:
            if data != b"save":
                raise Abort(0x08000020)
            return
        if key[0] != DATA and len(data) != len(before):
            raise Abort(0x06070012 if len(data) > len(before) else 0x06070013)
        if key[0] == WORD and number(data) > 1000:
            raise Abort(0x06090031)
        self.values[key] = bytes(data)


class SdoServer:
    """One transfer at a time (CiA 301, 7.2.4.3). `handle` yields the bytes of the answers."""

    def __init__(self, objects):
        self.objects = objects
        self.end()

    def end(self):
        self.step, self.data, self.toggle = None, b"", 0

    def handle(self, request):
        try:
            if request[0] == 0x80:
                self.end()
            elif self.step == self.block_download_segment:
                yield from self.block_download_segment(request)
            else:
                yield from self.dispatch(request)
        except Abort as abort:
            named = getattr(self, "mux", bytes(3))
            self.end()
            yield bytes([0x80]) + named + abort.args[0].to_bytes(4, "little")

    def dispatch(self, request):
        specifier = request[0] >> 5
        if specifier in (1, 2) or (specifier == 5 and not request[0] & 3) or (specifier == 6 and not request[0] & 1):
            self.end()
            self.mux = bytes(request[MUX])
            self.key = number(self.mux[:2]), self.mux[2]
            begin = {1: self.download, 2: self.upload, 5: self.block_upload, 6: self.block_download}[specifier]
            yield from begin(request)
        elif self.step:
            yield from self.step(request)
        else:
            raise Abort(0x05040001)

    def upload(self, _):
        self.data = self.objects.read(self.key)
        size = len(self.data)
        if 0 < size <= 4:
            yield bytes([0x43 | (4 - size) << 2]) + self.mux + self.data.ljust(4, b"\0")
            return
        self.step = self.upload_segment
        tells = self.objects.option(3)
        yield bytes([0x40 | tells]) + self.mux + (size if tells else 0).to_bytes(4, "little")

    def upload_segment(self, request):
        if request[0] >> 5 != 3:
            raise Abort(0x05040001)
        if request[0] >> 4 & 1 != self.toggle:
            raise Abort(0x05030000)
        part, self.data = self.data[:7], self.data[7:]
        answer = bytes([self.toggle << 4 | (7 - len(part)) << 1 | (not self.data)]) + part.ljust(7, b"\0")
        self.toggle ^= 1
        if not self.data:
            self.end()
        yield answer

    def download(self, request):
        self.objects.find(self.key)
        if request[0] & 2:
            size = 4 - (request[0] >> 2 & 3) if request[0] & 1 else 4
            self.objects.write(self.key, request[4:4 + size])
        else:
            self.step = self.download_segment
            self.announced = number(request[4:8]) if request[0] & 1 else None
        yield bytes([0x60]) + self.mux + bytes(4)

    def finish_download(self):
        if self.announced is not None and len(self.data) != self.announced:
            raise Abort(0x06070010)
        self.objects.write(self.key, self.data)
        self.end()

    def download_segment(self, request):
        if request[0] >> 5 != 0:
            raise Abort(0x05040001)
        if request[0] >> 4 & 1 != self.toggle:
            raise Abort(0x05030000)
        self.data += bytes(request[1:8 - (request[0] >> 1 & 7)])
        answer = bytes([0x20 | self.toggle << 4]) + bytes(7)
        self.toggle ^= 1
        if request[0] & 1:
            self.finish_download()
        yield answer

    def block_upload(self, request):
        if not self.objects.option(2):
            raise Abort(0x05040001)
        self.data = self.objects.read(self.key)
        self.block, threshold = request[4], request[5]
        if not 1 <= self.block <= 127:
            raise Abort(0x05040002)
        if threshold and len(self.data) <= threshold:  # the client's wish: as a normal upload
            yield from self.upload(request)
            return
        tells, self.with_crc = self.objects.option(3), self.objects.option(4) and request[0] >> 2 & 1
        self.step = self.block_upload_go
        self.sent = 0
        size = len(self.data) if tells else 0
        yield bytes([0xC0 | self.objects.option(4) << 2 | tells << 1]) + self.mux + size.to_bytes(4, "little")

    def block_upload_go(self, request):
        if request[0] != 0xA3:
            raise Abort(0x05040001)
        yield from self.segments()

    def segments(self):
        self.step = self.block_upload_acknowledged
        for sequence in range(1, self.block + 1):
            at = self.sent + 7 * (sequence - 1)
            last = at + 7 >= len(self.data)
            yield bytes([last << 7 | sequence]) + self.data[at:at + 7].ljust(7, b"\0")
            if last:
                return

    def block_upload_acknowledged(self, request):
        if request[0] != 0xA2:
            raise Abort(0x05040001)
        if request[1] > self.block:
            raise Abort(0x05040003)
        self.sent += 7 * request[1]
        self.block = request[2]
        if not 1 <= self.block <= 127:
            raise Abort(0x05040002)
        if self.sent < max(len(self.data), 1):
            yield from self.segments()
            return
        unused = (7 - len(self.data) % 7) % 7 if self.data else 7
        self.step = self.block_upload_end
        yield bytes([0xC1 | unused << 2]) + (crc(self.data) if self.with_crc else 0).to_bytes(2, "little") + bytes(5)

    def block_upload_end(self, request):
        if request[0] != 0xA1:
            raise Abort(0x05040001)
        self.end()
        yield from ()

    def block_download(self, request):
        if not self.objects.option(2):
            raise Abort(0x05040001)
        self.objects.find(self.key)
        self.announced = number(request[4:8]) if request[0] & 2 else None
        self.with_crc = self.objects.option(4) and request[0] >> 2 & 1
        self.block, self.sequence = self.objects.option(1), 0
        self.step = self.block_download_segment
        yield bytes([0xA0 | self.objects.option(4) << 2]) + self.mux + bytes([self.block, 0, 0, 0])

    def block_download_segment(self, request):
        sequence, last = request[0] & 0x7F, request[0] >> 7
        if sequence == self.sequence + 1:
            self.sequence = sequence
            self.data += bytes(request[1:8])
        else:
            last = 0  # what follows a gap does not count, and comes again
        if not last and sequence < self.block:
            return
        answer = bytes([0xA2, self.sequence, self.block]) + bytes(5)
        self.sequence = 0
        if last:
            self.step = self.block_download_end
        yield answer

    def block_download_end(self, request):
        if request[0] & 0xE3 != 0xC1:
            raise Abort(0x05040001)
        self.data = self.data[:len(self.data) - (request[0] >> 2 & 7)]
        if self.with_crc and number(request[1:3]) != crc(self.data):
            raise Abort(0x05040004)
        self.finish_download()
        yield bytes([0xA1]) + bytes(7)


class LssSlave:
    """CiA 305. `handle` answers bytes, or None."""

    def __init__(self, node, identity):
        self.node = self.pending = node
        self.identity = identity
        self.configures = False
        self.selected = self.position = 0
        self.timing = NO_NODE
        self.activates = None

    def handle(self, data):
        command, rest = data[0], data[1:]
        if command == 0x04:
            self.configures = data[1] == 1
            return None
        if 0x40 <= command <= 0x43:
            part = command - 0x40
            fits = (part == 0 or part == self.selected) and number(rest[:4]) == self.identity[part]
            self.selected = part + 1 if fits else 0
            if self.selected < 4:
                return None
            self.selected, self.configures = 0, True
            return [0x44]
        if command == 0x51:
            return self.fast_scan(number(rest[:4]), *rest[4:7])
        if not self.configures:
            return None
        if command == 0x11:
            good = 1 <= data[1] <= 127 or data[1] == NO_NODE
            self.pending = data[1] if good else self.pending
            return [0x11, 0 if good else 1]
        if command == 0x13:
            good = data[1] == 0 and data[2] in (0, 2, 3, 4)  # 1000, 500, 250 and 125 kbit/s
            self.timing = data[2] if good else self.timing
            return [0x13, 0 if good else 1]
        if command == 0x15:
            self.activates = number(rest[:2]) / 1000
            return None
        if command == 0x17:
            return [0x17, 0]
        if 0x5A <= command <= 0x5D:
            return [command, *self.identity[command - 0x5A].to_bytes(4, "little")]
        return [0x5E, self.node] if command == 0x5E else None

    def fast_scan(self, asked, bit, part, following):
        if self.configures or self.node != NO_NODE or self.pending != NO_NODE:
            return None
        if bit == 0x80:
            self.position = 0
            return [0x4F]
        if bit > 31 or part != self.position or asked >> bit != self.identity[part] >> bit:
            return None
        self.position = following
        if bit == 0 and following < part:
            self.configures = True
        return [0x4F]


class Node:
    def __init__(self, send, node, serial):
        self.send = send
        self.objects = Objects(serial)
        self.lss = LssSlave(node, self.objects.identity)
        self.silent_until = 0
        self.boot()

    def boot(self):
        """Initialisation ends in the boot-up message and Pre-operational; without a node id it waits for LSS."""
        self.lss.node = self.lss.pending
        self.sdo, self.state, self.beats_at = SdoServer(self.objects), 0x7F, 0
        if self.lss.node != NO_NODE:
            self.send(0x700 + self.lss.node, [0])

    def handle(self, identifier, data, now):
        if now < self.silent_until:
            return
        if identifier == 0x7E5 and len(data) == 8:
            answer = self.lss.handle(data)
            if answer:
                self.send(0x7E4, bytes(answer).ljust(8, b"\0"))
            if self.lss.activates is not None:
                self.silent_until, self.lss.activates = now + 2 * self.lss.activates, None
                self.objects.values[TIMING, 0] = bytes([self.lss.timing])
            # A node that had no id comes up once it has one and configures no longer.
            if self.lss.node == NO_NODE and self.lss.pending != NO_NODE and not self.lss.configures:
                self.boot()
        elif self.lss.node == NO_NODE:
            return
        elif identifier == 0 and len(data) == 2 and data[1] in (0, self.lss.node):
            if data[0] in (0x81, 0x82):
                self.boot()
            else:
                self.state = {1: 5, 2: 4, 0x80: 0x7F}.get(data[0], self.state)
        elif identifier == 0x600 + self.lss.node and len(data) == 8 and self.state != 4:
            for answer in self.sdo.handle(data):
                self.send(0x580 + self.lss.node, answer)

    def poll(self, now):
        period = number(self.objects.values[0x1017, 0]) / 1000
        if period and self.lss.node != NO_NODE and now >= max(self.beats_at, self.silent_until):
            self.beats_at = now + period
            self.send(0x700 + self.lss.node, [self.state])


def main():
    interface, *words = sys.argv[1:]
    bus = can.interface.Bus(channel=interface, interface="socketcan")

    def send(identifier, data):
        bus.send(can.Message(arbitration_id=identifier, data=bytes(data), is_extended_id=False))

    nodes = []
    for word in words:
        node, _, serial = word.rpartition(":")
        nodes.append(Node(send, int(node or NO_NODE), int(serial, 0)))
    print("up", flush=True)
    while True:
        message = bus.recv(0.01)
        now = time.monotonic()
        for node in nodes:
            if message is not None and not message.is_error_frame:
                node.handle(message.arbitration_id, message.data, now)
            node.poll(now)


if __name__ == "__main__":
    main()

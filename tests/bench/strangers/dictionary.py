"""The object dictionary of a CANopen device: what may be read and written, by CiA 301, 7.4 and the abort codes of table 22."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from canopen_node import Abort, number  # noqa: E402

ABSENT, NO_SUB, READ_ONLY, WRITE_ONLY = 0x06020000, 0x06090011, 0x06010002, 0x06010001
TOO_LONG, TOO_SHORT, BAD_VALUE, STATE_FORBIDS = 0x06070012, 0x06070013, 0x06090030, 0x08000022
MAKERS_RANGE = 0x2000


class Dictionary:
    """Values by (index, sub-index), as the bytes that travel. What the SDO server of canopen_node.py asks."""

    def __init__(self):
        self.values, self._defaults, self._access, self._checks, self._written = {}, {}, {}, {}, {}
        self.refuses, self.refuses_write = {}, {}  # (index, sub-index) or index: abort code
        self.forbids = lambda index: False  # to write it in the present state
        self.blocks = self.sizes = True

    def add(self, index, sub, value, size, access="rw", check=None, written=None):
        """`check` raises Abort for a value that is not to be taken; `written` is told of one that was."""
        key = index, sub
        self.values[key] = self._defaults[key] = value if isinstance(value, bytes) else (value & (1 << 8 * size) - 1).to_bytes(size, "little")
        self._access[key], self._checks[key], self._written[key] = access, check, written

    def remove(self, index, sub=None):
        for key in [key for key in self.values if key[0] == index and sub in (None, key[1])]:
            del self.values[key]

    def reset(self, application):
        """Power-on values: of the communication profile, and with `application` of everything."""
        for key in self.values:
            if application or key[0] < MAKERS_RANGE:
                self.values[key] = self._defaults[key]

    def get(self, index, sub=0):
        return number(self.values[index, sub])

    def get_signed(self, index, sub=0):
        return int.from_bytes(self.values[index, sub], "little", signed=True)

    def set(self, index, value, sub=0):
        size = len(self.values[index, sub])
        self.values[index, sub] = (value & (1 << 8 * size) - 1).to_bytes(size, "little")

    def set_default(self, index, value, sub=0):
        self.set(index, value, sub)
        self._defaults[index, sub] = self.values[index, sub]

    def find(self, key):
        self._refuse(self.refuses, key)
        if key not in self.values:
            raise Abort(NO_SUB if any(index == key[0] for index, _ in self.values) else ABSENT)
        return self.values[key]

    def read(self, key):
        value = self.find(key)
        if self._access[key] == "wo":
            raise Abort(WRITE_ONLY)
        return value

    def write(self, key, data):
        before = self.find(key)
        self._refuse(self.refuses_write, key)
        if self._access[key] in ("ro", "const"):
            raise Abort(READ_ONLY)
        if self.forbids(key[0]):
            raise Abort(STATE_FORBIDS)
        if len(data) != len(before):
            raise Abort(TOO_LONG if len(data) > len(before) else TOO_SHORT)
        if self._checks[key]:
            self._checks[key](number(data))
        self.values[key] = bytes(data)
        if self._written[key]:
            self._written[key](number(data))

    def option(self, which):
        """Of the SDO server: segments in a block, whether it knows blocks, tells sizes, has a CRC."""
        return {1: 127, 2: self.blocks, 3: self.sizes, 4: True}[which]

    @staticmethod
    def _refuse(codes, key):
        code = codes.get(key, codes.get(key[0]))
        if code is not None:
            raise Abort(code)

"""PDOs, their communication parameters and their mapping, by CiA 301, 7.5.2.33 to 7.5.2.38."""

from dictionary import ABSENT, BAD_VALUE, STATE_FORBIDS, Abort

NOT_MAPPABLE, TOO_MANY_BITS = 0x06040041, 0x06040042
INVALID, NO_REMOTE, EXTENDED = 1 << 31, 1 << 30, 1 << 29
MOST_SYNCHRONOUS, EVENT_BY_MAKER, EVENT_BY_PROFILE = 240, 254, 255
DUMMIES = {(5, 0): 8, (6, 0): 16, (7, 0): 32}


def restricted(identifier):
    """CiA 301, table 40: identifiers that no PDO may have."""
    ranges = ((0, 0x7F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x7FF))
    return any(first <= identifier <= last for first, last in ranges)


class Pdo:
    """Object `communication` (14xxh, 18xxh) and the mapping 200h above it. `mappable`: bits by (index, sub-index)."""

    def __init__(self, dictionary, communication, identifier, contents, mappable, valid=True):
        self._dictionary, self._communication, self._mapping = dictionary, communication, communication + 0x200
        self._mappable = mappable
        sends = communication >= 0x1800
        flags = (0 if valid else INVALID) | (NO_REMOTE if sends else 0)
        dictionary.add(communication, 0, 5 if sends else 2, 1, "const")
        dictionary.add(communication, 1, identifier | flags, 4, check=self._check_identifier)
        dictionary.add(communication, 2, EVENT_BY_PROFILE, 1, check=self._check_type)
        if sends:
            dictionary.add(communication, 3, 0, 2)
            dictionary.add(communication, 5, 0, 2)
        dictionary.add(self._mapping, 0, len(contents), 1, check=self._check_count)
        for sub in range(1, 9):
            word = contents[sub - 1] if sub <= len(contents) else 0
            dictionary.add(self._mapping, sub, word, 4, check=self._check_entry)

    @property
    def valid(self):
        return not self._dictionary.get(self._communication, 1) & INVALID

    @property
    def identifier(self):
        return self._dictionary.get(self._communication, 1) & 0x7FF

    @property
    def type(self):
        return self._dictionary.get(self._communication, 2)

    @property
    def synchronous(self):
        return self.type <= MOST_SYNCHRONOUS

    def contents(self):
        """[((index, sub-index), bytes)]"""
        entries = (self._dictionary.get(self._mapping, sub + 1) for sub in range(self._dictionary.get(self._mapping)))
        return [((word >> 16, word >> 8 & 0xFF), (word & 0xFF) // 8) for word in entries]

    def length(self):
        return sum(size for _, size in self.contents())

    def pack(self):
        return b"".join(self._dictionary.values[key] for key, _ in self.contents())

    def unpack(self, data):
        """{(index, sub-index): bytes}, dummies left out."""
        found, at = {}, 0
        for key, size in self.contents():
            if key not in DUMMIES:
                found[key] = bytes(data[at:at + size])
            at += size
        return found

    def _check_identifier(self, word):
        if word & EXTENDED or (not word & INVALID and restricted(word & 0x7FF)):
            raise Abort(BAD_VALUE)
        if self.valid and not word & INVALID and word & 0x1FFFFFFF != self._dictionary.get(self._communication, 1) & 0x1FFFFFFF:
            raise Abort(STATE_FORBIDS)

    def _check_type(self, kind):
        if MOST_SYNCHRONOUS < kind < EVENT_BY_MAKER:
            raise Abort(BAD_VALUE)

    def _check_count(self, count):
        if self.valid:
            raise Abort(STATE_FORBIDS)
        if count > 8:
            raise Abort(TOO_MANY_BITS)
        words = [self._dictionary.get(self._mapping, sub + 1) for sub in range(count)]
        for word in words:
            self._check_object(word)
        if sum(word & 0xFF for word in words) > 64:
            raise Abort(TOO_MANY_BITS)

    def _check_entry(self, word):
        if self.valid or self._dictionary.get(self._mapping):
            raise Abort(STATE_FORBIDS)
        self._check_object(word)

    def _check_object(self, word):
        key, bits = (word >> 16, word >> 8 & 0xFF), word & 0xFF
        if key not in self._dictionary.values and key not in DUMMIES:
            raise Abort(ABSENT)
        if self._mappable.get(key) != bits:
            raise Abort(NOT_MAPPABLE)

"""The objects of a servo drive, by CiA 301 and CiA 402-2, and its PDOs."""

import motor
from dictionary import BAD_VALUE, Abort, Dictionary
from pdo import DUMMIES, Pdo

SERVO_DRIVE = 0x00020192
NAME = b"a drive in Python, by the standard"
MODES = 1 << 7 | 1 << 8 | 1 << 9  # 6502h: cyclic synchronous position, velocity, torque
RPDO_OBJECTS = {(0x6040, 0): 16, (0x6060, 0): 8, (0x6071, 0): 16, (0x607A, 0): 32, (0x60FF, 0): 32}
TPDO_OBJECTS = {(0x6041, 0): 16, (0x603F, 0): 16, (0x6061, 0): 8, (0x6064, 0): 32, (0x606C, 0): 32, (0x6077, 0): 16, (0x60FD, 0): 32,
                (0x1001, 0): 8}


def make(node, manners, written):
    """The dictionary, its RPDOs and its TPDOs. `written` has what is to be called when an object was."""
    d = Dictionary()
    communication(d, node, manners, written)
    device(d, written)
    for index in manners.absent:
        d.remove(*(index if isinstance(index, tuple) else (index,)))
    words = lambda text: [int(word, 16) for word in text.split()]  # noqa: E731
    first = lambda number, contents: words(contents) if number == 0 else []  # noqa: E731
    rpdos = [Pdo(d, 0x1400 + n, base + node, first(n, manners.rpdo), RPDO_OBJECTS | DUMMIES)
             for n, base in enumerate((0x200, 0x300, 0x400, 0x500)) if 0x1400 + n not in manners.absent]
    tpdos = [Pdo(d, 0x1800 + n, base + node, first(n, manners.tpdo), TPDO_OBJECTS)
             for n, base in enumerate((0x180, 0x280, 0x380, 0x480)) if 0x1800 + n not in manners.absent]
    for key, value in manners.value:
        d.set_default(key[0], value, key[1])
    d.refuses, d.refuses_write = dict(manners.refuse), dict(manners.refuse_write)
    if manners.fixed_mapping:
        d.refuses_write |= {base + n: 0x06010002 for base in (0x1600, 0x1A00) for n in range(4)}
    return d, rpdos, tpdos


def communication(d, node, manners, written):
    d.add(0x1000, 0, SERVO_DRIVE, 4, "ro")
    d.add(0x1001, 0, 0x81 if manners.history else 0, 1, "ro")
    d.add(0x1003, 0, len(manners.history), 1, check=only(0))
    for sub, code in enumerate(manners.history, 1):
        d.add(0x1003, sub, code, 4, "ro")
    d.add(0x1005, 0, 0x80, 4, check=only(0x80))
    d.add(0x1008, 0, NAME, len(NAME), "const")
    if manners.guarding_only:
        d.add(0x100C, 0, 0, 2, written=written["life"])
        d.add(0x100D, 0, 0, 1, written=written["life"])
    else:
        d.add(0x1017, 0, 0, 2, written=written["heartbeat"])
        d.add(0x1016, 0, 1, 1, "const")
        d.add(0x1016, 1, 0, 4, written=written["watch"])
    d.add(0x1014, 0, 0x80 + node, 4)
    d.add(0x1018, 0, 4, 1, "const")
    for sub, value in enumerate((0x2A5, 0x402, 0x10001, 0x5000 + node), 1):
        d.add(0x1018, sub, value, 4, "const")
    d.add(0x1029, 0, 1, 1, "const")
    d.add(0x1029, 1, 0, 1)


def device(d, written):
    d.add(0x6007, 0, 1, 2, check=only(*range(4)))
    d.add(0x603F, 0, 0, 2, "ro")
    d.add(0x6040, 0, 0, 2, written=written["controlword"])
    d.add(0x6041, 0, 0, 2, "ro")
    d.add(0x605A, 0, 2, 2, check=only(2))
    d.add(0x6060, 0, 0, 1, check=only(0, motor.POSITION, motor.VELOCITY, motor.TORQUE))
    for index, size in ((0x6061, 1), (0x6064, 4), (0x606C, 4), (0x6077, 2), (0x60FD, 4)):
        d.add(index, 0, 0, size, "ro")
    d.add(0x6071, 0, 0, 2)
    d.add(0x607A, 0, 0, 4)
    d.add(0x60FF, 0, 0, 4)
    d.add(0x607E, 0, 0, 1)
    d.add(0x6085, 0, int(motor.QUICK_STOP_COUNTS_S2), 4)
    for index, (one, two) in {0x608F: (131072, 1), 0x6091: (1, 1), 0x6092: (131072, 1)}.items():
        d.add(index, 0, 2, 1, "const")
        d.add(index, 1, one, 4)
        d.add(index, 2, two, 4)
    d.add(0x60C2, 0, 2, 1, "const")
    d.add(0x60C2, 1, 1, 1, check=only(*range(1, 256)))
    d.add(0x60C2, 2, -3, 1, check=only(*range(0xFD - 3, 0x100), 0))
    d.add(0x6502, 0, MODES, 4, "ro")


def only(*values):
    def check(value):
        if value not in values:
            raise Abort(BAD_VALUE)
    return check

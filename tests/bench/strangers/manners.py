"""What a drive may do that is legal by CiA 301 and 402, or that drives are known for: the options of drive.py, each off by default."""

import argparse
import dataclasses


def object_of(text):
    """"1402" or "1018:04" as a key of Dictionary.refuses."""
    index, _, sub = text.partition(":")
    return (int(index, 16), int(sub, 16)) if sub else int(index, 16)


def refusal(text):
    """"60C2=06010002": what is refused, and by which abort code."""
    what, code = text.split("=")
    return object_of(what), int(code, 16)


def entry(text):
    """"6502:00=00000080": an object and its value."""
    what, value = text.split("=")
    return object_of(what), int(value, 16)


def many(kind):
    return dataclasses.field(default_factory=list, metadata={"type": kind, "nargs": "+"})


def one(kind, default):
    return dataclasses.field(default=default, metadata={"type": kind})


def yes():
    return dataclasses.field(default=False, metadata={"action": "store_true"})


@dataclasses.dataclass
class Manners:
    """Names are those of the options, with - for _."""
    # The dictionary.
    refuse: list = many(refusal)  # to read and to write
    refuse_write: list = many(refusal)
    absent: list = many(object_of)
    value: list = many(entry)  # another one at power-on
    fixed_mapping: bool = yes()  # 16xxh and 1Axxh tell what they hold and refuse to be written
    rpdo: str = one(str, "60400010 607A0020")  # contents at power-on, of the first pair
    tpdo: str = one(str, "60410010 60640020")
    # SDO.
    sdo_ignore_first: int = one(int, 0)  # requests after each boot
    sdo_lose_every: int = one(int, 0)  # answer of so many
    sdo_delay_ms: float = one(float, 0.0)
    sdo_deaf_to_abort: bool = yes()  # works on when the client gave up, and takes no other request meanwhile
    sdo_queues: bool = yes()  # takes them, one after the other
    sdo_wrong_index_once: bool = yes()
    sdo_twice: bool = yes()  # each answer comes twice, as a gateway may have it
    expedited_only: bool = yes()
    always_segmented: bool = yes()  # what would fit into an expedited answer, too
    no_sizes: bool = yes()  # no answer tells its size
    stale_bytes: bool = yes()  # in what an answer does not use
    no_blocks: bool = yes()
    # NMT, boot and heartbeat.
    boot_s: float = one(float, 0.0)  # from the reset to the boot-up message
    boot_ups: int = one(int, 1)
    boot_up_gap_ms: float = one(float, 100.0)
    obeys_start_while_booting: bool = yes()  # and is operational once it has booted
    starts_itself: bool = yes()  # CiA 302-2, 1F80h
    mapped_before_start: bool = yes()  # 14xxh to 1Axxh are not to be written in Operational
    resets_itself_s: float = one(float, 0.0)  # again and again, for so long after the first reset that it is told
    resets_each_s: float = one(float, 1.0)
    heartbeat_toggles: bool = yes()
    heartbeat_step_ms: int = one(int, 1)  # periods are rounded up to whole ones
    guarding_only: bool = yes()  # 100Ch and 100Dh, no 1016h and 1017h
    life_from_writing: bool = yes()  # its life time runs from when 100Ch and 100Dh are written, not from the first question
    # EMCY.
    emcy_at_boot: int = one(int, 0)
    emcy_code: str = one(str, "FF01")
    history: list = many(lambda text: int(text, 16))  # 1003h, and 1001h not zero with it
    # Power states and statusword.
    not_ready_s: float = one(float, 0.0)
    fault_at_boot: str = one(str, "")  # 603Fh; until the controlword resets it
    fault_reset_s: float = one(float, 0.0)
    quick_stop_at_boot: bool = yes()
    enable_s: float = one(float, 0.0)
    status_delay: int = one(int, 0)  # SYNCs
    status_set: str = one(str, "0000")  # bits that are always 1
    status_clear: str = one(str, "0000")
    # PDO.
    tpdo_delay_ms: float = one(float, 0.0)
    position_delay: int = one(int, 0)  # SYNCs: 6064h tells where it was so many before
    skips_first_sync: int = one(int, 0)  # after the start, SYNCs without an answer
    chatters: bool = yes()  # a third TPDO, each 5 ms, whatever 1802h says


def add_arguments(parser):
    for field in dataclasses.fields(Manners):
        default = field.default if field.default is not dataclasses.MISSING else []
        parser.add_argument("--" + field.name.replace("_", "-"), default=default, **field.metadata)


def manners_of(words=()):
    parser = argparse.ArgumentParser()
    add_arguments(parser)
    return Manners(**vars(parser.parse_args(list(words))))

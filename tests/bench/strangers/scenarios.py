"""Each manner: what the drive is told to be like, what the machine is told of it, and what must come of it by the standard and docs/canopen.md."""

import dataclasses

MOVES, REFUSED = "moves", "refused"
ABORTS = ("06020000", "06010000", "06090011", "08000000", "08000022")
HEARTBEAT_MS = 50


@dataclasses.dataclass
class Scenario:
    """`text` is a regular expression: of the refusal, or of the daemon's log where it moves. `parameters` are added to those of device.json's
    CANopenInterface, `described` is what the library of drives says of it. `known` says why the appliance is known to miss it."""
    name: str
    options: str
    verdict: str = MOVES
    text: str = ""
    parameters: dict = dataclasses.field(default_factory=dict)
    mode: int = 8
    reset: bool = False  # the person does, where the refusal says so, and loads it again
    meanwhile: str = ""  # a frame that somebody else sends each tenth of a second while the machine is loaded, as cansend takes it
    described: dict = dataclasses.field(default_factory=dict)
    at_most: dict = dataclasses.field(default_factory=dict)  # of what the drive itself counts
    known: str = ""


def named(index, sub=None):
    """A reason that a commissioner can act on names the node and the object."""
    return rf"node 1\b.*{index}h" + (f":{sub:02d}" if sub is not None else "")


def aborts():
    for code in ABORTS:
        needless = " ".join(f"{index}={code}" for index in ("60C2", "6502", "608F", "1402", "1802"))
        yield Scenario(f"aborts 60C2h, 6502h, 608Fh, 1402h, 1802h by {code}h", f"--refuse {needless}", mode=10)
        for index in ("6007", "1016"):
            yield Scenario(f"aborts {index}h by {code}h", f"--refuse {index}={code}", REFUSED, named(index) + rf".*{code}")
    yield Scenario("aborts 60C2h by 06090011h, position mode", "--refuse 60C2=06090011")
    yield Scenario("aborts 6007h by 06010000h, not wanted", "--refuse 6007=06010000", parameters={"abort_connection": -1})


def dictionary():
    yield Scenario("has no 60C2h", "--absent 60C2")
    yield Scenario("60C2h is fixed, as the cycle", "--refuse-write 60C2=06010002 --value 60C2:01=2")
    yield Scenario("60C2h is fixed, another cycle", "--refuse-write 60C2=06010002 --value 60C2:01=8", REFUSED, named("60C2"))
    yield Scenario("60C2h is fixed, another cycle, torque mode", "--refuse-write 60C2=06010002 --value 60C2:01=8", mode=10)
    yield Scenario("1402h, 1802h cannot be switched off", "--refuse-write 1402=06010002 1403=06010002 1802=06010002 1803=06010002")
    yield Scenario("1802h cannot be switched off, and sends", "--refuse-write 1802=08000022 --chatters")
    yield Scenario("has two PDOs", "--absent 1401 1402 1403 1601 1602 1603 1801 1802 1803 1A01 1A02 1A03")
    yield Scenario("6502h denies the mode", "--value 6502:00=0x3", REFUSED, r"node 1\b.*(6502h|mode)")
    yield Scenario("has no serial number, no revision", "--absent 1018:03 1018:04")
    yield Scenario("has no 1018h", "--absent 1018")
    yield Scenario("another scale", "--value 608F:01=0x2710 6092:01=0x2710", REFUSED, r"axis 0\b.*10000.*131072")
    yield Scenario("6060h is fixed, as wanted", "--refuse-write 6060=06010002 --value 6060:00=8", REFUSED, named("6060"))
    yield Scenario("answers by events alone", "--refuse-write 1800:02=06090030", REFUSED, named("1800"))
    yield Scenario("acts on setpoints as they come", "--refuse-write 1400:02=06010002 --value 1400:02=0xFF", REFUSED, named(1400, 2))
    yield Scenario("identifiers are fixed, as wanted", "--refuse-write 1400:01=06010002", text=r"node 1\b.*keeps 1400h")
    yield Scenario("identifiers are fixed, others", "--refuse-write 1400:01=06010002 --value 1400:01=0x205", REFUSED, named(1400, 1))
    yield Scenario("mapping is fixed, as wanted", "--fixed-mapping", text=r"node 1\b.*keeps 1600h")
    yield Scenario("mapping is fixed, another", "--fixed-mapping --tpdo 60410010", REFUSED, named("1[6A]00"))
    yield Scenario("mapping is fixed, more than wanted", "--fixed-mapping --tpdo '60410010 60640020 60770010'", REFUSED, named("1[6A]00"))
    yield Scenario("device type has bits of the maker", "--value 1000:00=0x4420192")
    yield Scenario("1001h and 1003h at boot", "--history 1000 8130 7305")


def sdo():
    yield Scenario("first request of a boot unanswered", "--sdo-ignore-first 1")
    yield Scenario("first 4 requests of a boot unanswered", "--sdo-ignore-first 4")
    yield Scenario("each 7th answer lost", "--sdo-lose-every 7")
    yield Scenario("each 2nd answer lost", "--sdo-lose-every 2")
    yield Scenario("answers take 700 ms, known", "--sdo-delay-ms 700", parameters={"sdo_timeout_ms": [3000, 500, 500]})
    yield Scenario("answers take 1.5 s, known", "--sdo-delay-ms 1500", parameters={"sdo_timeout_ms": [3000, 500, 500]})
    yield Scenario("answers take 700 ms, not known, works on", "--sdo-delay-ms 700 --sdo-deaf-to-abort")
    yield Scenario("answers take 700 ms, not known, works on, queues", "--sdo-delay-ms 700 --sdo-deaf-to-abort --sdo-queues", REFUSED,
                   r"node 1\b.*sdo_timeout_ms")
    yield Scenario("answers take 700 ms, not known", "--sdo-delay-ms 700", REFUSED, r"node 1\b.*sdo_timeout_ms")
    yield Scenario("answers take 450 ms", "--sdo-delay-ms 450")
    yield Scenario("one answer of another index", "--sdo-wrong-index-once")
    yield Scenario("each answer twice", "--sdo-twice")
    yield Scenario("expedited alone", "--expedited-only --no-blocks")
    yield Scenario("no block transfer", "--no-blocks")
    yield Scenario("all in segments", "--always-segmented")
    yield Scenario("tells no sizes", "--no-sizes")
    yield Scenario("tells no sizes, in segments", "--no-sizes --always-segmented")
    yield Scenario("unused bytes are stale", "--stale-bytes")


def boot():
    yield Scenario("boot-up message twice", "--boot-ups 2")
    yield Scenario("boot-up message three times", "--boot-ups 3 --boot-up-gap-ms 250")
    yield Scenario("boots for 3 s", "--boot-s 3")
    yield Scenario("boots for 8 s, not known", "--boot-s 8", REFUSED, r"node 1\b.*boot")
    yield Scenario("boots for 8 s, known", "--boot-s 8", parameters={"boot_timeout_s": 12})
    yield Scenario("obeys a start while it boots", "--boot-s 1 --obeys-start-while-booting", meanwhile="000#0101")
    yield Scenario("starts by itself", "--starts-itself")
    yield Scenario("starts by itself, takes no mapping then", "--starts-itself --mapped-before-start")
    yield Scenario("resets itself each second for 4 s, boots for 0.8 s", "--resets-itself-s 4.5 --boot-s 0.8")
    yield Scenario("resets itself each 0.25 s for 1.6 s", "--resets-itself-s 1.6 --resets-each-s 0.25")
    yield Scenario("resets itself each 0.25 s for 4 s", "--resets-itself-s 4 --resets-each-s 0.25", REFUSED, r"node 1\b.*(boot|starts anew)")
    yield Scenario("EMCY storm at boot", "--emcy-at-boot 60")
    yield Scenario("EMCY of no error at boot", "--emcy-at-boot 1 --emcy-code 0000")


def heartbeat():
    yield Scenario("heartbeat with a toggle bit", "--heartbeat-toggles")
    yield Scenario("guarding, no 1016h and 1017h", "--guarding-only", REFUSED, named("1016"))
    guarded = {"NodeGuarding": True}
    yield Scenario("guarding, described", "--guarding-only", text="node 1 knows no heartbeat", described=guarded)
    # Its master's death, at the end, is one; its life time is a tenth of its set-up.
    yield Scenario("guarding, described, slow, lives from when it is told", "--guarding-only --life-from-writing --sdo-delay-ms 30",
                   described=guarded, at_most={"masters_lost": 1})
    yield Scenario("heartbeat in steps of 20 ms", "--heartbeat-step-ms 20")
    yield Scenario("heartbeat from power-on", "--value 1017:00=0x64")


def power():
    yield Scenario("status 1 cycle late", "--status-delay 1")
    yield Scenario("status 5 cycles late", "--status-delay 5")
    yield Scenario("status 5 cycles late, fault at first", "--status-delay 5 --fault-at-boot 7305", reset=True)
    yield Scenario("fault at first", "--fault-at-boot 7305", reset=True)
    yield Scenario("fault at first, of its master's death", "--fault-at-boot 8130", reset=True)
    yield Scenario("fault at first, goes after 300 ms", "--fault-at-boot 3220 --fault-reset-s 0.3", reset=True)
    yield Scenario("bits 14 and 15 set, 9 clear", "--status-set C000 --status-clear 0200")
    yield Scenario("bits 8, 9, 14, 15 set", "--status-set C300")
    yield Scenario("bit 7 set: a warning", "--status-set 0080")
    yield Scenario("bit 4 clear", "--status-clear 0010")
    yield Scenario("quick stop active at first", "--quick-stop-at-boot")
    yield Scenario("not ready for 2 s", "--not-ready-s 2")
    yield Scenario("enabled after 500 ms", "--enable-s 0.5")
    yield Scenario("enabled after 3 s", "--enable-s 3")


def pdo():
    yield Scenario("answers 0.5 ms after SYNC", "--tpdo-delay-ms 0.5")
    yield Scenario("first 3 SYNCs unanswered", "--skips-first-sync 3")
    yield Scenario("positions 3 cycles old", "--position-delay 3")
    yield Scenario("positions 3 cycles old, described", "--position-delay 3", described={"AnswerDelay": 3})
    yield Scenario("none", "")
    yield Scenario("none, torque mode", "", mode=10)


GROUPS = {group.__name__: group for group in (aborts, dictionary, sdo, boot, heartbeat, power, pdo)}
LSS = "lss"
KINDS = (*GROUPS, LSS)


def of(kind):
    return list(GROUPS[kind]()) if kind in GROUPS else []

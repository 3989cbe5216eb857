"""What `rmac bus lss` must make of nodes without an id: of CANopenNode's manner, too. Each scenario gives (what came, what was to come) as text."""

import json
import re
import subprocess

MOST_S = 60  # fast scan takes seven for each node, and as long again to see that there is no other


def rmac(*words):
    try:
        done = subprocess.run(["rmac", "--json", "bus", "lss", *map(str, words)], capture_output=True, text=True, timeout=MOST_S)
    except subprocess.TimeoutExpired:
        return 1, "", f"rmac bus lss {words[0]} did not end in {MOST_S} s"
    return done.returncode, done.stdout, done.stderr.strip()


def serials(answer):
    code, out, text = answer
    return sorted(node["serial_number"] for node in json.loads(out)) if code == 0 else text


def all_found(wanted):
    def scan():
        found = serials(rmac("scan", "vcan0"))
        return found == sorted(wanted), f"scan: {found}"
    return scan


def found_or_told(wanted):
    """All of them, or a reason that tells about nodes and what to do; one alone without a word would leave the others unnoticed."""
    def scan():
        found = serials(rmac("scan", "vcan0"))
        return found == sorted(wanted) or (isinstance(found, str) and re.search(r"node|fast scan", found) is not None and "did not end" not in found), f"scan: {found}"
    return scan


def assigned(*identity):
    def assign():
        words = ["--identity", *identity] if identity else []
        code, out, text = rmac("assign", "vcan0", 9, *words)
        asked = subprocess.run(["rmac", "bus", "scan", "vcan0"], capture_output=True, text=True)
        return code == 0 and re.search(r"^\s*9\s", asked.stdout, re.MULTILINE) is not None, f"assign: {text or out} scan: {asked.stderr or asked.stdout}"
    return assign


MATCHES, ANSWERS = "--when-selected matches", "--when-selected answers"
IDENTITY = (0x2A5, 0x80000077, 0x00010002)
# name, options of lss_nodes.py, serial numbers, what is done, why it is known to fail
SCENARIOS = (
    ("LSS by the standard, two nodes: scan", "", (7, 0x80000001), all_found((7, 0x80000001)), ""),
    ("LSS by the standard, one node: assign", "", (7,), assigned(), ""),
    *(row for who, manner in (("that matches on", MATCHES), ("of CANopenNode", ANSWERS)) for row in (
        (f"LSS {who}, one node: scan", manner, (7,), found_or_told((7,)), ""),
        (f"LSS {who}, one node: assign", manner, (7,), assigned(), ""),
        (f"LSS {who}, two nodes: scan", manner, (7, 0x80000001), found_or_told((7, 0x80000001)), ""),
        (f"LSS {who}, two nodes: assign by identity", manner, (7, 0x80000001), assigned(*IDENTITY, 7), ""))),
)

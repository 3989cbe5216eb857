#!/usr/bin/python3
"""Nodes without a node id, those of canopen_node.py, with manners of their own: one that fast scan has found, and that waits for its configuration, goes
on answering fast scan. usage: lss_nodes.py INTERFACE [--when-selected matches|answers] SERIAL …"""

import argparse
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from canopen_node import NO_NODE, LssSlave, Node  # noqa: E402


class Matches(LssSlave):
    """As if it had not been found. CiA 305 has fast scan answered by nodes in LSS waiting alone."""

    def fast_scan(self, asked, bit, part, following):
        selected, self.configures = self.configures, False
        answer = super().fast_scan(asked, bit, part, following)
        self.configures |= selected
        return answer


class Answers(LssSlave):
    """Whatever is asked for, as CANopenNode does: its slave compares in LSS waiting, and beyond that answers each fast scan with yes."""

    def fast_scan(self, asked, bit, part, following):
        return [0x4F] if self.configures else super().fast_scan(asked, bit, part, following)


MANNERS = {"": LssSlave, "matches": Matches, "answers": Answers}


def make(send, serial, when_selected=""):
    node = Node(send, NO_NODE, serial)
    node.lss = MANNERS[when_selected](NO_NODE, node.objects.identity)
    return node


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("interface")
    parser.add_argument("--when-selected", default="", choices=MANNERS)
    parser.add_argument("serials", nargs="+", type=lambda text: int(text, 0))
    options = parser.parse_args()
    import can
    bus = can.interface.Bus(channel=options.interface, interface="socketcan")

    def send(identifier, data):
        bus.send(can.Message(arbitration_id=identifier, data=bytes(data), is_extended_id=False))

    nodes = [make(send, serial, options.when_selected) for serial in options.serials]
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

#!/usr/bin/python3
"""A servo drive of CiA 402 on python3-can, written after the standards by somebody who has not read the master: whom the appliance must get on with,
whatever its manners (manners.py). usage: drive.py INTERFACE NODE [OPTION …]; it prints its states, and what became of it when it is ended."""

import argparse
import collections
import gc
import heapq
import itertools
import json
import pathlib
import signal
import sys
import time

import manners as manners_module
import objects
from axis import Axis
from nmt import Nmt, State
from sdo import Mailbox, StrangeServer

GUARD_LOST, LENGTH_ERROR = 0x8130, 0x8210
CHATTER_S = 0.005
COAST_S = 0.01
SYNC = 0x80


class Drive:
    """`send(identifier, bytes)` puts a frame onto the bus; `handle` takes what came, `poll` does what is due; `next_at` tells when that is."""

    def __init__(self, send, node, manners, now, tell=lambda text: None):
        self.send, self.node, self.manners, self._tell = send, node, manners, tell
        self.d, self.rpdos, self.tpdos = objects.make(node, manners, {
            "heartbeat": self._heartbeat_written, "watch": self._watch_written, "life": self._life_written, "controlword": lambda _: self.axis.controlword_written(self._now)})
        self.axis = Axis(self.d, manners)
        self.nmt = Nmt(self, manners)
        self.events, self._order = [], itertools.count()
        self.counts = collections.Counter()
        self._told = None
        self.d.forbids = lambda index: manners.mapped_before_start and 0x1400 <= index < 0x1C00 and self.nmt.state == State.OPERATIONAL
        self._resets_until, self._now = None, now
        self.reset(True, now)

    # What is to be done at a time.
    def at(self, when, action):
        heapq.heappush(self.events, (when, next(self._order), action))

    @property
    def next_at(self):
        times = [self.events[0][0]] if self.events else []
        return min([*times, self.sdo.next_at] if self.sdo.next_at is not None else times, default=None)

    def poll(self, now):
        self._now = now
        while self.events and self.events[0][0] <= now:
            heapq.heappop(self.events)[2](now)
        if self.nmt.state in (State.PRE_OPERATIONAL, State.OPERATIONAL):
            for answer in self.sdo.due(now):
                self.send(0x580 + self.node, answer)
        self._tell_changes()

    def handle(self, identifier, data, now, remote=False):
        self._now = now
        if remote:
            if self.nmt.guarded(identifier):
                self._keep_alive(now)
        elif identifier == 0:
            self.nmt.command(data, now)
        elif identifier == SYNC:
            self._synchronise(now)
        elif identifier == 0x600 + self.node:
            if len(data) == 8 and self.nmt.state in (State.PRE_OPERATIONAL, State.OPERATIONAL):
                self.sdo.take(data, now)
        elif identifier >> 7 == 0xE:
            self._watch(identifier & 0x7F, now)
        elif self.nmt.state == State.OPERATIONAL:
            self._take_pdo(identifier, data, now)
        self.poll(now)

    # NMT.
    def reset(self, application, now, told=False):
        self.counts["resets" if told else "resets_by_itself"] += 1
        self.events.clear()
        self.axis.drop()
        self.d.reset(application)
        self.axis.reset(application)
        self.sdo = Mailbox(StrangeServer(self.d, self.manners), self.manners)
        self._watched_until = None
        self._arrived = {}
        self._synced_at, self._syncs = None, 0
        self._skips = self.manners.skips_first_sync
        self.nmt.boot(now)
        self.at(now + COAST_S, self._coast)
        if told and self._resets_until is None:
            self._resets_until = now + self.manners.resets_itself_s
        if self._resets_until is not None and now + self.manners.resets_each_s < self._resets_until:
            self.at(now + self.manners.resets_each_s, lambda then: self.reset(True, then))

    def booted(self, now):
        """With the boot-up message."""
        self.at(now + self.manners.not_ready_s, lambda _: self.axis.initialise())
        for _ in range(self.manners.emcy_at_boot):
            self.emergency(int(self.manners.emcy_code, 16))
        if self.manners.chatters:
            self.at(now + CHATTER_S, self._chatter)

    def started(self):
        """PDOs by event are sent once then (CiA 301, 7.5.2.37)."""
        for pdo in self.tpdos:
            if pdo.valid and not pdo.synchronous and pdo.contents():
                self.send(pdo.identifier, pdo.pack())

    def emergency(self, code):
        self.counts["emergencies"] += 1
        self.send(0x80 + self.node, code.to_bytes(2, "little") + bytes([0x81 if code else self.d.get(0x1001)]) + bytes(5))

    def _heartbeat_written(self, milliseconds):
        step = self.manners.heartbeat_step_ms
        self.d.set(0x1017, -(-milliseconds // step) * step)
        self.nmt.heartbeat_changed()

    # The watch over the master (1016h): from its first heartbeat on.
    def _watch_written(self, _):
        self._watched_until = None

    def _watch(self, node, now):
        word = self.d.get(0x1016, 1) if (0x1016, 1) in self.d.values else 0
        period = (word & 0xFFFF) / 1000
        if period and word >> 16 & 0x7F == node:
            if self._watched_until is None:
                self.at(now + period, self._look_at_watch)
            self._watched_until = now + period

    def _look_at_watch(self, now):
        if self._watched_until is None:
            return
        if now < self._watched_until:
            self.at(self._watched_until, self._look_at_watch)
            return
        self._watched_until = None
        self.counts["masters_lost"] += 1
        self.emergency(GUARD_LOST)
        if self.nmt.state == State.OPERATIONAL and self.d.get(0x1029, 1) == 0:
            self.nmt.change(State.PRE_OPERATIONAL)

    # The same by guarding (100Ch times 100Dh): from the first question on, or from when it is told.
    def _life_written(self, _):
        self._watched_until = None
        if self.manners.life_from_writing:
            self._keep_alive(self._now)

    def _keep_alive(self, now):
        period = self.d.get(0x100C) * self.d.get(0x100D) / 1000
        if period:
            if self._watched_until is None:
                self.at(now + period, self._look_at_watch)
            self._watched_until = now + period

    # PDOs and the cycle.
    def _take_pdo(self, identifier, data, now):
        for number_, pdo in enumerate(self.rpdos):
            if pdo.valid and pdo.identifier == identifier and pdo.contents():
                if len(data) < pdo.length():
                    self.emergency(LENGTH_ERROR)
                elif pdo.synchronous:
                    self._arrived[number_] = pdo.unpack(data)
                else:
                    self.axis.command(pdo.unpack(data))

    def _synchronise(self, now):
        measured = now - self._synced_at if self._synced_at is not None else 0
        self._synced_at = now
        self._syncs += 1
        self.axis.step(measured)
        if self.nmt.state == State.OPERATIONAL:
            self._answer_sync(now)
            for values in self._arrived.values():
                self.axis.command(values)
        self._arrived.clear()
        self.axis.obey(now)

    def _coast(self, now):
        """What goes on without SYNC."""
        self.at(now + COAST_S, self._coast)
        if self._synced_at is None or now - self._synced_at > 2 * COAST_S:
            self._synced_at = None
            self.axis.step(COAST_S)
            self.axis.obey(now)

    def _answer_sync(self, now):
        if self._skips:
            self._skips -= 1
            return
        for pdo in self.tpdos:
            if pdo.valid and 1 <= pdo.type <= 240 and self._syncs % pdo.type == 0 and pdo.contents():
                data, identifier = pdo.pack(), pdo.identifier
                if self.manners.tpdo_delay_ms:
                    self.at(now + self.manners.tpdo_delay_ms / 1000, lambda _, i=identifier, d=data: self.send(i, d))
                else:
                    self.send(identifier, data)

    def _chatter(self, now):
        if self.nmt.state == State.OPERATIONAL:
            self.send(0x380 + self.node, self.d.values[0x6064, 0])
        self.at(now + CHATTER_S, self._chatter)

    def _tell_changes(self):
        state = self.nmt.state.name, self.axis.power.state.name
        if state != self._told:
            self._told = state
            self._tell(" ".join(state))

    def summary(self):
        return {"node": self.node, "nmt": self.nmt.state.name, "power": self.axis.power.state.name, "position": round(self.axis.motor.position),
                "sdo_requests": self.sdo.requests, **self.counts}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("interface")
    parser.add_argument("node", type=int)
    manners_module.add_arguments(parser)
    options = vars(parser.parse_args())
    import can
    bus = can.interface.Bus(channel=options.pop("interface"), interface="socketcan")

    def send(identifier, data):
        bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def tell(text):
        print(f"{time.monotonic():.6f} {text}", flush=True)

    drive = Drive(send, options.pop("node"), manners_module.Manners(**options), time.monotonic(), tell)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    gc.freeze()
    gc.disable()  # a collection in mid-cycle would cost cycles
    try:
        while True:
            until = drive.next_at
            message = bus.recv(0.5 if until is None else max(0.0, min(0.5, until - time.monotonic())))
            now = time.monotonic()
            if message is None or message.is_error_frame:
                drive.poll(now)
            else:
                drive.handle(message.arbitration_id, message.data, now, message.is_remote_frame)
    finally:
        print(json.dumps(drive.summary()), flush=True)


if __name__ == "__main__":
    main()

"""`rmac-vmodbus`: every register map that is shipped against the appliance, mbpoll and pymodbus beside it, faults on demand, and
requests that no master would send."""

import contextlib
import json
import os
import pathlib
import random
import re
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import unittest

from pymodbus.client import ModbusSerialClient
from test_modbus import Machine

BUILD = pathlib.Path(os.environ["RMAC_BUILD"])
BOUND_S = 60.0
SPINDLES = ("delta-vfd-b", "automationdirect-gs2", "toshiba-vf-s11", "hitachi-wj200", "powtran-pi500")


class Virtual:
    """rmac-vmodbus on a TCP port and a pseudo-terminal. A context manager; `drive` is itself, as `Machine` wants it."""

    def __init__(self, *devices, serial=False):
        self.devices, self.serial = devices, serial
        self._news = threading.Condition()
        self._lines = []
        self.turning_hz = 0.0
        self.drive = self

    def __enter__(self):
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="rmac-test-"))
            self.port_link = pathlib.Path(folder) / "port"
            self.process = stack.enter_context(subprocess.Popen(
                [BUILD / "bin/rmac-vmodbus", *self.devices, "--tcp", "0", "--pty", self.port_link, "--commands", "-", "--ramp", "1000"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1))
            stack.callback(self._end)
            self._reader = threading.Thread(target=self._read)
            self._reader.start()
            self.port = int(self.wait_line("listening on 127.0.0.1:").rsplit(":", 1)[1])
            self.wait_line("serial port")
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error):
        self._stack.__exit__(*error)

    def _end(self):
        self.process.stdin.close()
        self.process.terminate()
        if self.process.wait(BOUND_S) != 0:
            raise AssertionError(f"it ended with {self.process.returncode}")
        self._reader.join()

    def _read(self):
        for line in self.process.stdout:
            with self._news:
                self._lines.append(line.rstrip())
                if found := re.search(r"(forward|backward|stopped) at ([0-9.]+) of", line):
                    self.turning_hz = float(found[2]) * (-1 if found[1] == "backward" else 1)
                self._news.notify_all()

    def wait_line(self, part):
        """The first line with that in it that was not waited for yet."""
        with self._news:
            if not self._news.wait_for(lambda: any(part in line for line in self._lines), timeout=BOUND_S):
                raise AssertionError(f"no line with {part!r} in {self._lines}")
            while part not in (line := self._lines.pop(0)):
                pass
            return line

    def wait_for(self, reached):
        with self._news:
            if not self._news.wait_for(lambda: reached(self), timeout=BOUND_S):
                raise AssertionError(f"it did not come to that: {self._lines}")

    def tell(self, command, answer):
        self.process.stdin.write(command + "\n")
        return self.wait_line(answer)

    def parameters(self):
        return {"device": str(self.port_link)} if self.serial else {"address": "127.0.0.1", "tcp_port": self.port}

    def mbpoll(self, *words):
        return subprocess.run(["mbpoll", "-m", "tcp", "-p", str(self.port), "-0", "-1", "-q", "-o", "10", *words[:-1], "127.0.0.1", *words[-1]],
                              capture_output=True, text=True, timeout=BOUND_S).stdout

    def connect(self):
        connection = socket.create_connection(("127.0.0.1", self.port), BOUND_S)
        connection.settimeout(BOUND_S)
        return connection


def receive(connection, count):
    """So many bytes, or fewer when the connection ends."""
    data = b""
    while len(data) < count and (more := connection.recv(count - len(data))):
        data += more
    return data


def ask(connection, request, slave=1, number=7):
    """A request over TCP: what is answered behind the head, or None when the connection ends."""
    connection.sendall(struct.pack(">HHHB", number, 0, len(request) + 1, slave) + request)
    head = receive(connection, 7)
    if len(head) < 7:
        return None
    transaction, protocol, length, unit = struct.unpack(">HHHB", head)
    assert (transaction, protocol) == (number, 0), head
    return bytes([unit]) + receive(connection, length - 1)


class WithTheAppliance(unittest.TestCase):
    def reset(self, operator):
        """As a person does it, again where the drive has not taken it yet: a serial line on a busy computer is slow."""
        until = time.monotonic() + BOUND_S
        while "error" in (answer := operator.ask("RMAC_CAM.Reset")):
            self.assertIn("the fault is still there", answer["error"]["message"])
            self.assertLess(time.monotonic(), until)

    def check(self, register_map, serial):
        parameters = {"maximum_hz": 400} if register_map == "powtran-pi500" else {}
        with Virtual(f"1={register_map}", serial=serial) as served, Machine(served, register_map, **parameters) as machine:
            for rpm in (600, -300, 0, 750):
                machine.turn(rpm)
            served.tell("1 trip 9", "tripped with 9")
            self.assertIn("the drive reports error 0009h", machine.wait_fault())
            self.reset(machine.operator)
            served.wait_for(lambda drive: drive.turning_hz == 0)
            machine.turn(600)

    def test_each_register_map_on_a_serial_line(self):
        for register_map in SPINDLES:
            with self.subTest(register_map=register_map):
                self.check(register_map, serial=True)

    def test_on_tcp(self):
        self.check("hitachi-wj200", serial=False)

    def test_a_spindle_stopped_at_its_panel_faults_the_machine(self):
        with Virtual("toshiba-vf-s11") as served, Machine(served, "toshiba-vf-s11") as machine:
            machine.turn(600)
            served.tell("1 panel-stop", "slave 1: Toshiba VF-S11: stopped")
            self.assertIn("left Operation Enabled by itself", machine.wait_fault())


class WhatTheBusWentThrough(unittest.TestCase):
    def test_a_drive_that_goes_mute_is_told_and_the_record_of_the_fault_keeps_it(self):
        with Virtual("1=delta-vfd-b") as served, Machine(served, "delta-vfd-b", stale_ms=2000, deadline_ms=1000) as machine:
            def told(part):
                return machine.watcher.wait_note("events", lambda event: event["kind"] == "Bus" and part in event["message"])

            def wait_bad(units):
                machine.watcher.wait_note("state", lambda state: [bus["nodes_bad"] for bus in state["buses"]] == [units])

            machine.turn(600)
            wait_bad([])
            served.tell("1 mute on", "slave 1: ok")
            fault = machine.watcher.wait_note("events", lambda event: event["kind"] == "Fault")
            machine.watcher.wait_note("events", lambda event: event["kind"] == "FlightRecord")
            wait_bad([1])
            head = json.loads(machine.operator.call("FlightRecorder.Read", Name=fault["record"])["text"].splitlines()[0])
            unit = head["buses"]["lines"][0]["units"][0]
            self.assertEqual(unit["unit"], 1)
            self.assertGreater(unit["timeouts"], 0)
            served.tell("1 mute off", "slave 1: ok")
            told("unit 1: answers, after it does not answer")
            wait_bad([])


class TimeOut(unittest.TestCase):
    """What stops a spindle when its master dies, because no message can."""

    def test_trips_a_spindle_whose_master_is_held(self):
        served = Virtual("1=delta-vfd-b", "--time-out", "8", "--time-out-trip", "23")  # long beside 0.05 s a round, on a machine that may be busy
        with served, Machine(served, "delta-vfd-b") as machine:
            machine.turn(600)
            served.tell("1 status", "runs forward at 10.0")
            machine.appliance.process.send_signal(signal.SIGSTOP)
            self.assertIn("tripped with 23", served.wait_line("stopped at 0.0"))
            machine.appliance.process.send_signal(signal.SIGCONT)

    def test_ramps_a_spindle_down_that_stays_so_when_someone_talks_again(self):
        with Virtual("1=delta-vfd-b", "--time-out", "0.3") as served:
            served.mbpoll("-a", "1", "-t", "4:hex", "-r", str(0x2000), ["0x12", "0x3E8"])
            served.wait_line("stopped at 0.0")
            self.assertIn("[8451]: \t0", served.mbpoll("-a", "1", "-t", "4", "-r", str(0x2103), []))
            served.tell("1 status", "stopped at 0.0")


class OtherMasters(unittest.TestCase):
    def test_mbpoll_reads_and_writes(self):
        with Virtual("1=delta-vfd-b", "2=generic-remote-io") as served:
            served.mbpoll("-a", "1", "-t", "4:hex", "-r", str(0x2000), ["0x12", "0x3E8"])
            served.wait_for(lambda drive: drive.turning_hz == 10)
            read = served.mbpoll("-a", "1", "-t", "4", "-r", str(0x2103), [])
            self.assertIn("[8451]: \t1000", read)
            served.tell("2 input 3 on", "inputs 8h")
            self.assertIn("[3]: \t1", served.mbpoll("-a", "2", "-t", "1", "-r", "3", []))
            served.mbpoll("-a", "2", "-t", "0", "-r", "4", ["1", "1"])
            served.wait_line("outputs 30h")

    def test_pymodbus_reads_and_writes_on_a_serial_line(self):
        with Virtual("7=hitachi-wj200") as served:
            client = ModbusSerialClient(port=str(served.port_link), baudrate=115200, timeout=10)
            self.assertTrue(client.connect())
            with contextlib.closing(client):
                self.assertFalse(client.write_registers(0, [0, 2500], slave=7).isError())
                self.assertFalse(client.write_coil(0, True, slave=7).isError())
                served.wait_for(lambda drive: drive.turning_hz == 25)
                self.assertEqual(client.read_holding_registers(0x1000, 2, slave=7).registers, [0, 2500])
                self.assertTrue(client.read_coils(0x0E, 1, slave=7).bits[0])
                self.assertEqual(client.read_holding_registers(0x7777, 1, slave=7).exception_code, 2)


class Requests(unittest.TestCase):
    def test_are_refused_as_the_protocol_says(self):
        with Virtual("delta-vfd-b") as served, served.connect() as connection:
            for request, answer in (
                    (bytes([0x2B, 0x0E, 1, 0]), [0xAB, 1]),                      # a function that it lacks
                    (struct.pack(">BHH", 3, 0x2000, 3), [3, 6, 0, 0, 0, 0, 0, 0]),
                    (struct.pack(">BHH", 3, 0x1000, 1), [0x83, 2]),              # an address that it lacks
                    (struct.pack(">BHH", 3, 0xFFFF, 2), [0x83, 2]),
                    (struct.pack(">BHH", 3, 0x2000, 0), [0x83, 3]),
                    (struct.pack(">BHH", 3, 0x2000, 13), [0x83, 3]),             # more than it gives in one answer
                    (struct.pack(">BH", 3, 0x2000), [0x83, 3]),                  # too short
                    (struct.pack(">BHHB", 16, 0x2000, 2, 4), [0x90, 3]),         # its values are missing
                    (struct.pack(">BHHBH", 16, 0x2000, 1, 2, 1), [16, 0x20, 0, 0, 1])):
                with self.subTest(request=request.hex()):
                    self.assertEqual(list(ask(connection, request))[1:], answer)

    def test_that_are_noise_do_no_harm(self):
        seed = 20261121
        noise = random.Random(seed)
        with Virtual("1=hitachi-wj200", "2=generic-remote-io") as served:
            for _ in range(100):
                with served.connect() as connection:
                    for _ in range(20):
                        request = noise.randbytes(noise.randrange(1, 40))
                        if noise.random() < 0.8:
                            request = bytes([noise.choice([1, 2, 3, 4, 5, 6, 15, 16])]) + request
                            ask(connection, request, slave=noise.randrange(1, 3))
                    connection.sendall(noise.randbytes(300))
            with open(served.port_link, "r+b", buffering=0) as line:
                for _ in range(50):
                    line.write(noise.randbytes(noise.randrange(1, 300)))
            with served.connect() as connection:
                self.assertEqual(list(ask(connection, struct.pack(">BHH", 2, 0, 8), slave=2)), [2, 2, 1, 0], f"seed {seed}")


class Manners(unittest.TestCase):
    REQUEST = struct.pack(">BHH", 3, 0x2000, 1)
    ANSWER = [1, 3, 2, 0, 0]

    def test_are_as_bad_as_they_are_told_to_be(self):
        with Virtual("delta-vfd-b") as served, served.connect() as connection:
            self.assertEqual(list(ask(connection, self.REQUEST)), self.ANSWER)
            served.tell("1 late 300", "slave 1: ok")
            began = time.monotonic()
            self.assertEqual(list(ask(connection, self.REQUEST)), self.ANSWER)
            self.assertGreaterEqual(time.monotonic() - began, 0.3)
            served.tell("1 late 0", "slave 1: ok")
            served.tell("1 drip 20", "slave 1: ok")
            began = time.monotonic()
            self.assertEqual(list(ask(connection, self.REQUEST)), self.ANSWER)
            self.assertGreaterEqual(time.monotonic() - began, 10 * 0.02, "eleven bytes, ten pauses")
            served.tell("all drip 0", "slave 1: ok")
            served.tell("1 busy on", "slave 1: ok")
            self.assertEqual(list(ask(connection, self.REQUEST)), [1, 0x83, 6])
            served.tell("1 busy off", "slave 1: ok")
            served.tell("1 wrong-id on", "slave 1: ok")
            self.assertEqual(list(ask(connection, self.REQUEST)), [2, *self.ANSWER[1:]])
            served.tell("1 wrong-id off", "slave 1: ok")
            served.tell("1 mute on", "slave 1: ok")
            connection.settimeout(0.5)
            self.assertRaises(TimeoutError, ask, connection, self.REQUEST)
            connection.settimeout(BOUND_S)
            served.tell("1 mute off", "slave 1: ok")
            self.assertEqual(list(ask(connection, self.REQUEST)), self.ANSWER)

    def test_power_off_forgets_what_was_commanded(self):
        with Virtual("delta-vfd-b") as served, served.connect() as connection:
            ask(connection, struct.pack(">BHHBHH", 16, 0x2000, 2, 4, 0x12, 1000))
            served.wait_for(lambda drive: drive.turning_hz == 10)
            served.tell("1 power off", "slave 1: ok")
            served.tell("1 power on", "slave 1: ok")
            self.assertEqual(list(ask(connection, struct.pack(">BHH", 3, 0x2000, 2))), [1, 3, 4, 0, 0, 0, 0])


class CommandLine(unittest.TestCase):
    def test_says_what_is_missing_or_wrong(self):
        for words, code, message in (
                ((), 2, "DEVICE is required"),
                (("delta-vfd-b",), 2, "a line is needed"),
                (("no-such-drive", "--tcp", "0"), 1, "\"no-such-drive\" is neither a register map in "),
                ((os.curdir, "--tcp", "0"), 1, "nor a file"),
                (("0=delta-vfd-b", "--tcp", "0"), 1, "slaves are 1 to 247"),
                (("delta-vfd-b", "--tcp", "0", "--ramp", "nan"), 2, "nan is no finite number"),
                (("1=delta-vfd-b", "1=hitachi-wj200", "--tcp", "0"), 1, "slave 1 is given twice"),
                (("delta-vfd-b", "--tcp", "0", "--address", "localhost"), 1, "\"localhost\" is no IPv4 address"),
                (("delta-vfd-b", "--serial", "/dev/no-such-port"), 1, "/dev/no-such-port cannot be opened as a serial port: No such file"),
                (("delta-vfd-b", "--pty", "/no/such/folder/port"), 1, "/no/such/folder/port cannot be made a link")):
            with self.subTest(words=words):
                done = subprocess.run([BUILD / "bin/rmac-vmodbus", *words], capture_output=True, text=True, timeout=BOUND_S)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(message, done.stderr + done.stdout)

    def test_says_which_command_it_does_not_know(self):
        with Virtual("1=delta-vfd-b", "2=generic-remote-io") as served:
            served.tell("3 mute on", 'error: "3 mute on" is no slave here')
            served.tell("1 mute perhaps", 'error: "perhaps" is neither on nor off')
            served.tell("1 late long", 'error: "long" is no time from 0 to 60000 ms')
            served.tell("1 input 3 on", 'error: "input 3 on" is no command of a spindle drive; there are: trip CODE, panel-stop')
            served.tell("2 trip 3", 'error: "trip 3" is no command of remote I/O; there are: input BIT on|off')


if __name__ == "__main__":
    unittest.main()

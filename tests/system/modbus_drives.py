"""Spindle drives behind pymodbus's servers, as their manuals describe them. They know addresses that the manuals list and
answer an exception at any other, and share nothing with the appliance's register maps."""

import asyncio
import os
import select
import threading
import tty

from pymodbus.datastore import ModbusServerContext
from pymodbus.server.async_io import ModbusSerialServer, ModbusTcpServer

START_BOUND_S = 60.0
COILS, DISCRETE_INPUTS, HOLDING, INPUT_REGISTERS = "coil", "discrete input", "holding", "input register"
TABLES = {1: COILS, 5: COILS, 15: COILS, 2: DISCRETE_INPUTS, 3: HOLDING, 6: HOLDING, 16: HOLDING, 4: INPUT_REGISTERS}


class Drive:
    """A slave's tables. `turning_hz` is what its output does: at once what it is told. Any thread."""

    most_per_read = 20
    trip_code = 7

    def __init__(self):
        self._news = threading.Condition()
        self.values = {}
        self.turning_hz = 0.0
        self.tripped = False
        self.define()

    def define(self):
        raise NotImplementedError

    def has(self, table, *addresses):
        for address in addresses:
            self.values[table, address] = 0

    def __getitem__(self, key):
        with self._news:
            return self.values[key]

    def trip(self):
        """It trips by itself, and coasts to a stop."""
        with self._news:
            self.tripped = True
            self.turning_hz = 0.0
            self.show()
            self._news.notify_all()

    def wait_for(self, reached):
        with self._news:
            if not self._news.wait_for(lambda: reached(self), timeout=START_BOUND_S):
                raise AssertionError(f"it did not come to that; its values are {self.values}")

    # What pymodbus asks of a slave's context.
    def validate(self, function, address, count=1):
        if function < 5 and count > self.most_per_read:
            return False
        return all((TABLES[function], address + i) in self.values for i in range(count))

    def getValues(self, function, address, count=1):  # noqa: N802
        with self._news:
            return [self.values[TABLES[function], address + i] for i in range(count)]

    def setValues(self, function, address, values):  # noqa: N802
        with self._news:
            for i, value in enumerate(values):
                self.values[TABLES[function], address + i] = int(value)
            self.act(address)
            self.show()
            self._news.notify_all()


class DeltaVfdB(Drive):
    fault_words = "error 0004h (Delta VFD-B: overload of the drive (oL))"
    trip_code = 4

    def define(self):
        self.has(HOLDING, 0x2000, 0x2001, 0x2002, *range(0x2100, 0x2110))

    def act(self, address):
        if address == 0x2002 and self.values[HOLDING, 0x2002] & 2:
            self.tripped = False
        command = self.values[HOLDING, 0x2000]
        if command & 3 == 1 or self.tripped:
            self.turning_hz = 0.0
        elif command & 3 == 2:
            way = {1: 1, 2: -1}[command >> 4 & 3]
            self.turning_hz = way * self.values[HOLDING, 0x2001] / 100

    def show(self):
        self.values[HOLDING, 0x2100] = self.trip_code if self.tripped else 0
        self.values[HOLDING, 0x2102] = self.values[HOLDING, 0x2001]
        self.values[HOLDING, 0x2103] = round(abs(self.turning_hz) * 100)


class Gs2(Drive):
    fault_words = "error 0007h (AutomationDirect GS2: see its manual)"

    def define(self):
        self.has(HOLDING, *range(0x091A, 0x091F), *range(0x2100, 0x210D))

    def act(self, _):
        if self.values[HOLDING, 0x091E] == 1:
            self.tripped = False
        runs = self.values[HOLDING, 0x091B] == 1 and not self.tripped
        way = -1 if self.values[HOLDING, 0x091C] == 1 else 1
        self.turning_hz = way * self.values[HOLDING, 0x091A] / 10 if runs else 0.0

    def show(self):
        self.values[HOLDING, 0x2100] = self.trip_code if self.tripped else 0
        self.values[HOLDING, 0x2102] = self.values[HOLDING, 0x091A]
        self.values[HOLDING, 0x2103] = round(abs(self.turning_hz) * 10)


class VfS11(Drive):
    fault_words = "error 0007h (Toshiba VF-S11: see its manual)"
    most_per_read = 1

    def define(self):
        self.has(HOLDING, 0xFA00, 0xFA01, 0xFC90, 0xFD00, 0xFD01)

    def act(self, _):
        command = self.values[HOLDING, 0xFA00]
        if command & 0x2000:
            self.tripped = False
        runs = command & 0x8000 and command & 0x4000 and command & 0x0400 and not self.tripped
        self.turning_hz = (-1 if command & 0x0200 else 1) * self.values[HOLDING, 0xFA01] / 100 if runs else 0.0

    def show(self):
        status = 0x0400 if self.turning_hz != 0 else 0
        status |= 0x0200 if self.turning_hz < 0 else 0
        status |= 0x0002 if self.tripped else 0
        self.values[HOLDING, 0xFD00] = round(abs(self.turning_hz) * 100)
        self.values[HOLDING, 0xFD01] = status
        self.values[HOLDING, 0xFC90] = self.trip_code if self.tripped else 0


class Wj200(Drive):
    """Its manual counts coils and registers from 1: coil 0001h is address 0."""

    fault_words = "error 0007h (Hitachi WJ200: over-voltage (E07))"

    def define(self):
        self.has(COILS, *range(0x00, 0x20))
        self.has(HOLDING, 0, 1, 2, 3, 4, 0x10, 0x11, 0x1000, 0x1001)

    def act(self, _):
        if self.values[COILS, 3]:
            self.tripped = False
            self.values[COILS, 3] = 0
        runs = self.values[COILS, 0] and not self.tripped
        hz = (self.values[HOLDING, 0] << 16 | self.values[HOLDING, 1]) / 100
        self.turning_hz = (-hz if self.values[COILS, 1] else hz) if runs else 0.0

    def show(self):
        output = round(abs(self.turning_hz) * 100)
        self.values[HOLDING, 0x1000], self.values[HOLDING, 0x1001] = output >> 16, output & 0xFFFF
        self.values[COILS, 0x0E] = int(self.turning_hz != 0)
        self.values[COILS, 0x0F] = int(self.turning_hz < 0)
        self.values[HOLDING, 3] = 2 if self.tripped else int(self.turning_hz != 0)
        if self.tripped:  # the last cause stays there after a reset
            self.values[HOLDING, 0x11] = self.trip_code


class Pi500(Drive):
    fault_words = "error 0007h (Powtran PI500: see its manual)"
    maximum_hz = 400

    def define(self):
        self.has(HOLDING, *range(0x1000, 0x1010), 0x2000, 0x3000, 0x8000)

    def act(self, address):
        command = self.values[HOLDING, 0x2000]
        if address == 0x2000 and command == 7:
            self.tripped = False
        if command not in (1, 2) or self.tripped:
            self.turning_hz = 0.0
        else:
            hz = self.values[HOLDING, 0x1000] / 10000 * self.maximum_hz
            self.turning_hz = hz if command == 1 else -hz

    def show(self):
        self.values[HOLDING, 0x1001] = round(abs(self.turning_hz) * 100)
        self.values[HOLDING, 0x3000] = 1 if self.turning_hz > 0 else 2 if self.turning_hz < 0 else 3
        self.values[HOLDING, 0x8000] = self.trip_code if self.tripped else 0


class RemoteIo(Drive):
    """Sixteen discrete inputs and sixteen coils from address 0."""

    def define(self):
        self.has(DISCRETE_INPUTS, *range(16))
        self.has(COILS, *range(16))

    def act(self, _):
        """Its coils are all it has."""

    def show(self):
        """The same."""

    def switch(self, number, value):
        with self._news:
            self.values[DISCRETE_INPUTS, number] = value


class Served:
    """A drive behind one of pymodbus's servers, in a thread of its own. A context manager."""

    def __init__(self, drive):
        self.drive = drive
        self._loop = asyncio.new_event_loop()
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._run)

    def __enter__(self):
        self._thread.start()
        if not self._ready.wait(START_BOUND_S):
            raise AssertionError("pymodbus did not come up")
        return self

    def __exit__(self, *_):
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()

    def _run(self):
        asyncio.set_event_loop(self._loop)
        self._loop.run_until_complete(self.serve(ModbusServerContext(slaves=self.drive, single=True)))
        self._ready.set()
        self._loop.run_forever()
        self.close()
        for task in asyncio.all_tasks(self._loop):
            task.cancel()
            self._loop.run_until_complete(asyncio.gather(task, return_exceptions=True))
        self._loop.close()


class ServedOnTcp(Served):
    async def serve(self, context):
        self._server = ModbusTcpServer(context, address=("127.0.0.1", 0))
        self._serving = self._loop.create_task(self._server.serve_forever())
        await self._server.serving
        self.port = self._server.server.sockets[0].getsockname()[1]

    def close(self):
        for connection in self._server.active_connections.values():
            connection.transport.abort()
        self._server.server.close()

    def parameters(self):
        return {"address": "127.0.0.1", "tcp_port": self.port}


class ServedOnRtu(Served):
    """Two pseudo-terminals with a thread between them: a cable with a serial port at either end."""

    async def serve(self, context):
        self._pairs = [os.openpty(), os.openpty()]
        for pair in self._pairs:
            for end in pair:
                tty.setraw(end)
        self._end, self._cut = os.pipe()
        self._cable = threading.Thread(target=self._carry)
        self._cable.start()
        self._server = ModbusSerialServer(context, port=os.ttyname(self._pairs[0][1]), baudrate=115200)
        await self._server.start()

    def _carry(self):
        ends = {self._pairs[0][0]: self._pairs[1][0], self._pairs[1][0]: self._pairs[0][0]}
        while True:
            readable, _, _ = select.select([*ends, self._end], [], [])
            if self._end in readable:
                return
            for end in readable:
                os.write(ends[end], os.read(end, 4096))

    def close(self):
        self._server.transport.close()
        os.write(self._cut, b"x")
        self._cable.join()
        for pair in self._pairs:
            for end in pair:
                os.close(end)
        os.close(self._end)
        os.close(self._cut)

    def parameters(self):
        return {"device": os.ttyname(self._pairs[1][1]), "bit_rate": 115200}

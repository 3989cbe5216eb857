"""The asyncio client."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterable, Sequence
from types import TracebackType
from typing import Any, TypeVar

from rmac.address import Address, parse_address
from rmac.aio.authority import Authority, OperatorPlace
from rmac.aio.connection import Connection
from rmac.aio.heard import Heard, Recording
from rmac.aio.run import Run
from rmac.animation import RATE_HZ, Animation, MachineGeometry, read_animation, read_geometry
from rmac.errors import CannotConnect, OtherRefusal, RmacError
from rmac.events import Event, read_event
from rmac.generated.awaiting import Methods
from rmac.hearing import Hearer, Hearing
from rmac.machines import LoadedMachine, Machine, Steps, describe_loaded, find_machines
from rmac.records import FlightRecord, read_flight_record
from rmac.streaming.progress import Interrupted, is_done
from rmac.streaming.resuming import check_left, resume, runs
from rmac.streaming.stream import Stream, free_id
from rmac.wire.call import Call
from rmac.wire.exchange import Promise
from rmac.wire.greeting import Greeting, check_version, hello

T = TypeVar("T")


class Client(Methods):
    """As `rmac.Client`, awaited; of one event loop. `connect` makes it."""

    def __init__(self, address: Address, name: str, check: bool, connect_within_s: float, answer_within_s: float) -> None:
        super().__init__(self.call)
        self.address = address
        self.name = name
        self._check = check
        self._connect_within_s = connect_within_s
        self._answer_within_s = answer_within_s
        self._hearing = Hearing()
        self._subscribing = asyncio.Lock()
        self._latest: Stream | None = None
        self._fed: Run | None = None
        self._authorities: list[Authority] = []
        self._connection: Connection
        self.greeting: Greeting

    async def __aenter__(self) -> Client:
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await self.close()

    async def close(self) -> None:
        await self._connection.close()

    @property
    def lost(self) -> RmacError | None:
        """Why there is no connection any more; None while there is one."""
        return self._connection.ended

    async def reconnect(self, patience_s: float = 0) -> None:
        """Connects anew, trying for so long. Topics are heard as before; nothing is taken or sent again by this."""
        await self._connection.close()
        until = time.monotonic() + patience_s
        while True:
            try:
                return await self.open()
            except CannotConnect:
                if time.monotonic() >= until:
                    raise
                await asyncio.sleep(min(0.2, patience_s))

    async def call(self, call: Call[T]) -> T:
        """What any call of `rmac.calls` gives, or its refusal as an exception."""
        return await self._connection.call(call, self._answer_within_s)

    async def call_all(self, calls: Sequence[Call[Any]]) -> list[Any]:
        """Sends them together, in their order; the first refusal is raised once all are answered."""
        replies = [self._connection.send(call) for call in calls]
        if not replies:
            return []
        await asyncio.wait([reply.future for reply in replies], timeout=self._answer_within_s)
        answers: list[Any] = await asyncio.gather(*(self._connection.wait(reply, call, 0) for reply, call in zip(replies, calls)), return_exceptions=True)
        for answer in answers:
            if isinstance(answer, BaseException):
                raise answer
        return answers

    def authority(self) -> Authority:
        return Authority(self.call, self._authority_over, self._authorities)

    def operator(self) -> OperatorPlace:
        return OperatorPlace(self.call)

    async def machines(self, where: str = "") -> list[Machine]:
        """Machines that the appliance knows; `where` is an SQL condition as `Type = 'Mill' AND NumberOfJoints = 5`."""
        found: list[Machine] = await self._follow(find_machines(where))
        return found

    async def load(self, name: str, virtual: bool = False) -> LoadedMachine:
        """Loads a machine's driver, at standstill; modules that are new are verified first, which takes its time."""
        await self.device.Load(name, virtual)
        return await self.machine()

    async def machine(self) -> LoadedMachine:
        """The machine that is loaded; refused where none is."""
        described: LoadedMachine = await self._follow(describe_loaded())
        return described

    async def state(self) -> dict[str, Any]:
        """As the topic `state` tells it; docs/protocol.md names its members."""
        return await self.cam.GetState()

    async def run(self, moves: Iterable[Any], *, start: bool = True, first_id: int | None = None) -> Run:
        """As `rmac.Client.run`: nothing goes out before the run is iterated, or waited for."""
        return self._run(moves, await self.state(), first_id, 0, start)

    async def resume(self, interrupted: Interrupted) -> Run:
        """As `rmac.Client.resume`: goes on at the place where the machine stands, or raises `CannotResume`."""
        check_left(interrupted)
        state = await self._cycle_ended()
        moves, index = resume(interrupted, state)
        return self._run(moves, state, None, index, True)

    async def until_done(self) -> dict[str, Any]:
        """Waits until nothing is queued and nothing moves, and gives the state then; `MachineStopped` where the machine stops
        before. For what is not a run: jogs, a program that was taken up again."""
        while not is_done(state := await self.state()):
            await asyncio.sleep(0.01)
        return state

    async def at_rest(self) -> dict[str, Any]:
        """The state once nothing moves."""
        while (state := await self.state())["moving"] or state["state"] == "Stopping":
            await asyncio.sleep(0.01)
        return state

    def events(self) -> Heard[Event]:
        """What happens, as it does: a `with` block, iterated."""
        return Heard(self, "events", 100, read_event)

    def states(self, rate_hz: float = 20) -> Heard[dict[str, Any]]:
        """The topic `state`, so often a second of the machine's time."""
        return Heard(self, "state", rate_hz, dict)

    async def geometry(self) -> MachineGeometry:
        """What there is to draw of the machine that is loaded."""
        return read_geometry(await self.cam.GetGeometry())

    def animation(self, rate_hz: float = RATE_HZ) -> Heard[Animation]:
        """Where the machine's links stand, so often a second of its time."""
        return Heard(self, "animation", rate_hz, read_animation)

    def record(self, rate_hz: float | None = None) -> Recording:
        """Records joints within a `with` block: every cycle, which one client at a time may have more than 100 of a second,
        or so many a second."""
        return Recording(self, self.greeting.cycle_hz if rate_hz is None else rate_hz)

    async def flight_record(self, name: str) -> FlightRecord:
        """A flight record, by its name in `recorder.List()` or in an event."""
        found: FlightRecord = await self._follow(read_flight_record(name))
        return found

    def feeds(self, run: Run) -> None:
        """One program at a time: two would come to the machine mixed."""
        if self._fed is not None:
            raise RmacError("another run of this client is not at its end: wait for it, or close it")
        self._fed = run

    def feeds_no_more(self, run: Run) -> None:
        if self._fed is run:
            self._fed = None

    async def start_cycle(self) -> None:
        """A machine that still stops, as after a run that was left, comes to rest first."""
        try:
            await self.cam.CycleStart("AUTOMATIC")
        except OtherRefusal:
            await self.at_rest()
            await self.cam.CycleStart("AUTOMATIC")  # refused for another reason, it is refused again

    async def begin(self, stream: Stream, first_id: int | None) -> None:
        """Nothing of it was sent. What the machine did since the run was made is none of it."""
        state = await self.state()
        stream.begin(state, free_id(state, self._latest) if first_id is None else first_id)
        self._latest = stream

    async def send_batch(self, requests: Sequence[tuple[str, str]], promise: Promise) -> None:
        """Of each its method and its parameters as JSON; the promise gets a list of outcomes."""
        await self._connection.send_batch(requests, promise)

    async def hear(self, hearer: Hearer) -> None:
        """Has a topic come; `take` is called in the loop."""
        async with self._subscribing:
            try:
                await self.call(self._hearing.add(hearer))
            except BaseException:
                self._hearing.forget(hearer)  # or it would be asked for with every topic that comes after
                raise

    async def unhear(self, hearer: Hearer) -> None:
        if not self._hearing.has(hearer):
            return
        async with self._subscribing:
            call = self._hearing.remove(hearer)
            if self.lost is None:
                await self.call(call)

    async def open(self) -> None:
        connection = await Connection.open(self.address, self._connect_within_s, self._hearing.hear)
        try:
            self.greeting = await connection.call(hello(self.name), self._connect_within_s)
            if self._check:
                check_version(self.greeting.version)
            for call in self._hearing.subscriptions():
                await connection.call(call, self._answer_within_s)
        except BaseException:
            await connection.close()
            raise
        connection.on_end = self._hearing.lost
        self._authorities.clear()  # the connection before had them
        self._connection = connection

    async def _authority_over(self) -> None:
        """A run that was left in its midst, by an exception in the body of its loop, stands in nobody's way from here on."""
        run = self._fed
        if run is not None and run.left:
            self.feeds_no_more(run)
            await run.give_up(RmacError("the authority under which this program was fed is given back"))

    async def _cycle_ended(self) -> dict[str, Any]:
        """The state once the cycle of a lease that was lost is at its end: before, a state may be of a moment between two
        moves, when nothing moved either."""
        until = time.monotonic() + self._answer_within_s
        while runs(state := await self.state()) and time.monotonic() < until:
            await asyncio.sleep(0.01)
        return state

    def _run(self, moves: Iterable[Any], state: dict[str, Any], first_id: int | None, index: int, start: bool) -> Run:
        stream = Stream(moves, state, self.greeting.queue_capacity, first_id or 1, index, self.greeting.line_bytes)
        return Run(self, stream, start, first_id)

    async def _follow(self, steps: Steps) -> Any:
        try:
            asked = next(steps)
            while True:
                asked = steps.send(await self.call_all(asked))
        except StopIteration as end:
            return end.value


async def connect(
    address: str, name: str = "python", *, check: bool = True, connect_within_s: float = 10, answer_within_s: float = 300
) -> Client:
    """As `rmac.connect`, for asyncio."""
    client = Client(parse_address(address), name, check, connect_within_s, answer_within_s)
    await client.open()
    return client

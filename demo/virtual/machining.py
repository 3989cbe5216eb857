"""The simulated appliance: what stands on the table is told to it, and programs are run and recorded there."""

import contextlib
import dataclasses
import time

import clamping
import sweeps
from recorder import Recorder

import rmac  # from clients/python, where `recorder` found it

PATIENCE_S = 240


@dataclasses.dataclass
class Held:
    """How the appliance stopped before something met."""

    move_id: int
    message: str
    state: str
    joints: list  # measured, at rest


class Machining:
    """A machine that was just loaded, high above its table, with the collision check on; within a `with` block."""

    def __init__(self, host, port, setup):
        self.setup = setup
        self.client = rmac.connect(f"{host}:{port}", "virtual demo")
        # Whoever takes every cycle hears of events behind them all; this connection hears of them at once.
        self.watcher = rmac.connect(f"{host}:{port}", "virtual demo, watching")
        self.within = contextlib.ExitStack()

    def __enter__(self):
        client = self.client
        self.within.callback(self.watcher.close)
        self.within.callback(client.close)
        self.within.enter_context(client.authority())
        client.load(clamping.MACHINE)
        self.within.callback(client.device.Unload)
        if client.state()["tool"] != clamping.TOOL:
            raise RuntimeError(f"tool {clamping.TOOL} is not in the spindle of {clamping.MACHINE}: run_virtual.py --tools FOLDER writes its tool table")
        client.cam.JogJoint(2, Distance=sweeps.HIGH - client.state()["joints"][2])
        self.rest()
        client.cam.SetPartFrame({"p": list(clamping.PART_FRAME), "q": [1, 0, 0, 0]})
        client.cam.SetSetup(self.setup)
        client.cam.SetCollisionCheck(True)
        return self

    def __exit__(self, *error):
        return self.within.__exit__(*error)

    def rest(self):
        self.client.until_done()
        self.until(lambda state: state["state"] == "Idle" and not state["moving"], "rest")

    def until(self, reached, what):
        deadline = time.monotonic() + PATIENCE_S
        while not reached(state := self.client.state()):
            if time.monotonic() > deadline:
                raise TimeoutError(f"{what} did not come within {PATIENCE_S} s: the machine is {state['state']}")
            time.sleep(0.01)

    def send(self, program):
        self.client.call_all([rmac.Call(request["method"], request["params"]) for request in program])
        self.client.cam.CycleStart("AUTOMATIC")

    def until_held(self, program):
        """Runs a program until the appliance holds it before a collision; then drops it and goes up along the tool."""
        with self.watcher.events() as events:
            self.send(program)
            while (event := events.next(PATIENCE_S)).kind != "CollisionAhead":
                if event.kind == "MoveDone" and event.move_id == program[-1]["params"]["MoveID"]:
                    raise RuntimeError("the program ran to its end, and was to be held before the clamp")
        self.until(lambda state: not state["moving"], "rest")
        state = self.client.state()
        held = Held(event.move_id, event.message, state["state"], list(state["joints"]))
        self.client.cam.StopNow()
        self.rest()
        # The head goes up along the tool, clear of all, before the table turns back.
        self.client.cam.JogJoint(2, Distance=sweeps.HIGH - self.client.state()["joints"][2])
        self.rest()
        return held

    def run(self, program):
        """Runs a program to its end; the record of every cycle of it."""
        with Recorder(self.client) as recorder:
            self.send(program)
            self.client.until_done()
            self.client.cam.CycleStop("AUTOMATIC")
            self.rest()
        if recorder.lost:
            raise RuntimeError(f"{recorder.lost} cycles are missing in the record")
        return recorder.record()

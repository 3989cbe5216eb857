"""What a person does in FreeCAD who got a STEP file and wants the part: through `rmac_freecad` alone, with no file between. `inspection.py` goes on
from there."""

import contextlib
import threading
import time

import FreeCAD
import rmac_freecad  # noqa: F401  finds the package rmac
from rmac_freecad.holes import Drilling, read_holes
from rmac_freecad.machines import Wanted, compare
from rmac_freecad.parts import check_size, open_step, recognise
from rmac_freecad.pockets import Pocket, outline_of, read_pocket
from rmac_freecad.profiles import Profile, edges_of, read_profile
from rmac_freecad.program import keep
from rmac_freecad.running import check_part_zero, cut, look
from rmac_freecad.simulation import simulate
from rmac_freecad.surfaces import ball_end, plan_faces

import rmac
from recorder import Recorder

BALL, FLAT, DRILL = 1, 2, 3  # tool numbers
LENGTH_MM = 30.0  # of all tools, from the spindle to the tip, as the tool table has it
BALL_RADIUS, FLAT_RADIUS = 4.0, 2.0
SAFE_MM = 6.0  # above the part's top, which is Z 0
RISE_MM = 15.0
RPM = 900
FEED, PLUNGE = 1200.0, 200.0  # mm/min
MILL_ZERO = (0.0, 0.0, -30.0)  # where the part was set on the mill


class Steps:
    """Names and seconds of what the user did, in order."""

    def __init__(self, say):
        self._say = say
        self.done = []

    @contextlib.contextmanager
    def step(self, name):
        self._say(name)
        began = time.monotonic()
        yield
        self.done.append((name, time.monotonic() - began))

    def seconds(self, name):
        return sum(seconds for one, seconds in self.done if one == name)


class Person:
    """Stands at the machine and puts in the tool that it asks for."""

    def __init__(self, address):
        self._address = address
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self.failed = None

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended.set()
        self._thread.join()
        if self.failed is not None:
            raise self.failed

    def _watch(self):
        with rmac.connect(self._address, "person at the mill") as client:
            try:
                with client.operator(), client.states() as states:
                    self._look(client, states)
            except rmac.RmacError as error:
                self.failed = error
                client.cam.StopNow()  # or the machine would wait for its tool for ever

    def _look(self, client, states):
        asked = None
        while not self._ended.is_set():
            state = next(states)
            wanted = state["tool_wanted"] if state["tool_prompt"] else None
            if wanted is not None and wanted != asked:
                client.cam.ConfirmToolChange(wanted)
            asked = wanted


class Session:
    def __init__(self, address, rmac_program, say, scallop_mm):
        self.address, self.rmac, self.say, self.scallop_mm = address, rmac_program, say, scallop_mm
        self.steps = Steps(say)
        self.client = rmac.connect(address, "FreeCAD")
        self.programs, self.records, self.dry = {}, {}, {}
        self.left_out = []
        self.began = time.monotonic()
        self.first_motion = None

    def open(self, step_file):
        with self.steps.step("open the STEP file"):
            self.part = open_step(step_file)
            self.part.Document.UndoMode = 1
            self.found = recognise(self.part.Shape)
        self.say(f"  {self.part.Label}: {self.found}")

    def select(self):
        with self.steps.step("search and select a machine"):
            wanted = Wanted(type="Mill", joints=3, length_mm=100, width_mm=100, depth_mm=50, positioning_mm=0.05)
            self.machines = self.client.machines(wanted.condition())
            for machine in self.machines:
                check_size(self.part.Shape, machine)
        self.say(f"  {len(self.client.machines())} machines known; these are wanted: {', '.join(machine.name for machine in self.machines)}")

    def plan(self):
        """Paths for each machine's rapids; those of the mill that is taken are kept."""
        with self.steps.step("make the tool paths"):
            seconds = {}
            for name, made in (("sweep", self._sweep), ("pocket", self._pocket), ("holes", self._holes), ("profile", self._profile)):
                began = time.monotonic()
                self.programs[name] = made()
                seconds[name] = time.monotonic() - began
        self.say("  " + ", ".join(f"{name} {len(program)} moves in {seconds[name]:.1f} s" for name, program in self.programs.items()))
        for text in self.left_out:
            self.say(f"  left out: {text}")

    def _rapid(self):
        return min(machine.max_feed_mm_min for machine in self.machines)

    def _sweep(self):
        swept = plan_faces(self.part.Label, self.part.Shape, self.found.free_form, ball_end(BALL_RADIUS), scallop_mm=self.scallop_mm, feed_mm_min=FEED,
                           plunge_mm_min=PLUNGE, along=90.0, tool=BALL, rpm=RPM)  # fmt: skip
        self.left_out += swept.left_out
        return swept.program("Sweep", self._rapid())

    def _pocket(self):
        recess = self.found.recesses[0]
        pocket = Pocket(FLAT, FLAT_RADIUS, recess.top, recess.top - recess.z, 2.0, 1.8, SAFE_MM, FEED / 2, PLUNGE, RPM)
        return read_pocket("Pocket", outline_of(self.part, recess.floor), pocket, rapid_mm_min=self._rapid()).program

    def _holes(self):
        drill = Drilling(DRILL, self.found.holes[0].diameter_mm, 100.0, RPM, SAFE_MM, peck_mm=4.0, beyond_mm=2.5)
        return read_holes("Holes", self.found.holes, drill, rapid_mm_min=self._rapid())

    def _profile(self):
        box = self.part.Shape.BoundBox
        profile = Profile(FLAT, 2 * FLAT_RADIUS, "outside", box.ZMax, box.ZMin, 4.0, SAFE_MM, FEED / 2, PLUNGE, RPM, lead_mm=2.0)
        return read_profile("Profile", edges_of(self.part, self.found.outline), profile, rapid_mm_min=self._rapid())

    def take(self):
        """Selects the quickest of the machines that fit, and sets it up."""
        with self.steps.step("load the machine that fits, set part frame and tools"):
            table = {"Mounted": 0, "Tools": self._tools()}
            fits, why = compare({machine.name: self.programs["sweep"] for machine in self.machines}, table, self.rmac)
            self.machine = fits[0].machine if fits else None
            if self.machine is None:
                raise RuntimeError(f"no machine can cut the part: {why}")
            with self.client.authority():
                self.client.load(self.machine)
                for tool in self._tools():
                    self.client.cam.SetTool(**tool)
                self.client.cam.SetPartFrame({"p": list(MILL_ZERO), "q": [1, 0, 0, 0]})
                self.client.cam.JogJoint(2, Distance=RISE_MM)  # a program goes straight to where it begins, so the tool stands above the part
                self.client.until_done()
            self.now = look(self.client)
            check_part_zero(self.now, False)
        self.say("  fits, quickest first: " + ", ".join(f"{fit.machine} {fit.found.cycle_time_s:.0f} s" for fit in fits))

    def _tools(self):
        tools = ((BALL, "ball end 8", BALL_RADIUS), (FLAT, "end mill 4", FLAT_RADIUS), (DRILL, "drill", self.found.holes[0].diameter_mm / 2))
        return [{"ToolNumber": number, "Name": name, "Length": LENGTH_MM, "Radius": radius} for number, name, radius in tools]

    def dry_run(self):
        with self.steps.step("dry run"):
            for name, program in self.programs.items():
                self.dry[name] = simulate(program, self.machine, self.now.tools, self.rmac, part_frame=self.now.part_frame)
        self.say("  " + ", ".join(f"{name} {found.cycle_time_s:.0f} s" for name, found in self.dry.items()))

    def machine_part(self):
        """Every program to its end, each cycle recorded."""
        with self.steps.step("machine"), self.client.events() as events, Person(self.address):
            for name, program in self.programs.items():
                done = 0
                with self.client.authority(), Recorder(self.client) as recorder:
                    sent = time.monotonic()
                    for _ in cut(self.client, program):
                        done += 1
                if self.first_motion is None:
                    self.first_motion, self.sent = recorder.first_motion, sent
                self.records[name] = recorder.record()
                keep(self.part.Document, program, name)
                self.say(f"  {name}: {done} of {len(program)} moves are cut, {recorder.cycles} cycles watched")
                if done != len(program) or recorder.lost:
                    raise RuntimeError(f"{name}: {len(program) - done} moves were not done, {recorder.lost} samples lost")
            faults = [event.message for event in events.so_far() if "fault" in event.kind.lower()]
            if faults:
                raise RuntimeError(f"the machine had a fault: {faults[0]}")
        with self.client.authority():
            self.client.device.Unload()

    def close(self):
        with self.client.authority():
            self.client.device.Unload()
        self.client.close()


def save(document, file):
    document.saveAs(str(file))
    FreeCAD.Console.PrintLog(f"saved {file}\n")

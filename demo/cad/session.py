"""What a person does in FreeCAD who got a STEP file: machine it, measure it, correct the model. Through `rmac_freecad` alone.

`Session.run` goes from the file to the corrected model in one go, with no file between; what it counts and measures on the way is
for `verdict.py`.
"""

import contextlib
import threading
import time

import FreeCAD
import numpy as np
import rmac_freecad  # noqa: F401  finds the package rmac
from rmac_freecad import master
from rmac_freecad.holes import Drilling, read_holes
from rmac_freecad.machines import Wanted, compare
from rmac_freecad.measuring import measure, places_on
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
TIP_RADIUS, CLEARANCE = 1.0, 1.5
MILL_ZERO = (0.0, 0.0, -30.0)  # where the part was set on each machine, as its user found it
CMM_ZERO = (0.0, 0.0, -30.0)
HOLE_EDGE, FREE_EDGE = 2.0, 7.0  # from there on a face is measured
WIDE_MM2 = 15.0  # walls that are measured


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
        self.changes = 0
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
                self.changes += 1
            asked = wanted


class Session:
    def __init__(self, address, rmac_program, say, scallop_mm):
        self.address, self.rmac, self.say, self.scallop_mm = address, rmac_program, say, scallop_mm
        self.steps = Steps(say)
        self.client = rmac.connect(address, "FreeCAD")
        self.programs, self.records, self.dry = {}, {}, {}
        self.fits, self.left_out, self.cleared = [], [], None
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
            self.plan_s = {}
            for name, made in (("sweep", self._sweep), ("pocket", self._pocket), ("holes", self._holes), ("profile", self._profile)):
                began = time.monotonic()
                self.programs[name] = made()
                self.plan_s[name] = time.monotonic() - began
        self.say("  " + ", ".join(f"{name} {len(program)} moves in {self.plan_s[name]:.1f} s" for name, program in self.programs.items()))
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
        self.cleared = read_pocket("Pocket", outline_of(self.part, recess.floor), pocket, rapid_mm_min=self._rapid())
        return self.cleared.program

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
            self.fits = [(fit.machine, fit.found.cycle_time_s) for fit in fits]
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
        self.say("  fits, quickest first: " + ", ".join(f"{name} {seconds:.0f} s" for name, seconds in self.fits))

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
        with self.steps.step("machine"), self.client.events() as events, Person(self.address) as person:
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
            self.changes = person.changes
        with self.client.authority():
            self.client.device.Unload()

    def places(self):
        """Where the part will be measured: the free-form face, sides, floor and flat walls of the pocket, and the holes."""
        shape, recess, found = self.part.Shape, self.found.recesses[0], self.found
        common = {"tip_radius_mm": TIP_RADIUS, "clearance_mm": CLEARANCE, "safe_mm": SAFE_MM}
        walls = {name: shape.getElement(name) for name in recess.walls}
        flat = [name for name, wall in walls.items() if wall.Surface.TypeId == "Part::GeomPlane" and wall.Area > WIDE_MM2]
        under, top = shape.BoundBox.ZMin, shape.BoundBox.ZMax
        return [
            *places_on(shape, found.free_form, count=16, edge_mm=FREE_EDGE, **common),
            *places_on(shape, found.tops[:1], count=4, edge_mm=2.0, **common),
            *places_on(shape, found.sides, count=3, edge_mm=1.5, between_mm=(under + 1.0, under + 5.5), **common),
            *places_on(shape, [recess.floor], count=6, edge_mm=1.6, **common),
            *places_on(shape, flat, count=2, edge_mm=1.0, between_mm=(recess.z + 0.5, top), **common),
            *places_on(shape, [name for hole in found.holes for name in hole.faces], count=4, edge_mm=HOLE_EDGE, between_mm=(under + 1.0, top), **common),
        ]  # fmt: skip

    def load_cmm(self):
        with self.client.authority():
            self.client.drivers.Rescan()  # the part lies there now: in this simulated world, the description of the machine tells it
            self.client.load("CMM")
            self.client.cam.SetPartFrame({"p": list(CMM_ZERO), "q": [1, 0, 0, 0]})

    def touch(self, places):
        return measure(self.client, places, tip_radius_mm=TIP_RADIUS, clearance_mm=CLEARANCE, safe_mm=SAFE_MM, rmac=self.rmac)

    def measure_part(self, places):
        with self.steps.step("load the measuring machine and measure"):
            self.load_cmm()
            self.touched = self.touch(places)
        self.before = master.deviations(self.part.Shape, self.touched)
        self.say(f"  {len(self.touched)} places; as the part was taken to lie: rms {1000 * self.before.rms:.1f} µm, worst {1000 * self.before.worst:+.1f} µm")

    def correct(self):
        """Where the part lies, by its datums: top, sides, and the pocket's walls. On the free-form face scallops stand; floor and holes are as deep
        and as wide as a tool is."""
        with self.steps.step("fit where the part lies, correct the model"):
            self.nominal = self.part.Shape.copy()
            aside = {*self.found.free_form, *self.sized()}
            self.datums = [one for one in self.touched if one.place.face not in aside]
            self.fit = master.fit_placement(self.nominal, self.datums)
            self.after = master.deviations(self.nominal, self.touched, self.fit.placement)
            self.frame = master.corrected_frame({"p": list(CMM_ZERO), "q": [1, 0, 0, 0]}, self.fit, upright=True)
            shown = master.show_deviations(self.part.Document, self.after)
            stood = self.part.Placement
            master.correct_placement(self.part, self.fit)
            self.moved = not _same(self.part.Placement, stood)
            self.part.Document.undo()
            self.undone = _same(self.part.Placement, stood)
            self.part.Document.redo()
            shown.Placement = self.part.Placement
        self.say(f"  {self.fit}")

    def sized(self):
        """Faces whose places tell a size that is to be corrected: the pocket's floor, and holes."""
        return [self.found.recesses[0].floor, *(name for hole in self.found.holes for name in hole.faces)]

    def measure_again(self, places):
        """In the corrected part frame."""
        with self.steps.step("measure again in the corrected part frame"):
            with self.client.authority():
                self.client.cam.SetPartFrame(self.frame)
            self.again = master.deviations(self.nominal, self.touch(places))
        self.say(f"  rms {1000 * self.again.rms:.1f} µm, worst {1000 * self.again.worst:+.1f} µm")

    def correct_parameters(self, designed, names):
        """The designer's model, in whose spreadsheet the names are; by the datums and what has those sizes."""
        with self.steps.step("fit named parameters, correct the master model"):
            designed.UndoMode = 1
            sized = [one for one in self.touched if one.place.face in self.sized()]
            self.parameters = master.fit_parameters(designed.Part, designed.Dimensions, names, [*self.datums, *sized])
            master.correct_parameters(designed.Part, self.parameters)
            self.corrected = master.deviations(designed.Part.Shape, self.touched, self.parameters.placement)
        self.say(f"  {self.parameters}")

    def close(self):
        with self.client.authority():
            self.client.device.Unload()
        self.client.close()


def _same(a, b):
    return np.allclose(a.Matrix.A, b.Matrix.A, rtol=0, atol=1e-9)


def save(document, file):
    document.saveAs(str(file))
    FreeCAD.Console.PrintLog(f"saved {file}\n")

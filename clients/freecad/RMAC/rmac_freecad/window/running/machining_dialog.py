"""A job, or a file of another control, simulated and cut. Nothing moves before Cut is pressed; closing waits until nothing does."""

import FreeCADGui
from PySide import QtGui

from rmac_freecad.jogging import is_machine_frame
from rmac_freecad.running import check_part_zero, check_tools, look
from rmac_freecad.simulation import simulate_telling_lengths
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.quantity import length_text, time_text
from rmac_freecad.window.running.limits_list import LimitsList
from rmac_freecad.window.running.path_view import PathView
from rmac_freecad.window.running.prompts import Prompts
from rmac_freecad.window.running.run_buttons import RunButtons
from rmac_freecad.window.running.tools_box import ToolsBox
from rmac_freecad.window.work import work_in_question


class MachiningDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Machine a job")
        self.machining = session.machining
        self.work = None
        self.needed_tools = []
        self.view = None
        self._shown = self._cuts = None  # whose path the view has, and what is cut
        self._wanted = None  # what is to be simulated or cut once it is read: a new object each time
        self.headline = QtGui.QLabel()
        self.part_zero = QtGui.QLabel()
        self.at_machine_zero = QtGui.QCheckBox("The part stands at the machine's own zero")
        self.tools = ToolsBox(self._add_tool)
        self.simulate_button = button("Simulate", self.simulate, "Plans the job as the machine would cut it; moves nothing")
        self.cut_button = button("Cut", self.cut, "Sends the job to the machine, which begins at once")
        self.go_on_button = button("Go on after the lost connection", self.go_on, "From the place where the machine stands")
        self.run = RunButtons(self)
        self.prompts = Prompts(self._confirm_tool)
        self.progress = QtGui.QProgressBar()
        self.place = QtGui.QLabel()
        self.limits = LimitsList()
        box = QtGui.QVBoxLayout(self)
        for part in (self.headline, self.part_zero, self.at_machine_zero, self.tools, row(self.simulate_button, self.cut_button, self.go_on_button, None),
                     self.run, self.prompts, self.progress, self.place, self.limits, self.message):  # fmt: skip
            box.addLayout(part) if isinstance(part, QtGui.QLayout) else box.addWidget(part)
        box.setStretchFactor(self.limits, 1)
        self.resize(560, 460)

    def goes_on(self):
        return self.machining.running or self._wanted is not None

    def begin(self):
        self._look(self._looked)

    def simulate(self):
        self._with_program(self._simulate, lambda now: None)

    def cut(self):
        self._with_program(self._cut, lambda now: check_part_zero(now, self.at_machine_zero.isChecked()))

    def go_on(self):
        self.message.tell("the rest is being cut…")
        self.machining.go_on(self._cut_to_its_end, self.failed)

    def hold(self):
        self.ask(lambda client: client.cam.FeedHold(), lambda answer: None)

    def resume(self):
        self.ask(lambda client: client.cam.FeedResume(), lambda answer: None)

    def stop(self):
        self._drop()
        self.station.stop(self.session.settings.address, failed=self.failed)

    def override(self, percent):
        self.ask(lambda client: client.cam.SetFeedOverride(percent), lambda answer: None)

    def tick(self):
        state = self.station.state
        running = self.machining.running
        self.run.show(state, running)
        self.prompts.show_state(state, self.needed_tools[0].number if self.needed_tools else 0)
        for one in (self.simulate_button, self.cut_button):
            one.setEnabled(not running and self._wanted is None)
        self.go_on_button.setVisible(self.machining.can_go_on)
        if running:
            self._show_progress()

    def reject(self):
        """Escape, and whatever else would close it."""
        if self.machining.running:
            return self.message.tell("The machine cuts. Stop it first, or leave this open.")
        super().reject()

    def failed(self, error):
        self._wanted = None
        super().failed(error)

    def hideEvent(self, event):
        self._wanted = None  # nothing begins that nobody sees
        self._show_in_view(None)
        super().hideEvent(event)

    def _drop(self):
        if self._wanted is not None:
            self._wanted = None
            self.message.tell("It was stopped before it began.")

    def _look(self, looked):
        """At what is selected now, and at the machine."""
        try:
            self.work = work_in_question()
            self.needed_tools = self.work.tools(None)
        except Exception as error:
            return self.failed(error)
        self.ask(look, looked, "the machine is looked at…")

    def _with_program(self, does, check):
        """`does(program, now)`, once it is read and nothing speaks against it: unless somebody stopped, or closed this, meanwhile."""
        if self._wanted is not None or self.machining.running:
            return
        wanted, stops = object(), self.station.stops
        self._wanted = wanted

        def only_while_wanted(then):
            def called(*what):
                if self._wanted is wanted and self.station.stops != stops:
                    self._drop()
                if self._wanted is wanted:
                    then(*what)

            return called

        def looked(now):
            self._looked(now)
            work = self.work
            try:
                read = work.reading(now.machine.max_feed_mm_min, self.session.settings.rmac)
            except Exception as error:
                return self.failed(error)

            def read_and_draw():
                program = read()
                return program, work.strokes(program), now

            self.message.tell(f"{work.label} is read…")
            self.station.ask(read_and_draw, only_while_wanted(have), only_while_wanted(self.failed))

        def have(came):
            program, strokes, now = came
            try:
                self._show_tools(program, now)
                check_tools(self.needed_tools, now)
                check(now)
            except Exception as error:
                return self.failed(error)
            self._wanted = None
            self._show_in_view(strokes)
            does(program, now)

        self._look(only_while_wanted(looked))

    def _simulate(self, program, now):
        self.message.tell(f"{self.work.label} is simulated on {now.machine.name}…")
        rmac = self.session.settings.rmac
        self.station.ask(
            lambda: simulate_telling_lengths(program, now.machine.name, now.tools, rmac, now.part_frame), self._show_found, self.failed
        )

    def _show_found(self, found):
        self.limits.show_found(found)
        if self.view is not None:
            self.view.show_limits(found.move_limits)
        self.message.tell(
            f"It takes {time_text(found.cycle_time_s)} for {length_text(round(found.length_mm, 1))} of path. The machine was taken to stand at its zero; collisions were not checked."
        )

    def _cut(self, program, now):
        self.progress.setRange(0, len(program))
        self._cuts = self.work
        self.message.tell(f"{now.machine.name} cuts {self.work.label}…")
        self.machining.start(program, self._cut_to_its_end, self.failed)
        self.tick()

    def _cut_to_its_end(self):
        self._show_progress()
        self.message.tell(f"{self._cuts.label} is cut. {self._cuts.keep(self.machining.program)}")

    def _show_progress(self):
        self.progress.setValue(self.machining.done)
        self.place.setText(str(self.machining.place or ""))
        if self.view is not None:
            self.view.show_done(self.machining.done)

    def _show_in_view(self, strokes):
        """None takes the path away."""
        view, self.view = self.view, None
        if view is not None:
            view.remove()
            self._shown.show_own_path(True)
        document = FreeCADGui.ActiveDocument
        if strokes is not None and document is not None and hasattr(document.ActiveView, "getSceneGraph"):
            self.view, self._shown = PathView(strokes, document.ActiveView.getSceneGraph()), self.work
            self._shown.show_own_path(False)

    def _looked(self, now):
        self.message.tell("")
        self.session.machine = now.machine
        self.headline.setText(f"{self.work.label} on {now.machine.name}")
        unset = is_machine_frame(now.part_frame)
        where = " ".join(f"{axis} {length_text(value)}" for axis, value in zip("XYZ", now.part_frame["p"]))
        self.part_zero.setText("The part's zero was not set." if unset else f"The part's zero stands at {where} of the machine.")
        self.at_machine_zero.setVisible(unset)
        self._show_tools(None, now)

    def _show_tools(self, program, now):
        self.needed_tools = self.work.tools(program)
        self.tools.show_tools(self.needed_tools, now.tools)

    def _add_tool(self, tool, length_mm):
        def add(client):
            client.cam.SetTool(tool.number, length_mm, tool.radius_mm, tool.label)
            return look(client)

        self.change(add, self._looked)

    def _confirm_tool(self, number):
        self.ask(lambda client: client.cam.ConfirmToolChange(number), lambda answer: self.message.tell(""))


show = OnlyOne(MachiningDialog)

"""Moves the machine by hand. What moves while a button is held stops when it is let go, when the dialog is no longer the one in
front, is closed or hangs, and when the connection is lost."""

import time

from PySide import QtCore, QtGui

import rmac
from rmac_freecad.jogging import HeldJog, axes_of, is_machine_frame, place_part
from rmac_freecad.window.dialog import Dialog, OnlyOne, button, row
from rmac_freecad.window.jogging.axis_row import AxisRow
from rmac_freecad.window.jogging.step_fields import StepFields
from rmac_freecad.window.quantity import length_text

calls = rmac.calls.RMAC_CAM
LATE_S = 5  # nobody expects a motion any more that a button asked for so long ago


class JogDialog(Dialog):
    def __init__(self, session):
        super().__init__(session, "Jog")
        self._hand = session.hand
        self._held = HeldJog(lambda: self._hand.client().call, lambda error: self.station.tell(self.failed, error))
        self.rows = []
        self._learning = False
        self.machine = QtGui.QLabel()
        self.part_zero = QtGui.QLabel()
        self.steps = StepFields()
        self._grid = QtGui.QGridLayout()
        self.home_button = button("Home", self.home, "Has the machine look for its zero, or go there")
        self.reference_button = button("To reference point", self.to_reference_point, "Straight to the part's zero: look at the way first")
        self.zero_button = button("Part zero here", self.zero_here, "Puts the part's zero where the tool tip stands")
        self.reset_button = button("Reset", self.reset, "Leaves a fault whose cause is gone; nothing moves by it")
        self.take_button = button("Take the machine", self.begin, "Takes authority, after another station had it or the connection was lost")
        self.stop_button = button("Stop", self.stop)
        box = QtGui.QVBoxLayout(self)
        box.addWidget(self.machine)
        box.addLayout(self._grid)
        box.addWidget(self.part_zero)
        box.addWidget(self.steps)
        box.addLayout(row(self.home_button, self.reference_button, self.zero_button, self.reset_button, self.take_button, None, self.stop_button))
        box.addWidget(self.message)
        session.station.on_loss(self._lost)

    def appear(self):
        super().appear()
        self.activateWindow()  # a held button ends when another window comes to the front

    def begin(self):
        """Takes authority, and learns what can be jogged."""
        self._learning = True

        def learn(client):
            client = self._hand.client()
            return client.machine(), client.cam.GetPartFrame()

        self.ask(learn, self._learnt, "the machine is taken…")

    def tick(self):
        state = self.station.state
        for one in self.rows:
            one.show(state)
        known = self.session.machine
        if known is not None:
            self.machine.setText(f"{known.name}: {state['state'] if state else 'no connection'}")
            if state and state["mechanism"] not in (known.name, None) and not self._learning:
                self.begin()  # somebody loaded another one
        self._renew(state)

    def home(self):
        self._move(calls.Home())

    def to_reference_point(self):
        self._move(calls.SetFeedrate(self._feed()), calls.MoveToReferencePoint())

    def reset(self):
        self._move(calls.Reset())

    def stop(self):
        self._held.stop()
        self.station.stop(self.session.settings.address, failed=self.failed)

    def step(self, axis, sign):
        """A tap on a button; where it is to be held, holding did it."""
        if self.steps.by_steps.isChecked():
            feed = () if axis.turns else (calls.SetFeedrate(self._feed()),)
            self._move(*feed, axis.by(sign * self.steps.step_mm))

    def zero_here(self):
        def zero(client):
            client = self._hand.client()
            client.cam.SetCalibratedPartFrame()
            return client.cam.GetPartFrame()

        self.ask(zero, self._show_part_zero)

    def place(self, axis, mm):
        self.ask(lambda client: place_part(self._hand.client(), {axis.name: mm}), self._show_part_zero)

    def changeEvent(self, event):
        super().changeEvent(event)
        if event.type() == QtCore.QEvent.ActivationChange and not self.isActiveWindow():
            self._held.stop()

    def hideEvent(self, event):
        self._held.stop()
        self.station.ask(self._hand.leave, failed=self.failed)
        super().hideEvent(event)

    def _renew(self, state):
        """The buttons themselves are looked at, so that no lost event leaves a jog going."""
        row_held = next((one for one in self.rows if one.held()), None) if self.steps.while_held.isChecked() else None
        if row_held is None:
            self._held.release()
        elif not self.isActiveWindow() or state is None:
            self._held.stop()
        else:
            self._held.hold(row_held.axis, row_held.held() * self.steps.speed_mm_s, state["moving"])

    def _feed(self):
        fastest = self.session.machine.max_feed_mm_min if self.session.machine else float("inf")
        return min(self.steps.speed_mm_s * 60, fastest)

    def _move(self, *asked):
        clicked = time.monotonic()

        def move(client):
            client = self._hand.client()
            if time.monotonic() - clicked > LATE_S:
                raise rmac.RmacError("The appliance was reached too late: nothing was moved. Press the button again.")
            for call in asked:
                client.call(call)

        self.ask(move, lambda answer: None)

    def _learnt(self, came):
        self._learning = False
        machine, frame = came
        if self.session.machine != machine or not self.rows:
            self.session.machine = machine
            self._show_axes(axes_of(machine))
        self._show_part_zero(frame)

    def _show_axes(self, axes):
        while self._grid.count():
            self._grid.takeAt(0).widget().deleteLater()
        self.rows = [AxisRow(axis, self.step, self.place) for axis in axes]
        for number, one in enumerate(self.rows):
            one.add_to(self._grid, number)

    def _show_part_zero(self, frame):
        self.message.tell("")
        where = " ".join(f"{axis} {length_text(value)}" for axis, value in zip("XYZ", frame["p"]))
        self.part_zero.setText("The part's zero is the machine's own: it was not set." if is_machine_frame(frame) else f"The part's zero stands at {where} of the machine.")

    def _lost(self, error):
        self._held.stop()
        if self.isVisible():
            self.failed(error)


show = OnlyOne(JogDialog)

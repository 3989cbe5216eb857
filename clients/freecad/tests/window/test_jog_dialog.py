"""The jog dialog on a machine that moves in real time: what is held moves, and stops however it is let go."""

import unittest

import FreeCAD
from PySide import QtCore, QtGui
from rmac_freecad.window.jogging.jog_dialog import JogDialog
from windowed import WindowTest, process_until



def mouse(button, kind):
    """As the server of the screen would send it."""
    place = QtCore.QPoint(button.width() // 2, button.height() // 2)
    pressed = QtCore.Qt.LeftButton if kind == QtCore.QEvent.MouseButtonPress else QtCore.Qt.NoButton
    QtGui.QApplication.sendEvent(button, QtGui.QMouseEvent(kind, place, QtCore.Qt.LeftButton, pressed, QtCore.Qt.NoModifier))


def press(button):
    mouse(button, QtCore.QEvent.MouseButtonPress)


def let_go(button):
    mouse(button, QtCore.QEvent.MouseButtonRelease)


class JogDialogTest(WindowTest):
    PACE = "real-time"

    def setUp(self):
        super().setUp()
        client = self.connect("set-up")
        self.free(client)
        with client.authority():
            client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
            client.cam.Home()
            client.until_done()
        self.dialog = self.opened(JogDialog(self.session))
        self.dialog.begin()
        process_until(lambda: self.dialog.rows and self.dialog.isActiveWindow() and self.state(), "the dialog knows the machine")

    def state(self):
        return self.session.station.state

    def x(self):
        return self.state()["pose"][0]

    def at_rest(self):
        process_until(lambda: self.state() and not self.state()["moving"] and self.state()["state"] != "Stopping", "the machine rests")

    def shows(self, row, value, unit):
        """A drive stands where it stands, to the encoder's count."""
        number, _, shown = row.place.text().partition(" ")
        return shown == unit and abs(float(number) - value) < 0.005

    def hold(self):
        """X+ is held, and moves."""
        self.dialog.steps.while_held.setChecked(True)
        self.dialog.steps.speed.set_quantity(5)
        button = self.dialog.rows[0].plus
        press(button)
        begun = self.x()
        process_until(lambda: self.x() > begun + 1, "the held button moves X")
        return button

    def stays(self):
        """At rest, and so it was after hundreds of ms more of the machine's time."""
        self.at_rest()
        x, t_s = self.x(), self.state()["t_s"]
        process_until(lambda: self.state()["t_s"] > t_s + 0.5, "half a second of the machine's time")
        self.assertAlmostEqual(self.x(), x, 2)

    def test_a_tap_goes_by_a_step_and_the_display_follows(self):
        self.dialog.steps.step.set_quantity(2.5)
        row = self.dialog.rows[1]
        row.plus.click()
        process_until(lambda: abs(self.state()["pose"][1] - 2.5) < 0.01, lambda: f"Y is at 2.5; {self.dialog.message.text()!r}, {self.state()}")
        self.at_rest()
        process_until(lambda: self.shows(row, 2.5, "mm"), "the display says so")
        row.minus.click()
        process_until(lambda: abs(self.state()["pose"][1]) < 0.01, "and back")

    def test_the_slider_sets_the_step_as_in_figure_6_6(self):
        self.dialog.steps.slider.setValue(4)
        self.assertAlmostEqual(self.dialog.steps.step_mm, 5)

    def test_a_held_button_moves_until_it_is_let_go(self):
        let_go(self.hold())
        self.stays()
        self.assertIsNone(self.dialog.message.refused)

    def test_a_button_that_the_mouse_leaves_lets_go(self):
        button = self.hold()
        button.setDown(False)
        self.stays()

    def test_another_window_in_front_lets_go(self):
        self.hold()
        other = QtGui.QDialog()
        self.addCleanup(other.close)
        other.show()
        other.activateWindow()
        process_until(lambda: not self.dialog.isActiveWindow(), "the other window is in front")
        self.stays()

    def test_a_dialog_that_closes_lets_go_and_gives_authority_back(self):
        self.hold()
        self.dialog.close()
        process_until(lambda: self.state()["authority"] == "", "authority is given back")
        self.stays()

    def test_a_window_that_hangs_stops_the_machine(self):
        """Its thread waits here, and its timer does not come; the machine ends by itself what nobody renews."""
        self.hold()
        with self.connect().states() as states:
            rested = next(state["t_s"] for state in states if not state["moving"])
            for state in states:
                self.assertFalse(state["moving"])
                if state["t_s"] > rested + 0.5:
                    break

    def test_a_lost_connection_stops_it_and_is_told(self):
        button = self.hold()
        self.session.station.client._connection._socket.shutdown(2)
        self.refused(self.dialog, "connection")
        with self.connect() as other:
            other.at_rest()
            x = other.state()["pose"][0]
            let_go(button)
            self.dialog.begin()
            process_until(lambda: self.state() is not None, "it is connected again")
            self.stays()
            self.assertAlmostEqual(self.x(), x, 2)

    def test_a_held_button_does_not_go_on_over_a_new_connection(self):
        self.hold()
        self.session.station.client._connection._socket.shutdown(2)
        self.refused(self.dialog, "connection")
        self.session.station.ask(self.session.client)
        process_until(lambda: self.state() is not None, "it is connected again, and the button still down")
        self.stays()

    def test_the_machine_stands_where_another_station_has_authority(self):
        self.dialog.close()
        with self.connect("the other CAM") as other:
            process_until(lambda: other.state()["authority"] == "", "authority is free")
            with other.authority():
                self.opened(self.dialog).begin()
                self.refused(self.dialog, "the other CAM", "authority")
                self.dialog.rows[0].plus.click()
                process_until(lambda: self.dialog.message.refused is not None, "the tap is refused")
                self.stays()

    def test_the_part_zero_is_set_where_the_tool_stands(self):
        self.dialog.steps.step.set_quantity(10)
        self.dialog.rows[0].plus.click()
        process_until(lambda: abs(self.x() - 10) < 0.01, "X is at 10")
        self.at_rest()
        self.dialog.zero_button.click()
        process_until(lambda: abs(self.x()) < 0.001, "the tool reads zero")
        process_until(lambda: "stands at" in self.dialog.part_zero.text(), "the dialog tells where it is")
        self.assertAlmostEqual(self.connect().cam.GetPartFrame()["p"][0], 10, 2)
        self.dialog.rows[2].reads.set_quantity(1)
        self.dialog.rows[2].set_button.click()
        process_until(lambda: abs(self.state()["pose"][2] - 1) < 0.001, "Z reads a gauge's height")
        self.assertAlmostEqual(self.x(), 0, 2)
        self.dialog.home_button.click()
        process_until(lambda: abs(self.x() + 10) < 0.01, "home is 10 mm beside the part's zero")
        self.at_rest()
        self.dialog.reference_button.click()
        process_until(lambda: abs(self.x()) < 0.01, "the reference point is the part's zero")

    def test_stop_ends_a_step_on_its_way(self):
        self.dialog.steps.step.set_quantity(40)
        self.dialog.steps.speed.set_quantity(2)
        self.dialog.rows[0].plus.click()
        process_until(lambda: self.x() > 0.5, "it is on its way")
        self.dialog.stop_button.click()
        self.stays()
        self.assertLess(self.x(), 39)

    def test_inches_are_shown_and_sent_as_what_they_are(self):
        self.dialog.close()
        before = FreeCAD.Units.getSchema()
        self.addCleanup(FreeCAD.Units.setSchema, before)
        FreeCAD.Units.setSchema(3)
        dialog = self.opened(JogDialog(self.session))
        dialog.begin()
        process_until(lambda: dialog.rows and self.state(), "the dialog knows the machine")
        dialog.steps.slider.setValue(5)
        self.assertAlmostEqual(dialog.steps.step_mm, 12.7)
        self.assertIn("in", dialog.steps.step.text())
        dialog.rows[0].plus.click()
        process_until(lambda: abs(self.x() - 12.7) < 0.01, "half an inch further")
        self.at_rest()
        process_until(lambda: self.shows(dialog.rows[0], 0.5, "in"), "and shown so")


if __name__ == "__main__":
    unittest.main()

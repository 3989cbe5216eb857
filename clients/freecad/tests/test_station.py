"""The station that a window asks, without a window: nothing waits behind another question, answers come by deliver."""

import os
import sys
import threading
import time
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

from appliance import Appliance
from rmac_freecad.jogging import Hand, axes_of
from rmac_freecad.machines import Wanted
from rmac_freecad.station import NotConnected, Settings, Station

import rmac  # isort: skip

BOUND_S = 120


class StationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())
        cls.address = f"127.0.0.1:{cls.appliance.port}"

    def setUp(self):
        self.station = Station("tests")
        self.addCleanup(self.station.disconnect)

    def deliver_until(self, condition):
        until = time.monotonic() + BOUND_S
        while not condition():
            self.assertLess(time.monotonic(), until)
            self.station.deliver()

    def client(self):
        return self.station.connect(self.address)

    def test_answers_come_in_the_thread_that_delivers(self):
        came = []
        self.station.ask(lambda: self.client().greeting.server, lambda server: came.append((server, threading.current_thread())))
        self.deliver_until(lambda: came)
        self.assertEqual(came, [("rmacd", threading.current_thread())])

    def test_what_went_wrong_is_told_to_who_asked(self):
        failed = []
        self.station.ask(lambda: self.station.client, failed=failed.append)
        self.deliver_until(lambda: failed)
        self.assertIsInstance(failed[0], NotConnected)

    def test_a_stop_waits_behind_no_question(self):
        goes_on, stopped = threading.Event(), []
        self.addCleanup(goes_on.set)
        self.station.ask(goes_on.wait)
        self.station.stop(self.address, stopped.append)
        self.deliver_until(lambda: stopped)
        self.assertEqual(stopped, [True])

    def test_a_stop_needs_no_connection_before(self):
        self.assertFalse(self.station.connected)
        stopped = []
        self.station.stop(self.address, stopped.append)
        self.deliver_until(lambda: stopped)

    def test_one_connection_serves_all_and_another_address_takes_another(self):
        first = self.client()
        self.assertIs(self.client(), first)
        self.assertIsNot(self.station.connect(f"localhost:{self.appliance.port}"), first)
        self.assertIsNotNone(first.lost)

    def test_a_lost_connection_is_told_and_its_state_is_no_state_any_more(self):
        lost = []
        self.station.on_loss(lost.append)
        client = self.client()
        self.deliver_until(lambda: self.station.state)
        client._connection._socket.shutdown(2)
        self.deliver_until(lambda: lost)
        self.assertIsNone(self.station.state)
        self.assertFalse(self.station.connected)

    def test_disconnecting_is_no_loss(self):
        lost = []
        self.station.on_loss(lost.append)
        self.client()
        self.station.disconnect()
        self.client()
        self.deliver_until(lambda: self.station.state)
        self.assertEqual(lost, [])

    def test_a_hand_has_authority_until_it_leaves_and_takes_it_again_over_a_new_connection(self):
        hand = Hand(self.client)
        first = hand.client()
        self.assertIn("tests", first.state()["authority"])
        self.station.disconnect()
        second = hand.client()
        self.assertIsNot(second, first)
        self.assertIn("tests", second.state()["authority"])
        hand.leave()
        self.assertEqual(second.state()["authority"], "")

    def test_what_can_be_jogged_is_the_tip_and_each_joint_that_turns(self):
        client = self.client()
        with client.authority():
            machine = client.load("TarusXYZCATwin")
        axes = axes_of(machine)
        self.assertEqual([(axis.name, axis.turns, axis.joint) for axis in axes],
                         [("X", False, None), ("Y", False, None), ("Z", False, None), ("joint 4", True, 3), ("joint 5", True, 4)])  # fmt: skip
        with client.authority():
            client.call(axes[3].by(30))
            client.until_done()
        self.assertAlmostEqual(axes[3].place(client.state()), 30, 1)

    def test_a_search_by_a_name_with_a_quote_finds_nothing_and_breaks_nothing(self):
        machines = self.client().machines(Wanted(name="it's", joints=5).condition())
        self.assertEqual(machines, [])

    def test_every_field_of_a_search_narrows_it(self):
        everything = {machine.name for machine in self.client().machines(Wanted().condition())}
        for wanted in (Wanted(name="DMAC"), Wanted(type="CMM"), Wanted(joints=5), Wanted(length_mm=101), Wanted(width_mm=101), Wanted(depth_mm=101),
                       Wanted(spindle_hp=4), Wanted(spindle_rpm=1001), Wanted(spindle_torque_nm=6), Wanted(feed_mm_min=2001), Wanted(load_kg=101),
                       Wanted(positioning_mm=0.04), Wanted(repeatability_mm=0.02)):  # fmt: skip
            found = {machine.name for machine in self.client().machines(wanted.condition())}
            self.assertLess(found, everything, wanted)


class SettingsTest(unittest.TestCase):
    def setUp(self):
        self.settings = Settings("User parameter:BaseApp/Preferences/Mod/RMACTests")

    def test_an_address_is_there_before_anybody_gives_one(self):
        self.settings.address = ""
        self.assertEqual(self.settings.address, "localhost:7402")

    def test_an_address_is_kept_without_the_spaces_around_it(self):
        self.settings.address = " unix:/run/rmac/rmacd.sock\n"
        self.assertEqual(self.settings.address, "unix:/run/rmac/rmacd.sock")
        self.assertEqual(str(rmac.address.parse_address(self.settings.address)), "unix:/run/rmac/rmacd.sock")


if __name__ == "__main__":
    unittest.main()

"""What ends or disturbs a cut in progress: clients that stop, hold, go away or meddle. At the machine's real pace."""

import signal
import unittest

from appliance import Appliance, line

AUTHORITY_REQUIRED, AUTHORITY_HELD = -32040, -32041
SLOW_MM_MIN = 120  # 2 mm/s: the 40 mm below last 20 s, so every test interrupts it.
LENGTH_MM = 40.0


class Interruptions(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance(pace="real-time"))
        self.operator = self.appliance.operator()
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])
        self.watcher.call("subscribe", topics=["state"], rate_hz=100)
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=SLOW_MM_MIN)
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (LENGTH_MM, 0, 0), move_id=7))
        self.wait_state(lambda state: state["moving"] and state["pose"][0] > 0.2)

    def wait_state(self, matches):
        return self.watcher.wait_note("state", matches)

    def rest(self):
        state = self.wait_state(lambda state: not state["moving"] and state["state"] not in ("Running", "Stopping"))
        self.assertGreater(state["pose"][0], 0.1)
        self.assertLess(state["pose"][0], LENGTH_MM - 10, "it did not stop in mid-cut")
        self.assertAlmostEqual(state["pose"][1], 0, delta=0.02)
        return state

    def assert_stays(self, state, samples=20):
        for _ in range(samples):
            later = self.wait_state(lambda _: True)
            self.assertFalse(later["moving"])
            self.assertAlmostEqual(later["pose"][0], state["pose"][0], delta=0.02)

    def test_anyone_connected_may_stop(self):
        self.watcher.call("RMAC_CAM.StopNow")
        state = self.rest()
        self.assertEqual(state["state"], "Idle")
        self.assertEqual(self.watcher.state()["moves_in_buffer"], 0)
        self.assert_stays(state)

    def test_anyone_connected_may_stop_the_cycle_and_the_rest_waits_for_a_new_start(self):
        self.watcher.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        state = self.rest()
        self.assertEqual(state["state"], "Idle")
        self.assertEqual(self.watcher.state()["moves_in_buffer"], 1)
        self.assert_stays(state)
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.wait_state(lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.1)

    def test_anyone_connected_may_hold_and_the_holder_of_authority_resumes(self):
        self.watcher.call("RMAC_CAM.FeedHold")
        state = self.rest()
        self.assertEqual(state["state"], "Holding")
        self.assert_stays(state)
        refusal = self.watcher.refusal("RMAC_CAM.FeedResume")
        self.assertEqual(refusal.code, AUTHORITY_REQUIRED)
        self.operator.call("RMAC_CAM.FeedResume")
        self.wait_state(lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.1)

    # Red when what the operator holds is resumed by the program's client, which does not stand at the machine.
    def test_what_the_operator_held_only_the_operator_resumes(self):
        panel = self.appliance.client("panel")
        panel.call("operator.acquire")
        panel.call("RMAC_CAM.FeedHold")
        state = self.rest()
        for method, parameters in (("FeedResume", {}), ("CycleStart", {"Mode": "AUTOMATIC"}), ("Reset", {}),
                                   ("FeedRetrace", {"Distance": 1}), ("ParkProgram", {})):
            self.assertIn("panel (TCP", self.operator.refusal("RMAC_CAM." + method, **parameters).message)
        self.assert_stays(state)
        panel.call("RMAC_CAM.FeedResume")
        self.wait_state(lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.1)

    def test_hold_stays_when_the_operator_goes_and_a_reset_gives_it_to_the_program(self):
        panel = self.appliance.client("panel")
        panel.call("operator.acquire")
        panel.call("RMAC_CAM.FeedHold")
        state = self.rest()
        panel.close()
        self.wait_state(lambda later: later["operator"] == "")
        self.assertIn("has left", self.operator.refusal("RMAC_CAM.FeedResume").message)
        self.assert_stays(state)
        self.operator.call("RMAC_CAM.Reset")
        self.assert_stays(state)
        self.operator.call("RMAC_CAM.FeedResume")
        self.wait_state(lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.1)

    def test_program_that_goes_away_under_an_operators_hold_is_dropped_and_the_hold_stays(self):
        panel = self.appliance.client("panel")
        panel.call("operator.acquire")
        panel.call("RMAC_CAM.FeedHold")
        self.rest()
        self.operator.close()
        state = self.wait_state(lambda later: later["state"] == "Idle" and later["authority"] == "")
        self.assertIn("StopNow", state["last_stop"]["message"])
        self.assertTrue(state["held_by"].startswith("panel"))
        self.assertEqual(self.watcher.call("authority.acquire")["dropped_moves"], 1)
        self.assertIn("panel", self.watcher.refusal("RMAC_CAM.JogJoint", JntNum=1, Distance=1).message)
        panel.call("RMAC_CAM.FeedResume")
        self.watcher.call("RMAC_CAM.JogJoint", JntNum=1, Distance=1)

    def test_client_that_goes_away_stops_the_machine_and_nothing_restarts_it(self):
        self.operator.close()
        event = self.watcher.wait_note("events", lambda event: event["kind"] == "Authority")
        self.assertTrue(event["message"])
        state = self.rest()
        self.assertEqual(state["authority"], "")
        self.assert_stays(state)
        self.assertEqual(self.watcher.call("authority.acquire")["dropped_moves"], 1)
        self.assertEqual(self.watcher.state()["moves_in_buffer"], 0)
        self.watcher.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.assert_stays(state)
        self.watcher.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        self.wait_state(lambda later: later["state"] == "Idle")
        self.watcher.call("RMAC_CAM.JogJoint", JntNum=1, Distance=1)
        self.wait_state(lambda later: not later["moving"] and abs(later["pose"][1] - 1) < 0.02)

    def test_end_of_the_daemon_stops_the_machine_and_tells_that_before_it_closes(self):
        self.appliance.process.send_signal(signal.SIGTERM)
        events = []
        while (message := self.watcher.read_line()) is not None:
            if message.get("method") == "events":
                events.append(message["params"])
            elif message.get("method") == "state":
                state = message["params"]
        self.assertIn("Stopped", [event["kind"] for event in events])
        self.assertFalse(state["moving"])
        self.assertGreater(state["pose"][0], 0.1)
        self.assertLess(state["pose"][0], LENGTH_MM - 10, "it did not stop in mid-cut")
        self.assertAlmostEqual(state["pose"][1], 0, delta=0.02)

    def test_state_is_not_idle_between_an_accepted_start_and_its_end(self):
        self.operator.call("RMAC_CAM.StopNow")
        self.rest()
        target = self.operator.state()["joints"][1]
        for distance in (0.2, -0.2) * 10:
            target += distance
            self.operator.call("RMAC_CAM.JogJoint", JntNum=1, Distance=distance)
            while (state := self.operator.state())["state"] != "Idle":
                pass
            self.assertAlmostEqual(state["joints"][1], target, delta=0.05, msg="Idle before the jog was done")

    def test_second_client_that_jogs_disturbs_nothing(self):
        before = self.watcher.state()
        self.assertEqual(self.watcher.refusal("RMAC_CAM.JogJoint", JntNum=1, Distance=5).code, AUTHORITY_REQUIRED)
        self.assertEqual(self.watcher.refusal("authority.acquire").code, AUTHORITY_HELD)
        state = self.wait_state(lambda later: later["pose"][0] > before["pose"][0] + 0.2)
        self.assertEqual((state["state"], state["moving"], state["authority"]), ("Running", True, before["authority"]))
        self.assertAlmostEqual(state["pose"][1], 0, delta=0.02)

    def test_jog_beside_a_running_program_is_refused(self):
        refusal = self.operator.refusal("RMAC_CAM.JogJoint", JntNum=1, Distance=5)
        self.assertTrue(refusal.message)
        self.assertTrue(self.operator.state()["moving"])

    def test_mechanism_is_not_swapped_in_mid_cut(self):
        self.operator.refusal("Device.Load", Name="DMACXY")
        state = self.operator.state()
        self.assertEqual((state["mechanism"], state["moving"]), ("DMACXYZ", True))

    def test_override_acts_at_once(self):
        self.operator.call("RMAC_CAM.SetFeedOverride", Percent=200)
        self.wait_state(lambda state: abs(state["feed_set_mm_min"] - 2 * SLOW_MM_MIN) < 1)
        self.operator.call("RMAC_CAM.SetFeedOverride", Percent=0)
        state = self.wait_state(lambda state: not state["moving"] or state["feed_set_mm_min"] == 0)
        self.operator.call("RMAC_CAM.SetFeedOverride", Percent=100)
        self.wait_state(lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.1)


if __name__ == "__main__":
    unittest.main()

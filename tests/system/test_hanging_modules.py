"""Kinematics that passed verification and hang, or lie, later: the machine rests, and nobody waits for them."""

import json
import shutil
import subprocess
import unittest

from appliance import BUILD, Appliance, line, pose, wait_for_rest
from client import Refused

TOOL = 77.125  # of bad_kinematics.cpp: and 1 mm more for the next thread that asks
GATEWAY, PLANNER, SERVO = 0, 1, 2
LIES_TO_SERVO = 3
ENDS_WITHIN_S = 100.0


def bad_machine(tree):
    """DMACXYZ with kinematics that hang when they are told to."""
    folder = tree / "mill/3-axis/Bad"
    shutil.copytree(tree / "mill/3-axis/DMACXYZ", folder)
    shutil.copy(BUILD / "bad_modules/HangsWhenTold/BadKinematics.so", folder)
    device = json.loads((folder / "device.json").read_text())
    device["MechanismName"] = "Bad"
    device.pop("MechanismID", None)
    device["Kinematics"] = {"Module": "BadKinematics"}
    (folder / "device.json").unlink()
    (folder / "device.json").write_text(json.dumps(device))
    return folder / "device.json"


class HangingModules(unittest.TestCase):
    def start(self, who):
        """A machine whose next move has `who` hang in its kinematics."""
        appliance = self.enterContext(Appliance(pace="real-time", own_tree=True))
        appliance.ends_with = 1
        bad_machine(appliance.tree)
        client = appliance.client("operator")
        client.call("authority.acquire")
        client.call("DeviceDriverManager.Rescan")
        client.call("Device.Load", Name="Bad")
        client.call("RMAC_CAM.SetToolInterfaceFrame", ToolInterfaceFrame={"p": [0, 0, TOOL + who], "q": [1, 0, 0, 0]})
        return appliance, client

    def move(self, client, who):
        client.call("RMAC_CAM.SetFeedrate", Feedrate=2000)
        client.call("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(30, 20, TOOL + who))
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def assert_ended(self, appliance, why):
        self.assertEqual(appliance.process.wait(timeout=ENDS_WITHIN_S), 1)
        appliance.end()
        log = "".join(appliance.log)
        self.assertIn(why, log)
        self.assertIn("brought to rest", log)

    def test_planner_that_hangs_keeps_no_stop_waiting(self):
        appliance, client = self.start(PLANNER)
        self.move(client, PLANNER)
        stopping = appliance.client("beside it")
        # Who asks meanwhile is told, or finds the connection closed: nobody waits for ever.
        for ask in (client.state, lambda: stopping.call("RMAC_CAM.StopNow")):
            with self.assertRaises((Refused, TypeError, OSError)) as told:
                for _ in range(100000):
                    ask()
            if isinstance(told.exception, Refused):
                self.assertIn("hangs", told.exception.message)
        self.assert_ended(appliance, "the planner hangs")

    def test_request_that_hangs_ends_the_daemon(self):
        appliance, client = self.start(GATEWAY)
        with self.assertRaises((TypeError, OSError)):
            self.move(client, GATEWAY)
        self.assert_ended(appliance, "a request has computed")

    def test_servo_thread_that_hangs_ends_the_daemon(self):
        appliance, client = self.start(SERVO)
        self.move(client, SERVO)
        self.assert_ended(appliance, "the servo thread has begun no cycle")

    def test_lie_on_the_way_is_a_fault_that_a_reset_leaves(self):
        appliance, client = self.start(LIES_TO_SERVO)
        appliance.ends_with = 0
        client.call("subscribe", topics=["events", "state"], rate_hz=50)
        self.move(client, LIES_TO_SERVO)
        fault = client.wait_note("events", lambda event: event["kind"] == "Fault")
        self.assertIn("could not have come to within a cycle for joint 1", fault["message"])
        client.wait_note("state", lambda state: state["state"] == "Faulted" and not state["moving"])
        client.call("RMAC_CAM.Reset")
        client.call("RMAC_CAM.SetToolInterfaceFrame", ToolInterfaceFrame={"p": [0, 0, 0], "q": [1, 0, 0, 0]})
        rests_at = client.state()["joints"][0]
        self.assertTrue(0.1 < rests_at < 29, rests_at)
        client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=2)
        self.assertAlmostEqual(wait_for_rest(client)["joints"][0], rests_at + 2, delta=0.01)

    def test_signal_ends_what_hangs(self):
        appliance, client = self.start(PLANNER)
        self.move(client, PLANNER)
        appliance.wait_for_log("BadKinematics hangs")
        self.assertEqual(appliance.end(), 1)

    def test_simulation_ends_after_ten_seconds_of_computing(self):
        appliance = self.enterContext(Appliance(own_tree=True))
        device = bad_machine(appliance.tree)
        program = appliance.folder / "hangs.rmac"
        requests = [("RMAC_CAM.SetToolInterfaceFrame", {"ToolInterfaceFrame": {"p": [0, 0, TOOL], "q": [1, 0, 0, 0]}}),
                    ("RMAC_CAM.SetFeedrate", {"Feedrate": 2000}),
                    ("RMAC_CAM.MoveAlongLine", line((0, 0, TOOL), (30, 20, TOOL)))]
        program.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": i, "method": method, "params": params}) + "\n"
                                   for i, (method, params) in enumerate(requests)))
        ended = subprocess.run([BUILD / "bin/rmac", "simulate", program, "--machine", device, "--device-tree",
                                appliance.tree], capture_output=True, text=True, timeout=ENDS_WITHIN_S)
        self.assertEqual(ended.returncode, 1, ended.stderr)
        self.assertIn("no progress in 10 s of CPU time", ended.stderr)


if __name__ == "__main__":
    unittest.main()

"""What a program does between its moves, through the daemon: dwells, stops, and calls in turn."""

import json
import tempfile
import pathlib
import unittest

from appliance import Appliance, line, pose, wait_for_rest

DONE, FAILED = 0, 1
COOLANT = 1  # Bit 0 of DMACXYZ's outputs.


def request(method, **params):
    return json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})


def call(method, **params):
    return {"method": method, "params": params}


class BetweenMoves(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.client = self.appliance.operator()
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])
        self.client.call("RMAC_CAM.SetFeedrate", Feedrate=1500)

    def event(self, kind, move_id):
        return self.watcher.wait_note(
            "events", lambda event: event["kind"] == kind and event["move_id"] == move_id)

    def start(self):
        self.client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def test_a_program_changes_the_speed_between_two_cuts(self):
        self.client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 0, 0), 1))
        self.client.call("RMAC_CAM.InTurn", MoveID=2, Calls=[
            call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=600), call("RMAC_CAM.TurnCoolantOn")])
        self.client.call("RMAC_CAM.MoveAlongLine", **line((5, 0, 0), (10, 0, 0), 3))
        self.client.call("RMAC_CAM.InTurn", MoveID=4, Calls=[call("RMAC_CAM.SetOutput", Name="Coolant", On=False)])
        self.client.call("RMAC_CAM.MoveAlongLine", **line((10, 0, 0), (15, 0, 0), 5))
        self.assertAlmostEqual(self.client.state()["spindle_rpm"][0], 0, delta=1)
        self.start()
        self.assertIn("spindle 0 at 600 rpm, Coolant on", self.event("MoveDone", 2)["message"])
        self.event("MoveStarted", 3)
        self.assertAlmostEqual(self.client.state()["spindle_rpm"][0], 600, delta=50)
        self.event("MoveDone", 4)
        self.event("MoveDone", 5)
        wait_for_rest(self.client)
        self.assertEqual(self.client.state()["outputs"] & COOLANT, 0)

    def test_a_stop_holds_until_whoever_stands_there_goes_on(self):
        self.client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 0, 0), 1))
        self.client.call("RMAC_CAM.ProgramStop", MoveID=2, Optional=True, Message="measure it")
        self.client.call("RMAC_CAM.ProgramStop", MoveID=3, Message="turn it over")
        self.client.call("RMAC_CAM.MoveAlongLine", **line((5, 0, 0), (10, 0, 0), 4))
        self.start()
        told = self.event("ProgramStopped", 3)
        self.assertIn("turn it over; the program is held: FeedResume goes on", told["message"])
        state = self.client.state()
        self.assertEqual((state["state"], state["stop_prompt"], state["optional_stops"]),
                         ("Holding", "program stop 3: turn it over", False))
        shown = self.appliance.rmac("status").stdout
        self.assertIn("program stop 3: turn it over", shown)
        self.assertEqual(self.appliance.rmac("resume").returncode, DONE)
        self.event("MoveDone", 4)
        panel = self.appliance.client("panel")
        panel.refusal("RMAC_CAM.SetOptionalStop", On=True)
        panel.call("operator.acquire")
        panel.call("RMAC_CAM.SetOptionalStop", On=True)
        self.client.call("RMAC_CAM.ProgramStop", MoveID=5, Optional=True)
        self.event("ProgramStopped", 5)
        panel.call("RMAC_CAM.FeedResume")
        self.event("MoveDone", 5)

    def test_what_cannot_work_is_refused_with_what_could(self):
        for method, params, words in (
                ("RMAC_CAM.InTurn", {"Calls": [call("RMAC_CAM.SetOutput", Name="Laser", On=True)]},
                 ("no output named \"Laser\"", "has Coolant")),
                ("RMAC_CAM.InTurn", {"Calls": [call("RMAC_CAM.SetSpindleRPM", SpindleNumber=3, RPM=5)]},
                 ("no spindle 3",)),
                ("RMAC_CAM.InTurn", {"Calls": [call("RMAC_CAM.Home")]}, ("RMAC_CAM.Home is not called in turn",)),
                ("RMAC_CAM.AwaitInput", {"Name": "Clamp", "On": True, "TimeOut": 1}, ("no input named \"Clamp\"",
                                                                                  "Probe")),
                ("RMAC_CAM.Dwell", {"Time": -1}, ("\"Time\"", "-1"))):
            message = str(self.client.refusal(method, MoveID=1, **params))
            for word in words:
                self.assertIn(word, message)
        self.assertEqual(self.client.state()["moves_in_buffer"], 0)

    def test_an_input_that_does_not_come_holds_the_program(self):
        self.client.call("RMAC_CAM.AwaitInput", MoveID=1, Name="Probe", On=True, TimeOut=0.5)
        self.client.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 0, 0), 2))
        self.start()
        self.assertIn("input Probe did not go on within 0.5 s", self.event("ProgramStopped", 1)["message"])
        state = self.client.state()
        self.assertEqual((state["state"], state["status_minor"], state["moves_in_buffer"]), ("Holding", 12, 2))
        self.client.call("RMAC_CAM.StopNow")
        wait_for_rest(self.client)
        self.assertEqual(self.client.state()["moves_in_buffer"], 0)

    def test_a_program_file_runs_with_all_that_is_in_it(self):
        with tempfile.TemporaryDirectory(prefix="rmac-test-") as folder:
            file = pathlib.Path(folder) / "program.rmac"
            file.write_text("\n".join([
                request("RMAC_CAM.SetFeedrate", Feedrate=1500),
                request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(10, 0, 0)),
                request("RMAC_CAM.Dwell", MoveID=2, Time=0.5),
                request("RMAC_CAM.InTurn", MoveID=3, Calls=[call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=300)]),
                request("RMAC_CAM.MoveAlongArc", MoveID=4, RotSign=1, Closed=True, Turns=1, CenterPoint=pose(0, 0, 0),
                        StartPoint=pose(10, 0, 0), EndPoint=pose(10, 0, -4)),
                request("RMAC_CAM.InTurn", MoveID=5, Calls=[call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=0)])]))
            self.client.call("authority.release")
            done = self.appliance.rmac("--json", "run", file)
            self.assertEqual((done.returncode, done.stderr), (DONE, ""))
            report = json.loads(done.stdout)
            self.assertEqual(report["moves"], 5)
            self.assertGreater(report["cycle_time_s"], 0.5)


if __name__ == "__main__":
    unittest.main()

"""The tool table, and changing tools: by hand, between the moves of a program."""

import json
import os
import pathlib
import pty
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance, line, pose, wait_for_rest

DONE, FAILED = 0, 1
CUTTER = {"ToolNumber": 7, "Name": "ball 6", "Length": 20, "Radius": 3, "MaxRPM": 600}
KNIFE = {"ToolNumber": 9, "Name": "drag knife", "Length": 12.5, "NeedsSpindle": False}
COOLANT = 1  # Bit 0 of DMACXYZ's outputs.


def request(method, **params):
    return json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})


def table_file(folder, machine="DMACXYZ"):
    return pathlib.Path(folder) / "tools" / f"{machine}.json"


def kept(folder, machine="DMACXYZ"):
    return json.loads(table_file(folder, machine).read_text())


class Table(unittest.TestCase):
    def setUp(self):
        self.state = self.enterContext(tempfile.TemporaryDirectory(prefix="rmac-tools-"))

    def appliance(self):
        return Appliance(state_folder=self.state)

    def test_name_of_a_tool_stays_within_its_line(self):
        with self.appliance() as appliance:
            appliance.rmac("load", "DMACXYZ")
            appliance.rmac("tools", "set", "7", "--length", "20", "--name", "ball\n6\x1b[31m")
            self.assertRegex(appliance.rmac("tools").stdout, r"(?m)^ +7  ball\?6\?\[31m +20 ")

    def test_tools_are_kept_and_listed_after_a_restart(self):
        with self.appliance() as appliance:
            self.assertEqual(appliance.rmac("load", "DMACXYZ").returncode, DONE)
            for words in (("set", "7", "--length", "20.125", "--radius", "3", "--name", "ball 6"),
                          ("set", "8", "--length", "5", "--frame", "0", "0", "10", "1", "0", "0", "0"),
                          ("set", "7", "--max-rpm", "600"), ("remove", "8")):
                done = appliance.rmac("tools", *words)
                self.assertEqual(done.returncode, DONE, done.stderr)
        with self.appliance() as appliance:
            self.assertEqual(appliance.rmac("load", "DMACXYZ").returncode, DONE)
            told = json.loads(appliance.rmac("tools", "--json").stdout)
            self.assertEqual((told["Mounted"], told["Wanted"], len(told["Tools"])), (0, None, 1))
            self.assertEqual({key: told["Tools"][0][key] for key in ("ToolNumber", "Name", "Length", "Radius", "MaxRPM")},
                             {"ToolNumber": 7, "Name": "ball 6", "Length": 20.125, "Radius": 3, "MaxRPM": 600})
            shown = appliance.rmac("tools").stdout
            self.assertIn("ball 6", shown)
            self.assertIn("spindle: empty", shown)

    def test_each_mechanism_has_a_table_of_its_own(self):
        with self.appliance() as appliance:
            operator = appliance.operator()
            operator.call("RMAC_CAM.SetTool", **CUTTER)
            operator.call("Device.Load", Name="SuginoXYZ")
            self.assertEqual(operator.call("RMAC_CAM.GetTools")["Tools"], [])
            operator.call("Device.Load", Name="DMACXYZ")
            self.assertEqual(len(operator.call("RMAC_CAM.GetTools")["Tools"]), 1)

    def test_wrong_table_is_refused_with_file_key_value_and_range(self):
        file = table_file(self.state)
        file.parent.mkdir()
        tool = {"ToolNumber": 7, "Length": 20}
        for tools, mounted, words in (([{**tool, "Length": -1}], 0, ("/Tools/0/Length", "-1", "0 to 10000")),
                                      ([{**tool, "Lenght": 1}], 0, ("Lenght", "Length")),
                                      ([tool, tool], 0, ("/Tools/1", "ToolNumber 7 stands twice")),
                                      ([{**tool, "Frame": {"p": [0, 0, 0], "q": [1, 1, 0, 0]}}], 0, ("/Tools/0", "q")),
                                      ([tool], 8, ("/Mounted", "8"))):
            file.write_text(json.dumps({"Mounted": mounted, "Tools": tools}))
            with self.appliance() as appliance:
                refused = appliance.rmac("load", "DMACXYZ")
                self.assertEqual(refused.returncode, FAILED)
                for word in (str(file), *words):
                    self.assertIn(word, refused.stderr)

    def test_daemon_that_dies_in_a_change_does_not_know_the_tool_afterwards(self):
        table_file(self.state).parent.mkdir()
        table_file(self.state).write_text(json.dumps({"Mounted": 9, "Tools": [
            {"ToolNumber": 9, "Length": 12.5, "NeedsSpindle": False}, {"ToolNumber": 7, "Length": 20}]}))
        first = self.appliance()
        first.__enter__()
        operator = first.operator()
        self.assertEqual(operator.state()["tool"], 9)
        self.assertEqual(operator.call("RMAC_CAM.GetToolInterfaceFrame")["p"], [0, 0, -12.5])
        operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        operator.call("RMAC_CAM.DoToolChange", ToolNumber=7)
        first.process.kill()
        with self.assertRaises(AssertionError, msg="killed"):
            first.__exit__(None, None, None)
        self.assertIsNone(kept(self.state)["Mounted"])
        with self.appliance() as second:
            operator = second.operator()
            self.assertIsNone(operator.state()["tool"])
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=1000)
            for method, params in (("MoveAlongLine", line((0, 0, 0), (1, 0, 0))),
                                   ("SetSpindleRPM", {"SpindleNumber": 0, "RPM": 100})):
                self.assertIn("ConfirmToolChange", operator.refusal("RMAC_CAM." + method, **params).message)
            self.assertIn("not known", second.rmac("tools").stdout)
            done = second.rmac("confirm", "9")
            self.assertEqual(done.returncode, DONE, done.stderr)
            self.assertEqual(kept(self.state)["Mounted"], 9)
            operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, -12.5), (1, 0, -12.5)))


class Change(unittest.TestCase):
    def setUp(self):
        self.state = self.enterContext(tempfile.TemporaryDirectory(prefix="rmac-tools-"))
        self.appliance = self.enterContext(Appliance(state_folder=self.state))
        self.operator = self.appliance.operator()
        self.operator.call("RMAC_CAM.SetTool", **CUTTER)
        self.operator.call("RMAC_CAM.SetTool", **KNIFE)
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])

    def event(self, kind):
        return self.watcher.wait_note("events", lambda event: event["kind"] == kind)

    def start(self):
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def queue(self, start, end, move_id):
        self.operator.call("RMAC_CAM.MoveAlongLine", **line(start, end, move_id))

    def assert_joints(self, *joints):
        for value, wanted in zip(self.operator.state()["joints"], joints, strict=True):
            self.assertAlmostEqual(value, wanted, delta=0.02)

    def test_moves_behind_a_change_wait_for_the_person_and_are_with_the_new_tip(self):
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        self.operator.call("RMAC_CAM.TurnCoolantOn")
        self.operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=500)
        self.queue((0, 0, 0), (10, 0, 0), 1)
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=9)
        refusal = self.operator.refusal("RMAC_CAM.MoveAlongLine", **line((10, 0, 0), (10, 5, 0), 2))
        self.assertIn("start", refusal.message.lower())
        self.queue((10, 0, -12.5), (10, 5, -12.5), 2)
        self.assertEqual(self.operator.state()["moves_in_buffer"], 3)
        self.start()
        prompt = self.event("ToolWanted")["message"]
        for word in ("insert", "9", "drag knife", "confirm"):
            self.assertIn(word, prompt)
        state = self.operator.state()
        self.assertEqual((state["moving"], state["tool"], state["tool_wanted"], state["moves_in_buffer"]),
                         (False, None, 9, 2))
        self.assertEqual(state["outputs"] & COOLANT, 0)
        self.assertAlmostEqual(state["spindle_rpm"][0], 0, delta=20)
        self.assert_joints(10, 0, 0)
        self.assertIsNone(kept(self.state)["Mounted"])
        for method, params in (("SetSpindleRPM", {"SpindleNumber": 0, "RPM": 100}), ("TurnCoolantOn", {})):
            self.assertIn("tool change", self.operator.refusal("RMAC_CAM." + method, **params).message)
        self.assertIn("9", self.watcher.refusal("RMAC_CAM.ConfirmToolChange", ToolNumber=7).message)
        self.assert_joints(10, 0, 0)
        self.watcher.call("RMAC_CAM.ConfirmToolChange", ToolNumber=9)
        self.event("ToolChanged")
        self.watcher.wait_note("events", lambda event: event["kind"] == "MoveDone" and event["move_id"] == 2)
        wait_for_rest(self.operator)
        self.assert_joints(10, 5, 0)
        state = self.operator.state()
        self.assertEqual((state["tool"], state["tool_wanted"], state["tool_prompt"]), (9, None, ""))
        self.assertAlmostEqual(state["pose"][2], -12.5, delta=0.02)
        self.assertEqual(kept(self.state)["Mounted"], 9)

    def test_unknown_tool_is_refused_before_anything_moves(self):
        self.start()
        message = self.operator.refusal("RMAC_CAM.DoToolChange", ToolNumber=8).message
        for word in ("no tool 8", "7", "9"):
            self.assertIn(word, message)
        self.assertEqual((self.operator.state()["moves_in_buffer"], self.operator.state()["tool"]), (0, 0))

    def test_stop_in_a_change_leaves_the_tool_unknown_until_it_is_said(self):
        self.start()
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=7)
        self.event("ToolWanted")
        self.watcher.call("RMAC_CAM.StopNow")
        self.assertIn("not known", self.event("ToolChangeDropped")["message"])
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1000)
        self.assertIn("ConfirmToolChange",
                      self.operator.refusal("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (1, 0, 0))).message)
        self.watcher.call("RMAC_CAM.ConfirmToolChange", ToolNumber=0)
        self.queue((0, 0, 0), (1, 0, 0), 1)

    def test_stop_before_a_change_leaves_the_tool_that_was_there(self):
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=7)
        self.operator.call("RMAC_CAM.StopNow")
        self.assertIn("before it began", self.event("ToolChangeDropped")["message"])
        self.assertEqual(self.operator.state()["tool"], 0)
        self.assertEqual(kept(self.state)["Mounted"], 0)

    def test_hold_keeps_a_change_waiting_and_what_follows_waits_for_the_resume(self):
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=9)
        self.queue((0, 0, -12.5), (5, 0, -12.5), 1)
        self.start()
        self.event("ToolWanted")
        self.operator.call("RMAC_CAM.FeedHold")
        self.operator.call("RMAC_CAM.ConfirmToolChange", ToolNumber=9)
        self.event("ToolChanged")
        self.assert_joints(0, 0, 0)
        self.assertEqual(self.operator.state()["state"], "Holding")
        self.operator.call("RMAC_CAM.FeedResume")
        self.watcher.wait_note("events", lambda event: event["kind"] == "MoveDone" and event["move_id"] == 1)

    def test_change_alone_is_one_step_of_manual_mode(self):
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=9)
        self.operator.call("RMAC_CAM.CycleStart", Mode="MANUAL")
        self.event("ToolWanted")
        self.operator.call("RMAC_CAM.ConfirmToolChange", ToolNumber=9)
        self.watcher.wait_note("events", lambda event: event["kind"] == "CycleStateChanged" and
                               event["message"].endswith("to Idle"))
        self.assertEqual(self.operator.state()["tool"], 9)

    def mount(self, number):
        self.start()
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=number)
        self.event("ToolWanted")
        self.operator.call("RMAC_CAM.ConfirmToolChange", ToolNumber=number)
        self.event("ToolChanged")
        while self.operator.state()["tool"] != number:
            pass

    def test_tool_bounds_the_spindle_and_what_cuts_needs_it_turning(self):
        self.mount(7)
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1000)
        refusal = self.operator.refusal("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=601)
        self.assertIn("600", refusal.message)
        self.assertEqual(refusal.minor, "MACHINE_ERR_SPEED_LIMIT")
        refusal = self.operator.refusal("RMAC_CAM.MoveAlongLine", **line((0, 0, -20), (1, 0, -20)))
        self.assertIn("spindle", refusal.message)
        self.operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=600)
        self.queue((0, 0, -20), (1, 0, -20), 1)
        self.watcher.wait_note("events", lambda event: event["kind"] == "MoveDone")

    def test_length_that_is_set_anew_is_in_force_at_once_and_only_at_rest(self):
        self.mount(9)
        self.operator.call("RMAC_CAM.SetTool", **{**KNIFE, "Length": 13})
        self.assertEqual(self.operator.call("RMAC_CAM.GetToolInterfaceFrame")["p"], [0, 0, -13])
        self.operator.call("RMAC_CAM.CycleStop", Mode="AUTOMATIC")
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1000)
        self.queue((0, 0, -13), (1, 0, -13), 1)
        self.assertIn("empty queue", self.operator.refusal("RMAC_CAM.SetTool", **KNIFE).message)
        self.assertIn("spindle", self.operator.refusal("RMAC_CAM.RemoveTool", ToolNumber=9).message)

    def test_virtual_mode_changes_tools_and_not_what_is_kept(self):
        self.mount(9)
        self.operator.call("RMAC_CAM.StopNow")
        wait_for_rest(self.operator)
        while self.operator.state()["state"] != "Idle":
            pass
        self.operator.call("Device.Load", Name="DMACXYZ", Virtual=True)
        self.assertEqual(self.operator.state()["tool"], 9)
        self.mount(7)
        self.operator.call("RMAC_CAM.SetTool", ToolNumber=3, Length=1)
        self.assertEqual(kept(self.state)["Mounted"], 9)
        self.assertEqual([tool["ToolNumber"] for tool in kept(self.state)["Tools"]], [3, 7, 9])


class Changer(unittest.TestCase):
    """DMACXYZA changes tools by itself, on simulated valves."""

    ADVANCE, UNCLAMP = 1 << 1, 1 << 2
    CHANGE_POSITION = (0, 0, 45, 0)
    MILLS = ({"ToolNumber": 3, "Length": 20}, {"ToolNumber": 5, "Length": 12.5, "NeedsSpindle": False},
             {"ToolNumber": 8, "Length": 10})

    def begin(self, edit=None):
        """Clients of an appliance whose DMACXYZA is as `edit` makes it."""
        self.appliance = Appliance(own_tree=edit is not None)
        if edit is not None:
            file = self.appliance.tree / "mill/4-axis/DMACXYZA/device.json"
            device = json.loads(file.read_text())
            edit(device)
            file.write_text(json.dumps(device))
        self.enterContext(self.appliance)
        self.operator = self.appliance.operator("DMACXYZA")
        for mill in self.MILLS:
            self.operator.call("RMAC_CAM.SetTool", **mill)
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def change(self, number):
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=number)
        self.watcher.wait_note("events", lambda event: event["kind"] == "ToolChanged")

    def table(self):
        return kept(self.appliance.folder / "state", "DMACXYZA")

    def pocket(self, state):
        return state["outputs"] >> 3 & 7

    def test_changer_fetches_a_tool_and_puts_it_back_between_moves(self):
        self.begin()
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        self.operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=500)
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (10, 0, 0), 1))
        drives = self.appliance.client("drives")
        drives.call("subscribe", topics=["drives"], rate_hz=1000)
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=5)
        # The machine will stand where the change ends, with the new tip; the next move is queued while it works.
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 32.5), (0, 5, 32.5), 2))
        seen = []
        while not seen or seen[-1] != 0 or len(seen) < 4:
            for sample in drives.wait_note("drives")["samples"]:
                valves = sample["outputs"] & (self.ADVANCE | self.UNCLAMP)
                if not seen or seen[-1] != valves:
                    seen.append(valves)
        self.assertEqual(seen, [0, self.ADVANCE, self.ADVANCE | self.UNCLAMP, self.ADVANCE, 0])
        self.watcher.wait_note("events", lambda event: event["kind"] == "MoveDone" and event["move_id"] == 2)
        state = wait_for_rest(self.operator)
        for value, wanted in zip(state["joints"], (0, 5, 45, 0), strict=True):
            self.assertAlmostEqual(value, wanted, delta=0.02)
        self.assertEqual((state["tool"], self.pocket(state), self.table()["Mounted"]), (5, 5, 5))
        self.assertAlmostEqual(state["spindle_rpm"][0], 0, delta=20)
        self.change(3)
        state = self.operator.state()
        self.assertEqual((state["tool"], self.pocket(state)), (3, 3))
        self.change(0)
        state = self.operator.state()
        self.assertEqual((state["tool"], self.pocket(state), self.table()["Mounted"]), (0, 3, 0))
        for value, wanted in zip(state["joints"], self.CHANGE_POSITION, strict=True):
            self.assertAlmostEqual(value, wanted, delta=0.02)

    def test_input_that_does_not_come_faults_and_the_tool_is_not_known(self):
        self.begin(lambda device: device["DigitalIOInterface"]["Parameters"].pop("unclamp"))
        self.operator.call("RMAC_CAM.DoToolChange", ToolNumber=5)
        fault = self.watcher.wait_note("events", lambda event: event["kind"] == "Fault")
        for word in ("Unclamped", "2 s", "not known", "ConfirmToolChange"):
            self.assertIn(word, fault["message"])
        state = self.operator.state()
        self.assertEqual((state["state"], state["tool"], self.table()["Mounted"]), ("Faulted", None, None))
        self.operator.call("RMAC_CAM.Reset")
        self.assertIn("ConfirmToolChange", self.operator.refusal("RMAC_CAM.DoToolChange", ToolNumber=5).message)
        self.operator.call("RMAC_CAM.ConfirmToolChange", ToolNumber=0)
        self.assertEqual((self.operator.state()["tool"], self.table()["Mounted"]), (0, 0))

    def test_tool_without_a_place_in_the_changer_is_refused_before_anything_moves(self):
        self.begin()
        self.assertIn("up to 7", self.operator.refusal("RMAC_CAM.DoToolChange", ToolNumber=8).message)
        state = self.operator.state()
        self.assertEqual((state["moves_in_buffer"], state["tool"], self.table()["Mounted"]), (0, 0, 0))
        self.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        self.operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (1, 0, 0), 1))

    def test_automatic_change_without_the_changers_steps_is_refused(self):
        self.begin(lambda device: device.pop("ToolChange"))
        refusal = self.operator.refusal("RMAC_CAM.DoToolChange", ToolNumber=5)
        self.assertIn("ToolChange", refusal.message)
        self.assertEqual(refusal.minor, "MACHINE_ERR_UNSUPPORTED_OPERATION")

    def test_wrong_step_is_refused_with_its_key_and_what_is_allowed(self):
        for edit, words in ((lambda steps: steps[0].update(Joints=[0, 0, 51, 0]), ("/ToolChange/0/Joints/2", "51", "50")),
                            (lambda steps: steps[0].update(Joints=[0]), ("/ToolChange/0/Joints", "1 entries", "4")),
                            (lambda steps: steps[1].pop("For"), ("/ToolChange/1", "For")),
                            (lambda steps: steps[3].update(Input="Forward"), ("/ToolChange/3/Input", "Forward"))):
            with Appliance(own_tree=True) as appliance:
                file = appliance.tree / "mill/4-axis/DMACXYZA/device.json"
                device = json.loads(file.read_text())
                edit(device["ToolChange"])
                file.write_text(json.dumps(device))
                client = appliance.client()
                client.call("authority.acquire")
                message = client.refusal("Device.Load", Name="DMACXYZA").message
                for word in words:
                    self.assertIn(word, message)

    def test_virtual_mode_waits_for_no_input(self):
        self.begin(lambda device: device["DigitalIOInterface"].pop("Parameters"))
        self.operator.call("RMAC_CAM.StopNow")
        wait_for_rest(self.operator)
        while self.operator.state()["state"] != "Idle":
            pass
        self.operator.call("Device.Load", Name="DMACXYZA", Virtual=True)
        self.operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.change(5)
        self.assertEqual((self.operator.state()["tool"], self.table()["Mounted"]), (5, 0))


class Programs(unittest.TestCase):
    """`rmac run` and `rmac simulate` with a program that changes the tool between two cuts."""

    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, DONE)
        self.file = self.appliance.folder / "change.rmac"
        self.file.write_text("\n".join((
            request("RMAC_CAM.SetTool", **CUTTER),
            request("RMAC_CAM.SetFeedrate", Feedrate=1500),
            request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(0, 0, 0)),
            request("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (10, 0, 0), 2)),
            request("RMAC_CAM.DoToolChange", ToolNumber=7),
            request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=400),
            request("RMAC_CAM.MoveAlongLine", **line((10, 0, -20), (10, 5, -20), 3)),
            request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=0))) + "\n")
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])

    def run_it(self, stdin):
        return self.enterContext(subprocess.Popen(
            [BUILD / "bin" / "rmac", "--port", str(self.appliance.port), "run", self.file, "--json"],
            stdin=stdin, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))

    def assert_done(self, run):
        out, told = run.communicate(timeout=60)
        self.assertEqual(run.returncode, DONE, told)
        self.assertEqual(json.loads(out)["moves"], 3)
        self.assertIn("insert tool 7 (ball 6)", told)
        for value, wanted in zip(self.watcher.state()["joints"], (10, 5, 0), strict=True):
            self.assertAlmostEqual(value, wanted, delta=0.02)

    def test_program_waits_for_confirm_from_another_terminal(self):
        run = self.run_it(subprocess.DEVNULL)
        self.watcher.wait_note("events", lambda event: event["kind"] == "ToolWanted")
        status = self.appliance.rmac("status")
        self.assertIn("insert tool 7", status.stdout)
        done = self.appliance.rmac("confirm")
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assert_done(run)

    def test_enter_at_the_terminal_of_the_program_confirms(self):
        keyboard, terminal = pty.openpty()
        run = self.run_it(terminal)
        self.watcher.call("subscribe", topics=["state"], rate_hz=100)
        self.watcher.wait_note("state", lambda state: state["tool_prompt"])

        def confirmed(event):
            return event["kind"] == "ToolChanged"

        # The client may not have heard of the prompt yet; Enter does nothing then, so it is typed again.
        while True:
            os.write(keyboard, b"\n")
            self.watcher.wait_note("state")
            if any(note["method"] == "events" and confirmed(note["params"]) for note in self.watcher.notes):
                break
            if self.watcher.state()["tool"] == 7:
                break
        self.assert_done(run)
        os.close(keyboard)
        os.close(terminal)

    def simulate(self, *words):
        done = subprocess.run([BUILD / "bin" / "rmac", "simulate", self.file, "--machine", "DMACXYZ", "--device-tree",
                               BUILD / "drivers", "--json", *words], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=120, check=False)
        return done

    def test_simulation_changes_the_tool_in_no_time_and_says_how_often(self):
        done = self.simulate()
        self.assertEqual(done.returncode, DONE, done.stderr)
        told = json.loads(done.stdout)
        self.assertEqual((told["moves"], told["tool_changes"]), (3, 1))
        self.assertAlmostEqual(told["length_mm"], 15, delta=1e-6)

    def test_simulation_reads_the_tables_that_it_is_given_and_writes_none(self):
        program = self.file.read_text().splitlines()
        self.file.write_text("\n".join(program[1:]) + "\n")
        refused = self.simulate()
        self.assertEqual(refused.returncode, FAILED)
        self.assertIn("no tool 7", refused.stderr)
        tables = self.appliance.folder / "tables"
        tables.mkdir()
        text = json.dumps({"Mounted": 0, "Tools": [CUTTER]})
        (tables / "DMACXYZ.json").write_text(text)
        done = self.simulate("--tools", str(tables))
        self.assertEqual(done.returncode, DONE, done.stderr)
        self.assertEqual((tables / "DMACXYZ.json").read_text(), text)


if __name__ == "__main__":
    unittest.main()

"""A part measured where it is cut: the program is parked, the measuring machine is a role of the mill, the cut goes on."""

import json
import math
import os
import pty
import subprocess
import time
import unittest

from appliance import BUILD, Appliance, pose, wait_for_rest
from client import Refused
from test_measure import FRONT, LEFT, TIP_RADIUS, TOP

DONE = 0
PLACE = [0.3, -0.2, 0.1, 0, 0, 0.2]  # of the part: mm, and degrees about z
# Above the block: the tip of the cutter is the probe's, so it must not touch.
HEIGHT = -10.0
CORNERS = [(-12, -8), (12, -8), (12, 8), (-12, 8), (-12, -8)]


def in_part(point):
    """A point of the machine in the part as it is clamped."""
    turn = math.radians(PLACE[5])
    x, y, z = (point[i] - PLACE[i] for i in range(3))
    return [math.cos(turn) * x + math.sin(turn) * y, -math.sin(turn) * x + math.cos(turn) * y, z]


def program(feed):
    """The rectangle, as a client sends it."""
    requests = [("SetFeedrate", {"Feedrate": feed}),
                ("MoveToPathTarget", {"MoveID": 1, "TargetFrame": pose(*CORNERS[0], HEIGHT)})]
    for number, (start, end) in enumerate(zip(CORNERS, CORNERS[1:]), 2):
        requests.append(("MoveAlongLine", {"MoveID": number, "StartPoint": pose(*start, HEIGHT),
                                           "EndPoint": pose(*end, HEIGHT)}))
    return [("RMAC_CAM." + function, params) for function, params in requests]


class Parking(unittest.TestCase):
    def setUp(self):
        self.appliance = Appliance(own_tree=True)
        parts = {}
        for name in ("cmm/3-axis/CMM", "mill/3-axis/DMACXYZ"):
            file = self.appliance.tree / name / "device.json"
            parts[file] = json.loads(file.read_text())
        measurer, mill = parts.values()
        mill["DigitalIOInterface"]["Parameters"] = measurer["DigitalIOInterface"]["Parameters"]
        mill["DigitalIOInterface"]["Parameters"]["part_place"] = PLACE
        file.write_text(json.dumps(mill))
        self.enterContext(self.appliance)
        self.plan = self.appliance.folder / "plan.json"
        self.plan.write_text(json.dumps({"SafeHeight": -5, "TipRadius": TIP_RADIUS, "Features": [TOP, LEFT, FRONT]}))

    def rmac(self, *words):
        done = self.appliance.rmac(*words)
        self.assertEqual(done.returncode, DONE, done.stderr)
        return done.stdout

    def measure_and_come_back(self):
        self.rmac("load", "CMM")
        measured = json.loads(self.rmac("measure", str(self.plan), "--apply", "--upright", "--json"))
        self.assertTrue(measured["applied"])
        for lean in measured["part_frame"]["q"][1:3]:
            self.assertAlmostEqual(lean, 0, delta=1e-12, msg="a machine of three slides cannot lean its tool")
        back = json.loads(self.rmac("parked", "--back", "4", "--json"))
        self.assertLess(back["off_mm"], 0.01)
        self.rmac("load", "DMACXYZ")
        return measured

    def check_cut(self, samples):
        """What was cut after the correction lies on the rectangle of the part as it is clamped."""
        checked = 0
        for sample in samples:
            if sample["move_id"] < 2:
                continue
            x, y, z = in_part(sample["q"])
            edge = min(abs(abs(x) - 12), abs(abs(y) - 8))
            self.assertLess(edge, 5e-3, f"move {sample['move_id']} at {x}, {y}")
            self.assertLess(abs(z - HEIGHT), 5e-3)
            checked += 1
        self.assertGreater(checked, 1000)

    def record(self, client):
        """Moving samples from now on."""
        samples = []
        client.call("subscribe", topics=["joints"], rate_hz=1000)

        def take():
            while client.notes:
                note = client.notes.popleft()
                if note["method"] == "joints":
                    samples.extend(sample for sample in note["params"]["samples"] if sample["moving"])
            return samples

        return take

    def park(self, client):
        """Once it stands: at a corner it does so for a moment on its way, too, and is asked again then, as it says."""
        while True:
            while client.state()["moving"]:
                pass
            try:
                return client.call("RMAC_CAM.ParkProgram")
            except Refused as refused:
                self.assertIn("still coming to rest", refused.message)

    def test_cut_is_paused_measured_corrected_and_gone_on_with(self):
        client = self.appliance.operator()
        client.call("subscribe", topics=["events"])
        for method, params in program(60):
            client.call(method, **params)
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.wait_note("events", lambda event: event["kind"] == "MoveStarted" and event["move_id"] == 2)
        self.assertIn("FeedHold first", client.refusal("RMAC_CAM.ParkProgram").message)
        client.call("RMAC_CAM.FeedHold")
        while "park them with ParkProgram" not in client.refusal("Device.Load", Name="CMM").message:
            pass  # it moves
        self.park(client)
        parked = client.call("RMAC_CAM.GetParkedProgram")
        self.assertEqual((parked["mechanism"], parked["move_id"], parked["moves"]), ("DMACXYZ", 2, 4))
        client.call("authority.release")
        self.measure_and_come_back()
        client.call("authority.acquire")
        self.assertEqual(client.call("RMAC_CAM.GetParkedProgram")["moves"], 4)
        client.call("RMAC_CAM.TakeUpProgram")
        self.assertEqual(client.state()["state"], "Holding")
        self.assertEqual(client.call("RMAC_CAM.GetParkedProgram"), {})
        client.call("RMAC_CAM.SetFeedOverride", Percent=200)
        client.notes.clear()
        samples = self.record(client)
        client.call("RMAC_CAM.FeedResume")
        while client.state()["moves_in_buffer"] > 0 or client.state()["moving"]:
            samples()
        self.check_cut(samples())

    def test_failed_measurement_leaves_the_program_where_it_was(self):
        client = self.appliance.operator()
        for method, params in program(60):
            client.call(method, **params)
        client.call("subscribe", topics=["events"])
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.wait_note("events", lambda event: event["kind"] == "MoveStarted" and event["move_id"] == 2)
        client.call("RMAC_CAM.FeedHold")
        self.park(client)
        client.call("authority.release")
        self.assertEqual(self.appliance.rmac("load", "NoSuchMachine").returncode, 1)
        self.rmac("load", "CMM")
        air = {"Name": "air", "Points": [{"Point": [40, -40, -20], "Normal": [0, 0, 1]}]}
        self.plan.write_text(json.dumps({"SafeHeight": -5, "TipRadius": TIP_RADIUS, "Features": [air]}))
        self.assertEqual(self.appliance.rmac("measure", str(self.plan), "--apply").returncode, 1)
        self.rmac("load", "DMACXYZ")
        client.call("authority.acquire")
        self.assertIn("at most 1 mm", client.refusal("RMAC_CAM.TakeUpProgram").message)
        client.call("authority.release")
        self.rmac("parked", "--back", "4")
        client.call("authority.acquire")
        client.call("RMAC_CAM.TakeUpProgram")
        client.call("RMAC_CAM.SetFeedOverride", Percent=200)
        client.call("RMAC_CAM.FeedResume")
        state = wait_for_rest(client)
        self.assertAlmostEqual(state["joints"][0], CORNERS[-1][0], delta=0.01)

    def test_program_of_rmac_run_is_parked_at_its_terminal(self):
        self.rmac("load", "DMACXYZ")
        self.rmac("home")
        file = self.appliance.folder / "rectangle.rmac"
        file.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": i, "method": method, "params": params}) + "\n"
                                for i, (method, params) in enumerate(program(60))))
        watcher = self.appliance.client("watcher")
        watcher.call("subscribe", topics=["events"])
        keyboard, terminal = pty.openpty()
        self.addCleanup(os.close, keyboard)
        run = subprocess.Popen([BUILD / "bin/rmac", "--port", str(self.appliance.port), "run", str(file)],
                               stdin=terminal, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        os.close(terminal)
        try:
            watcher.wait_note("events", lambda event: event["kind"] == "MoveStarted" and event["move_id"] == 2)
            self.rmac("hold")
            while watcher.state()["moving"]:
                pass
            os.write(keyboard, b"p\n")
            while not watcher.call("RMAC_CAM.GetParkedProgram") or watcher.state()["authority"]:
                pass
            self.measure_and_come_back()
            os.write(keyboard, b"\n")
            samples = self.record(watcher)
            until = time.monotonic() + 100
            while run.poll() is None and time.monotonic() < until:
                watcher.state()
                samples()
            complaint = run.stderr.read() if run.poll() is not None else "it did not end"
        finally:
            run.kill()
            run.communicate()
        self.assertEqual(run.returncode, DONE, complaint)
        self.check_cut(samples())


if __name__ == "__main__":
    unittest.main()

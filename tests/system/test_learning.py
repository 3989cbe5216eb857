"""rmac run --learn and --learned: a program that is repeated gets better, and what was learned holds for it alone."""

import csv
import json
import pathlib
import tempfile
import unittest

from appliance import Appliance, pose, wait_for_rest
from bending_mill import device_of, rigid

PERIOD = 0.001


def request(method, **params):
    return json.dumps({"jsonrpc": "2.0", "id": 1, "method": f"RMAC_CAM.{method}", "params": params})


def around(radius=20, ends=(0, 0, 0)):
    """A circle, and a way through all three axes that ends there; a dwell and a spindle that changes in between."""
    corner, below = pose(15, 8, 0), pose(0, 0, -5)
    return [
        request("SetFeedrate", Feedrate=2000),
        request("SetPathTolerance", Tolerance=0.01),
        request("MoveToPathTarget", MoveID=5, TargetFrame=pose(0, 0, 0)),
        request("MoveAlongArc", MoveID=10, RotSign=1, Closed=True, CenterPoint={"p": [0, radius, 0], "q": [1, 0, 0, 0]},
                StartPoint=pose(0, 0, 0), EndPoint=pose(0, 0, 0)),
        request("MoveAlongLine", MoveID=20, StartPoint=pose(0, 0, 0), EndPoint=corner),
        request("Dwell", MoveID=25, Time=0.3),
        request("InTurn", MoveID=26, Calls=[{"method": "RMAC_CAM.SetSpindleRPM", "params": {"SpindleNumber": 0, "RPM": 500}}]),
        request("MoveAlongLine", MoveID=30, StartPoint=corner, EndPoint=below),
        request("MoveAlongLine", MoveID=40, StartPoint=below, EndPoint=pose(*ends)),
    ]


class Learning(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.appliance = self.enterContext(Appliance(own_tree=True))
        self.honest = self.device.read_text()
        with device_of(self.appliance) as device:
            rigid(device)
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, 0)
        self.program = self.folder / "part.rmac"
        self.write(around())

    @property
    def device(self):
        return next(self.appliance.tree.glob("*/*/DMACXYZ/device.json"))

    def write(self, lines):
        self.program.write_text("\n".join(lines) + "\n")

    def learn(self, *words, passes=4):
        done = self.appliance.rmac("--json", "run", str(self.program), "--learn", str(passes), *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn(f"goes round {passes} times on DMACXYZ", done.stderr, "it says so before it starts")
        return json.loads(done.stdout)

    def run_it(self, *words):
        return self.appliance.rmac("--json", "run", str(self.program), *words)

    def refused(self, done):
        self.assertEqual((done.returncode, done.stderr.count("\n")), (1, 1), done.stderr)
        return done.stderr

    def test_errors_fall_to_a_third_within_four_passes(self):
        told = self.learn("--bandwidth", "40")
        first, last = told["passes"][0]["rms"], told["passes"][-1]["rms"]
        for joint, before, after in zip(told["joints"], first, last, strict=True):
            self.assertLess(after, before / 3, joint)
        learned = json.loads(pathlib.Path(told["file"]).read_text())
        self.assertEqual(told["file"], f"{self.program}.learned")
        for joint in learned["Joints"]:
            self.assertLessEqual(max(map(abs, joint["Offsets"])), 0.5 / 4, "a quarter of MaxFollowingError")
        # It is used when asked for, and only then.
        without = json.loads(self.run_it().stdout)["following_error"]
        record = self.folder / "record.csv"
        with_it = json.loads(self.run_it("--learned", "--record", str(record)).stdout)["following_error"]
        self.assertLess(max(with_it), max(without) / 2)
        again = json.loads(self.run_it().stdout)["following_error"]
        self.assertGreater(max(again), 2 * max(with_it), "it ended with motion authority")
        self.assert_within_limits(record)

    def assert_within_limits(self, record):
        """What is told as setpoints is the program's, without what was learned: on its circle, within the limits."""
        rows = list(csv.DictReader(record.read_text().splitlines()))
        circle = [row for row in rows if row["move_id"] == "10"]
        self.assertGreater(len(circle), 1000)
        for row in circle:
            self.assertAlmostEqual((float(row["q1"]) ** 2 + (float(row["q2"]) - 20) ** 2) ** 0.5, 20, delta=0.0101)
        velocity = [float(row["qd1"]) for row in rows]
        for before, after in zip(velocity, velocity[1:]):
            self.assertLessEqual(abs(after - before), 1.001 * 5000 * PERIOD)

    def test_axes_that_bend_stick_and_cog_teach_too(self):
        """As the tree has them, whose loops know most of it already."""
        self.device.write_text(self.honest)
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, 0)
        told = self.learn(passes=6)
        before = told["passes"][0]["rms"]
        # What is kept: an axis that sticks elsewhere once has a pass that is worse.
        kept = [told["passes"][best - 1]["rms"][joint] for joint, best in enumerate(told["best_pass"])]
        for first, best in zip(before, kept, strict=True):
            self.assertLess(best, first / 2)
        self.assertLess(max(kept[:2]), 0.0005, "those that go round the circle")

    def test_drives_that_answer_a_cycle_late_teach_too(self):
        with device_of(self.appliance) as device:
            rigid(device, late_answers=[1])
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, 0)
        record = self.folder / "record.csv"
        seen = json.loads(self.run_it("--record", str(record)).stdout)["following_error"]
        rows = list(csv.DictReader(record.read_text().splitlines()))
        for joint, largest in enumerate(seen, start=1):
            wanted, at, error = ([float(row[f"{of}{joint}"]) for row in rows] for of in ("q", "a", "error"))
            for q, a, told in zip(wanted, at[1:], error[1:]):
                self.assertAlmostEqual(told, q - a, delta=1e-9)
            self.assertEqual(largest, max(map(abs, error)), "in the summary of a run it is none either")
        told = self.learn()
        for before, after in zip(told["passes"][0]["rms"], told["passes"][-1]["rms"], strict=True):
            self.assertLess(before, 0.005, "the way of a cycle, 33 µm, is no error")
            self.assertLess(after, 0.75 * before)

    def test_what_was_learned_is_refused_for_another_program_or_another_machine(self):
        said = self.refused(self.run_it("--learned"))
        self.assertIn("part.rmac.learned: cannot be read", said)
        self.learn(passes=2)
        self.assertEqual(self.run_it("--learned").returncode, 0)
        self.write(around(radius=21))
        self.assertIn("has changed since", self.refused(self.run_it("--learned")))
        self.write(around())
        self.assertEqual(self.run_it("--learned").returncode, 0)
        client = self.appliance.client()
        client.call("authority.acquire")
        client.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[1500, 140000, 11.1])
        client.call("RMAC_Config.Apply")
        client.call("authority.release")
        self.assertIn("learned with another configuration of DMACXYZ", self.refused(self.run_it("--learned")))
        client.call("authority.acquire")
        client.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[1550, 140000, 11.1])
        client.call("RMAC_Config.Apply")
        client.call("authority.release")
        self.assertEqual(self.run_it("--learned").returncode, 0, "as it was")
        self.assertEqual(self.appliance.rmac("load", "DMACXYZA").returncode, 0)
        self.assertIn("learned with DMACXYZ, and DMACXYZA is loaded", self.refused(self.run_it("--learned")))

    def test_programs_that_cannot_be_learned_are_refused_before_anything_moves(self):
        load = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "Device.Load", "params": {"Name": "DMACXYZ"}})
        for lines, said in (([load, *around()], ":1: Device.Load changes the machine"),
                            ([*around(), *around()[3:5]], ":10: MoveID 10 stands on an earlier line too"),
                            ([request("SetFeedrate", Feedrate=100)], "queues no move")):
            with self.subTest(said=said):
                self.write(lines)
                self.assertIn(said, self.refused(self.run_it("--learn", "3")))
        self.write(around())
        for words, said in ((("--learn", "3", "--offsets", "/nowhere/x"), "cannot be written"),
                            (("--learn", "3", "--offsets", str(self.program)), "this run uses this file"),
                            (("--learn", "3", "--bandwidth", "150"), "100 Hz are the most")):
            with self.subTest(said=said):
                self.assertIn(said, self.refused(self.run_it(*words)))
        self.assertEqual(self.run_it("--learn", "1").returncode, 2)
        self.assertEqual(self.run_it("--learn", "3", "--learned").returncode, 2)
        joints = self.appliance.client().state()["joints"]
        self.assertLess(max(map(abs, joints)), 0.01)
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ", "--virtual").returncode, 0)
        self.assertIn("virtual mode", self.refused(self.run_it("--learn", "3")))

    def test_a_program_that_ends_elsewhere_learns_all_but_its_approach(self):
        first, second = pose(10, 0, 0), pose(10, 20, 0)
        self.write([request("SetFeedrate", Feedrate=2000), request("MoveToPathTarget", MoveID=1, TargetFrame=first),
                    request("MoveAlongLine", MoveID=2, StartPoint=first, EndPoint=second)])
        told = self.learn(passes=3)
        learned = json.loads(pathlib.Path(told["file"]).read_text())
        begins = dict(learned["Moves"])[2]
        for joint in learned["Joints"]:
            for place, offset in zip(learned["Places"], joint["Offsets"], strict=True):
                self.assertTrue(place > begins or offset == 0, (place, offset))

    def test_only_sound_offsets_are_taken_and_only_at_rest(self):
        self.learn(passes=2)
        learned = json.loads(pathlib.Path(f"{self.program}.learned").read_text())
        del learned["Program"]
        client = self.appliance.operator()
        put = "RMAC_CAM.SetLearnedOffsets"

        def refusal(**change):
            return client.refusal(put, Learned={**learned, **change}).message

        client.call(put, Learned=learned)
        self.assertEqual(client.call("RMAC_CAM.GetLearnedOffsets")["Knots"], len(learned["Places"]))
        joints = learned["Joints"]
        zeros = [0] * len(learned["Places"])
        for change, said in (
                ({"Joints": [{"Offsets": [0.2, *zeros[1:]]}, *joints[1:]]}, "joint X would be moved by 0.2"),
                ({"Joints": joints[:2]}, "offsets of 2 joints, and the machine moves 3"),
                ({"Joints": [*joints, joints[0]]}, "offsets of 4 joints"),
                ({"Joints": [{"Offsets": zeros[1:]}, *joints[1:]]}, "numbers for"),
                ({"Joints": [{"Offsets": [None, *zeros[1:]]}, *joints[1:]]}, "/Joints/0/Offsets[0] is no number"),
                ({"Places": learned["Places"][::-1]}, "places of knots must ascend"),
                ({"Places": list(range(250001))}, "250000 are possible"),
                ({"Moves": [[1, 0], [1, 5]]}, "two moves have the id 1"),
                ({"Moves": []}, "no move"), ({"End": "far"}, "/End is no number"), ({"Else": 1}, "members alone"),
                ({"Machine": "Sugino"}, "learned with Sugino"), ({"Configuration": "0"}, "another configuration")):
            with self.subTest(said=said):
                self.assertIn(said, refusal(**change))
        self.assertEqual(client.call("RMAC_CAM.GetLearnedOffsets")["Knots"], len(learned["Places"]), "as before")
        client.call("RMAC_CAM.SetFeedrate", Feedrate=60)
        client.call("RMAC_CAM.MoveAlongLine", MoveID=1, StartPoint=pose(0, 0, 0), EndPoint=pose(20, 0, 0))
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        self.assertIn("SetLearnedOffsets", refusal())
        client.call("RMAC_CAM.StopNow")
        wait_for_rest(client)
        client.call(put)
        self.assertEqual(client.call("RMAC_CAM.GetLearnedOffsets")["Knots"], 0)

    def test_holds_retraces_overrides_and_a_stop_in_mid_path_end_without_a_fault(self):
        self.learn(passes=3)
        learned = json.loads(pathlib.Path(f"{self.program}.learned").read_text())
        del learned["Program"]
        client = self.appliance.operator()
        client.call("subscribe", topics=["joints"], rate_hz=1e6)
        client.call("RMAC_CAM.SetLearnedOffsets", Learned=learned)
        for line in around():
            sent = json.loads(line)
            client.call(sent["method"], **sent["params"])
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        for what, params in (("SetFeedOverride", {"Percent": 200}), ("SetFeedOverride", {"Percent": 30}),
                             ("FeedHold", {}), ("FeedRetrace", {"Distance": 3}), ("FeedResume", {}),
                             ("SetFeedOverride", {"Percent": 100}), ("FeedHold", {}), ("StopNow", {})):
            before = client.state()["t_s"]
            client.call("subscribe", topics=["state"], rate_hz=100)
            client.wait_note("state", lambda state: state["t_s"] > before + 0.3)
            client.call("unsubscribe", topics=["state"])
            with self.subTest(what=what):
                client.call(f"RMAC_CAM.{what}", **params)
        state = wait_for_rest(client)
        self.assertNotIn(state["state"], ("Faulted", "EmergencyStop"), state)
        client.call("authority.release")
        self.assertEqual(client.call("RMAC_CAM.GetLearnedOffsets")["Knots"], 0, "it ended with motion authority")
        self.assertEqual(self.run_it("--learned").returncode, 0)


if __name__ == "__main__":
    unittest.main()

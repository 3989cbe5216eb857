"""The daemon's check of a path before it is run: what somebody sends who has never read our code."""

import json
import unittest

from appliance import Appliance, line, wait_for_rest

CLAMP = {"Name": "clamp", "Shape": {"Box": {"Size": [10, 10, 20]}}, "Pose": {"p": [60, 0, 0], "axis": [0, 0, 1]}}
SETUP = {"Machine": "DMACXYZ", "Fixtures": [CLAMP], "Clearance": 1}
NOSE = 25  # radius of the spindle's lower end, which widens upwards
CUBE = {"Points": [[-5, -5, -10], [5, -5, -10], [5, 5, -10], [-5, 5, -10],
                   [-5, -5, 10], [5, -5, 10], [5, 5, 10], [-5, 5, 10]],
        "Triangles": [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
                      [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]]}
EMPTY = "nothing is held against a set-up before it moves"


def with_clamp(**changes):
    return SETUP | {"Fixtures": [CLAMP | changes]}


def mesh(**changes):
    return with_clamp(Shape={"Mesh": CUBE | changes})


def wait_for_stop(client):
    while client.state()["moving"]:
        pass


class CollisionCheck(unittest.TestCase):
    pace = "as-fast-as-computed"

    def setUp(self):
        self.appliance = self.enterContext(Appliance(pace=self.pace))
        self.client = self.appliance.operator()
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["events"])
        self.client.call("RMAC_CAM.SetFeedrate", Feedrate=1500)

    def event(self, kind, move_id=0):
        return self.watcher.wait_note("events", lambda e: e["kind"] == kind and e["move_id"] == move_id)

    def check(self, setup=None):
        self.client.call("RMAC_CAM.SetSetup", Setup=SETUP if setup is None else setup)
        self.client.call("RMAC_CAM.SetCollisionCheck", On=True)

    def to(self, x, move_id, y=0):
        self.client.call("RMAC_CAM.MoveToJointTarget", MoveID=move_id, JointTargetFrame={"joints": [x, y, 0]})

    def start(self):
        self.client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")

    def x(self):
        return self.client.call("RMAC_CAM.CurrentPosition")[0]

    def test_holds_before_a_clamp_and_goes_no_farther(self):
        self.check()
        self.to(10, 1)
        self.to(40, 2)
        self.to(0, 3)
        self.start()
        told = self.event("CollisionAhead", 2)
        for word in ("move 2", "clamp", "spindle nose", "mm deep", "part frame"):
            self.assertIn(word, told["message"])
        self.assertEqual(self.client.state()["state"], "Holding")
        self.assertLess(self.x(), 55 - NOSE - SETUP["Clearance"])
        self.assertGreater(self.x(), 25, "it went as far as it may")
        stands = self.x()
        for method, params in (("FeedResume", {}), ("CycleStart", {"Mode": "AUTOMATIC"})):
            self.assertIn("a collision lies ahead", self.client.refusal(f"RMAC_CAM.{method}", **params).message)
        self.assertIn("empty queue", self.client.refusal("RMAC_CAM.SetCollisionCheck", On=False).message)
        self.assertAlmostEqual(self.x(), stands, delta=0.01)
        self.client.call("RMAC_CAM.StopNow")
        wait_for_rest(self.client)
        self.to(0, 4)
        self.start()
        self.event("MoveDone", 4)

    def test_runs_what_is_free_to_its_end(self):
        self.check(with_clamp(Pose={"p": [0, 60, 0], "axis": [0, 0, 1]}))
        self.client.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=600)
        self.client.call("RMAC_CAM.SetPathTolerance", Tolerance=0.05)
        corners = [(0, 0, 0), (20, 0, 0), (20, 15, 0), (-10, 15, 0), (0, 0, 0)]
        for move_id, (begin, end) in enumerate(zip(corners, corners[1:]), 1):
            self.client.call("RMAC_CAM.MoveAlongLine", **line(begin, end, move_id))
        self.start()
        self.event("MoveDone", len(corners) - 1)

    def test_a_jog_stops_before_it(self):
        self.check()
        self.client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=45)
        self.event("CollisionAhead", -1)
        wait_for_rest(self.client)
        self.assertLess(self.x(), 55 - NOSE - SETUP["Clearance"])
        self.assertGreater(self.x(), 25)
        self.client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=-20)
        wait_for_rest(self.client)
        self.assertLess(self.x(), 10)

    def test_refuses_with_the_reason_and_keeps_what_was(self):
        self.client.call("RMAC_CAM.SetSetup", Setup=SETUP)
        path = with_clamp(Shape={"Mesh": {"File": "/etc/passwd"}})
        hole = CUBE["Triangles"][1:]
        flat = [point[:2] + [0] for point in CUBE["Points"]]
        for setup, words in (
                (path, "/Fixtures/0/Shape/Mesh/File names a file, and none is read here"),
                (SETUP | {"Machine": "SuginoXYZAC"}, "/Machine is \"SuginoXYZAC\", and DMACXYZ is loaded"),
                (mesh(Triangles=hole), "open"),
                (mesh(Points=flat), "its surface"),
                (mesh(Triangles=[[0, 1, 99]] * 4), "/Fixtures/0/Shape/Mesh/Triangles/0 is no triangle"),
                (mesh(Points=[[0, 0, "a"]] * 4), "/Fixtures/0/Shape/Mesh/Points/0 is no place"),
                (mesh(Points=[[0, 0, 1e9]] * 4), "/Fixtures/0/Shape/Mesh/Points/0 is no place"),
                (with_clamp(Shape={"Mesh": {}}), "needs \"File\", or both \"Points\" and \"Triangles\""),
                (with_clamp(Link="Q"), "Link"),
                (with_clamp(Shape={"Box": {"Size": [10, 0, 10]}}), "Size"),
                (with_clamp(Colour="#" + "0" * 100000), "longer than any text that a set-up has"),
                (SETUP | {"Fixtures": [CLAMP, CLAMP]}, "which another fixture has"),
                (SETUP | {"Part": {"Shape": {"Box": {"Size": [1, 1, 1]}}, "Pose": {"p": [90, 0, 0], "axis": [0, 0, 1]}},
                          "Stock": {"Shape": {"Box": {"Size": [1, 1, 1]}}}}, "beside the stock"),
                ({}, "Machine")):
            with self.subTest(words):
                self.assertIn(words, self.client.refusal("RMAC_CAM.SetSetup", Setup=setup).message)
                self.assertEqual(self.client.call("RMAC_CAM.GetSetup"), SETUP)
        for bad in (3, "setup.json", [SETUP]):
            self.client.refusal("RMAC_CAM.SetSetup", Setup=bad)
        self.watcher.refusal("RMAC_CAM.SetSetup", Setup=SETUP)
        self.watcher.refusal("RMAC_CAM.SetCollisionCheck", On=True)

    def test_meshes_come_with_their_triangles(self):
        self.check(mesh())
        self.to(40, 1)
        self.start()
        self.event("CollisionAhead", 1)
        self.assertLess(self.x(), 55 - NOSE - SETUP["Clearance"])

    def test_is_not_on_without_a_set_up_and_says_when_it_goes_off(self):
        self.assertEqual(self.client.call("RMAC_CAM.GetSetup"), {})
        self.assertIn("there is no set-up", self.client.refusal("RMAC_CAM.SetCollisionCheck", On=True).message)
        self.check()
        self.assertTrue(self.client.call("RMAC_CAM.GetCollisionCheck"))
        self.client.call("RMAC_CAM.SetSetup", Setup=SETUP)  # Twice.
        self.client.call("RMAC_CAM.SetSetup", Setup=None)
        self.assertIn(EMPTY, self.event("NotChecked")["message"])
        self.assertFalse(self.client.call("RMAC_CAM.GetCollisionCheck"))
        self.check()
        self.client.call("Device.Load", Name="DMACXYZ", Virtual=True)
        self.assertIn("loaded or unloaded", self.event("NotChecked")["message"])
        self.assertEqual(self.client.call("RMAC_CAM.GetSetup"), {})

    def test_a_force_is_not_kept_while_it_is_on(self):
        self.client.call("RMAC_Config.SetMechanismJointControlMethod", JntNum=2,
                         DMACServoControlMethod="DMAC_FORCE_CONTROL")
        self.client.call("RMAC_Config.Apply")
        self.check()
        self.assertIn("checked ahead", self.client.refusal("RMAC_CAM.SetJointForce", JntNum=2, Force=-20).message)
        self.client.call("RMAC_CAM.SetJointForce", JntNum=2, Force=0)
        self.client.call("RMAC_CAM.SetCollisionCheck", On=False)
        self.client.call("RMAC_CAM.SetJointForce", JntNum=2, Force=-20)
        self.assertIn("keeps a force", self.client.refusal("RMAC_CAM.SetCollisionCheck", On=True).message)

    def test_a_program_that_is_parked_before_a_clamp_goes_on_from_there(self):
        self.check()
        self.to(10, 1)
        self.to(40, 2)
        self.start()
        self.event("CollisionAhead", 2)
        wait_for_stop(self.client)
        stands = self.x()
        self.client.call("RMAC_CAM.ParkProgram")
        parked = self.client.call("RMAC_CAM.GetParkedProgram")
        self.assertEqual(parked["move_id"], 2)
        self.assertAlmostEqual(parked["pose"][0], stands, delta=0.01)
        self.assertLess(parked["off_mm"], 0.01)
        self.client.call("RMAC_CAM.TakeUpProgram")
        self.client.call("RMAC_CAM.FeedResume")
        self.event("CollisionAhead", 2)
        self.assertLess(self.x(), 55 - NOSE - SETUP["Clearance"])

    def test_is_not_changed_while_something_is_queued(self):
        self.check()
        self.to(10, 1)
        for method, params in (("SetSetup", {"Setup": SETUP}), ("SetCollisionCheck", {"On": False})):
            self.assertIn("empty queue", self.client.refusal(f"RMAC_CAM.{method}", **params).message)
        self.start()
        self.event("MoveDone", 1)


class Tools(unittest.TestCase):
    def test_a_new_length_keeps_the_shape_that_is_checked(self):
        post = CLAMP | {"Pose": {"p": [30, 0, -60], "axis": [0, 0, 1]}}  # Its top is at -50.
        appliance = Appliance()
        (appliance.folder / "state/tools").mkdir()
        (appliance.folder / "state/tools/DMACXYZ.json").write_text(json.dumps({"Mounted": 1, "Tools": [
            {"ToolNumber": 1, "Length": 30, "Radius": 3, "Shape": {"DC": 6, "LCF": 20, "OAL": 30}}]}))
        with appliance:
            client = appliance.operator()
            watcher = appliance.client("watcher")
            watcher.call("subscribe", topics=["events"])
            client.call("RMAC_CAM.SetSetup", Setup=SETUP | {"Fixtures": [post]})
            client.call("RMAC_CAM.SetCollisionCheck", On=True)
            for distance, length in ((5, 31), (40, 65)):  # The old length passes above the post.
                self.jog(client, distance)
                self.jog(client, -distance)
                client.call("RMAC_CAM.SetTool", ToolNumber=1, Length=length, Radius=3, NeedsSpindle=False)
            self.jog(client, 40)
            self.assertLess(client.call("RMAC_CAM.CurrentPosition")[0], 25 - 3 - SETUP["Clearance"])
            told = watcher.wait_note("events", lambda e: e["kind"] == "CollisionAhead")
            self.assertIn("tool 1", told["message"])

    def jog(self, client, distance):
        client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=distance)
        wait_for_rest(client)
        while client.state()["state"] != "Idle":
            pass


class CollisionCheckInRealPace(CollisionCheck):
    pace = "real-time"


if __name__ == "__main__":
    unittest.main()

"""The machine as a CAM client draws it that has read no device.json: what there is to draw, and where it is at 60 Hz."""

import json
import math
import random
import unittest

from appliance import Appliance, pose, run_to_rest, wait_for_rest

NEAR_MM = 1e-6
MICROMETRE = 1e-3
CYCLE_HZ, RATE_HZ = 1000, 60
# Drives of TarusXYZCA are on CAN buses that a test does not have; in virtual mode all machines are driven alike.
MACHINES = ("DMACXYZ", "DMACXY", "DMACXYZA", "SuginoXYZ", "SuginoXYZAC", "TarusXYZCA", "BenchXYZ", "TarusXYZCATwin")
PLATE = """solid plate
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 1 0 vertex 1 0 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 0 1 endloop endfacet
facet normal 0 0 0 outer loop vertex 0 0 0 vertex 0 0 1 vertex 0 1 0 endloop endfacet
facet normal 0 0 0 outer loop vertex 1 0 0 vertex 0 1 0 vertex 0 0 1 endloop endfacet
endsolid plate
"""


def turned(q, v):
    """By the matrix of the quaternion, as a textbook has it."""
    w, x, y, z = q
    rows = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    return [sum(a * b for a, b in zip(row, v)) for row in rows]


def out_of(frame, point):
    return [a + b for a, b in zip(frame["p"], turned(frame["q"], point))]


def into(frame, point):
    w, x, y, z = frame["q"]
    return turned((w, -x, -y, -z), [a - b for a, b in zip(point, frame["p"])])


def tip_of(told, sample, geometry):
    """In the part frame, from links alone: the tip hangs on the spindle, and the part lies on the table."""
    on_interface = out_of(told["tool_frame"], (0, 0, 0))
    in_base = out_of(sample["links"]["spindle"], out_of(geometry["interface"], on_interface))
    return into(told["part_frame"], into(sample["links"]["table"], in_base))


class Animated(unittest.TestCase):
    pace = "as-fast-as-computed"

    def setUp(self):
        self.appliance = self.enterContext(Appliance(pace=self.pace, own_tree=True))
        self.mover = self.appliance.client("mover")
        self.mover.call("authority.acquire")
        self.watcher = self.appliance.client("watcher")

    def load(self, name, virtual=True):
        self.mover.call("Device.Load", Name=name, Virtual=virtual)
        return self.mover.state()["joints"]

    def watch(self):
        self.watcher.call("RMAC_CAM.SetAnimation", mode=True)
        return self.watcher.call("RMAC_CAM.GetGeometry")

    def edit(self, machine, change):
        """Its device.json in this appliance's tree."""
        file, = self.appliance.tree.glob(f"*/*/{machine}/device.json")
        device = json.loads(file.read_text())
        change(device, file.parent)
        file.write_text(json.dumps(device))

    def near(self, place, wanted, within, what):
        self.assertLess(math.dist(place, wanted), within, f"{what}: {place} is not at {wanted}")


class AnimationTest(Animated):
    def samples_until(self, done):
        """With what was told together with each."""
        told = []
        while True:
            params = self.watcher.wait_note("animation")
            told += [(params, sample) for sample in params["samples"]]
            if told and done(told[-1][1]):
                return told

    def test_who_only_listens_sees_the_path_at_60_hz_and_finds_the_tip_on_it(self):
        self.load("SuginoXYZAC")
        self.mover.call("RMAC_CAM.SetPartFrame", PartFrame={"p": [5, -10, 30], "q": [1, 0, 0, 0]})
        self.mover.call("RMAC_CAM.SetFeedrate", Feedrate=600)
        self.mover.call("RMAC_CAM.SetTool", ToolNumber=7, Length=80, Radius=3, NeedsSpindle=False)
        self.mover.call("RMAC_CAM.DoToolChange", ToolNumber=7)
        self.mover.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        while not self.mover.state()["tool_prompt"]:
            pass
        self.mover.call("RMAC_CAM.ConfirmToolChange", ToolNumber=7)
        self.mover.call("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(20, 0, 0))
        run_to_rest(self.mover)
        geometry = self.watch()
        # Half a circle of 20 mm, while the tool leans over by half a radian.
        self.mover.call("RMAC_CAM.MoveAlongArc", MoveID=2, StartPoint=pose(20, 0, 0),
                        EndPoint={"p": [-20, 0, 0], "axis": [0, math.sin(0.5), math.cos(0.5)]},
                        CenterPoint=pose(0, 0, 0), RotSign=1, Closed=False)
        self.mover.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        told = self.samples_until(lambda sample: math.dist(sample["pose"][:3], (-20, 0, 0)) < NEAR_MM)
        on_arc = [(params, sample) for params, sample in told if sample["move_id"] == 2 and sample["moving"]]
        self.assertGreater(len(on_arc), 300, "6.3 s of the machine's time")
        for (_, before), (_, after) in zip(told, told[1:]):
            self.assertIn(after["cycle"] - before["cycle"], (CYCLE_HZ // RATE_HZ, CYCLE_HZ // RATE_HZ + 1))
        for params, sample in on_arc:
            self.assertEqual((params["machine"], params["geometry"]), ("SuginoXYZAC", geometry["geometry"]))
            self.assertEqual((params["tool"], params["virtual"]), (7, True))
            x, y, z = tip = tip_of(params, sample, geometry)
            self.near((math.hypot(x, y), z), (20, 0), MICROMETRE, f"cycle {sample['cycle']}, off the arc")
            self.near(tip, sample["pose"][:3], NEAR_MM, f"cycle {sample['cycle']}, off what the machine says")
        leans = [sample["links"]["table"]["q"] for _, sample in on_arc]
        self.assertGreater(max(math.dist(q, leans[0]) for q in leans), 0.2, "the table turned")

    def test_links_of_each_machine_lead_to_the_tip_that_the_daemon_tells(self):
        for name in MACHINES:
            with self.subTest(machine=name):
                self.load(name)
                geometry = self.watch()
                self.assertEqual((geometry["machine"], geometry["missing"]), (name, ""))
                for body in geometry["bodies"]:
                    self.assertIn(body["Link"], geometry["links"])
                self.mover.call("RMAC_CAM.SetToolInterfaceFrame",
                                ToolInterfaceFrame={"p": [1, 2, -30], "q": [0.6, 0, 0.8, 0]})
                for seed in range(3):
                    draw = random.Random(f"{name} {seed}")
                    joints = [draw.uniform(-45, 45) for _ in geometry["joints"]]
                    self.mover.call("RMAC_CAM.MoveToJointTarget", MoveID=seed + 1, JointTargetFrame={"joints": joints})
                    run_to_rest(self.mover)
                    self.watcher.notes.clear()
                    cycle = self.mover.state()["cycle"]
                    params, sample = self.samples_until(lambda s: s["cycle"] > cycle)[-1]  # noqa: B023
                    self.near(sample["joints"], joints, NEAR_MM, f"seed {seed}")
                    self.assertEqual(set(sample["links"]), set(geometry["links"]))
                    self.assertEqual(sample["links"]["base"], {"p": [0, 0, 0], "q": [1, 0, 0, 0]})
                    self.near(tip_of(params, sample, geometry), self.mover.state()["pose"][:3], NEAR_MM, f"seed {seed}")

    def test_a_swap_is_told_with_another_geometry_and_an_unloaded_machine_with_a_sentence(self):
        self.load("SuginoXYZAC")
        first = self.watch()
        self.samples_until(lambda sample: True)
        self.load("DMACXYZ")
        told = self.watcher.wait_note("animation", lambda params: params["machine"] == "DMACXYZ" and params["samples"])
        second = self.watcher.call("RMAC_CAM.GetGeometry")
        self.assertNotEqual(first["geometry"], second["geometry"])
        self.assertEqual(told["geometry"], second["geometry"])
        self.assertEqual(set(told["samples"][0]["links"]), set(second["links"]))
        self.mover.call("Device.Unload")
        told = self.watcher.wait_note("animation", lambda params: params["machine"] is None)
        self.assertEqual((told["missing"], told["samples"]), ("no machine is loaded; load one with Device.Load", []))
        self.assertEqual(self.watcher.call("RMAC_CAM.GetGeometry")["missing"], told["missing"])

    def test_a_measuring_machine_is_drawn_as_the_machine_below_it(self):
        self.load("SuginoXYZ", virtual=False)
        below = self.watch()
        self.load("CMM", virtual=False)
        self.watcher.wait_note("animation", lambda params: params["machine"] == "CMM" and params["samples"])
        over = self.watcher.call("RMAC_CAM.GetGeometry")
        self.assertEqual((over["machine"], over["missing"]), ("CMM", ""))
        self.assertEqual(over["bodies"], below["bodies"])

    def test_a_machine_with_no_geometry_is_told_in_a_line(self):
        self.edit("DMACXYZ", lambda device, folder: [device.pop(key) for key in ("Chain", "Geometry")])
        self.edit("SuginoXYZ", lambda device, folder: device.pop("Geometry"))
        self.load("DMACXYZ")
        nothing = "nothing is known of the links of DMACXYZ: the device.json of its machine has no Chain and no Geometry"
        geometry = self.watch()
        self.assertEqual((geometry["missing"], geometry["links"], geometry["bodies"]), (nothing, [], []))
        told = self.watcher.wait_note("animation")
        self.assertEqual((told["missing"], told["samples"]), (nothing, []))
        self.load("SuginoXYZ")
        told = self.watcher.wait_note("animation", lambda params: params["samples"])
        self.assertIn("where the links of SuginoXYZ stand is known", told["missing"])

    def test_a_mesh_is_named_and_sent_when_it_is_asked_for(self):
        def add_mesh(device, folder):
            (folder / "meshes").mkdir()
            (folder / "meshes/plate.stl").write_text(PLATE)
            shape = {"Mesh": {"File": "meshes/plate.stl", "Unit": "inch"}}
            device["Geometry"].append({"Name": "plate", "Link": "X", "Shape": shape})

        self.edit("DMACXYZ", add_mesh)
        self.load("DMACXYZ")
        plate = self.watch()["bodies"][-1]
        self.assertEqual((plate["Name"], plate["Shape"]), ("plate", {"Mesh": {"File": "plate.stl"}}))
        mesh = self.watcher.call("RMAC_CAM.GetMesh", Body="plate")
        self.assertEqual((len(mesh["Points"]), len(mesh["Triangles"])), (4, 4))
        self.near(sorted(mesh["Points"])[-1], (25.4, 0, 0), NEAR_MM, "its corner")
        self.assertIn("there are plate", self.watcher.refusal("RMAC_CAM.GetMesh", Body="bed").message)

    def test_nothing_more_comes_once_it_is_off(self):
        self.load("DMACXYZ")
        self.watch()
        self.samples_until(lambda sample: True)
        self.watcher.call("RMAC_CAM.SetAnimation", mode=False)
        self.watcher.notes.clear()
        begin = self.mover.state()["cycle"]
        while self.mover.state()["cycle"] < begin + 1000:
            pass
        self.watcher.state()
        self.assertEqual(list(self.watcher.notes), [])


class RealTimeAnimationTest(Animated):
    pace = "real-time"

    def test_simulated_drives_are_shown_where_they_are_measured(self):
        self.load("DMACXYZ", virtual=False)
        self.mover.call("RMAC_CAM.Home")
        wait_for_rest(self.mover)
        geometry = self.watch()
        self.mover.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
        # It stands a cycle before the machine has seen that Home is over.
        while "error" in (answer := self.mover.ask("RMAC_CAM.JogJoint", JntNum=0, Distance=10)):
            self.assertIn("coming to rest", answer["error"]["message"])
        seen = []
        while not seen or seen[-1]["joints"][0] < 9.9:
            told = self.watcher.wait_note("animation")
            for sample in told["samples"]:
                self.near(tip_of(told, sample, geometry), sample["pose"][:3], NEAR_MM, f"cycle {sample['cycle']}")
            self.assertFalse(told["virtual"])
            seen += told["samples"]
        apart = {after["cycle"] - before["cycle"] for before, after in zip(seen, seen[1:])}
        self.assertLessEqual(apart, {16, 17})
        self.assertGreater(len({sample["joints"][0] for sample in seen}), 10, "it was seen on its way")


if __name__ == "__main__":
    unittest.main()

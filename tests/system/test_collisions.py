"""`rmac simulate --setup`: what a machine, its tool and what stands on its table meet, as a user sees it."""

import copy
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, pose

MACHINE = SOURCE / "drivers/mill/5-axis/SuginoXYZAC/device.json"
LENGTH = 80  # of the tool; with A and C at 0 its tip is so far below the joint Z
TABLE = -100  # top of the turntable
SETUP = {
    "Machine": "SuginoXYZAC",
    "PartFrame": {"p": [0, 0, TABLE], "q": [1, 0, 0, 0]},
    "Stock": {"Shape": {"Box": {"Size": [80, 60, 30]}}, "Pose": {"p": [0, 0, 15], "axis": [0, 0, 1]}},
    "Part": {"Shape": {"Box": {"Size": [78, 58, 20]}}, "Pose": {"p": [0, 0, 10], "axis": [0, 0, 1]}},
    "Fixtures": [{"Name": "clamp", "Shape": {"Box": {"Size": [20, 20, 70]}}, "Pose": {"p": [60, 0, 35], "axis": [0, 0, 1]}}],
    "Clearance": 0.5, "Resolution": 0.5,
}
TOOLS = {"Mounted": 7, "Tools": [
    {"ToolNumber": 7, "Length": LENGTH, "Radius": 3, "NeedsSpindle": False, "Shape": {
        "DC": 6, "RE": 3, "LCF": 12, "OAL": 57, "ZEFP": 2,
        "Holder": [{"Cone": {"Radius": 10, "TopRadius": 14, "Height": 30}}, {"Cylinder": {"Radius": 25, "Height": 15}}]}},
    {"ToolNumber": 8, "Length": LENGTH, "NeedsSpindle": False}]}


def request(method, **params):
    return {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}


def to(x, y, z, a=0, c=0, move_id=1):
    """A positioning move that brings the tip, with A and C at 0, to z above the turntable."""
    return request("RMAC_CAM.MoveToJointTarget", MoveID=move_id, JointTargetFrame={"joints": [x, y, z + TABLE + LENGTH, a, c]})


def cut(start, end, move_id):
    return request("RMAC_CAM.MoveAlongLine", MoveID=move_id, StartPoint=tip(start), EndPoint=tip(end))


def tip(point):
    """In the set-up's part frame, which is in force."""
    return pose(*point)


FEED = request("RMAC_CAM.SetFeedrate", Feedrate=3000)


class Collisions(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_rmac(self, requests, *words, setup=None, tools=None, machine="SuginoXYZAC"):
        (self.folder / "tools").mkdir(exist_ok=True)
        (self.folder / "tools/SuginoXYZAC.json").write_text(json.dumps(tools or TOOLS))
        (self.folder / "setup.json").write_text(json.dumps(setup or SETUP))
        file = self.folder / "program.rmac"
        file.write_text("".join(json.dumps(r) + "\n" for r in requests))
        return subprocess.run([BUILD / "bin" / "rmac", "simulate", file, "--machine", machine, "--setup",
                               self.folder / "setup.json", "--tools", self.folder / "tools", *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)

    def report(self, requests, *words, **options):
        done = self.run_rmac(requests, "--json", *words, **options)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stderr)
        return json.loads(done.stdout), done

    def refusal(self, setup=None, **options):
        done = self.run_rmac([to(0, 0, 100)], setup=setup, **options)
        self.assertEqual((done.returncode, done.stdout), (1, ""), done.stdout)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_a_program_that_meets_nothing_says_so(self):
        report, done = self.report([to(0, 0, 100), to(0, 20, 60, move_id=2)])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual((report["collisions"], report["near_misses"], report["collisions_not_checked"]), ([], [], []))

    def test_a_holder_that_meets_a_clamp_is_found_with_where_and_how_deep(self):
        # Beside the clamp, whose top is at 70 and whose side at x = 50, above the stock: the holder begins 35 above the
        # tip, at 66, and is 10 thick there.
        program = [to(0, 40, 100), to(34, 40, 100, move_id=2), to(34, 0, 100, move_id=3), to(34, 0, 31, move_id=4),
                   to(42, 0, 31, move_id=5)]
        report, done = self.report(program)
        self.assertEqual(done.returncode, 1)
        found = [f for f in report["collisions"] if f["bodies"] == ["clamp", "tool 7, holder"]]
        self.assertEqual(len(found), 1, report["collisions"])
        self.assertTrue(found[0]["certain"])
        self.assertEqual((found[0]["line"], found[0]["move_id"]), (5, 5))
        # At 70, as high as the clamp, the holder is 10 + 4 * 4 / 30 thick.
        self.assertAlmostEqual(found[0]["depth_mm"], 42 + 10 + 4 * 4 / 30 - 50, delta=0.1)
        self.assertAlmostEqual(found[0]["place_mm"][0], 50, delta=0.5)
        self.assertIn("tool 7, holder meets clamp", done.stderr)
        people = self.run_rmac(program)
        self.assertEqual(people.returncode, 1)
        for part in ("COLLISION", "clamp", "tool 7, holder"):
            self.assertIn(part, people.stdout)

    def test_the_first_collision_ends_a_run_that_asks_for_it(self):
        program = [to(34, 0, 100), to(34, 0, 30, move_id=2), to(42, 0, 30, move_id=3), to(-60, 0, 30, move_id=4)]
        first, done = self.report(program, "--first")
        whole, _ = self.report(program)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len([f for f in first["collisions"] if f["certain"]]), 1)
        self.assertGreater(len(whole["collisions"]), 1)

    def test_what_passes_nearer_than_the_clearance_is_a_near_miss(self):
        report, done = self.report([to(60, 30, 100), to(60, 30, 70.3, move_id=2), to(60, -30, 70.3, move_id=3)])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual([f["bodies"] for f in report["near_misses"]], [["clamp", "tool 7, cutting part"]])
        self.assertAlmostEqual(report["near_misses"][0]["distance_mm"], 0.3, delta=0.06)

    def test_cutting_may_be_in_stock_and_a_rapid_may_not(self):
        above, deep = (-60, -32, 25), (60 - 45, -32, 25)
        report, done = self.report([to(*above), FEED, cut(above, deep, 2)])
        self.assertEqual((report["collisions"], done.returncode), ([], 0), done.stderr)
        report, done = self.report([to(*above), to(*deep, move_id=2)])
        self.assertEqual([f["bodies"] for f in report["collisions"]], [["stock", "tool 7, cutting part"]])
        self.assertEqual(done.returncode, 1)

    def test_a_shank_in_stock_that_is_still_there_is_certain(self):
        beside, inside = (-60, 0, 5), (-36, 0, 5)
        report, done = self.report([to(*beside), FEED, cut(beside, inside, 2)])
        shank = [f for f in report["collisions"] if f["bodies"] == ["stock", "tool 7, shank"]]
        self.assertEqual(len(shank), 1, report["collisions"])
        self.assertTrue(shank[0]["certain"], "the cutting part ends below it")
        self.assertEqual((shank[0]["why"], done.returncode), ("it does not cut", 1))
        self.assertGreater(report["material"]["removed_mm3"], 0)

    def test_what_is_left_of_the_stock_is_told_and_written(self):
        tools, setup = copy.deepcopy(TOOLS), copy.deepcopy(SETUP)
        tools["Tools"][0]["Shape"].update(RE=0)
        del setup["Part"], setup["Fixtures"]
        setup["Resolution"] = 0.5
        start, end, file = (-60, 0, 25), (60, 0, 25), self.folder / "left.stl"
        report, done = self.report([to(*start), FEED, cut(start, end, 2)], "--stock-out", file, tools=tools, setup=setup)
        self.assertEqual((report["collisions"], done.returncode), ([], 0), done.stderr)
        self.assertAlmostEqual(report["material"]["removed_mm3"], 80 * 6 * 5, delta=10)
        self.assertEqual(file.stat().st_size, 84 + 50 * report["material"]["stock_triangles"])
        # What the set-up reads is not written over, and what is no file is none to write to.
        mesh = copy.deepcopy(setup) | {"Stock": {"Shape": {"Mesh": {"File": "left.stl"}}}}
        whole = file.read_bytes()
        (self.folder / "link.stl").symlink_to(file)
        for name in ("left.stl", "link.stl"):
            done = self.run_rmac([to(*start)], "--stock-out", self.folder / name, tools=tools, setup=mesh)
            self.assertEqual((done.returncode, file.read_bytes() == whole), (1, True))
            self.assertIn("this run uses this file", done.stderr)
        record = self.folder / "record.stl"
        done = self.run_rmac([to(*start)], "--stock-out", record, "--record", record, tools=tools, setup=setup)
        self.assertEqual((done.returncode, record.exists()), (1, False))
        self.assertIn("this run uses this file", done.stderr)
        os.mkfifo(self.folder / "pipe.stl")
        done = self.run_rmac([to(*start)], "--stock-out", self.folder / "pipe.stl", tools=tools, setup=mesh)
        self.assertIn("cannot be written", done.stderr)
        # What is left is a stock in its turn: a thinner tool goes through the slot, meets nothing, and cuts nothing.
        tools["Tools"][0]["Shape"].update(DC=4)
        setup["Stock"] = {"Shape": {"Mesh": {"File": "left.stl"}}}
        again, done = self.report([to(-60, 0, 26), to(60, 0, 26, move_id=2)], tools=tools, setup=setup)
        self.assertEqual((again["collisions"], again["material"]["removed_mm3"]), ([], 0), done.stderr)
        self.assertTrue(again["material"]["never_cut"] and "never_cut" not in report["material"])
        for words, what in ((("--resolution", "0"), "give one above 0"), (("--resolution", "-1"), "give one above 0"),
                            (("--resolution", "0.0001"), "takes less than 2 GB"), (("--stock-out", "a.obj"), "ends in .stl")):
            done = self.run_rmac([to(0, 0, 100)], *words, setup=setup)
            self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
            self.assertIn(what, done.stderr)

    def test_a_cut_deeper_into_the_part_than_the_clearance_is_found(self):
        # The part ends at 20.
        for z, wrong in ((20, False), (19.7, False), (19.2, True)):
            start, end = (-60, 0, z), (0, 0, z)
            report, _ = self.report([to(*start), FEED, cut(start, end, 2)])
            part = [f for f in report["collisions"] if f["bodies"] == ["part", "tool 7, cutting part"]]
            self.assertEqual(bool(part), wrong, z)
            if wrong:
                self.assertAlmostEqual(part[0]["depth_mm"], 0.8, delta=0.05)

    def test_a_tool_thinner_than_the_clearance_cuts_into_no_part_unseen(self):
        tools, setup = copy.deepcopy(TOOLS), copy.deepcopy(SETUP)
        tools["Tools"][0]["Shape"].update(DC=1, RE=0)
        tools["Tools"][0]["Radius"] = 0.5
        setup["Clearance"] = 1
        start, end = (0, 0, 30), (0, 0, 12)
        report, done = self.report([to(*start), FEED, cut(start, end, 2)], tools=tools, setup=setup)
        part = [f for f in report["collisions"] if f["bodies"] == ["part", "tool 7, cutting part"]]
        self.assertEqual((len(part), done.returncode), (1, 1), report)
        self.assertAlmostEqual(part[0]["depth_mm"], 8, delta=0.2)

    def test_what_was_near_before_the_first_cut_is_not_certain_behind_it(self):
        # The way in begins 0.3 mm beside the stock, whose side is at -40, with a tool 3 mm thick.
        beside, inside = (-43.3, 0, 5), (-36, 0, 5)
        report, done = self.report([to(-60, 0, 5), to(*beside, move_id=2), FEED, cut(beside, inside, 3),
                                    cut(inside, (-30, 0, 5), 4)])
        shank = [f for f in report["collisions"] if f["bodies"] == ["stock", "tool 7, shank"]]
        self.assertTrue(shank, report)
        self.assertTrue(all(not f["certain"] for f in shank if f["line"] > 4), shank)

    def test_the_spindle_in_stock_that_was_cut_is_only_possible(self):
        tools = copy.deepcopy(TOOLS)
        tools["Tools"][0].update(Length=5, Shape={"DC": 6, "RE": 0, "LCF": 5, "OAL": 5})
        deep = 12
        program = [request("RMAC_CAM.MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": [0, 0, TABLE + 5 + 60, 0, 0]}),
                   FEED, cut((0, 0, 60), (0, 0, 30 - deep), 2)]
        setup = {key: value for key, value in SETUP.items() if key not in ("Part", "Fixtures")}
        report, done = self.report(program, tools=tools, setup=setup)
        machine = [f for f in report["collisions"] if "stock" in f["bodies"]]
        self.assertTrue(machine, report)
        self.assertFalse(any(f["certain"] for f in machine), machine)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_near_misses_leave_room_for_what_meets(self):
        program = [to(-60, -50, 60)]
        for index in range(1005):
            program += [to(0, 0, 30.3, move_id=2 + 2 * index), to(0, 0, 33, move_id=3 + 2 * index)]
        program.append(to(0, 0, 12, move_id=5000))
        report, done = self.report(program)
        self.assertEqual(done.returncode, 1, report["collisions"])
        self.assertIn(["stock", "tool 7, cutting part"], [f["bodies"] for f in report["collisions"]])

    def test_a_mesh_opens_no_other_file(self):
        outside = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(outside.cleanup)
        elsewhere = pathlib.Path(outside.name, "o.stl")
        elsewhere.write_text("solid o\nendsolid o\n")
        (self.folder / "part.stl").symlink_to(elsewhere)
        setup = copy.deepcopy(SETUP)
        setup["Part"] = {"Shape": {"Mesh": {"File": "part.stl", "Unit": "mm"}}}
        self.refusal(setup)  # writes the files
        bare = subprocess.run([BUILD / "bin" / "rmac", "simulate", "program.rmac", "--machine", "SuginoXYZAC", "--setup",
                               "setup.json"], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=120, check=False)
        self.assertEqual(bare.returncode, 1)
        self.assertNotIn(outside.name, bare.stderr)
        os.mkfifo(self.folder / "hangs.mtl")
        (self.folder / "box.obj").write_text("mtllib hangs.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
                                             "f 1 4 3\n")
        setup["Part"] = {"Shape": {"Mesh": {"File": "box.obj", "Unit": "mm"}}}
        del setup["Stock"]
        report, done = self.report([to(0, 0, 100)], setup=setup)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_what_stands_on_a_table_that_tilts_meets_the_machine(self):
        setup = copy.deepcopy(SETUP)
        del setup["Stock"], setup["Part"]
        setup["Fixtures"] = [{"Name": "angle plate", "Shape": {"Box": {"Size": [280, 20, 40]}},
                              "Pose": {"p": [0, 0, 40], "axis": [0, 0, 1]}}]
        report, _ = self.report([to(0, 0, 250), to(0, 0, 250, c=90, move_id=2)], setup=setup)
        self.assertEqual(report["collisions"], [])
        setup["Fixtures"][0]["Shape"]["Box"]["Size"][0] = 420
        report, _ = self.report([to(0, 0, 250, c=90), to(0, 0, 250, move_id=2)], setup=setup)
        met = {f["bodies"][0] for f in report["collisions"]} | {f["bodies"][1] for f in report["collisions"]}
        self.assertIn("angle plate", met)
        self.assertTrue(met & {"left cradle arm", "left trunnion"}, met)

    def test_a_tool_without_shape_is_not_passed_over(self):
        tools = copy.deepcopy(TOOLS)
        tools["Mounted"] = 8
        report, done = self.report([to(0, 0, 100), to(0, 10, 100, move_id=2)], tools=tools)
        self.assertEqual(done.returncode, 1)
        self.assertIn("tool 8 has no Shape", done.stderr)
        self.assertEqual(len(report["collisions_not_checked"]), 1)

    def test_a_machine_that_the_program_loads_instead_is_not_passed_over(self):
        report, done = self.report([to(0, 0, 100), request("Device.Load", Name="DMACXYZ"),
                                    request("RMAC_CAM.MoveToJointTarget", MoveID=2, JointTargetFrame={"joints": [1, 1, 1]})])
        self.assertEqual(done.returncode, 1)
        self.assertEqual(report["collisions_not_checked"], ["moves of DMACXYZ: the set-up is for SuginoXYZAC"])

    def test_what_is_wrong_with_a_set_up_is_one_line(self):
        def changed(edit):
            setup = copy.deepcopy(SETUP)
            edit(setup)
            return self.refusal(setup)

        self.assertIn('/Machine is "DMACXYZ"', changed(lambda s: s.update(Machine="DMACXYZ")))
        self.assertIn("/Stock/Shape/Box/Size/2", changed(lambda s: s["Stock"]["Shape"]["Box"].update(Size=[1, 1, 0])))
        self.assertIn("beside the stock", changed(lambda s: s["Part"]["Pose"].update(p=[200, 0, 0])))
        self.assertIn("no such file", changed(lambda s: s["Part"].update(Shape={"Mesh": {"File": "part.stl"}})))
        self.assertIn("allowed is a file in", changed(lambda s: s["Part"].update(Shape={"Mesh": {"File": "/etc/passwd"}})))
        self.assertIn("/Fixtures/0/Pose", changed(lambda s: s["Fixtures"][0]["Pose"].update(axis=[0, 0, 0.5])))
        self.assertIn("Fixtures", changed(lambda s: s["Fixtures"].append(s["Fixtures"][0])))
        self.assertIn('"Clearence"', changed(lambda s: s.update(Clearence=1)))
        self.assertIn("/Clearance", changed(lambda s: s.update(Clearance=0)))
        (self.folder / "open.stl").write_text("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\n"
                                              "vertex 0 9 0\nendloop\nendfacet\nendsolid a\n")
        self.assertIn("is open", changed(lambda s: s["Part"].update(Shape={"Mesh": {"File": "open.stl"}})))
        (self.folder / "setup.json").write_text('{"Machine": NaN}')
        done = subprocess.run([BUILD / "bin" / "rmac", "simulate", self.folder / "program.rmac", "--machine", "SuginoXYZAC",
                               "--setup", self.folder / "setup.json"], capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("is not JSON", done.stderr)

    def test_a_machine_of_which_nothing_can_be_said_is_refused(self):
        device = json.loads(MACHINE.read_text())
        file = self.folder / "device.json"
        del device["Geometry"], device["Chain"]
        file.write_text(json.dumps(device))
        self.assertIn("has no Geometry", self.refusal(machine=str(file)))
        device = json.loads(MACHINE.read_text())
        device["Chain"] = ["A", "C", "base", "X", "Y", "Z"]
        file.write_text(json.dumps(device))
        self.assertIn("the kinematics module moves the tool otherwise", self.refusal(machine=str(file)))


if __name__ == "__main__":
    unittest.main()

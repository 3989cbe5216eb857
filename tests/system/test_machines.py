"""The device driver database as a client sees it."""

import json
import unittest

from appliance import SOURCE, Appliance

TABLE_4_1 = {"DMACXYZ", "TarusXYZCA", "SuginoXYZ", "SuginoXYZAC", "CMM", "DMACXY"}
OURS = {"DMACXYZA"}
ALL = TABLE_4_1 | OURS | {"BenchXYZ", "TarusXYZCATwin"}


class Machines(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())

    def names(self, *words):
        done = self.appliance.rmac("--json", "machines", *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return {machine["Name"] for machine in json.loads(done.stdout)}

    def test_all_machines_of_the_tree_are_listed(self):
        self.assertEqual(self.names(), ALL)

    def test_searches_for_mills_do_not_find_the_bench(self):
        self.assertEqual(self.names("--type", "mill"), (TABLE_4_1 | OURS) - {"CMM"})

    def test_five_axis_mill_with_volume_and_power_is_the_tarus(self):
        found = self.names("--type", "mill", "--joints", "5", "--volume", "150x150x150", "--spindle-hp", "5.1")
        self.assertEqual(found, {"TarusXYZCA"})

    def test_sql_of_the_client_finds_the_same(self):
        sql = ("SELECT * FROM DeviceDrivers WHERE Type = 'Mill' AND NumberOfJoints = 5 AND Length > 150 AND Width > 150 "
               "AND Depth > 150 AND SpindleHorsePower > 5")
        self.assertEqual(self.names("--sql", sql), {"TarusXYZCA"})

    def fits(self, program, *words):
        file = self.appliance.folder / "program.rmac"
        file.write_text("".join(json.dumps({"jsonrpc": "2.0", "id": number, **request}) + "\n"
                                for number, request in enumerate(program, 1)))
        done = self.appliance.rmac("--json", "machines", "--fits", str(file), "--device-tree", str(self.appliance.tree),
                                   *words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return {machine["Name"]: machine for machine in json.loads(done.stdout)}

    def test_fits_tells_how_long_a_program_takes_or_why_a_machine_cannot(self):
        feed = {"method": "RMAC_CAM.SetFeedrate", "params": {"Feedrate": 1500}}
        leaning = {"method": "RMAC_CAM.MoveToJointTarget",
                   "params": {"MoveID": 1, "JointTargetFrame": {"p": [10, 0, 0], "axis": [0, 0.5, 0.8660254037844386]}}}
        cut = {"method": "RMAC_CAM.MoveToPathTarget",
               "params": {"MoveID": 2, "TargetFrame": {"p": [10, 20, 0], "axis": [0, 0.5, 0.8660254037844386]}}}
        machines = self.fits([feed, leaning, cut], "--type", "mill")
        self.assertEqual({name for name, machine in machines.items() if machine["Fits"]},
                         {"SuginoXYZAC", "TarusXYZCA", "DMACXYZA"})
        for name in ("SuginoXYZAC", "TarusXYZCA", "DMACXYZA"):
            self.assertGreater(machines[name]["CycleTime_s"], 20 / 25)  # 20 mm at 25 mm/s
        self.assertIn("program.rmac:2", machines["DMACXYZ"]["WhyNot"])
        self.assertIn("pose", machines["DMACXYZ"]["WhyNot"])

        far = {"method": "RMAC_CAM.MoveToPathTarget",
               "params": {"MoveID": 1, "TargetFrame": {"p": [300, 0, 0], "axis": [0, 0, 1]}}}
        machines = self.fits([{"method": "Device.Load", "params": {"Name": "DMACXYZ"}}, feed, far])
        self.assertTrue(machines["TarusXYZCA"]["Fits"])
        self.assertIn("joint X", machines["SuginoXYZAC"]["WhyNot"])
        self.assertIn("50.0000 mm beyond", machines["SuginoXYZAC"]["WhyNot"])
        self.assertIn("joint X", machines["CMM"]["WhyNot"])

    def slot(self, to_x, depth, rpm=3000):
        """A slot of so much depth, 30 mm above the table, from x -50 on; the clamp of the set-up begins at x 50."""
        z = 30 - depth
        place = {"a": [-50, 0, 60], "b": [-50, 0, z], "c": [to_x, 0, z], "d": [to_x, 0, 60]}
        at = {name: {"p": p, "axis": [0, 0, 1]} for name, p in place.items()}
        return [{"method": "RMAC_CAM.SetFeedrate", "params": {"Feedrate": 600}},
                {"method": "RMAC_CAM.SetSpindleRPM", "params": {"SpindleNumber": 0, "RPM": rpm}},
                *({"method": "RMAC_CAM.MoveToJointTarget", "params": {"MoveID": i, "JointTargetFrame": at[name]}} for i, name in enumerate("ab", 1)),
                {"method": "RMAC_CAM.MoveAlongLine", "params": {"MoveID": 3, "StartPoint": at["b"], "EndPoint": at["c"]}},
                {"method": "RMAC_CAM.MoveToJointTarget", "params": {"MoveID": 4, "JointTargetFrame": at["d"]}}]

    def test_fits_holds_each_machine_against_a_set_up(self):
        folder = self.appliance.folder / "clamped"
        folder.mkdir(exist_ok=True)
        tool = {"ToolNumber": 7, "Length": 80, "Radius": 3, "Shape": {
            "DC": 6, "RE": 3, "LCF": 12, "OAL": 57, "ZEFP": 2,
            "Holder": [{"Cone": {"Radius": 10, "TopRadius": 14, "Height": 30}}, {"Cylinder": {"Radius": 25, "Height": 15}}]}}
        for name in ALL:
            (folder / f"{name}.json").write_text(json.dumps({"Mounted": 7, "Tools": [tool]}))
        setup = folder / "setup.json"
        setup.write_text(json.dumps({
            "Machine": "SuginoXYZAC", "PartFrame": {"p": [0, 0, -100], "q": [1, 0, 0, 0]}, "Material": "Al7075-T6", "Resolution": 0.5,
            "Stock": {"Shape": {"Box": {"Size": [80, 60, 30]}}, "Pose": {"p": [0, 0, 15], "axis": [0, 0, 1]}},
            "Fixtures": [{"Name": "clamp", "Shape": {"Box": {"Size": [20, 20, 70]}}, "Pose": {"p": [60, 0, 35], "axis": [0, 0, 1]}}]}))

        def fits(program, *words):
            return self.fits(program, "--tools", str(folder), "--setup", str(setup), *words)

        machines = fits(self.slot(20, 2))
        fitting = {name for name, machine in machines.items() if machine["Fits"]}
        self.assertLessEqual({"SuginoXYZAC", "TarusXYZCA"}, fitting, machines)
        ranked = list(machines)[:len(fitting)]
        self.assertEqual(set(ranked), fitting)
        times = [machines[name]["CycleTime_s"] for name in ranked]
        self.assertEqual(times, sorted(times))
        for name in fitting:
            self.assertTrue(0 < machines[name]["SpindleUsed"] < 1, machines[name])
        self.assertIn("above spindle 0's maximum of 1000 rpm", machines["DMACXYZ"]["WhyNot"])
        # On the other table too the holder meets the clamp, and at 100 rpm a tooth would take 3 mm at a time.
        for program, why in ((self.slot(45, 2), "holder meets clamp"), (self.slot(20, 11, 100), "cutting takes more than the spindle has")):
            machines = fits(program)
            self.assertIn(why, machines["SuginoXYZAC"]["WhyNot"])
            if "clamp" in why:
                self.assertIn(why, machines["TarusXYZCA"]["WhyNot"])
        for words, why in ((["--setup", str(setup)], "--setup needs --fits"),
                           (["--fits", "x.rmac", "--materials", str(setup)], "--materials needs --setup")):
            self.assertIn(why, self.appliance.rmac("machines", *words).stderr)
        setup.write_text("{}")
        done = self.appliance.rmac("machines", "--fits", str(self.appliance.folder / "program.rmac"), "--setup", str(setup))
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("setup.json", done.stderr)

    def test_fits_takes_tools_from_tables(self):
        change = {"method": "RMAC_CAM.DoToolChange", "params": {"ToolNumber": 7}}
        move = {"method": "RMAC_CAM.MoveToJointTarget",
                "params": {"MoveID": 1, "JointTargetFrame": {"p": [10, 0, -40], "axis": [0, 0, 1]}}}
        for machine in self.fits([change, move], "--joints", "3").values():
            self.assertIn("no tool 7", machine["WhyNot"])
        tables = self.appliance.folder / "tables"
        tables.mkdir()
        (tables / "SuginoXYZ.json").write_text(json.dumps({"Tools": [{"ToolNumber": 7, "Length": 42}], "Mounted": 0}))
        machines = self.fits([change, move], "--joints", "3", "--tools", str(tables))
        self.assertEqual({name for name, machine in machines.items() if machine["Fits"]}, {"SuginoXYZ"})

    def test_page_shows_each_machine_with_its_picture_and_its_figures(self):
        sections = (SOURCE / "docs/machines.md").read_text().split("\n### ")[1:]
        pages = {section.split("\n", 1)[0]: section for section in sections}
        for machine in json.loads(self.appliance.rmac("--json", "machines").stdout):
            name, page = machine["Name"], pages[machine["Name"]]
            self.assertIn(f"(images/machines/{name}.png)", page)
            self.assertTrue((SOURCE / f"docs/images/machines/{name}.png").is_file())
            self.assertIn(f"| feed at most | {machine['MaxFeedrate']:g} mm/min |", page)
            self.assertIn(machine["WorkingVolume"].replace("x", " x "), page)

    def test_picture_of_a_machine_is_drawn_from_its_device_json(self):
        picture = self.appliance.folder / "reach.png"
        words = ("show", "SuginoXYZAC", "--plot", str(picture), "--device-tree", str(self.appliance.tree))
        done = self.appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        empty = self.appliance.folder / "empty"
        empty.mkdir()
        done = self.appliance.rmac(*words[:-1], str(empty))
        self.assertEqual(done.returncode, 1)
        self.assertIn("holds no machine that is called SuginoXYZAC", done.stderr)

    def test_quotes_in_a_search_stay_text(self):
        self.assertEqual(self.names("--type", "Mill' OR '1'='1"), set())

    def test_table_has_a_row_a_machine(self):
        done = self.appliance.rmac("machines")
        rows = done.stdout.splitlines()
        self.assertEqual(len(rows), 1 + len(ALL))
        self.assertTrue(rows[0].startswith("name"))

    def test_hostile_sql_is_an_error_and_changes_nothing(self):
        for sql in ("DELETE FROM DeviceDrivers", "SELECT * FROM sqlite_master", "SELECT 1; DROP TABLE DeviceDrivers",
                    "ATTACH 'other' AS other", "PRAGMA table_info(DeviceDrivers)"):
            done = self.appliance.rmac("machines", "--sql", sql)
            self.assertEqual((done.returncode, done.stdout), (1, ""), sql)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertEqual(self.names(), ALL)

    def test_show_prints_table_4_1s_values(self):
        done = self.appliance.rmac("--json", "show", "DMACXYZ")
        machine = json.loads(done.stdout)
        self.assertEqual((machine["Name"], machine["NumberOfJoints"], machine["RepeatabilityTolerance"]),
                         ("DMACXYZ", 3, 0.025))
        self.assertEqual(machine["DriverVersion"].count("."), 2)

    def test_show_of_an_unknown_machine_fails_in_one_line(self):
        done = self.appliance.rmac("show", "Nonsense")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("Nonsense", done.stderr)

    def test_show_of_the_loaded_machine_has_its_joints(self):
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, 0)
        machine = json.loads(self.appliance.rmac("--json", "show", "DMACXYZ").stdout)
        self.assertEqual([joint["MaxJerk"] for joint in machine["Joints"]], [10000, 10000, 10000])


if __name__ == "__main__":
    unittest.main()

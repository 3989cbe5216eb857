"""`rmac measure`: a part that is clamped wrong is measured, and its frame corrected."""

import json
import math
import unittest

from appliance import Appliance
from bending_mill import device_of, rigid

DONE, FAILED = 0, 1
TIP_RADIUS = 1.0  # Of drivers/cmm/3-axis/CMM/device.json.
PLACE = [0.3, -0.2, 0.1, 0.05, -0.03, 0.2]  # mm, and degrees about x, y, z
# The block's faces: normal, and the points on them.
TOP = {"Name": "top", "Points": [{"Point": [x, y, -20], "Normal": [0, 0, 1]}
                                 for x, y in ((-15, -10), (15, -10), (15, 10), (-15, 10))]}
LEFT = {"Name": "left", "Points": [{"Point": [-20, y, -28], "Normal": [-2, 0, 0]} for y in (-10, 10)]}
FRONT = {"Name": "front", "Points": [{"Point": [x, -15, -28], "Normal": [0, -1, 0]} for x in (-15, 0, 15)]}


def turn(axis, degrees):
    """A rotation matrix about one axis."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = [(1, 2), (2, 0), (0, 1)][axis]
    matrix = [[1.0 if row == column else 0.0 for column in range(3)] for row in range(3)]
    matrix[i][i] = matrix[j][j] = c
    matrix[i][j], matrix[j][i] = -s, s
    return matrix


def rotated(matrix, vector):
    return [sum(matrix[row][k] * vector[k] for k in range(3)) for row in range(3)]


class OnClampedPart(unittest.TestCase):
    """The measuring machine, its axes as the tree has them, and a part that is clamped wrong."""

    def axes(self, device):
        pass

    def setUp(self):
        self.appliance = Appliance(own_tree=True)
        with device_of(self.appliance, "CMM") as device:
            self.axes(device)
            device["DigitalIOInterface"]["Parameters"]["part_place"] = PLACE
        self.enterContext(self.appliance)
        self.assertEqual(self.appliance.rmac("load", "CMM").returncode, DONE)
        self.watcher = self.appliance.client("watcher")

    def plan(self, *features, **changes):
        file = self.appliance.folder / "plan.json"
        file.write_text(json.dumps({"SafeHeight": -5, "TipRadius": TIP_RADIUS, "Features": features, **changes}))
        return str(file)

    def measured(self, *words):
        done = self.appliance.rmac("measure", *words, "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        return json.loads(done.stdout)


class MeasureAsItComes(OnClampedPart):
    def test_part_that_is_clamped_wrong_is_found_as_well_as_the_machine_repeats(self):
        """Where its axes bend, stick and cog, and its encoders err."""
        device = json.loads(next(self.appliance.tree.glob("*/*/CMM/device.json")).read_text())
        plan = self.plan(TOP, LEFT, FRONT)
        first = self.measured(plan, "--apply")
        self.assertGreater(max(abs(feature["before"]["worst_mm"]) for feature in first["features"]), 0.1)
        for feature in first["features"] + self.measured(plan)["features"]:
            left = feature["after"] if feature in first["features"] else feature["before"]
            self.assertLess(abs(left["worst_mm"]), device["RepeatabilityTolerance"])
        for value, wanted in zip(first["part_frame"]["p"], PLACE):
            self.assertAlmostEqual(value, wanted, delta=device["PositioningTolerance"])


class Measure(OnClampedPart):
    def axes(self, device):
        """On which a hit is as exact as its time."""
        rigid(device)

    def test_part_that_is_clamped_wrong_is_found_and_lies_right_when_its_frame_is_applied(self):
        plan = self.plan(TOP, LEFT, FRONT)
        first = self.measured(plan, "--apply")
        self.assertTrue(first["applied"])
        self.assertEqual([feature["name"] for feature in first["features"]], ["top", "left", "front"])
        self.assertGreater(max(abs(feature["before"]["worst_mm"]) for feature in first["features"]), 0.1)
        # Six freedoms and nine points: what is left is what the hits are off, a tenth of a micrometre and a count.
        for feature in first["features"]:
            self.assertLess(abs(feature["after"]["worst_mm"]), 5e-4)
        # The nominal corner of the block, laid by the frame, against where the part was put.
        matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        for axis in range(3):
            step = turn(axis, PLACE[3 + axis])
            matrix = [[sum(step[row][k] * matrix[k][column] for k in range(3)) for column in range(3)]
                      for row in range(3)]
        frame = first["part_frame"]
        w, x, y, z = frame["q"]
        laid_z = [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]
        for value, wanted in zip(laid_z, rotated(matrix, [0, 0, 1])):
            self.assertAlmostEqual(value, wanted, delta=5e-5)
        self.assertAlmostEqual(2 * math.degrees(math.acos(w)), math.hypot(*PLACE[3:]), delta=0.003)
        for value, wanted in zip(frame["p"], PLACE):
            self.assertAlmostEqual(value, wanted, delta=2e-3)
        self.assertEqual(self.watcher.call("RMAC_CAM.GetPartFrame")["p"], frame["p"])
        again = self.measured(plan)
        self.assertFalse(again["applied"])
        for feature in again["features"]:
            self.assertLess(abs(feature["before"]["worst_mm"]), 5e-3, "the residual of a part that was corrected")

    def test_plan_that_does_not_hold_the_part_reports_and_applies_nothing(self):
        plan = self.plan(TOP)
        told = self.measured(plan)
        self.assertIsNone(told["part_off"])
        self.assertIn("needs 6 points", told["not_aligned"])
        refused = self.appliance.rmac("measure", self.plan(TOP, FRONT), "--apply")
        self.assertEqual(refused.returncode, FAILED)
        self.assertIn("its place along (1.000", refused.stderr)
        self.assertEqual(self.watcher.call("RMAC_CAM.GetPartFrame")["p"], [0, 0, 0])

    def test_tool_that_cut_a_feature_is_found_too_long_and_too_large_and_corrected(self):
        self.assertEqual(self.appliance.rmac("tools", "set", "7", "--length", "40", "--radius", "3").returncode, DONE)
        # As programmed, the floor lies 0.05 mm higher and the wall 0.03 mm further out than they were cut.
        floor = {"Name": "floor", "Tool": 7, "Points": [{"Point": [x, 0, -19.95], "Normal": [0, 0, 1]}
                                                        for x in (-12, 12)]}
        wall = {"Name": "wall", "Tool": 7, "Points": [{"Point": [20.03, y, -28], "Normal": [1, 0, 0]}
                                                      for y in (-8, 8)]}
        told = self.measured(self.plan(TOP, LEFT, FRONT, floor, wall), "--apply")
        tool, = told["tools"]
        self.assertEqual(tool["number"], 7)
        self.assertAlmostEqual(tool["length_off_mm"], 0.05, delta=5e-4)
        self.assertAlmostEqual(tool["radius_off_mm"], 0.03, delta=5e-4)
        table = {entry["ToolNumber"]: entry for entry in self.watcher.call("RMAC_CAM.GetTools")["Tools"]}
        self.assertAlmostEqual(table[7]["Length"], 40 + tool["length_off_mm"], delta=1e-9)
        self.assertAlmostEqual(table[7]["Radius"], 3 + tool["radius_off_mm"], delta=1e-9)
        for point in told["points"]:
            if point["feature"] in ("top", "left", "front"):
                self.assertLess(abs(point["deviation_mm"]), 5e-4, "tools do not move the part")
        frame = self.watcher.call("RMAC_CAM.GetPartFrame")
        # A quaternion is normalised when it is set, which may round its last digit once more.
        for key in ("p", "q"):
            for is_set, was_told in zip(frame[key], told["part_frame"][key], strict=True):
                self.assertAlmostEqual(is_set, was_told, delta=1e-12)
        unknown = self.appliance.rmac("measure", self.plan(TOP, LEFT, FRONT, dict(wall, Tool=7), dict(floor, Tool=8)),
                                      "--apply")
        self.assertEqual(unknown.returncode, FAILED)
        self.assertIn("tool 8 is not in the tool table", unknown.stderr)
        after = {entry["ToolNumber"]: entry for entry in self.watcher.call("RMAC_CAM.GetTools")["Tools"]}
        self.assertEqual(after, table, "what cannot be applied as a whole is not applied")
        self.assertEqual(self.watcher.call("RMAC_CAM.GetPartFrame"), frame)

    def test_part_that_is_not_there_ends_the_plan_with_the_machines_reason(self):
        beside = {"Name": "air", "Points": [{"Point": [40, -40, -20], "Normal": [0, 0, 1]}]}
        done = self.appliance.rmac("measure", self.plan(beside))
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("not where it was looked for", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_wrong_plan_is_refused_with_key_and_range_before_anything_moves(self):
        before = self.watcher.state()["joints"]
        for changes, words in (({"TipRadius": -1}, ("/TipRadius", "-1", "0 to 100")), ({"Sped": 1}, ("Sped", "Speed"))):
            refused = self.appliance.rmac("measure", self.plan(TOP, **changes))
            self.assertEqual(refused.returncode, FAILED)
            for word in ("plan.json", *words):
                self.assertIn(word, refused.stderr)
        flat = {"Name": "top", "Points": [{"Point": [0, 0, -20], "Normal": [0, 0, 0]}]}
        self.assertIn("/Features/0/Points/0/Normal", self.appliance.rmac("measure", self.plan(flat)).stderr)
        self.assertEqual(self.watcher.state()["joints"], before)


class Qualify(unittest.TestCase):
    """`rmac qualify`: what the probe's tip is, found on a sphere that is known."""

    STYLUS, SPHERE = [0.05, -0.03, -29.98], ["20", "20", "-30", "8"]

    def setUp(self):
        self.appliance = Appliance(own_tree=True)
        for name, more in (("CMM", {}), ("SuginoXYZAC", {"probe_input": 0, "probe_radius_mm": 1})):
            with device_of(self.appliance, name) as device:
                rigid(device)
                inputs = device["DigitalIOInterface"]
                inputs["Parameters"] = {**inputs.get("Parameters", {}), **more, "part_place": [0] * 6,
                                        "probe_stylus_mm": self.STYLUS, "sphere_mm": [20, 20, -30, 8]}
                inputs["Parameters"].pop("part_block_mm", None)
                inputs["Parameters"].pop("part_bore_mm", None)
        self.enterContext(self.appliance)

    def mount(self, machine):
        """The probe as the table has it: 30 mm long, upright, with a tip of 1.2 mm."""
        client = self.appliance.operator(machine)
        client.call("RMAC_CAM.SetTool", ToolNumber=5, Length=30, Radius=1.2, NeedsSpindle=False)
        client.call("RMAC_CAM.DoToolChange", ToolNumber=5)
        client.call("subscribe", topics=["events"])
        client.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        client.wait_note("events", lambda event: event["kind"] == "ToolWanted")
        client.call("RMAC_CAM.ConfirmToolChange", ToolNumber=5)
        client.wait_note("events", lambda event: event["kind"] == "ToolChanged")
        client.call("authority.release")
        return client

    def qualified(self, *words):
        done = self.appliance.rmac("qualify", "--sphere", *self.SPHERE, *words, "--json")
        self.assertEqual(done.returncode, DONE, done.stderr)
        return json.loads(done.stdout)

    def test_tip_is_found_and_put_into_the_tool_table(self):
        client = self.mount("CMM")
        told = self.qualified()
        self.assertFalse(told["applied"])
        self.assertAlmostEqual(told["tip_radius_mm"], 1, delta=3e-4)
        for value, wanted in zip(told["offset_mm"], (0.05, -0.03, 0.02)):
            self.assertAlmostEqual(value, wanted, delta=3e-4)
        tool, = client.call("RMAC_CAM.GetTools")["Tools"]
        self.assertEqual((tool["Length"], tool["Radius"]), (30, 1.2))
        self.assertTrue(self.qualified("--apply")["applied"])
        tool, = client.call("RMAC_CAM.GetTools")["Tools"]
        self.assertAlmostEqual(tool["Radius"], 1, delta=3e-4)
        self.assertAlmostEqual(tool["Length"], 29.98, delta=3e-4)
        for value, wanted in zip(tool["Frame"]["p"], (0.05, -0.03, 0)):
            self.assertAlmostEqual(value, wanted, delta=3e-4)
        again = self.qualified()
        for value in again["offset_mm"]:
            self.assertAlmostEqual(value, 0, delta=3e-4, msg="the tip is where the table has it now")

    def test_plan_without_a_tip_radius_has_that_of_the_probe_in_the_spindle(self):
        self.mount("CMM")
        plan = self.appliance.folder / "plan.json"
        top = {"Name": "sphere", "Points": [{"Point": [20, 20, -22], "Normal": [0, 0, 1]}]}
        plan.write_text(json.dumps({"SafeHeight": 0, "Features": [top]}))
        for radius in (1.2, 1.0):
            self.assertEqual(self.appliance.rmac("tools", "set", "5", "--radius", str(radius)).returncode, DONE)
            told = json.loads(self.appliance.rmac("measure", str(plan), "--json").stdout)
            # The tip is 1 mm in truth and 0.02 mm higher than the table has it: the machine stands so much lower.
            self.assertAlmostEqual(told["features"][0]["before"]["mean_mm"], 1 - radius - 0.02, delta=1e-3)

    def test_offset_goes_with_the_part_frame_and_not_with_a_turned_head(self):
        client = self.mount("SuginoXYZAC")
        client.call("authority.acquire")
        # A quarter about Z, the sphere's centre being the part's zero.
        half = math.sqrt(0.5)
        client.call("RMAC_CAM.SetPartFrame", PartFrame={"p": [20, 20, -30], "q": [half, 0, 0, half]})
        client.call("authority.release")
        self.SPHERE = ["0", "0", "0", "8"]
        told = self.qualified("--apply")
        for value, wanted in zip(told["offset_mm"], (-0.03, -0.05, 0.02)):
            self.assertAlmostEqual(value, wanted, delta=1e-3)
        tool, = client.call("RMAC_CAM.GetTools")["Tools"]
        for value, wanted in zip(tool["Frame"]["p"], (0.05, -0.03, 0)):
            self.assertAlmostEqual(value, wanted, delta=1e-3)
        self.assertEqual(self.appliance.rmac("jog", "--joint", "4", "--distance", "30").returncode, DONE)
        refused = self.appliance.rmac("qualify", "--sphere", *self.SPHERE, "--apply")
        self.assertEqual(refused.returncode, FAILED)
        self.assertIn("with every turn at 0", refused.stderr)

    def test_what_cannot_be_qualified_is_told_and_changes_nothing(self):
        self.assertEqual(self.appliance.rmac("load", "CMM").returncode, DONE)
        empty = self.appliance.rmac("qualify", "--sphere", *self.SPHERE, "--apply")
        self.assertEqual(empty.returncode, FAILED)
        self.assertIn("rmac tools set", empty.stderr)
        client = self.mount("CMM")
        elsewhere = self.appliance.rmac("qualify", "--sphere", "-20", "-20", "-30", "8", "--apply")
        self.assertEqual(elsewhere.returncode, FAILED)
        self.assertIn("not where it was looked for", elsewhere.stderr)
        smaller = self.appliance.rmac("qualify", "--sphere", *self.SPHERE[:3], "10", "--tip-radius", "1", "--apply")
        self.assertEqual(smaller.returncode, FAILED)
        self.assertIn("the reference's radius is wrong", smaller.stderr)
        tool, = client.call("RMAC_CAM.GetTools")["Tools"]
        self.assertEqual((tool["Length"], tool["Radius"], tool["Frame"]["p"]), (30, 1.2, [0, 0, 0]))


if __name__ == "__main__":
    unittest.main()

"""`rmac simulate --setup` of a material that is known: what cutting takes, as a user sees it."""

import json
import math
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, pose
from test_collisions import LENGTH, SETUP, request, to

RADIUS, TEETH, TOP = 3, 2, 30
TOOL = {"ToolNumber": 7, "Length": LENGTH, "Radius": RADIUS,
        "Shape": {"DC": 2 * RADIUS, "LCF": 12, "OAL": LENGTH, "ZEFP": TEETH, "FHA": 30}}
MATERIAL = next(m for m in json.loads((SOURCE / "etc/materials.json").read_text())["Materials"] if m["Name"] == "Al7075-T6")
STOCK = {key: SETUP[key] for key in ("Machine", "PartFrame", "Stock")} | {"Resolution": 0.2, "Material": "AL 7075 T6"}
BEYOND = 50  # where the slot begins and ends; the stock is 80 mm long


def slot(depth, feed_mm_min, rpm):
    line = [pose(x, 0, TOP - depth) for x in (-BEYOND, BEYOND)]
    return [request("RMAC_CAM.SetFeedrate", Feedrate=feed_mm_min), request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=rpm),
            to(-BEYOND, 0, TOP - depth), request("RMAC_CAM.MoveAlongLine", MoveID=2, StartPoint=line[0], EndPoint=line[1])]


class SimulatedCut(unittest.TestCase):
    """A program on SuginoXYZAC with a stock and a material."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_rmac(self, requests, *words, setup=None, tool=None):
        (self.folder / "tools").mkdir(exist_ok=True)
        (self.folder / "tools/SuginoXYZAC.json").write_text(json.dumps({"Mounted": 7, "Tools": [tool or TOOL]}))
        (self.folder / "setup.json").write_text(json.dumps(setup or STOCK))
        file = self.folder / "program.rmac"
        file.write_text("".join(json.dumps(r) + "\n" for r in requests))
        return subprocess.run([BUILD / "bin/rmac", "simulate", file, "--machine", "SuginoXYZAC", "--setup", self.folder / "setup.json",
                               "--tools", self.folder / "tools", *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)

    def report(self, requests, *words, **options):
        done = self.run_rmac(requests, "--json", *words, **options)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stderr)
        return json.loads(done.stdout), done


class Forces(SimulatedCut):
    def test_a_slot_takes_what_its_chips_and_its_edges_take(self):
        depth, feed, rpm = 4, 600, 3000
        report, done = self.report(slot(depth, feed, rpm), "--by-move")
        self.assertEqual(done.returncode, 0, done.stderr)
        forces, volume = report["forces"], report["material"]["removed_mm3"]
        per_s = 2 * math.pi * rpm / 60
        # Half of the time a tooth is in the slot, and its edge is longer than the slot is deep.
        edge_w = TEETH / 2 * MATERIAL["Kte"] * depth / math.cos(math.radians(30)) * RADIUS / 1000 * per_s
        joule = MATERIAL["Ktc"] * volume / 1000 + edge_w * volume / (2 * RADIUS * depth * feed / 60)
        self.assertAlmostEqual(forces["mean_power_w"] * forces["cutting_s"] / joule, 1, delta=0.03)
        self.assertAlmostEqual(forces["mean_torque_nm"] * per_s, forces["mean_power_w"], delta=0.01 * forces["mean_power_w"])
        self.assertGreater(forces["peak_power_w"], forces["mean_power_w"])
        self.assertEqual([move["move_id"] for move in forces["moves"]], [2])
        self.assertEqual(forces["moves"][0]["peak_force_n"], forces["peak_force_n"])
        self.assertEqual((forces["material"], forces["overloads"], forces["not_told"]), ("Al7075-T6", [], []))
        self.assertIn("table 5", forces["source"])
        self.assertIn("N·m at most", self.run_rmac(slot(depth, feed, rpm)).stdout)

    def test_a_ball_that_leans_takes_what_its_chips_take(self):
        chips = self.folder / "chips.json"
        chips.write_text(json.dumps({"Materials": [MATERIAL | {"Kte": 0, "Kre": 0, "Kae": 0}]}))
        ball = TOOL | {"Shape": TOOL["Shape"] | {"RE": RADIUS}}
        lean = math.radians(25)
        for start, end in (((-10, -BEYOND, TOP - 3), (15, BEYOND, TOP - 3)), ((-BEYOND, 3, TOP + 2), (BEYOND, -4, TOP - 6))):
            line = [{"p": list(p), "axis": [0, math.sin(lean), math.cos(lean)]} for p in (start, end)]
            program = [request("RMAC_CAM.SetFeedrate", Feedrate=600), request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=3000),
                       request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=line[0]),
                       request("RMAC_CAM.MoveAlongLine", MoveID=2, StartPoint=line[0], EndPoint=line[1])]
            forces, material = (self.report(program, "--materials", chips, tool=ball)[0][key] for key in ("forces", "material"))
            joule = MATERIAL["Ktc"] * material["removed_mm3"] / 1000
            self.assertEqual(forces["not_told"], [])
            self.assertGreater(material["removed_mm3"], 500)
            self.assertAlmostEqual(forces["mean_power_w"] * forces["cutting_s"] / joule, 1, delta=0.05, msg=f"{start} to {end}")

    def test_more_than_the_spindle_has_is_told_with_line_time_and_place(self):
        report, done = self.report(slot(10, 3000, 1500))
        self.assertEqual(done.returncode, 1)
        overload = report["forces"]["overloads"][0]
        self.assertEqual((overload["what"], overload["line"], overload["move_id"], overload["allowed"]), ("torque", 4, 2, 10))
        self.assertGreater(overload["most"], 10)
        self.assertGreater(overload["until_s"], overload["t_s"])
        self.assertAlmostEqual(overload["place_mm"][2], TOP - 10, delta=0.01)
        self.assertLess(abs(overload["place_mm"][0]), 44)
        self.assertIn("cutting takes more than the spindle has, first in line 4", done.stderr)
        self.assertIn("OVERLOAD: torque", self.run_rmac(slot(10, 3000, 1500)).stdout)

    def test_what_is_missing_is_told_as_loudly(self):
        program = slot(4, 600, 3000)
        toothless = TOOL | {"Shape": {key: value for key, value in TOOL["Shape"].items() if key != "ZEFP"}}
        report, done = self.report(program, tool=toothless)
        self.assertEqual(done.returncode, 1)
        self.assertIn("forces of tool 7: its Shape does not say how many teeth it has", report["forces"]["not_told"][0])
        self.assertIn("NOT TOLD: forces of tool 7", self.run_rmac(program, tool=toothless).stdout)
        report, done = self.report(program, setup=STOCK | {"Material": "Al7057-T6"})
        self.assertEqual(done.returncode, 1)
        self.assertIn("did you mean \"Al7075-T6\"?", report["forces"]["not_told"][0])
        self.assertIn("did you mean \"Al7075-T6\"?", done.stderr)

    def test_what_rays_cannot_show_is_told_as_loudly(self):
        """Red when a cut thinner than half of the rays' distance takes material and no force, and nothing is said."""
        report, done = self.report(slot(0.05, 600, 3000))
        self.assertGreater(report["material"]["removed_mm3"], 10)
        self.assertEqual(done.returncode, 1)
        self.assertIn("takes off less than rays 0.2 mm apart show, first in line 4", " ".join(report["forces"]["not_told"]))
        report, done = self.report(slot(0.05, 600, 3000), "--resolution", "0.05")
        self.assertEqual((done.returncode, report["forces"]["not_told"]), (0, []), done.stderr)
        self.assertGreater(report["forces"]["cutting_s"], 6)

    def test_whatever_bytes_a_material_is_misspelt_with_are_told_as_one_line(self):
        done = self.run_rmac(slot(4, 600, 3000), setup=STOCK | {"Material": "Al\n\x1b[31mX"})
        self.assertEqual(done.returncode, 1)
        (line,) = (line for line in done.stdout.split("\n") if line.startswith("NOT TOLD: "))
        self.assertIn("X", line)
        self.assertNotIn("\x1b", done.stdout + done.stderr)

    def test_a_spindle_that_turns_to_the_left_is_told(self):
        report, done = self.report(slot(4, 600, -3000))
        self.assertEqual((done.returncode, report["forces"]["cutting_s"]), (1, 0))
        self.assertIn("turns to the left", " ".join(report["forces"]["not_told"]))

    def test_the_way_to_the_first_position_is_nobodys_whatever_is_done_before(self):
        """Red when a spindle's speed, calls in turn or a dwell before the first move have the way from the joints' zero judged."""
        plain = self.report(slot(4, 600, 3000))[0]
        calls = [{"method": "RMAC_CAM.SetSpindleRPM", "params": {"SpindleNumber": 0, "RPM": 3000}}]
        for before in ([request("RMAC_CAM.InTurn", MoveID=8, Calls=calls)], [request("RMAC_CAM.Dwell", MoveID=9, Time=0.5)]):
            report, done = self.report([*slot(4, 600, 3000)[:2], *before, *slot(4, 600, 3000)[2:]])
            self.assertEqual(done.returncode, 0, done.stderr)
            for key in ("removed_mm3", "left_mm3"):
                self.assertEqual(report["material"][key], plain["material"][key])
            self.assertEqual(report["collisions"], [])

    def test_nothing_that_is_read_is_written(self):
        materials = self.folder / "chips.stl"
        text = json.dumps({"Materials": [MATERIAL]})
        materials.write_text(text)
        for name in ("program.rmac", "setup.json", "tools/SuginoXYZAC.json"):
            done = self.run_rmac(slot(4, 600, 3000), "--record", self.folder / name)
            self.assertEqual(done.returncode, 1)
            self.assertIn("this run uses this file; choose another name with --record", done.stderr)
        for option in ("--record", "--stock-out"):
            done = self.run_rmac(slot(4, 600, 3000), "--materials", materials, option, materials)
            self.assertEqual(done.returncode, 1)
            self.assertIn(f"this run uses this file; choose another name with {option}", done.stderr)
        self.assertEqual(materials.read_text(), text)
        self.assertTrue((self.folder / "program.rmac").read_text().startswith("{"))

    def test_who_names_no_material_is_told_how(self):
        nameless = {key: value for key, value in STOCK.items() if key != "Material"}
        report, done = self.report(slot(4, 600, 3000), setup=nameless)
        self.assertEqual((done.returncode, report["forces"]), (0, "not told"))
        self.assertIn("name a --setup with Stock and Material", self.run_rmac(slot(4, 600, 3000), setup=nameless).stdout)

    def test_materials_of_ones_own_are_taken_and_checked(self):
        own = self.folder / "own.json"
        own.write_text(json.dumps({"Materials": [MATERIAL | {"Name": "wax", "AlsoCalled": [], "Ktc": 100}]}))
        report, done = self.report(slot(4, 600, 3000), "--materials", own, setup=STOCK | {"Material": "wax"})
        self.assertEqual((done.returncode, report["forces"]["material"]), (0, "wax"))
        own.write_text(json.dumps({"Materials": [MATERIAL | {"Ktc": -767}]}))
        done = self.run_rmac(slot(4, 600, 3000), "--materials", own)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("/Materials/0/Ktc is -767; allowed is a number from 10 to 20000 (N/mm²)", done.stderr)

    def test_a_tool_with_no_teeth_at_all_is_refused_by_its_table(self):
        done = self.run_rmac(slot(4, 600, 3000), tool=TOOL | {"Shape": TOOL["Shape"] | {"ZEFP": 0}})
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("/Tools/0/Shape/ZEFP is 0; allowed is an integer from 1 to 1000", done.stderr)


if __name__ == "__main__":
    unittest.main()

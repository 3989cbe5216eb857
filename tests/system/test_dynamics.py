"""`rmac simulate --dynamics`: what the axes do with a program, held to what the daemon's axes then do with it."""

import csv
import json
import math
import pathlib
import random
import shutil
import subprocess
import tempfile
import unittest

from appliance import BUILD, Appliance, pose
from bending_mill import rigid
from test_collisions import request
from test_forces import STOCK, TOOL, TOP, slot

MILL = "mill/3-axis/DMACXYZ"


def write(file, requests):
    file.write_text("".join(json.dumps(r) + "\n" for r in requests))
    return file


def path(seed, moves=7, at=(0, 0, 0)):
    """Lines, arcs and rests within 40 mm of the middle, at feeds of their own, from a place where the tool stands or is led to first."""
    chance = random.Random(seed)
    requests = []
    if any(at):
        requests.append(request("RMAC_CAM.MoveToJointTarget", MoveID=moves + 1, JointTargetFrame={"joints": list(at)}))
    for move in range(1, moves + 1):
        there = tuple(round(chance.uniform(-25, 25), 3) for _ in range(3))
        requests.append(request("RMAC_CAM.SetFeedrate", Feedrate=chance.choice([300, 900, 2000])))
        if move > 1 and chance.random() < 0.4:
            middle = [(a + b) / 2 for a, b in zip(at, there)]
            there = (there[0], there[1], at[2])
            middle[2] = at[2]
            requests.append(request("RMAC_CAM.MoveAlongArc", MoveID=move, RotSign=1, Closed=False, CenterPoint=pose(*middle),
                                    StartPoint=pose(*at), EndPoint=pose(*there)))
        else:
            requests.append(request("RMAC_CAM.MoveAlongLine", MoveID=move, StartPoint=pose(*at), EndPoint=pose(*there)))
        at = there
    return requests


def rows(file):
    with file.open(newline="") as lines:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


class Dynamics(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def simulate(self, program, *words, machine="DMACXYZ"):
        return subprocess.run([BUILD / "bin/rmac", "simulate", program, "--machine", machine, *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300, check=False)

    def report(self, program, *words, **options):
        done = self.simulate(program, "--dynamics", "--json", *words, **options)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stderr)
        return json.loads(done.stdout)["dynamics"], done

    def tree_with(self, change, machine=MILL):
        """The device tree with that machine changed."""
        tree = self.folder / "drivers"
        shutil.copytree(BUILD / "drivers", tree)
        file = tree / machine / "device.json"
        device = json.loads(file.read_text())
        change(device)
        file.write_text(json.dumps(device))
        return tree

    def held_to_the_daemon(self, tree, seeds, within_mm, sag_mm=0.0):
        for seed in seeds:
            program = write(self.folder / f"{seed}.rmac", path(seed, at=(1, 1, 1)))
            # What an axis does that sticks depends on what it did before: each begins as it was switched on.
            with Appliance(device_tree=str(tree)) as appliance:
                self.assertEqual(appliance.rmac("load", "DMACXYZ").returncode, 0)
                done = appliance.rmac("run", str(program), "--record", str(self.folder / "run.csv"))
                self.assertEqual(done.returncode, 0, done.stderr)
            told, done = self.report(program, "--device-tree", tree, "--record", self.folder / "simulated.csv")
            self.assertIsNone(told["stopped"])
            ran, simulated = rows(self.folder / "run.csv"), rows(self.folder / "simulated.csv")
            self.assertEqual(ran[0].keys(), simulated[0].keys())
            # Behind the way there, which begins where brakes and friction left the axes.
            errors = [[(ran_row[f"a{j}"] - ran_row[f"q{j}"], row[f"a{j}"] - row[f"q{j}"]) for j in (1, 2, 3)]
                      for ran_row, row in zip(ran, simulated) if row["move_id"] != 8]
            rms = [math.sqrt(sum(of(a, b) ** 2 for row in errors for a, b in row) / (3 * len(errors)))
                   for of in (lambda a, b: a - b, lambda a, _: a, lambda _, b: b)]
            self.assertAlmostEqual(rms[2] / rms[1], 1, delta=0.1)
            self.assertLess(rms[0], within_mm, f"seed {seed}: mm rms between what was predicted and what the daemon's axes did")
            most = max(abs(b) for row in errors for _, b in row)
            self.assertGreater(most, 0.005, "which is little against what they are off")
            # What is told is where the loads are; what is recorded, where their motors are.
            self.assertAlmostEqual(max(joint["peak_error"] for joint in told["joints"]), most, delta=0.3 * most + sag_mm)

    def test_axes_do_what_the_daemons_do(self):
        self.held_to_the_daemon(self.tree_with(rigid), (1, 2), 0.0002)

    def test_so_do_axes_that_bend_stick_and_cog(self):
        # Where an axis sticks, a micrometre of where it began decides when it breaks loose.
        self.held_to_the_daemon(BUILD / "drivers", (4, 6), 0.006, sag_mm=117.7 / 25000)

    def test_a_cut_pushes_the_axes_and_the_part_shows_it(self):
        (self.folder / "tools").mkdir()
        stiff = TOOL | {"Shape": TOOL["Shape"] | {"Modes": [{"Frequency": 9000, "DampingRatio": 0.1, "Stiffness": 1e7}]}}
        (self.folder / "tools/SuginoXYZAC.json").write_text(json.dumps({"Mounted": 7, "Tools": [stiff]}))
        told = {}
        tree = self.tree_with(rigid, "mill/5-axis/SuginoXYZAC")  # whose loops are stiff enough to keep to the path as the cut begins
        for name, setup in (("air", None), ("cut", STOCK)):
            words = ["--device-tree", tree]
            if setup:
                (self.folder / "setup.json").write_text(json.dumps(setup))
                words += ["--setup", self.folder / "setup.json"]
            program = write(self.folder / "slot.rmac", slot(4, 600, 3000))
            # Without the set-up its part frame is not in force: the same place by hand.
            if not setup:
                program = write(program, [request("RMAC_CAM.SetPartFrame", PartFrame=STOCK["PartFrame"]), *slot(4, 600, 3000)])
            told[name], done = self.report(program, "--tools", self.folder / "tools", *words, machine="SuginoXYZAC")
            self.assertEqual(done.returncode, 0, done.stderr)
        # A slot pushes the tool to the side and back; the screws' share of it is what the motors give beside friction.
        more = [abs(cut["rms_nm"] - air["rms_nm"]) for cut, air in zip(told["cut"]["motors"], told["air"]["motors"])]
        self.assertGreater(max(more), 0.01)
        self.assertGreater(told["cut"]["path_rms_mm"], 1.2 * told["air"]["path_rms_mm"])
        self.assertLess(told["cut"]["path_peak_mm"], 0.05)

    def test_a_machine_that_would_stop_or_leave_its_path_is_told(self):
        program = write(self.folder / "p.rmac", path(9, 2))
        def bounds(device):
            rigid(device)
            for joint in device["Joints"][:2]:
                joint["MaxFollowingError"] = 0.002

        weak = self.tree_with(bounds)
        told, done = self.report(program, "--device-tree", weak)
        self.assertEqual(done.returncode, 1)
        self.assertEqual(told["stopped"]["line"], 2)
        self.assertIsNone(told["keeps_at_percent"], "so weak a bound holds at no feed")
        self.assertIn("following error", told["stopped"]["why"])
        self.assertIn("the machine stops in line 2", done.stderr)
        self.assertIn("THE MACHINE STOPS in line 2", self.simulate(program, "--dynamics", "--device-tree", weak).stdout)

        file = weak / MILL / "device.json"
        device = json.loads(file.read_text())
        device["PositioningTolerance"] = 0.0001
        for joint in device["Joints"]:
            joint["MaxFollowingError"] = 0.5
        file.write_text(json.dumps(device))
        told, done = self.report(program, "--device-tree", weak)
        self.assertEqual(done.returncode, 1)
        self.assertGreater(told["off_path"][0]["most_mm"], told["off_path"][0]["allowed_mm"])
        self.assertEqual((told["off_path"][0]["line"], told["off_path"][0]["allowed_mm"]), (2, 0.0001))
        self.assertIn("leaves its path by more than PositioningTolerance, first in line 2", done.stderr)
        self.assertIsNone(told["keeps_at_percent"], "nor does it keep to so much at a lower feed")

    def test_the_feed_at_which_it_keeps_to_its_path_is_told(self):
        circle = [request("RMAC_CAM.SetFeedrate", Feedrate=2000), request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(20, 0, 0)),
                  request("RMAC_CAM.MoveAlongArc", MoveID=2, RotSign=1, Closed=True, CenterPoint=pose(0, 0, 0),
                          StartPoint=pose(20, 0, 0), EndPoint=pose(20, 0, 0))]
        tree = self.tree_with(rigid)
        peak = self.report(write(self.folder / "p.rmac", circle), "--device-tree", tree)[0]["path_peak_mm"]
        file = tree / MILL / "device.json"
        file.write_text(json.dumps(json.loads(file.read_text()) | {"PositioningTolerance": 0.8 * peak}))
        told, done = self.report(self.folder / "p.rmac", "--device-tree", tree)
        self.assertEqual(done.returncode, 1)
        self.assertIn(told["keeps_at_percent"], (80, 65, 50, 40, 30, 20))
        slower = write(self.folder / "slower.rmac", [request("RMAC_CAM.SetFeedOverride", Percent=told["keeps_at_percent"]), *circle])
        self.assertEqual(self.simulate(slower, "--dynamics", "--device-tree", tree).returncode, 0)
        self.assertIn(f"At a feed override of {told['keeps_at_percent']:g} % it keeps", self.simulate(self.folder / "p.rmac", "--dynamics", "--device-tree", tree).stdout)

    def test_a_program_that_configures_the_machine_anew_is_told(self):
        weak = [request("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[100, 1000, 5]), request("RMAC_Config.Apply")]
        told, done = self.report(write(self.folder / "p.rmac", [*weak, *path(1, 2)]))
        self.assertEqual(done.returncode, 1)
        self.assertIn("the program configures the machine anew", told["not_told"][0])

    def test_drives_that_answer_late_are_where_they_are_all_the_same(self):
        tree = self.folder / "drivers"
        shutil.copytree(BUILD / "drivers", tree)
        file = tree / "mill/5-axis/TarusXYZCA/device.json"
        device, peaks = json.loads(file.read_text()), []
        device["PositioningTolerance"] = 1
        target = [request("RMAC_CAM.MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": [100, 50, 0, 60, 30]})]
        for late in ((1, 1), (0, 1), (1, 2)):
            for bus, cycles in zip(("can0", "can1"), late):
                device["DigitalControlInterface"]["Parameters"][f"{bus}.model.late_answers"] = cycles
            file.write_text(json.dumps(device))
            told, done = self.report(write(self.folder / "p.rmac", target), "--device-tree", tree, machine="TarusXYZCA")
            self.assertEqual(done.returncode, 0, done.stderr)
            peaks.append(told["path_peak_mm"])
        self.assertLess(max(peaks), 2 * min(peaks))
        self.assertLess(max(peaks), 0.02)

    def test_what_cannot_be_told_is_refused(self):
        program = write(self.folder / "p.rmac", path(1, 2))
        tree = self.folder / "drivers"
        shutil.copytree(BUILD / "drivers", tree)
        file = tree / "mill/5-axis/TarusXYZCA/device.json"
        device = json.loads(file.read_text())
        parameters = device["DigitalControlInterface"]["Parameters"]
        device["DigitalControlInterface"]["Parameters"] = {key: value for key, value in parameters.items() if ".model." not in key}
        file.write_text(json.dumps(device))
        done = self.simulate(program, "--dynamics", "--device-tree", tree, machine="TarusXYZCA")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("has no model of its axes (can0.model.interface", done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)
        load = write(self.folder / "load.rmac", [request("Device.Load", Name="DMACXYZ"), *path(1, 2)])
        done = subprocess.run([BUILD / "bin/rmac", "simulate", load, "--dynamics"], stdin=subprocess.DEVNULL, capture_output=True,
                              text=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("--dynamics needs --machine", done.stderr)


if __name__ == "__main__":
    unittest.main()

"""`rmac simulate`: a program planned without an appliance, against the appliance and against arithmetic of its own."""

import csv
import json
import math
import pathlib
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, Appliance, line, pose

BENCH = SOURCE / "drivers/bench/3-axis/BenchXYZ/device.json"
PERIOD_S = 0.001
HEADER = "t_s,move_id,s_mm,feed_mm_s,x,y,z,i,j,k,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3"


def request(method, **params):
    return {"jsonrpc": "2.0", "id": 1, "method": method, "params": params}


def feed(mm_min):
    return request("RMAC_CAM.SetFeedrate", Feedrate=mm_min)


def along(start, end, move_id):
    return request("RMAC_CAM.MoveAlongLine", **line(start, end, move_id))


def to(x, y, z, move_id=1):
    return request("RMAC_CAM.MoveToPathTarget", MoveID=move_id, TargetFrame=pose(x, y, z))


def mixed_program():
    """Corners, an arc, a spline, a joint move, a frame, another feed, a dwell and a helix. The cycle starts when all of it is queued, so
    that on the appliance no move waits for a client on a busy computer."""
    return [
        request("RMAC_CAM.Home"),
        request("RMAC_CAM.SetPartFrame", PartFrame={"p": [5, 5, 5], "q": [1, 0, 0, 0]}),
        feed(6000),
        to(0, 0, 0, 7),
        request("RMAC_CAM.SetPathTolerance", Tolerance=0.05),
        along((0, 0, 0), (20, 0, 0), 1),
        along((20, 0, 0), (20, 15, 0), 2),
        request("RMAC_CAM.MoveAlongArc", MoveID=3, CenterPoint=pose(10, 15, 0), RotSign=1, Closed=False,
                StartPoint=pose(20, 15, 0), EndPoint=pose(0, 15, 0)),
        feed(2400),
        request("RMAC_CAM.MoveAlongNurbs", MoveID=4, Nurbs={
            "degree": 3, "knots": [0, 0, 0, 0, 1, 2, 2, 2, 2],
            "points": [[0, 15, 0], [0, 5, 0], [-20, 5, 5], [-25, -5, 5], [-30, -30, 0]]}),
        request("RMAC_CAM.MoveToJointTarget", MoveID=5, JointTargetFrame={"joints": [10, 10, 10]}),
        to(0, 0, 0, 6),
        request("RMAC_CAM.Dwell", MoveID=8, Time=0.4),
        request("RMAC_CAM.MoveAlongArc", MoveID=9, CenterPoint=pose(-10, 0, 0), RotSign=-1, Closed=True,
                StartPoint=pose(0, 0, 0), EndPoint=pose(0, 0, -6), Turns=1),
        request("RMAC_CAM.InTurn", MoveID=10, Calls=[{"method": "RMAC_CAM.TurnCoolantOn"}]),
        along((0, 0, -6), (5, 0, -6), 11),
        request("RMAC_CAM.CycleStart", Mode="AUTOMATIC"),
    ]


class Simulate(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, requests):
        file = self.folder / "program.rmac"
        file.write_text("".join(json.dumps(r) + "\n" for r in requests))
        return file

    def run_rmac(self, requests, *words, machine="BenchXYZ"):
        chosen = ["--machine", machine] if machine else []
        return subprocess.run([BUILD / "bin" / "rmac", "simulate", self.write(requests), *chosen, *words],
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=120, check=False)

    def simulate(self, requests, *words, **options):
        done = self.run_rmac(requests, "--json", *words, **options)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(done.stdout.splitlines()), 1)
        return json.loads(done.stdout)

    def refusal(self, requests, *words, **options):
        done = self.run_rmac(requests, *words, **options)
        self.assertEqual((done.returncode, done.stdout), (1, ""), done.stdout)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_takes_as_long_as_on_the_appliance(self):
        program = mixed_program()
        simulated = self.simulate(program)
        with Appliance() as appliance:
            done = appliance.rmac("--json", "run", "--machine", "BenchXYZ", self.write(program))
            self.assertEqual((done.returncode, done.stderr), (0, ""))
        machined = json.loads(done.stdout)
        self.assertEqual(simulated["moves"], machined["moves"])
        self.assertAlmostEqual(simulated["cycle_time_s"], machined["cycle_time_s"], delta=3 * PERIOD_S)

    def test_one_line_takes_the_time_of_the_closed_form(self):
        report = self.simulate([feed(12000), to(40, 0, 0)])
        # Rest to rest at 10 000 mm/s³ and 1000 mm/s²: with ramps of tj = 0.1 s and d = a ta (ta + tj) the time is
        # 2 (ta + tj), and nothing can be faster.
        ramp = (-0.1 + math.sqrt(0.01 + 4 * 40 / 1000)) / 2
        self.assertGreaterEqual(report["cycle_time_s"], 2 * (ramp + 0.1) - PERIOD_S)
        self.assertLess(report["cycle_time_s"], 1.03 * 2 * (ramp + 0.1))
        self.assertAlmostEqual(report["length_mm"], 40, places=9)
        self.assertEqual(report["moves"], 1)
        self.assertEqual(report["collisions"], "not checked")

    def test_record_has_the_peaks_and_keeps_the_limits(self):
        record = self.folder / "record.csv"
        report = self.simulate(mixed_program(), "--record", record)
        with record.open(encoding="ascii", newline="") as file:
            self.assertEqual(file.readline().strip(), HEADER)
            rows = [[float(cell) for cell in row] for row in csv.reader(file)]
        self.assertEqual(report["record_rows"], len(rows))
        times = [row[0] for row in rows]
        self.assertTrue(all(abs(b - a - PERIOD_S) < 1e-9 for a, b in zip(times, times[1:])))
        for number, joint in enumerate(report["joints"]):
            self.assertEqual(joint["name"], "XYZ"[number])
            q = [row[10 + number] for row in rows]
            jerks = [abs(d - 3 * c + 3 * b - a) / PERIOD_S**3 for a, b, c, d in zip(q, q[1:], q[2:], q[3:])]
            speeds = [abs(b - a) / PERIOD_S for a, b in zip(q, q[1:])]
            self.assertLess(max(speeds), 200)
            self.assertLess(max(jerks), 10000 * 1.001)
            self.assertAlmostEqual(joint["peak_velocity"], max(speeds), delta=0.01 * max(speeds) + 0.01)
            self.assertAlmostEqual(joint["peak_jerk"], max(jerks), delta=0.02 * max(jerks))
            self.assertLessEqual(joint["peak_jerk"], 10000 * 1.001)
            self.assertLessEqual(joint["peak_acceleration"], 1000 * 1.001)

    def test_time_goes_to_the_limit_that_rules(self):
        slow = self.simulate([feed(300), to(40, 0, 0)])
        self.assertGreater(slow["limited_by_s"]["feed"], 0.9 * slow["cycle_time_s"])
        fast = self.simulate([feed(12000), to(5, 0, 0)])
        self.assertGreater(fast["limited_by_s"]["X jerk"], 0.9 * fast["cycle_time_s"])
        self.assertAlmostEqual(sum(fast["limited_by_s"].values()), fast["cycle_time_s"], delta=2 * PERIOD_S)
        softly = self.simulate([request("RMAC_CAM.SetPathAccelRise", newVal=50), feed(12000), to(40, 0, 0)])
        self.assertGreater(softly["limited_by_s"]["path acceleration"], 0.5 * softly["cycle_time_s"])

    def test_each_move_tells_the_limit_that_ruled_it(self):
        program = [feed(300), to(5, 0, 0, 1), along((5, 0, 0), (20, 0, 0), 2), request("RMAC_CAM.Dwell", MoveID=3, Time=0.1),
                   feed(12000), to(25, 0, 0, 4)]
        told = self.simulate(program, "--by-move")
        limits = {move["move_id"]: move["limit"] for move in told["move_limits"]}
        self.assertEqual(limits, {1: "feed", 2: "feed", 3: "", 4: "X jerk"})
        self.assertNotIn("move_limits", self.simulate(program))

    def test_a_machine_by_the_path_of_its_device_json(self):
        device = json.loads(BENCH.read_text())
        device["MechanismName"] = "WhatIf"
        for joint in device["Joints"]:
            joint["MaxJerk"] = 80000
        changed = self.folder / "what-if.json"
        changed.write_text(json.dumps(device))
        program = [feed(12000), to(0.2, 0, 0)]
        original = self.simulate(program, machine=str(BENCH))
        self.assertEqual(original["cycle_time_s"], self.simulate(program)["cycle_time_s"])
        # Nothing but jerk bounds so short a move: eight times the jerk halves its time.
        self.assertAlmostEqual(self.simulate(program, machine=str(changed))["cycle_time_s"],
                               original["cycle_time_s"] / 2, delta=3 * PERIOD_S)

    def turning_lines(self, *settings):
        """The report on 100 lines of 0.2 mm, rounded as post-processors round, on which the axis turns by 10 degrees; and by how many degrees
        it leaves what they ask for."""
        def corner(k):
            angle = math.radians(20 + k / 10)
            return {"p": [round(k / 5 - 10, 3), round(2 * math.sin(k / 30), 3), 0],
                    "axis": [round(math.sin(angle), 6), 0, round(math.cos(angle), 6)]}
        program = [feed(6000), request("RMAC_CAM.MoveToPathTarget", MoveID=1000, TargetFrame=corner(0)),
                   request("RMAC_CAM.SetPathTolerance", Tolerance=0.01), *settings]
        program += [request("RMAC_CAM.MoveAlongLine", MoveID=k, StartPoint=corner(k - 1), EndPoint=corner(k))
                    for k in range(1, 101)]
        record = self.folder / "record.csv"
        report = self.simulate(program, "--record", record, machine="SuginoXYZAC")
        off = 0
        with record.open(encoding="ascii", newline="") as file:
            for row in csv.DictReader(file):
                if int(row["move_id"]) <= 100:
                    asked = math.radians(20 + (float(row["x"]) + 10) / 2)
                    off = max(off, abs(math.degrees(math.atan2(float(row["i"]), float(row["k"])) - asked)))
        return report, off

    def test_the_axis_of_lines_turns_within_its_own_tolerance(self):
        smooth, off = self.turning_lines()
        self.assertLess(off, 0.1 + 1e-3, "0.1 degrees unless set")
        # Nothing is left of the path's tolerance for corners of the axis: each is a stop.
        exact, off = self.turning_lines(request("RMAC_CAM.SetOrientationTolerance", Tolerance=0))
        self.assertLess(off, 2e-4)
        self.assertGreater(exact["cycle_time_s"], 3 * smooth["cycle_time_s"])

    def test_programs_may_load_and_configure_machines(self):
        report = self.simulate([
            request("Device.Load", Name="BenchXYZ"),
            request("RMAC_Config.SetMechanismJointMaximumSpeed", JntNum=0, MaxJntSpeed=20), request("RMAC_Config.Apply"),
            feed(12000), to(10, 0, 0, 1), to(0, 0, 0, 2),
            request("Device.Load", Name="DMACXY"),
            feed(1200), to(0, 10, 0, 3),
        ], machine=None)
        self.assertEqual([joint["name"] for joint in report["joints"]], ["X", "Y", "Z"])
        self.assertAlmostEqual(report["joints"][0]["peak_velocity"], 20, delta=0.1)
        self.assertAlmostEqual(report["joints"][1]["peak_velocity"], 20, delta=0.1)
        self.assertEqual((report["moves"], report["joints"][2]["peak_velocity"]), (3, 0))

    def test_a_refusal_names_line_joint_amount_and_place(self):
        said = self.refusal([feed(6000), along((0, 0, 0), (20, 0, 0), 1), along((20, 0, 0), (20, 52.5, 0), 2)])
        for part in ("program.rmac:3:", "move 2", "joint Y", "2.5000 mm beyond", "along the move"):
            self.assertIn(part, said)

    def test_what_cannot_be_done_is_one_line(self):
        self.assertIn("program.rmac:1:", self.refusal([to(1, 0, 0)]))
        self.assertIn("no machine", self.refusal([to(1, 0, 0)], machine=None))
        self.assertIn("Nonsense", self.refusal([to(1, 0, 0)], machine="Nonsense"))
        self.assertIn("/nonexistent.json", self.refusal([to(1, 0, 0)], machine="/nonexistent.json"))
        self.assertIn("/nonexistent/record.csv",
                      self.refusal([feed(60), to(1, 0, 0)], "--record", "/nonexistent/record.csv"))

    def test_a_program_that_cannot_go_on_ends(self):
        said = self.refusal([request("RMAC_CAM.CycleStart", Mode="AUTOMATIC"), feed(6000), to(1, 0, 0),
                             request("RMAC_CAM.FeedHold"), to(2, 0, 0, 2)])
        self.assertIn("program.rmac:5:", said)
        self.assertIn("Holding", said)
        self.assertIn("0 %", self.refusal([feed(6000), request("RMAC_CAM.SetFeedOverride", Percent=0), to(1, 0, 0)]))

    def test_the_table_is_for_people(self):
        done = self.run_rmac([feed(6000), to(1, 0, 0)])
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for part in ("cycle time", "not checked", "peak velocity", "limited by"):
            self.assertIn(part, done.stdout)


if __name__ == "__main__":
    unittest.main()

"""The checks find what they must find: each test breaks a good run in one way."""

import json
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent), str(HERE)]

import numpy as np  # noqa: E402

import entities  # noqa: E402
import figures  # noqa: E402
import nurbs  # noqa: E402
import part  # noqa: E402
import synthesis  # noqa: E402
import toolpaths  # noqa: E402
import verify  # noqa: E402
from record import Record  # noqa: E402

JOINT = {"Min": -50, "Max": 50, "MaxSpeed": 200, "MaxAcceleration": 1000, "MaxJerk": 10000}
BAND = (-2.0, 2.0)


def setUpModule():
    global folder, plan, sweep, rim, good, device
    folder = tempfile.TemporaryDirectory()
    out = pathlib.Path(folder.name)
    toolpaths.make(out, v_range=BAND)
    plan = json.loads((out / "plan.json").read_text())
    sweep = entities.read_program(out / "headlight-sweep.rmac")
    rim = entities.read_program(out / "headlight-rim.rmac", start=[*plan["wait_mm"], 0.0])
    good = synthesis.run(sweep)
    device = {"Joints": [{**JOINT, "Name": n} for n in "XYZ"]}


def tearDownModule():
    folder.cleanup()


def copy(record):
    return Record.from_table(record.table().copy(), record.joints)


class Limits(unittest.TestCase):
    def test_a_good_run_breaks_none(self):
        run = verify.check_run(good, sweep, device)
        self.assertEqual(run["limits"]["violations"], 0)
        self.assertEqual(run["feed"]["violations"], 0)
        self.assertEqual(run["path"]["unfinished_moves"], [])
        self.assertEqual(run["path"]["stray_rows"], 0)
        self.assertLess(run["path"]["deviation_um"], 1e-3)

    def test_a_jerk_above_the_limit_is_counted(self):
        bad = copy(good)
        bad.q[5000:, 1] += 12000 * 1e-9  # one step of the third difference: 12 000 mm/s3
        self.assertGreater(verify.check_limits(bad, device["Joints"])["joints"][1]["jerk_violations"], 0)

    def test_a_tighter_acceleration_limit_is_counted(self):
        peak = verify.check_limits(good, device["Joints"])["joints"][0]["peak_acceleration"]
        tight = [{**j, "MaxAcceleration": 0.9 * peak} for j in device["Joints"]]
        self.assertGreater(verify.check_limits(good, tight)["joints"][0]["acceleration_violations"], 0)

    def test_travel_beyond_the_limit_is_counted(self):
        tight = [{**j, "Min": -20} for j in device["Joints"]]
        self.assertGreater(verify.check_limits(good, tight)["joints"][0]["travel_violations"], 0)

    def test_a_lost_cycle_in_motion_is_counted_and_one_at_rest_is_not(self):
        table = good.table()
        bad = Record.from_table(np.delete(table, 4000, axis=0), 3)
        self.assertEqual(verify.check_limits(bad, device["Joints"])["lost_cycles"], 1)
        rest = np.repeat(table[:1], 500, axis=0)
        rest[:, 0] = np.arange(-500, 0) * 1e-3
        trimmed = Record.from_table(np.vstack([rest, table]), 3).without_long_rests(keep=10)
        self.assertLess(len(trimmed.t), len(good.t) + 40)
        self.assertEqual(verify.check_limits(trimmed, device["Joints"])["violations"], 0)

    def test_too_fast_a_feed_is_counted(self):
        slow = entities.Program(sweep.mechanism, sweep.part_origin_mm, [])
        slow.moves = [entities.Move(m.id, m.method, m.shape, 0.5 * m.feed_mm_min) for m in sweep.moves]
        self.assertGreater(verify.check_feed(good, slow)["violations"], 0)


class Path(unittest.TestCase):
    def test_a_path_off_by_5_um_is_found(self):
        bad = copy(good)
        rows = slice(len(bad.t) // 2, len(bad.t) // 2 + 50)
        bad.q[rows, 1] += 5e-3
        path = verify.check_path(bad, sweep, verify.setpoint_tips(bad, sweep))
        self.assertGreater(path["deviation_um"], 3.0)
        self.assertLess(path["deviation_um"], 5.1)
        self.assertIn(path["at_move"], bad.move[rows])

    def test_lines_and_arcs_of_the_rim_are_followed(self):
        record = synthesis.run(rim, held=[-25.0])
        path = verify.check_path(record, rim, verify.setpoint_tips(record, rim))
        self.assertLess(path["deviation_um"], 1e-6)
        self.assertEqual(path["unfinished_moves"], [])
        record.q[:, 0] += 2e-3
        self.assertGreater(verify.check_path(record, rim, verify.setpoint_tips(record, rim))["deviation_um"], 1.9)
        self.assertEqual(verify.check_held(record)[0]["position_mm"], -25.0)

    def test_a_move_left_out_is_found(self):
        table = good.table()
        bad = Record.from_table(table[table[:, 1] != 5], 3)
        self.assertIn(5, verify.check_path(bad, sweep, verify.setpoint_tips(bad, sweep))["unfinished_moves"])

    def test_a_following_error_is_found(self):
        bad = copy(good)
        bad.a[777, 2] += 0.040
        run = verify.check_run(bad, sweep, device)
        self.assertGreater(run["following"]["largest_um"], 35)
        self.assertLess(run["following_truth"]["largest_um"], 5)

    def test_a_load_that_hangs_behind_its_motor_is_found_in_the_truth_alone(self):
        bad = copy(good)
        bad.truth[:, 2] -= 0.040
        run = verify.check_run(bad, sweep, device)
        self.assertGreater(run["following_truth"]["largest_um"], 35)
        self.assertLess(run["following"]["largest_um"], 5)
        self.assertGreater(run["contour_truth_um"], run["contour_um"] + 20)

    def test_the_part_is_cut_where_the_tool_truly_was(self):
        deep, shown = copy(good), copy(good)
        deep.truth[:, 2] -= 0.050
        shown.a[:, 2] -= 0.050
        held = synthesis.run(rim, held=[plan["part_origin_mm"][2]])
        cut = [figures.machined(plan, {"sweep": record, "rim": held}, [sweep, rim]) for record in (good, deep, shown)]
        lowered = [float(np.nanmean((piece.z - cut[0].z)[cut[0].inside])) for piece in cut]
        self.assertLess(lowered[1], -0.001)
        self.assertEqual(lowered[2], 0.0)


class Part(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.surface = nurbs.Surface.read(HERE.parent / "headlight.json")
        cls.blank = part.blank(cls.surface, plan, y_range=(0.0, 1.6))

    def machined(self, tips):
        piece = part.HeightMap(**{**vars(self.blank), "z": self.blank.z.copy()})
        part.cut(piece, tips, plan["ball_radius_mm"], ball=True)
        piece.inside = self.blank.inside & (np.abs(piece.x[None, :]) < plan["part_half_mm"][0])
        return part.summary(piece)

    def test_exact_paths_leave_only_the_planned_ridges(self):
        result = self.machined(verify.setpoint_tips(good, sweep))
        self.assertLess(result["left_um"], plan["scallop_um"] + plan["fit_error_um"])
        self.assertGreater(result["left_um"], 0.5 * plan["scallop_um"])
        self.assertLess(result["gouge_um"], 1.0)

    def test_a_gouge_is_found(self):
        tips = verify.setpoint_tips(good, sweep)
        row = int(np.argmin(np.hypot(tips[:, 0] - 3, tips[:, 1]) + np.where(good.move > 3, 0, 1e3)))
        tips[row - 200 : row + 200, 2] -= 0.08
        self.assertGreater(self.machined(tips)["gouge_um"], 50)

    def test_what_was_not_machined_is_found(self):
        tips = verify.setpoint_tips(good, sweep)
        self.assertGreater(self.machined(tips[np.abs(tips[:, 0]) > 6])["left_um"], 100)


class Evaluator(unittest.TestCase):
    def test_a_rational_circle_is_round_and_its_derivatives_fit(self):
        root = np.sqrt(0.5)
        points = [[1, 0, 0], [1, 1, 0], [0, 1, 0]]
        circle = nurbs.Curve(2, [0, 0, 0, 1, 1, 1], points, [1, root, 1])
        t = np.linspace(0.1, 0.9, 9)
        p, d1, d2 = circle.evaluate(t, 2)
        self.assertLess(np.abs(np.linalg.norm(p, axis=1) - 1).max(), 1e-14)
        h = 1e-5
        self.assertLess(np.abs((circle(t + h) - circle(t - h)) / (2 * h) - d1).max(), 1e-8)
        self.assertLess(np.abs((circle(t + h) - 2 * p + circle(t - h)) / h**2 - d2).max(), 1e-4)

    def test_splines_agree_with_scipy(self):
        from scipy.interpolate import BSpline

        generator = np.random.default_rng(7)
        knots = np.concatenate([[0] * 6, np.sort(generator.uniform(0, 1, 12)), [1] * 6])
        poles = generator.normal(size=(18, 3))
        ours, theirs = nurbs.Curve(5, knots, poles), BSpline(knots, poles, 5)
        t = np.linspace(0, 1, 500)
        for order, value in enumerate(ours.evaluate(t, 3)):
            reference = theirs.derivative(order)(t) if order else theirs(t)
            self.assertLess(np.abs(value - reference).max(), 1e-9 * max(np.abs(reference).max(), 1))


class Headlight(unittest.TestCase):
    def test_the_surface_is_what_the_readme_says(self):
        import make_headlight

        surface = nurbs.Surface.read(HERE.parent / "headlight.json")
        facts = make_headlight.properties(surface)
        self.assertEqual(facts["size_mm"][:2], [80.0, 60.0])
        self.assertAlmostEqual(facts["size_mm"][2], 20, delta=0.5)
        self.assertGreater(facts["steepest_deg"], 45)
        self.assertGreater(facts["smallest_concave_radius_mm"], plan["ball_radius_mm"] + 0.5)
        self.assertLess(facts["smallest_convex_radius_mm"], 50)
        self.assertGreaterEqual(min(surface.points.shape[:2]), 8)
        self.assertGreaterEqual(min(surface.degrees), 3)

    def test_sweeps_are_fitted_within_a_micrometre(self):
        self.assertLess(plan["fit_error_um"], 1.0)
        self.assertGreater(plan["fit_error_um"], 0.01)

    def test_loops_continue_tangent_and_curvature_of_the_sweeps(self):
        splines = [m.shape.curve for m in sweep.moves if m.method == "MoveAlongNurbs"]
        self.assertGreater(len(splines), 8)
        for before, after in zip(splines, splines[1:]):
            states = []
            for curve, t in ((before, before.domain[1]), (after, after.domain[0])):
                p, d1, d2 = (x[0] for x in curve.evaluate([t], 2))
                speed = np.linalg.norm(d1)
                states.append((p, d1 / speed, np.cross(d1, d2) / speed**3))
            for one, other in zip(*states):
                self.assertLess(np.abs(one - other).max(), 1e-9)


if __name__ == "__main__":
    unittest.main()

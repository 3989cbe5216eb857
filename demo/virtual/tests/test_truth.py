"""What the demo holds the simulation and the machine against: part, chain, tool and clamp by formulas."""

import pathlib
import sys
import unittest

import numpy as np

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[1])]

import chain  # noqa: E402
import clamping  # noqa: E402
import clash  # noqa: E402
import dome  # noqa: E402
import sweeps  # noqa: E402
import swept  # noqa: E402

R = clamping.BALL_RADIUS
DRAW = np.random.default_rng(11)


def joints_of(poses):
    return np.array([chain.joints(pose) for pose in poses])


def upright(x, y, z):
    return np.array([x, y, z, 0, 0, 1.0])


def leaning(count):
    """Tips and axes at random, leaning up to 60 degrees."""
    tip = DRAW.uniform(-40, 40, (count, 3))
    lean, turn = np.radians(DRAW.uniform(1, 60, count)), DRAW.uniform(0, 2 * np.pi, count)
    return np.column_stack([tip, np.sin(lean) * np.cos(turn), np.sin(lean) * np.sin(turn), np.cos(lean)])


class Part(unittest.TestCase):
    def test_its_slopes_are_those_of_its_height(self):
        x, y = DRAW.uniform(-35, 35, (2, 200))
        d = 1e-5
        for told, moved in zip(dome.slopes(x, y), ((d, 0), (0, d))):
            by_difference = (dome.height(x + moved[0], y + moved[1]) - dome.height(x - moved[0], y - moved[1])) / (2 * d)
            np.testing.assert_allclose(told, by_difference, atol=1e-8)

    def test_its_mesh_is_closed_and_its_normals_point_outwards(self):
        points, triangles = dome.mesh(2)
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        forth, back = ({tuple(edge) for edge in some.tolist()} for some in (edges, edges[:, ::-1]))
        self.assertEqual(forth, back, "an edge has no partner that runs the other way")
        self.assertEqual(len(forth), len(edges), "two triangles have an edge the same way round")
        a, b, c = (points[triangles[:, n]] for n in range(3))
        x, y = np.meshgrid(np.linspace(-30, 30, 601), np.linspace(-20, 20, 401))
        volume = np.trapz(np.trapz(dome.height(x, y), dx=0.1, axis=1), dx=0.1)
        self.assertAlmostEqual(np.einsum("ij,ij->", a, np.cross(b, c)) / 6 / volume, 1, delta=1e-3)


class Chain(unittest.TestCase):
    def test_joints_bring_the_tool_where_it_is_wanted(self):
        poses = leaning(300)
        joints = joints_of(poses)
        np.testing.assert_allclose(chain.places(joints, 0), poses[:, :3], atol=1e-9)
        np.testing.assert_allclose(chain.places(joints, 1) - chain.places(joints, 0), poses[:, 3:], atol=1e-9)
        self.assertLessEqual(np.abs(joints[:, 4]).max(), 90)

    def test_an_upright_tool_is_as_far_below_z_as_it_is_long(self):
        tip = chain.places(np.array([[3, 4, 50, 0, 0.0]]), 0)[0] + clamping.PART_FRAME
        np.testing.assert_allclose(tip, [3, 4, 50 - clamping.TOOL_LENGTH])

    def test_a_positive_a_leans_the_tool_to_minus_y(self):
        motion = swept.motion(np.array([[0, 0, 50, 30, 0.0]]))
        np.testing.assert_allclose(motion.axis[0], [0, -0.5, np.sqrt(0.75)], atol=1e-12)


class Swept(unittest.TestCase):
    def slot(self):
        return swept.motion(joints_of([upright(x, 0, 10) for x in np.linspace(-20, 20, 401)]))

    def test_a_ball_leaves_a_round_slot(self):
        turn = np.radians([-80, -30, 0, 45])
        for off in (-0.01, 0.0, 0.02):
            floor = np.column_stack([0.03 + 0 * turn, (R + off) * np.sin(turn), 10 + R - (R + off) * np.cos(turn)])
            np.testing.assert_allclose(swept.left_over(floor, self.slot()), off, atol=1e-6)

    def test_its_straight_part_leaves_straight_walls_as_high_as_it_cuts(self):
        walls = np.array([[0, R + 0.5, 10 + R + 3], [0, -R + 0.25, 10 + R + 9]])
        np.testing.assert_allclose(swept.left_over(walls, self.slot()), [0.5, -0.25], atol=1e-6)
        above = [[0, 0, 10 + clamping.CUTS_UP_TO + 1]]
        self.assertTrue(np.isinf(swept.from_straight_part(np.array(above), self.slot()))[0])

    def test_a_leaning_tool_leaves_what_single_places_of_it_say(self):
        poses = np.linspace(*leaning(2), 4000)
        poses[:, 3:] /= np.linalg.norm(poses[:, 3:], axis=1, keepdims=True)
        motion = swept.motion(joints_of(poses))
        far = R * DRAW.uniform(0.7, 1.3, 60)
        direction = DRAW.normal(size=(60, 3))
        points = poses[DRAW.integers(4000, size=60), :3] + far[:, None] * direction / np.linalg.norm(direction, axis=1, keepdims=True)
        for point, told in zip(points, swept.left_over(points, motion)):
            way = point - poses[:, :3]
            up = np.einsum("ij,ij->i", way, poses[:, 3:])
            across = np.linalg.norm(way - up[:, None] * poses[:, 3:], axis=1)
            ball = np.hypot(across, up - R) - R
            straight = np.where((up >= R) & (up <= clamping.CUTS_UP_TO), across - R, np.inf)
            self.assertAlmostEqual(told, np.minimum(ball, straight).min(), delta=2e-3)

    def test_rests_are_left_out_and_no_way_is_lost(self):
        slot = self.slot()
        middle = np.concatenate([np.repeat(slot.middle[:1], 50, axis=0), slot.middle, np.repeat(slot.middle[-1:], 50, axis=0)])
        moving = swept.moving(swept.Motion(middle, np.repeat(slot.axis[:1], len(middle), axis=0)))
        np.testing.assert_allclose(moving.middle, slot.middle)

    def test_a_place_out_of_the_block_is_as_far_out_as_it_is(self):
        places = np.array([[0, 0, 1.0], [0, 0, -2.0], [33, 24, 10], [29.5, 0, 10]])
        np.testing.assert_allclose(swept.out_of_stock(places), [-1, 2, 5, -0.5])


class Clash(unittest.TestCase):
    def beside_stud(self, gap, above_lower_end):
        """An upright tool whose holder has the stud's top so far above its lower end, and its side so far away there."""
        x, y = clamping.STUD_PLACE
        z = clamping.STUD_TOP - clamping.HOLDER_FROM - above_lower_end
        return joints_of([upright(x, y - clamping.STUD_RADIUS - clash.LOW - clash.SLANT * above_lower_end - gap, z)])

    def test_a_holder_beside_the_stud_is_as_far_away_as_it_is(self):
        level = np.hypot(1, clash.SLANT)
        for gap in (0.5, 2.0, -0.3):
            self.assertAlmostEqual(clash.gaps(self.beside_stud(gap, 10))[0], gap / level, delta=0.01)

    def test_a_holder_over_the_stud_is_as_high_as_it_is(self):
        self.assertAlmostEqual(clash.gaps(self.beside_stud(-10, -0.7))[0], 0.7, delta=1e-6)

    def test_past_its_lower_edge_the_way_is_the_hypotenuse(self):
        self.assertAlmostEqual(clash.from_holder(clamping.HOLDER_FROM - 3, clash.LOW + 4), 5)


class Sweeps(unittest.TestCase):
    def test_the_ball_touches_the_surface_and_a_micrometre_beside_is_told(self):
        spline = sweeps.sweep(7.0, -1, 1)
        self.assertLess(sweeps.off_surface_um(spline), 0.02)
        spline.c[:, 2] += 1e-3
        self.assertAlmostEqual(sweeps.off_surface_um(spline), 1, delta=0.1)

    def test_a_loop_goes_on_with_tangent_and_curvature_and_meets_the_next_sweep_alike(self):
        before, behind = sweeps.sweep(3.0, 1, -1), sweeps.sweep(2.0, -1, -1)
        loop = sweeps.loop(before, behind)
        curve = sweeps.BSpline(loop.knots, loop.points, loop.degree)
        for order in range(3):
            np.testing.assert_allclose(curve(0, order), before(before.t[-1], order), atol=1e-9)
            np.testing.assert_allclose(curve(sweeps.LOOP, order), behind(behind.t[0], order), atol=1e-9)

    def test_loops_stay_beside_the_block(self):
        for ways in (1, -1):
            loop = sweeps.loop(sweeps.sweep(3.0, ways, 1), sweeps.sweep(-2.0, -ways, 1))
            at = sweeps.BSpline(loop.knots, loop.points, loop.degree)(np.linspace(0, sweeps.LOOP, 200))
            middle = at[:, :3] + R * at[:, 3:] / np.linalg.norm(at[:, 3:], axis=1, keepdims=True)
            self.assertGreaterEqual((ways * middle[:, 0]).min(), dome.LENGTH / 2 + R - 1e-6)

    def test_programs_lean_to_either_side(self):
        self.assertGreater(sweeps.axis(0, 0, 1)[1], 0.3)
        self.assertLess(sweeps.axis(0, 0, -1)[1], -0.3)

    def test_moves_begin_where_the_ones_before_end(self):
        ends = None
        for request in sweeps.program(4, -1):
            params = request["params"]
            if "NurbsND" in params:
                first, last = (np.array(params["NurbsND"]["points"][n]) for n in (0, -1))
            elif "StartPoint" in params:
                first, last = (np.array(params[name]["p"] + params[name]["axis"]) for name in ("StartPoint", "EndPoint"))
            else:
                continue
            if ends is not None:
                np.testing.assert_allclose(first, ends, atol=1e-9)
            ends = last


if __name__ == "__main__":
    unittest.main()

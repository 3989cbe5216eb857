"""Moves and curves as they go out, what is left of them in their midst, and what is refused before it is sent."""

import json
import math
import random
import unittest

import rmac
from rmac import Arc, ArcThrough, InvalidValue, Line, MoveJoints, MoveTo, Nurbs, NurbsCurve, Pose, PoseNurbs
from rmac.geometry import splines

try:
    import numpy
    from scipy import interpolate
except ImportError:
    numpy = interpolate = None


def homogeneous(curve):
    return [(*(w * x for x in place), w) for place, w in zip(curve.points, curve.weights or (1.0,) * len(curve.points))]


def at(curve, u):
    *place, w = splines.value(curve.degree, curve.knots, homogeneous(curve), u)
    return [x / w for x in place]


def random_curve(draw, degree, count):
    inner = sorted(draw.random() for _ in range(count - degree - 1))
    points = [[draw.uniform(-10, 10) for _ in range(3)] for _ in range(count)]
    return NurbsCurve(degree, [0] * (degree + 1) + inner + [1] * (degree + 1), points, [draw.uniform(0.5, 2) for _ in range(count)])


def arc_place(arc, t):
    """Where it is at a part of its way; written down from the arc's definition, with sines."""
    a, c = arc.begin.p, arc.center.p
    sense = -1 if arc.clockwise else 1
    start = math.atan2(a[1] - c[1], a[0] - c[0])
    stop = math.atan2(arc.target.p[1] - c[1], arc.target.p[0] - c[0])
    turn = sense * (stop - start) % (2 * math.pi)
    whole = (2 * math.pi if arc.closed else turn) + 2 * math.pi * arc.turns
    radius = math.hypot(a[0] - c[0], a[1] - c[1])
    angle = start + sense * whole * t
    return (c[0] + radius * math.cos(angle), c[1] + radius * math.sin(angle), a[2] + (arc.target.p[2] - a[2]) * t), math.hypot(whole * radius, arc.target.p[2] - a[2])


class MovesTest(unittest.TestCase):
    def test_what_goes_out_is_what_the_protocol_wants(self):
        self.assertEqual(
            Line((0, 0, 0), Pose((1, 2, 3), (1, 0, 0))).request(7),
            {"method": "RMAC_CAM.MoveAlongLine", "params": {"MoveID": 7, "StartPoint": {"p": [0, 0, 0], "axis": [0, 0, 1]}, "EndPoint": {"p": [1, 2, 3], "axis": [1, 0, 0]}}})
        self.assertEqual(Arc((1, 0, 0), (0, 1, 0), (0, 0, 0), clockwise=True, turns=2).request()["params"]["Turns"], 2)
        self.assertEqual(MoveJoints([1, 2]).request()["params"]["JointTargetFrame"], {"joints": [1, 2]})
        self.assertEqual(MoveTo(Pose((0, 0, 0), q=(1, 0, 0, 0))).request()["params"]["TargetFrame"], {"p": [0, 0, 0], "q": [1, 0, 0, 0]})
        self.assertEqual(rmac.output("Laser", True).request(3)["params"], {"MoveID": 3, "Calls": [{"method": "RMAC_CAM.SetOutput", "params": {"Name": "Laser", "On": True}}]})
        self.assertEqual(rmac.Dwell(1.5).request(4)["params"], {"MoveID": 4, "Time": 1.5})
        self.assertEqual(rmac.tool_change(3).request(), {"method": "RMAC_CAM.DoToolChange", "params": {"ToolNumber": 3}})

    def test_numbers_keep_all_their_digits(self):
        for seed in range(200):
            place = [random.Random(seed).uniform(-1e3, 1e3) for _ in range(3)]
            self.assertEqual(json.loads(MoveTo(place).params(0))["TargetFrame"]["p"], place)

    def test_what_is_no_place_is_refused_with_its_name(self):
        for wrong, told in (((0, math.nan, 0), "finite"), ((0, 0), "2 numbers"), ("abc", "numbers"), (None, "numbers"), ((0, 0, math.inf), "finite"),
                            ((0, 0, 0, 0, 0, 2), "length 2"), (5, "numbers"), ([[0, 0, 0]], "numbers"),
                            ("123", "numbers"), (("0", "0", "0"), "numbers"), ((1j, 0, 0), "numbers")):
            with self.subTest(wrong=wrong), self.assertRaisesRegex(InvalidValue, told):
                Line((0, 0, 0), wrong)
        with self.assertRaisesRegex(InvalidValue, "Arc: center"):
            Arc((0, 0, 0), (1, 0, 0), (math.nan, 0, 0))
        for turns in (0.5, -1, math.nan, "two"):
            with self.assertRaisesRegex(InvalidValue, "Arc: turns"):
                Arc((0, 0, 0), (0, 0, 0), (1, 0, 0), closed=True, turns=turns)
        with self.assertRaisesRegex(InvalidValue, "not both"):
            Pose((0, 0, 0), (0, 0, 1), q=(1, 0, 0, 0))

    def test_what_cannot_be_sent_between_moves_is_refused_where_it_is_made(self):
        for make in (lambda: rmac.InTurn(rmac.calls.RMAC_CAM.SetFeedrate(math.nan)), lambda: rmac.ProgramStop(object()),
                     lambda: rmac.MoveTo((10**400, 0, 0))):
            with self.assertRaises(rmac.InvalidValue):
                make()

    def test_curves_that_are_none_are_refused_with_the_reason(self):
        points = [(0, 0, 0), (1, 0, 0), (2, 0, 0)]
        for make, told in (
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1], points), "5 knots do not fit 3 control points of degree 2: 6 do"),
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1, 0.5], points), "knot 5"),
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1, 1], points, [1, 0, 1]), "weight 1 is 0"),
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1, 1], points, [1, 1]), "weights .* needs 3"),
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1, 1], [(0, 0, 0), (1, 0), (2, 0, 0)]), "as many coordinates"),
            (lambda: NurbsCurve(2, [0, 0, 0, 1, 1, 1], [(0, 0, 0), (math.nan, 0, 0), (2, 0, 0)]), "control point 1"),
            (lambda: NurbsCurve(26, [], points), "1 to 25"),
            (lambda: NurbsCurve(2.5, [], points), "degree is 2.5: give a whole number"),
            (lambda: NurbsCurve(math.inf, [], points), "degree is .*inf"),
            (lambda: NurbsCurve(2, [0, 1], points, multiplicities=[2.5, 3]), "multiplicity is 2.5: give a whole number"),
            (lambda: NurbsCurve(2, [0, 1], points, multiplicities=[3, 1e18]), "no degree takes more than 26"),
            (lambda: NurbsCurve(2, [0, 1], 5), "control points are 5"),
            (lambda: Nurbs("x"), "'x' is no curve"),
            (lambda: rmac.JointNurbs([(0, 0)]), "is no curve"),
            (lambda: NurbsCurve(2, [1, 1, 1, 1, 1, 1], points), "no length"),
            (lambda: Nurbs(NurbsCurve(1, [0, 0, 1, 1], [(0, 0), (1, 1)])), "3 coordinates, and this curve has 2; give it a z"),
            (lambda: PoseNurbs(NurbsCurve(1, [0, 0, 1, 1], [(0, 0, 0), (1, 1, 1)])), "6 coordinates"),
            (lambda: NurbsCurve(3, [0, 1, 2, 3], points, periodic=True), "multiplicities"),
            (lambda: NurbsCurve(3, [0, 1, 2, 3, 4], points, multiplicities=[1] * 5, periodic=True), "4 control points, not 3"),
        ):
            with self.subTest(told=told), self.assertRaisesRegex(InvalidValue, told):
                make()

    def test_what_is_left_of_a_line_an_arc_or_a_curve_begins_where_the_machine_is(self):
        for seed in range(100):
            draw = random.Random(seed)
            t = draw.random()
            line = Line([draw.uniform(-9, 9) for _ in range(3)], [draw.uniform(-9, 9) for _ in range(3)])
            left = line.rest(t * math.dist(line.start, line.end))
            self.assertLess(math.dist(left.start, [(1 - t) * a + t * b for a, b in zip(line.start, line.end)]), 1e-9)
            self.assertEqual(left.end, line.end)
            c, r, angle = [draw.uniform(-9, 9) for _ in range(3)], draw.uniform(1, 9), draw.uniform(0, 7)
            start = (c[0] + r * math.cos(angle), c[1] + r * math.sin(angle), draw.uniform(-1, 1))
            turn = draw.uniform(0.1, 6)
            end = (c[0] + r * math.cos(angle + turn), c[1] + r * math.sin(angle + turn), draw.choice((start[2], 3)))
            closed = draw.random() < 0.3
            arc = Arc(start, (*start[:2], end[2]) if closed else end, c, clockwise=draw.random() < 0.5, closed=closed, turns=draw.randint(0, 2))
            place, length = arc_place(arc, t)
            left = arc.rest(t * length)
            self.assertLess(math.dist(left.start, place), 1e-9, f"seed {seed}")
            again, rest = arc_place(left, 0.5)
            self.assertAlmostEqual(rest, (1 - t) * length, places=7, msg=f"seed {seed}")
            self.assertLess(math.dist(again, arc_place(arc, (1 + t) / 2)[0]), 1e-8, f"seed {seed}")

    def test_an_arc_through_a_place_is_taken_up_on_its_circle(self):
        arc = ArcThrough((1, 0, 0), (math.sqrt(0.5), 0, math.sqrt(0.5)), (0, 0, 1))
        left = arc.rest(math.pi / 6)
        self.assertLess(math.dist(left.start, (math.cos(math.pi / 6), 0, math.sin(math.pi / 6))), 1e-12)

    def test_what_is_behind_leaves_nothing_and_what_rests_anywhere_stays(self):
        self.assertIsNone(Line((0, 0, 0), (1, 0, 0)).rest(1))
        self.assertIsNone(Arc((1, 0, 0), (0, 1, 0), (0, 0, 0)).rest(2))
        self.assertIsNone(Nurbs(random_curve(random.Random(1), 3, 6)).rest(1e6))
        self.assertIsInstance(MoveTo((0, 0, 0)).rest(5), MoveTo)
        with self.assertRaises(rmac.CannotResume):
            rmac.JointNurbs(random_curve(random.Random(1), 3, 6)).rest(0.1)


class NurbsTest(unittest.TestCase):
    def test_a_piece_is_the_same_curve(self):
        for seed in range(20):
            draw = random.Random(seed)
            degree = draw.randint(1, 6)
            curve = random_curve(draw, degree, degree + draw.randint(1, 12))
            measure = splines.Measure(curve.degree, list(curve.knots), homogeneous(curve), 3)
            whole = sum(measure.length(a, b) for a, b in zip(measure._breaks, measure._breaks[1:]))
            length = draw.random() * whole * 0.9
            left = curve.rest(length, 3)
            begin = measure.parameter(length)
            for u in (begin, begin + 0.3 * (1 - begin), 1):
                self.assertLess(math.dist(at(left, u), at(curve, u)), 1e-9, f"seed {seed}")
            # By a sum of chords, so many in every span, the way to where it was cut is as long as was asked for.
            breaks = [u for u in sorted(set(curve.knots)) if u < begin] + [begin]
            places = [at(curve, a + (b - a) * number / 2000) for a, b in zip(breaks, breaks[1:]) for number in range(2001)]
            self.assertAlmostEqual(sum(map(math.dist, places, places[1:])), length, delta=1e-4 * whole, msg=f"seed {seed}")

    def test_a_periodic_curve_of_a_cad_kernel_is_the_closed_one(self):
        # A circle as OpenCASCADE has it: rational, degree 2, six poles, three knots of multiplicity 2 in a turn.
        poles, weights = [], [1, 0.5] * 3
        for third in range(3):
            angle = 2 * math.pi * third / 3
            poles += [(math.cos(angle), math.sin(angle), 0), (2 * math.cos(angle + math.pi / 3), 2 * math.sin(angle + math.pi / 3), 0)]
        circle = NurbsCurve(2, [0, 1, 2, 3], poles, weights, multiplicities=[2, 2, 2, 2], periodic=True)
        for number in range(31):
            self.assertAlmostEqual(math.hypot(*at(circle, number / 10)), 1, places=12)
        self.assertLess(math.dist(circle.points[0], circle.points[-1]), 1e-12)
        self.assertEqual(circle.knots[:3] + circle.knots[-3:], (0, 0, 0, 3, 3, 3))

    @unittest.skipIf(interpolate is None, "needs scipy")
    def test_splines_of_scipy_are_the_same_curve_clamped_or_not_periodic_or_not(self):
        draw = numpy.random.default_rng(5)
        turn = numpy.linspace(0, 2 * numpy.pi, 15)
        round_ = numpy.c_[numpy.cos(turn), numpy.sin(2 * turn), numpy.sin(turn)]
        round_[-1] = round_[0]
        splined = [interpolate.make_interp_spline(turn, round_, k=3, bc_type="periodic"), interpolate.make_interp_spline(turn, round_, k=5)]
        splined += [interpolate.BSpline(numpy.sort(draw.random(9 + k + 1)), draw.random((9, 3)), k) for k in (1, 2, 3, 4)]
        for spline in splined:
            curve = NurbsCurve.from_scipy(spline)
            for u in numpy.linspace(curve.knots[0], curve.knots[-1], 41):
                self.assertLess(numpy.abs(at(curve, u) - spline(u)).max(), 1e-12)
        tck, _ = interpolate.splprep(round_.T, s=0)
        curve = NurbsCurve.from_scipy(tck)
        self.assertLess(numpy.abs(at(curve, 0.3) - numpy.array(interpolate.splev(0.3, tck))).max(), 1e-12)
        self.assertEqual(NurbsCurve.from_scipy(interpolate.splprep(round_.T, s=0)), curve)

    @unittest.skipIf(interpolate is None, "needs scipy")
    def test_splines_of_scipy_that_are_no_curve_in_space_are_told_so(self):
        flat = interpolate.make_interp_spline([0, 1, 2, 3], [(0, 0), (1, 0), (1, 1), (0, 1)])
        with self.assertRaisesRegex(InvalidValue, "give it a z"):
            Nurbs(NurbsCurve.from_scipy(flat))
        with self.assertRaisesRegex(InvalidValue, "one coordinate"):
            NurbsCurve.from_scipy(interpolate.make_interp_spline([0, 1, 2, 3], [0, 1, 4, 9]))
        with self.assertRaisesRegex(InvalidValue, "no BSpline"):
            NurbsCurve.from_scipy(7)

    @unittest.skipIf(numpy is None, "needs numpy")
    def test_numpys_arrays_and_scalars_are_places(self):
        line = Line(numpy.zeros(3), numpy.array([1, 2, 3], dtype=numpy.int32))
        self.assertEqual(json.loads(line.params(1))["EndPoint"]["p"], [1, 2, 3])
        self.assertEqual(json.loads(MoveTo(numpy.float32([0.5, 0, 0])).params(1))["TargetFrame"]["p"], [0.5, 0, 0])
        with self.assertRaisesRegex(InvalidValue, "numbers"):
            MoveTo(numpy.array([1j, 0, 0]))
        self.assertEqual(len(list(rmac.polyline(numpy.arange(12.0).reshape(4, 3)))), 3)
        with self.assertRaisesRegex(InvalidValue, "finite"):
            list(rmac.polyline(numpy.full((2, 3), numpy.nan)))


if __name__ == "__main__":
    unittest.main()

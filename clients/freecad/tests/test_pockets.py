"""Pockets: what is cut is told by code that shares nothing with what made the way (pocket_check.py), and what is refused."""

import json
import math
import os
import sys
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import numpy as np
import Part
import Sketcher  # noqa: F401  its type of objects
from appliance import BUILD
from pocket_check import Cut, Flat, at, blob, nearest_of, rounded, seeded_face
from rmac_freecad.pockets import Pocket, PocketRefused, outline_of, read_pocket
from rmac_freecad.profiles import ProfileRefused
from rmac_freecad.simulation import simulate

import rmac  # isort: skip

GIVEN = {"tool": 1, "radius_mm": 2.0, "top_mm": 0.0, "depth_mm": 2.5, "step_down_mm": 1.0, "step_over_mm": 1.6, "safe_mm": 5.0, "feed_mm_min": 600.0,
         "plunge_mm_min": 200.0, "spindle_rpm": 800.0}  # fmt: skip
WAYS = ({}, {"order": "outside in"}, {"entry": "ramp", "ramp_deg": 5.0}, {"climb": False, "step_over_mm": 3.6}, {"step_over_mm": 2.9, "order": "outside in"})
GOUGE_MM = 0.001
LEFT_MM = 0.001
SEEDS = range(32)
PLACES, APART_MM = 1500, 0.2  # at random; of a grid


class PocketTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("pockets")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def outline(self, shape, face="Face1"):
        feature = self.document.addObject("Part::Feature", "Cut")
        feature.Shape = shape
        return outline_of(feature, face)

    def cleared(self, shape, **given):
        return read_pocket("Pocket", self.outline(shape), Pocket(**{**GIVEN, **given}), rapid_mm_min=2000)

    def refused(self, shape, *words, **given):
        with self.assertRaises(PocketRefused) as refused:
            self.cleared(shape, **given)
        for word in words:
            self.assertIn(word, str(refused.exception))

    def check(self, face, seed=0, **given):
        """All that is promised of any pocket."""
        pocket = Pocket(**{**GIVEN, **given})
        made = self.cleared(face, **given)
        cut, flat = Cut(made.program, pocket.top_mm), Flat(face)
        gouge = cut.gouge(flat, pocket.radius_mm)
        self.assertLess(gouge, GOUGE_MM)
        places = flat.places(PLACES, seed)
        centres = flat.centres(pocket.radius_mm, APART_MM)
        off = nearest_of(centres, places) - pocket.radius_mm
        self.check_depths(cut, pocket)
        self.assertLess(cut.uncut(places[off <= 0], pocket.radius_mm, cut.floors()[-1]), LEFT_MM)
        self.assertEqual(made.missed, ())
        self.check_area(made, face, (off > APART_MM).mean(), (off > 0).mean())
        return made, gouge

    def check_depths(self, cut, pocket):
        floors = cut.floors()
        self.assertAlmostEqual(floors[-1], pocket.top_mm - pocket.depth_mm, 9)
        above = dict(zip(floors, [pocket.top_mm, *floors]))
        for z, before in above.items():
            self.assertLessEqual(before - z, pocket.step_down_mm + 1e-9)
        slopes = cut.slopes()
        self.assertLessEqual(slopes.max(), pocket.ramp_deg)
        self.assertGreater(slopes.max(), pocket.ramp_deg * (0.99 if pocket.entry == "ramp" else 0.4))
        self.assertGreater(slopes.min(), -1e-9)
        self.check_rapids(cut, pocket, floors)
        ways = [sorted((type(move).__name__, *np.round((*move.start[:2], *move.end[:2]), 6)) for move in cut.level(z)) for z in floors]
        self.assertEqual(ways, [ways[0]] * len(floors))

    def check_rapids(self, cut, pocket, floors):
        """Sideways at the safe height alone; down no deeper than where a whole level was cleared, and so are plunges at feed."""
        lowest, ahead = pocket.top_mm, [(z, len(cut.level(z))) for z in floors]
        for before, move in zip(cut.moves, cut.moves[1:]):
            straight_down = math.dist(before.end[:2], move.end[:2]) < 1e-9 and not isinstance(move, rmac.Arc)
            if move.start is not None:
                self.assertEqual(tuple(move.start), tuple(before.end))  # the appliance takes no other
            if isinstance(move, rmac.MoveTo):
                self.assertTrue(straight_down or before.end[2] == move.end[2] == pocket.safe_mm)
            if straight_down and move.end[2] < before.end[2]:
                self.assertGreater(move.end[2], lowest - 1e-9)
            elif move.start is not None and ahead and abs(move.start[2] - ahead[0][0]) < 1e-9 and abs(move.end[2] - ahead[0][0]) < 1e-9:
                z, more = ahead[0]
                ahead[0] = z, more - 1
                if more == 1:
                    lowest = z
                    ahead.pop(0)
        self.assertEqual(ahead, [])

    def check_area(self, made, face, least, most):
        """What the tool does not get into, between shares of places as chance would have them."""
        told = sum(spot.area_mm2 for spot in made.unreached) / face.Area
        chance = 4 * math.sqrt(max(most, 1e-3) / PLACES)
        self.assertAlmostEqual(made.area_mm2, face.Area, delta=5e-5 * face.Area)
        self.assertTrue(least - chance < told < most + chance, (least, told, most))


class SeededTest(PocketTest):
    def test_no_wall_is_cut_into_and_all_that_can_be_reached_is_cut_at_the_step_and_the_angle(self):
        worst, kinds = -math.inf, set()
        for seed in SEEDS:
            kind, face = seeded_face(seed)
            given = WAYS[(seed + seed // 8) % len(WAYS)]
            with self.subTest(seed=seed, kind=kind, given=given):
                _, gouge = self.check(face, seed, **given)
                worst = max(worst, gouge)
                kinds.add(kind)
        print(f"{len(SEEDS)} pockets of {len(kinds)} kinds: cut into by {1e3 * worst:.3f} um at most")


if __name__ == "__main__":
    unittest.main()

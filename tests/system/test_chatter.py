"""`rmac simulate --dynamics`: how far the tool bends, and where it chatters, as a user sees it."""

import math
import unittest

from test_collisions import LENGTH
from test_forces import MATERIAL, TEETH, TOOL, SimulatedCut, slot

RPM, FEED, DEPTH = 3000, 600, 1.0
MODE = {"Frequency": 250, "DampingRatio": 0.03, "Stiffness": 10000}


def tool(**shape):
    return TOOL | {"Shape": TOOL["Shape"] | shape}


def holder(sticks_out):
    return [{"Cylinder": {"Radius": 20, "Height": LENGTH - sticks_out}}]


class Chatter(SimulatedCut):
    def dynamics(self, depth, rpm=RPM, **shape):
        report, done = self.report(slot(depth, FEED * rpm / RPM, rpm), "--dynamics", tool=tool(**shape))
        return report["dynamics"], done

    def test_a_cut_that_chatters_is_told_with_what_would_not(self):
        found, done = self.dynamics(DEPTH, Modes=[MODE])
        self.assertEqual(done.returncode, 1)
        self.assertEqual(len(found["chatter"]), 1)
        chatter = found["chatter"][0]
        self.assertEqual((chatter["line"], chatter["move_id"], chatter["rpm"]), (4, 2, RPM))
        self.assertGreater(chatter["until_s"], chatter["t_s"])
        self.assertLess(chatter["from_percent"], 100)
        self.assertEqual(chatter["from_percent"], found["chatter_from_percent"])
        self.assertGreater(chatter["frequency_hz"], MODE["Frequency"])
        self.assertLess(chatter["frequency_hz"], 1.5 * MODE["Frequency"])
        self.assertIn("1 cuts chatter, first in line 4", done.stderr)
        self.assertIsNone(found["keeps_at_percent"])
        shallower, done = self.dynamics(DEPTH * 0.9 * chatter["from_percent"] / 100, Modes=[MODE])
        self.assertEqual((shallower["chatter"], done.returncode), ([], 0), done.stderr)
        self.assertAlmostEqual(shallower["chatter_from_percent"], 100 / 0.9, delta=4)
        faster, done = self.dynamics(DEPTH, rpm=chatter["steady_rpm"], Modes=[MODE])
        self.assertEqual((faster["chatter"], done.returncode), ([], 0), done.stderr)
        self.assertIn("CHATTER", self.run_rmac(slot(DEPTH, FEED, RPM), "--dynamics", tool=tool(Modes=[MODE])).stdout)

    def test_a_stiffer_tool_bears_so_much_more(self):
        soft, stiff = (self.dynamics(DEPTH, Modes=[MODE | {"Stiffness": k}])[0]["chatter_from_percent"] for k in (10000, 30000))
        self.assertAlmostEqual(stiff / soft, 3, delta=0.01)

    def test_a_tool_bends_beside_its_path_by_the_force_across_it(self):
        depth = 2
        stiff, _ = self.dynamics(depth, Modes=[MODE | {"Stiffness": 1e7}])
        soft = MODE | {"Stiffness": 20000, "Frequency": 2000, "DampingRatio": 0.1}
        found, done = self.dynamics(depth, Modes=[soft])
        self.assertEqual(done.returncode, 0, done.stderr)
        # The mean of a slot across its feed, by the textbook; its edge is longer for the helix.
        per_tooth = FEED / (RPM * TEETH)
        force = TEETH * depth * (MATERIAL["Ktc"] * per_tooth / 4 + MATERIAL["Kte"] / math.pi / math.cos(math.radians(30)))
        self.assertAlmostEqual(found["path_peak_mm"], force / 20000, delta=0.1 * force / 20000 + stiff["path_peak_mm"])

    def test_by_what_it_is_made_of_a_tool_bends_more_the_longer_it_sticks_out(self):
        def across(**shape):
            found = self.dynamics(1, **shape)[0]
            return found["path_peak_mm"], found["chatter_from_percent"]
        carbide, steel, long = (across(BMC=code, Holder=holder(out)) for code, out in (("HM", 20), ("HSS", 20), ("HM", 30)))
        self.assertAlmostEqual(steel[0] / carbide[0], 580 / 220, delta=0.3)
        self.assertLess(steel[1], carbide[1])
        self.assertGreater(long[0], 2 * carbide[0])
        self.assertLess(long[1], carbide[1])

    def test_what_nobody_knows_of_the_tool_is_told_as_loudly(self):
        found, done = self.dynamics(2)
        self.assertEqual((done.returncode, found["chatter"], found["chatter_from_percent"]), (1, [], None))
        self.assertEqual(found["not_told"], [
            "how far tool 7 bends, and whether it chatters: its Shape does not say how it gives way; give BMC in the tool table, or the Modes of its tip"])

    def test_modes_that_cannot_be_are_refused(self):
        for mode, word in ((MODE | {"DampingRatio": 0}, "/Tools/0/Shape/Modes/0/DampingRatio is 0"),
                           (MODE | {"Stiffness": -5}, "/Tools/0/Shape/Modes/0/Stiffness is -5"),
                           (MODE | {"Frequency": "700"}, "/Tools/0/Shape/Modes/0/Frequency")):
            done = self.run_rmac(slot(2, FEED, RPM), "--dynamics", tool=tool(Modes=[mode]))
            self.assertEqual(done.returncode, 1)
            self.assertIn(word, done.stderr)
        self.assertIn("/Tools/0/Shape/BMC", self.run_rmac(slot(2, FEED, RPM), tool=tool(BMC="wood")).stderr)


if __name__ == "__main__":
    unittest.main()

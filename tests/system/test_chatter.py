"""`rmac simulate --dynamics`: how far the tool bends, and where it chatters, as a user sees it."""

import json
import math
import shutil
import unittest

from appliance import BUILD, pose
from bending_mill import rigid
from test_collisions import LENGTH, request, to
from test_forces import BEYOND, MATERIAL, TEETH, TOP, TOOL, SimulatedCut, slot

RPM, FEED, DEPTH = 3000, 600, 1.0
MODE = {"Frequency": 250, "DampingRatio": 0.03, "Stiffness": 10000}


def tool(**shape):
    return TOOL | {"Shape": TOOL["Shape"] | shape}


def holder(sticks_out):
    return [{"Cylinder": {"Radius": 20, "Height": LENGTH - sticks_out}}]


class Chatter(SimulatedCut):
    """On rigid axes: what gives way is the tool."""

    def setUp(self):
        super().setUp()
        self.tree = self.folder / "drivers"
        shutil.copytree(BUILD / "drivers", self.tree)
        file = self.tree / "mill/5-axis/SuginoXYZAC/device.json"
        device = json.loads(file.read_text())
        rigid(device)
        file.write_text(json.dumps(device))

    def run_rmac(self, requests, *words, **options):
        return super().run_rmac(requests, "--device-tree", self.tree, *words, **options)

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

    def test_a_tool_that_would_break_is_told_and_swings_with_no_force_of_its_own(self):
        """Red when the tip's own bending counted as feed, and forces grew with it."""
        stiff, weak = (self.report(slot(2, FEED, RPM), "--dynamics", tool=tool(Modes=[MODE | {"Stiffness": k}]))[0] for k in (1e6, 20))
        self.assertIn("tool 7 would bend by more than 0.3 mm, a twentieth of its diameter, first in line 4", weak["dynamics"]["not_told"][0])
        self.assertLess(weak["dynamics"]["path_peak_mm"], 0.35)
        for key in ("mean_force_n", "peak_force_n"):
            self.assertAlmostEqual(weak["forces"][key] / stiff["forces"][key], 1, delta=0.1, msg=key)

    def test_what_a_tool_still_cuts_as_it_springs_back_is_its_cut(self):
        """Red when a dwell in the slot, and the way up from its end, were collisions of a positioning move."""
        for stiffness in (1500, 1e7):
            inside, line = pose(10, 0, TOP - 2), pose(-BEYOND, 0, TOP - 2)
            program = [*slot(2, FEED, RPM)[:3], request("RMAC_CAM.MoveAlongLine", MoveID=2, StartPoint=line, EndPoint=inside),
                       request("RMAC_CAM.Dwell", MoveID=3, Time=1),
                       request("RMAC_CAM.MoveAlongLine", MoveID=4, StartPoint=inside, EndPoint=pose(20, 0, TOP - 2)), to(20, 0, TOP + 20)]
            report, _ = self.report(program, "--dynamics", tool=tool(Modes=[MODE | {"Stiffness": stiffness}]))
            self.assertEqual(report["collisions"], [], stiffness)
            self.assertLessEqual({each["move_id"] for each in report["dynamics"]["chatter"]}, {2, 4})

    def test_a_positioning_move_through_stock_right_after_a_cut_is_a_collision(self):
        """Red when all that was cut for six turns after a cut was the cut's."""
        end = pose(10, 0, TOP - 2)
        program = [*slot(2, FEED, RPM)[:3], request("RMAC_CAM.MoveAlongLine", MoveID=2, StartPoint=pose(-BEYOND, 0, TOP - 2), EndPoint=end)]
        for name, way in (("sideways", (10, 1, TOP - 2)), ("down", (10, 0, TOP - 3)), ("far", (10, 15, TOP - 2))):
            report, done = self.report([*program, to(*way, move_id=5)], "--dynamics", tool=tool(Modes=[MODE | {"Stiffness": 20000}]))
            self.assertEqual({(each["line"], each["move_id"], each["why"]) for each in report["collisions"]}, {(5, 5, "positioning move")}, name)
            self.assertEqual(done.returncode, 1)

    def test_a_tool_whose_spindle_stands_is_pushed_by_nothing(self):
        """Red when the force of the cut stayed for good, as a mean over a turn that never ends."""
        end = pose(10, 0, TOP - 2)
        program = [*slot(2, FEED, RPM)[:3], request("RMAC_CAM.MoveAlongLine", MoveID=2, StartPoint=pose(-BEYOND, 0, TOP - 2), EndPoint=end),
                   request("RMAC_CAM.InTurn", MoveID=4, Calls=[{"method": "RMAC_CAM.SetSpindleRPM", "params": {"SpindleNumber": 0, "RPM": 0}}]),
                   to(10, 0, TOP + 40, move_id=5)]
        report, _ = self.report(program, "--dynamics", tool=tool(Modes=[MODE | {"Stiffness": 1500}]))
        off = report["dynamics"]["off_path"]
        self.assertEqual(off[0]["move_id"], 2, "it is pushed while it cuts")
        self.assertLess(off[-1]["until_s"], report["cycle_time_s"] - 0.1, "and not on the way up")

    def test_a_tool_is_beside_its_path_as_far_however_slow_it_goes(self):
        """Red when a bend along the path counted for the cycles that the tip needs for as much."""
        soft = MODE | {"Stiffness": 8000, "Frequency": 2000, "DampingRatio": 0.1}
        fast, slow = (self.report(slot(1, feed, rpm), "--dynamics", tool=tool(Modes=[soft]))[0]["dynamics"]["path_peak_mm"]
                      for feed, rpm in ((600, 3000), (60, 300)))
        self.assertAlmostEqual(slow, fast, delta=0.15 * fast + 0.003)

    def test_no_speed_is_proposed_that_the_spindle_may_not_have(self):
        program = [request("RMAC_CAM.SetSpindleMaxRPM", SpindleNumber=0, MaxRPM=RPM), *slot(DEPTH, FEED, RPM)]
        report, _ = self.report(program, "--dynamics", tool=tool(Modes=[MODE]))
        self.assertEqual(len(report["dynamics"]["chatter"]), 1)
        self.assertLess(report["dynamics"]["chatter"][0]["steady_rpm"] or 0, RPM)

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

"""`rmac simulate --dynamics --view`: the page shows what the axes do, as the report and the record have it."""

import json
import shutil
import unittest

import numpy as np

import test_chatter
from appliance import BUILD
from bending_mill import rigid
from test_collisions import SETUP, cut, request, to
from test_forces import STOCK, slot
from view_page import BETWEEN_LOOKS_MM, TABLE_LINK, ViewCase, at, chain, frame, moves_at_random, program, shown

COUNT = 10 / 2**20  # mm of a screw that an encoder tells apart, or more than the degrees of a gear
SOFTER = 4
RATED_NM = 0.28
SHARE_ROUNDED = 1e-4  # of a rated torque: as plots and reports round it
SPINDLE = request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=4000)


def spun():
    first, *others = program()
    return [first, SPINDLE, *others]


def value(plot, times):
    return np.interp(times, plot["t"], plot["is"])


class ViewOfDynamics(ViewCase):
    """On rigid axes, whose encoders tell to a count where they are: what a page has is held to the record of those."""

    def setUp(self):
        super().setUp()
        self.tree = self.folder / "drivers"
        shutil.copytree(BUILD / "drivers", self.tree)
        self.change(rigid)

    def change(self, by):
        file = self.tree / "mill/5-axis/SuginoXYZAC/device.json"
        device = json.loads(file.read_text())
        by(device)
        file.write_text(json.dumps(device))

    def run_rmac(self, *words, **options):
        return super().run_rmac("--device-tree", self.tree, *words, **options)

    def seen(self, requests, change=None, **options):
        """The report, the page's data and the record, of a machine whose description was changed."""
        self.write(requests)
        if change:
            self.change(change)
        report, data = self.view("--dynamics", "--record", self.folder / "record.csv", **options)
        return report, data, np.genfromtxt(self.folder / "record.csv", delimiter=",", names=True)

    @staticmethod
    def weak(device):
        """Motors too small for their axes, with loops too soft: they follow badly, and what they give is too much for them."""
        for actuator in device["Actuators"]:
            actuator.update(RatedTorque=RATED_NM, MaxMeasuredTorque=8)
        device["DigitalControlInterface"]["Parameters"]["rated_torque_nm"] = [RATED_NM] * 3 + [0] + [RATED_NM] * 2
        for joint in device["Joints"]:
            for k, softer in enumerate((SOFTER, SOFTER**2, SOFTER)):
                joint["Gains"][k] /= softer
            joint["MaxFollowingError"] = 3

    @staticmethod
    def swinging(device):
        """Loops too soft for what they hold: an axis swings until its watch stops the machine."""
        for joint in device["Joints"]:
            joint["Gains"] = [0.3 * gain for gain in joint["Gains"][:3]] + [0, 0, 0, 0]
            joint["MaxFollowingError"] = 50

    def test_plots_are_what_the_axes_did_in_each_cycle(self):
        report, data, rows = self.seen(spun())
        self.assertEqual(data["dynamics"], report["dynamics"])
        plots = {(plot["row"], plot["name"]): plot for plot in data["plots"]}
        told = report["dynamics"]
        for n, joint in enumerate(told["joints"], 1):
            plot, error = plots["joints off", joint["name"]], rows[f"a{n}"] - rows[f"q{n}"]
            self.assertEqual(plot["unit"], "mm" if joint["name"] in "XYZ" else "°")
            apart = np.abs(value(plot, rows["t_s"]) - error).max()
            self.assertLess(apart, plot["within"] + COUNT, joint["name"])
            self.assertAlmostEqual(np.abs(plot["is"]).max(), joint["peak_error"], delta=plot["within"])
            self.assertGreater(joint["peak_error"], 10 * plot["within"], "which is little against what it shows")
        for motor in told["motors"]:
            plot = plots["motors", f"{motor['bus']} {motor['axis']}"]
            torque = value(plot, rows["t_s"]) * motor["rated_nm"]
            slack = (plot["within"] + SHARE_ROUNDED) * motor["rated_nm"]
            self.assertAlmostEqual(np.abs(torque).max(), motor["peak_nm"], delta=slack)
            self.assertAlmostEqual(abs(value(plot, motor["peak_t_s"])) * motor["rated_nm"], motor["peak_nm"], delta=slack)
            self.assertAlmostEqual(np.sqrt(np.mean(torque**2)), motor["rms_nm"], delta=slack)
            self.assertEqual(plot["levels"], [{"name": "rated", "is": 1}, {"name": "allowed", "is": motor["allowed_nm"] / motor["rated_nm"]}])
        path = plots["off the path", "off the path"]
        self.assertAlmostEqual(max(path["is"]), told["path_peak_mm"], delta=path["within"])
        self.assertEqual(path["levels"], [{"name": "PositioningTolerance", "is": 0.01}])

    def test_the_tip_is_plotted_off_its_path_where_it_is_told_to_be(self):
        report, data, rows = self.seen(spun(), self.weak)
        (path,) = (plot for plot in data["plots"] if plot["row"] == "off the path")
        off_path = report["dynamics"]["off_path"]
        self.assertTrue(off_path)
        # At rest nobody looks, and the plot is straight from before to after.
        times = rows["t_s"][np.any([rows[f"qd{n}"] != 0 for n in range(1, 6)], axis=0)]
        off_mm = value(path, times)
        for off in off_path:
            self.assertAlmostEqual(float(value(path, off["most_t_s"])), off["most_mm"], delta=path["within"])
            self.assertTrue(off["t_s"] <= off["most_t_s"] <= off["until_s"])
        told = np.any([(off["t_s"] - 1e-6 <= times) & (times <= off["until_s"] + 1e-6) for off in off_path], axis=0)
        self.assertGreater(told.sum(), 100)
        self.assertLess(off_mm[~told].max(), 0.01 + path["within"] + 1e-6)

    def test_the_machine_moves_where_its_axes_are(self):
        _, data, rows = self.seen(spun(), self.weak)
        cycle = {round(t, 6): n for n, t in enumerate(rows["t_s"])}
        measured, planned = (np.column_stack([rows[f"{name}{n}"] for n in range(1, 6)]) for name in "aq")
        beside = {"true": 0.0, "planned": 0.0}
        looked_at = 0
        for number, link in enumerate(data["links"]):
            for t in link["t"]:
                n = cycle.get(round(t, 6))
                if n is None:
                    continue  # one cycle more than the record
                looked_at += 1
                here = at(shown(link, t), link["middle"])
                for name, joints in (("true", measured[n]), ("planned", planned[n])):
                    beside[name] = max(beside[name], np.linalg.norm(here - at(chain(joints)[number], link["middle"])))
        self.assertGreater(looked_at, 200)
        self.assertLess(beside["true"], 0.002, "µm, as the page has them")
        self.assertGreater(beside["planned"], 0.05, "which is little against how far they are off")

    def test_a_browser_lists_what_axes_do_wrong_and_goes_there(self):
        report, data, _ = self.seen(spun(), self.weak)
        told = report["dynamics"]
        hot = [motor for motor in told["motors"] if motor["overheats"]]
        self.assertEqual([motor["overheats"] for motor in told["motors"]], [m["rms_nm"] > m["rated_nm"] for m in told["motors"]])
        self.assertTrue(hot and told["off_path"])
        check = self.self_check()
        self.assertEqual(check["errors"], [])
        found = {kind: [f for f in check["findings"] if f["text"].startswith(kind + ": ")] for kind in ("off path", "too hot")}
        self.assertEqual(len(check["findings"]) - sum(map(len, found.values())), len(report["collisions"]) + len(report["near_misses"]))
        self.assertEqual(len(found["off path"]), len(told["off_path"]))
        cutting_part = data["tools"][0]["bodies"][0]["name"]
        for seen, off in zip(found["off path"], told["off_path"]):
            self.assertAlmostEqual(seen["time"], off["most_t_s"], places=6)
            self.assertEqual(seen["coloured"], [cutting_part])
            self.assertIn(f"line {off['line']}", seen["text"])
            # The tip, which is beside where it was to be in the part frame.
            table = shown(data["links"][TABLE_LINK], off["most_t_s"]) @ frame(data["part_frame"]["p"], data["part_frame"]["q"])
            self.assertLess(np.linalg.norm(np.array(seen["mark"]) - at(table, off["place_mm"])), 0.3 + BETWEEN_LOOKS_MM)
        self.assertEqual(len(found["too hot"]), len(hot))
        for motor in hot:
            (seen,) = (f for f in found["too hot"] if f"motor {motor['bus']} {motor['axis']} gives" in f["text"])
            self.assertAlmostEqual(seen["time"], motor["peak_t_s"], places=6)
            self.assertEqual(seen["coloured"], [])
        rows = {(row["name"], row["unit"]): row for row in check["rows"]}
        self.assertEqual(rows["motors", "of rated"]["curves"], [f"{m['bus']} {m['axis']}" for m in told["motors"]])
        self.assertEqual(rows["joints off", "mm"]["curves"], ["X", "Y", "Z"])
        self.assertEqual(rows["joints off", "°"]["curves"], ["A", "C"])
        self.assertEqual(rows["motors", "of rated"]["levels"], ["rated"])
        self.assertEqual(rows["motors", "of rated"]["beyond"], ["allowed"])

    def test_a_browser_goes_to_where_the_machine_stops(self):
        report, data, rows = self.seen(spun(), self.swinging)
        stopped = report["dynamics"]["stopped"]
        self.assertIn("swings", stopped["why"])
        self.assertAlmostEqual(data["to_s"], rows["t_s"][-1], delta=0.01)
        for plot in data["plots"]:
            if plot["row"] == "joints off":
                self.assertLessEqual(plot["t"][-1], stopped["t_s"] + 1e-6)
        # It stands where its axes were, and not where they were to be.
        stands = [at(chain([rows[f"{name}{n}"][-1] for n in range(1, 6)])[-1], (0, 0, 0)) for name in "aq"]
        here = at(shown(data["links"][-1], data["to_s"]), (0, 0, 0))
        self.assertLess(np.linalg.norm(here - stands[0]), 0.002)
        self.assertGreater(np.linalg.norm(here - stands[1]), 0.05)
        check = self.self_check()
        (seen,) = (f for f in check["findings"] if f["text"].startswith("stops: "))
        self.assertAlmostEqual(seen["time"], stopped["t_s"], places=6)
        self.assertIn(stopped["why"], seen["text"])
        self.assertIn(f"line {stopped['line']}", seen["text"])

    def test_a_browser_goes_to_where_a_cut_chatters(self):
        soft = {"Mounted": 7, "Tools": [test_chatter.tool(Modes=[test_chatter.MODE])]}
        self.write(slot(test_chatter.DEPTH, test_chatter.FEED, test_chatter.RPM), setup=STOCK, tools=soft)
        report, data = self.view("--dynamics")
        chatter = report["dynamics"]["chatter"]
        self.assertTrue(chatter)
        check = self.self_check()
        self.assertEqual(check["errors"], [])
        found = [f for f in check["findings"] if f["text"].startswith("chatter: ")]
        self.assertEqual(len(found), len(chatter))
        for seen, each in zip(found, chatter):
            self.assertAlmostEqual(seen["time"], each["most_t_s"], places=6)
            self.assertEqual(seen["coloured"], [data["tools"][0]["bodies"][0]["name"]])
            self.assertIn(f"{each['frequency_hz']:.0f} Hz at {each['rpm']:.0f} rpm, from {each['from_percent']:.0f} % of its depth on", seen["text"])

    def test_without_a_set_up_findings_stand_where_the_tip_is(self):
        gains = request("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[10000, 900000, 70, 0, 0, 0, 0])
        configured = [gains, request("RMAC_Config.Apply")]
        report, data, _ = self.seen([*configured, *moves_at_random(6)], with_setup=False)
        self.assertTrue(report["dynamics"]["off_path"])
        check = self.self_check()
        self.assertEqual(check["notes"], ["NOT TOLD: " + text for text in report["dynamics"]["not_told"]])
        self.assertIn("configures the machine anew", check["notes"][0])
        self.assertEqual(len(check["findings"]), len(report["dynamics"]["off_path"]))
        for seen, off in zip(check["findings"], report["dynamics"]["off_path"]):
            tip = at(shown(data["links"][-1], off["most_t_s"]), data["tools"][0]["tip"])
            np.testing.assert_allclose(seen["mark"], tip, atol=1e-3)

    def test_a_note_tells_the_feed_at_which_the_axes_keep_to_the_program(self):
        slot = [(x, -20, 25.5) for x in (-50, 20)]
        requests = [to(*slot[0]), SPINDLE, request("RMAC_CAM.SetFeedrate", Feedrate=3600), cut(*slot, 2)]
        self.write(requests, SETUP | {"Material": "Al6082-T6"})
        report, _ = self.view("--dynamics")
        percent = report["dynamics"]["keeps_at_percent"]
        self.assertTrue(report["dynamics"]["off_path"] and percent)
        check = self.self_check()
        self.assertEqual(check["errors"], [])
        self.assertEqual(check["notes"][-1], f"At a feed override of {percent:g} % the axes keep to the program.")

    def test_nothing_of_it_is_shown_where_nobody_asked(self):
        self.write(spun())
        report, data = self.view()
        self.assertEqual((report["dynamics"], data["dynamics"]), ("not asked", "not asked"))
        self.assertEqual({plot["row"] for plot in data["plots"]}, {"feed", "spindle"})

    def test_an_hour_of_five_axes_fits_into_a_page(self):
        self.write(moves_at_random(2600))
        report, data = self.view("--dynamics", with_setup=False)
        of_axes = [plot for plot in data["plots"] if plot["row"] in ("off the path", "motors", "joints off")]
        within = {plot["row"] + ", " + plot["unit"]: plot["within"] for plot in of_axes}
        size = len(json.dumps(of_axes, separators=(",", ":")))
        print(f"\n{report['cycle_time_s']:.0f} s of machine time: {report['view_bytes'] / 1e6:.1f} MB, {size / 1e6:.1f} MB of them what axes do, "
              f"within {within}, {report['cpu_time_s']:.1f} s of CPU time")
        self.assertGreater(report["cycle_time_s"], 3000)
        self.assertEqual(len(of_axes), 11)
        self.assertLess(size, 8e6)
        self.assertLess(report["view_bytes"], 40e6)
        self.assertLess(max(plot["within"] for plot in of_axes if plot["row"] == "joints off"), 0.002)


if __name__ == "__main__":
    unittest.main()

"""`rmac simulate --view`: the page that shows a machine moving, its data and what a browser makes of it."""

import copy
import json
import os
import unittest

import numpy as np
from matplotlib import image

from appliance import BUILD
from test_collisions import FEED, LENGTH, MACHINE, SETUP, TOOLS, request, to
from view_page import BASE_LINK, BETWEEN_LOOKS_MM, TABLE_LINK, ViewCase, at, chain, frame, moves_at_random, program, shown

EVIL = "</script><script>errors.push('a name ran')</script>"


def volume(mesh):
    """What a closed surface holds."""
    points, triangles = np.array(mesh["points"]).reshape(-1, 3), np.array(mesh["triangles"]).reshape(-1, 3)
    a, b, c = (points[triangles[:, n]] for n in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


class View(ViewCase):
    def picture(self, hash_part):
        file = self.folder / "picture.png"
        self.browse(hash_part, f"--screenshot={file}")
        return image.imread(file)[..., :3]

    def test_links_stand_where_the_machine_has_them(self):
        self.write(program())
        record = self.folder / "record.csv"
        report, data = self.view("--record", record)
        rows = np.genfromtxt(record, delimiter=",", names=True)
        joints = np.column_stack([rows[f"q{n}"] for n in range(1, 6)])
        self.assertGreater(np.ptp(joints[:, 3]), 39)
        self.assertEqual([link["names"] for link in data["links"]], [["C"], ["A"], ["base"], ["X"], ["Y"], ["Z"]])
        bound = report["view_within_mm"] + BETWEEN_LOOKS_MM
        self.assertLess(report["view_within_mm"], 0.011)
        tool = data["tools"][0]
        part = frame(data["part_frame"]["p"], data["part_frame"]["q"])
        for index in range(0, len(rows), 37):
            t = rows["t_s"][index]
            expected, found = chain(joints[index]), [shown(link, t) for link in data["links"]]
            for body in data["bodies"]:
                corner = np.array(body["p"]) + (20, 30, 10)
                apart = np.linalg.norm(at(expected[body["link"]], corner) - at(found[body["link"]], corner))
                self.assertLess(apart, bound, f"{body['name']} at {t} s, joints {joints[index]}")
            # The planner's own tip, as the program has it: in the part's frame.
            tip = np.linalg.inv(found[TABLE_LINK] @ part) @ found[-1] @ np.append(tool["tip"], 1)
            programmed = [rows[axis][index] for axis in "xyz"]
            self.assertLess(np.linalg.norm(tip[:3] - programmed), 2 * bound, f"tip at {t} s")
        # With looks a sixtieth apart, where keys are needed, and few where none are.
        times = data["links"][TABLE_LINK]["t"]
        self.assertLess(len(times), len(rows) / 20)
        self.assertAlmostEqual(data["to_s"], rows["t_s"][-1], delta=0.1)
        self.assertEqual(len(data["links"][BASE_LINK]["t"]), len(set(data["links"][BASE_LINK]["t"])))

    def test_findings_limits_and_bodies_are_those_of_the_report(self):
        self.write(program())
        report, data = self.view()
        self.assertTrue(report["collisions"])
        self.assertEqual(data["collisions"], report["collisions"])
        self.assertEqual(data["near_misses"], report["near_misses"])
        self.assertEqual(data["not_checked"], report["collisions_not_checked"])
        device = json.loads(MACHINE.read_text())
        names = [body["Name"] for body in device["Geometry"]]
        self.assertEqual([b["name"] for b in data["bodies"]], names + ["clamp", "stock", "part"])
        self.assertEqual({b["name"] for b in data["tools"][0]["bodies"]},
                         {"tool 7, cutting part", "tool 7, shank", "tool 7, holder"})
        for finding in report["collisions"]:
            for name in finding["bodies"]:
                self.assertIn(name, [b["name"] for b in data["bodies"] + data["tools"][0]["bodies"]])
            line = data["lines"]["is"][np.searchsorted(data["lines"]["t"], finding["t_s"], "right") - 1]
            self.assertLessEqual(abs(line - finding["line"]), 1, "as near as a look tells")
        # What limited for how long, to a look or two at each change.
        limits = data["limits"]
        ends = np.append(limits["t"][1:], data["to_s"])
        for name, time in report["limited_by_s"].items():
            ruled = sum(end - t for t, end, n in zip(limits["t"], ends, limits["is"]) if limits["names"][n] == name)
            self.assertAlmostEqual(ruled, time, delta=0.1 + 0.2 * time, msg=name)
        self.assertGreater(report["view_bytes"], 500_000)
        self.assertEqual(self.page.stat().st_size, report["view_bytes"])
        removed = report["material"]["removed_mm3"]
        left = 80 * 60 * 30 - removed
        self.assertAlmostEqual(volume(data["stock_after"]), left, delta=0.01 * 80 * 60 * 30)
        # As it is cut it becomes less and less, from almost the whole to almost what is left.
        volumes = [volume(stock) for stock in data["stocks"]]
        self.assertTrue(3 <= len(volumes) <= 16)
        self.assertEqual([stock["t"] for stock in data["stocks"]], sorted({stock["t"] for stock in data["stocks"]}))
        for before, after in zip(volumes, volumes[1:]):
            self.assertLess(after, before)
        self.assertGreater(volumes[0] - volumes[-1], 0.5 * removed)

    def test_an_hour_of_five_axes_fits_into_a_page(self):
        self.write(moves_at_random(2600))
        plain = json.loads(self.run_rmac("--json", with_setup=False).stdout)
        report, data = self.view(with_setup=False)
        print(f"\n{report['cycle_time_s']:.0f} s of machine time: {report['view_bytes'] / 1e6:.1f} MB, within "
              f"{report['view_within_mm']:.2g} mm, {report['cpu_time_s']:.1f} s of CPU time instead of {plain['cpu_time_s']:.1f} s")
        self.assertGreater(report["cycle_time_s"], 3000)
        self.assertLess(report["view_bytes"], 50e6)
        self.assertLess(report["view_within_mm"], 0.5)
        self.assertEqual(data["within_mm"], report["view_within_mm"])
        self.assertLessEqual(sum(len(link["t"]) for link in data["links"]), 400_000)

    def test_forces_are_those_of_the_report(self):
        tools, setup = copy.deepcopy(TOOLS), copy.deepcopy(SETUP)
        setup["Material"] = "Al6082-T6"
        tools["Tools"][0]["NeedsSpindle"] = True
        spindle = request("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=4000)
        self.write(program()[:1] + [spindle] + program()[1:], setup, tools)
        report, data = self.view()
        plots = {plot["name"]: plot for plot in data["plots"]}
        self.assertEqual(max(plots["spindle"]["is"]), 4000)
        for name, key in (("force", "mean_force_n"), ("torque", "mean_torque_nm"), ("power", "mean_power_w")):
            t, value = np.array(plots[name]["t"]), np.array(plots[name]["is"])
            work = ((value[1:] + value[:-1]) / 2 * np.diff(t)).sum()
            self.assertAlmostEqual(work / (report["forces"][key] * report["forces"]["cutting_s"]), 1, delta=0.05, msg=name)
        self.assertEqual(data["overloads"], report["forces"]["overloads"])

    def test_without_a_set_up_the_machine_alone_is_shown(self):
        self.write([to(0, 40, 100), to(0, -40, 100, a=-20, move_id=2)])
        report, data = self.view(with_setup=False)
        self.assertEqual((report["collisions"], data["checked"]), ("not checked", False))
        self.assertEqual({body["kind"] for body in data["bodies"]}, {"machine"})
        self.assertNotIn("stock_after", data)
        self.assertEqual(len(data["tools"]), 1)

    def test_a_tool_is_shown_from_its_change_on(self):
        tools = copy.deepcopy(TOOLS)
        tools["Tools"][1]["Shape"] = {"DC": 10, "RE": 0, "LCF": 20, "OAL": LENGTH}
        change = request("RMAC_CAM.DoToolChange", ToolNumber=8)
        self.write([to(0, 40, 100), change, to(0, -40, 100, move_id=3)], tools=tools)
        report, data = self.view()
        self.assertEqual([tool["number"] for tool in data["tools"]], [7, 8])
        self.assertEqual(data["tool_at"]["is"], [0, 1])
        changed = data["tool_at"]["t"][1]
        y = data["links"][-1]
        before = max(t for t, p in zip(y["t"], np.array(y["p"]).reshape(-1, 3)) if abs(p[1] - max(y["p"][1::3])) < 0.02)
        self.assertAlmostEqual(changed, before, delta=0.2)
        self.assertEqual(report["tool_changes"], 1)

    def test_what_cannot_be_written_or_shown_is_refused_before_anything_runs(self):
        self.write([to(0, 0, 100)])
        (self.folder / "taken.html").symlink_to(self.folder / "setup.json")
        (self.folder / "folder.html").mkdir()
        (self.folder / "to_come.html").symlink_to("a.csv")
        (of_machine,) = (BUILD / "drivers").glob("**/SuginoXYZAC/device.json")
        (self.folder / "named.html").symlink_to(of_machine)
        (self.folder / "module.html").symlink_to(sorted(of_machine.parent.glob("*.so"))[0])
        (self.folder / "template.html").symlink_to(BUILD / "helpers/view/page.html")
        setup = (self.folder / "setup.json").read_bytes()
        bare = json.loads(MACHINE.read_text())
        del bare["Geometry"], bare["Chain"]
        (self.folder / "device.json").write_text(json.dumps(bare))
        for words, options, what in (
                (("--view", "page.htm"), {}, "page.htm: the name of --view ends in .html"),
                (("--view", "none/page.html"), {}, "none/page.html: cannot be written; choose another place with --view"),
                (("--view", "folder.html"), {}, "folder.html: cannot be written; choose another place with --view"),
                (("--view", "taken.html"), {}, "taken.html: this run uses this file; choose another name with --view"),
                (("--view", "a.html", "--record", "a.html"), {}, "a.html: this run uses this file"),
                (("--view", "./a.html", "--record", "a.html"), {}, "a.html: this run uses this file"),
                (("--view", "to_come.html", "--record", "a.csv"), {}, "to_come.html: this run uses this file"),
                (("--view", "named.html"), {}, "named.html: this run uses this file"),
                (("--view", "module.html"), {}, "module.html: this run uses this file"),
                (("--view", "template.html"), {}, "template.html: this run uses this file"),
                (("--view", "a.html"), {"machine": None, "with_setup": False}, "name one with --machine"),
                (("--view", "a.html"), {"machine": self.folder / "device.json", "with_setup": False},
                 "device.json: has no Geometry, so that there is nothing to show with --view")):
            done = self.run_rmac(*words, **options)
            self.assertEqual((done.returncode, done.stdout, len(done.stderr.splitlines())), (1, "", 1), done.stderr)
            self.assertIn(what, done.stderr)
        self.write([FEED])
        done = self.run_rmac("--view", "a.html")
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
        self.assertIn("program.rmac: it moves nothing, so that there is nothing to show with --view", done.stderr)
        self.assertEqual((self.folder / "setup.json").read_bytes(), setup)
        self.assertFalse((self.folder / "a.html").exists())

    def test_a_page_is_whole_or_the_old_one_stays(self):
        self.write([to(0, 0, 100)])
        self.page.write_text("old")
        link = self.folder / "link.html"
        link.symlink_to(self.page)
        folder = self.folder / "folder.html"
        folder.mkdir()
        done = self.run_rmac("--view", folder)
        self.assertEqual((done.returncode, len(done.stderr.splitlines())), (1, 1), done.stderr)
        self.assertIn("folder.html", done.stderr)
        done = self.run_rmac("--view", link)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(link.is_symlink())
        self.assertEqual(list(self.folder.glob("*.part")), [])
        self.data()

    def test_a_name_may_hold_any_bytes(self):
        self.write([to(0, 0, 100)])
        done = self.run_rmac("--json", "--view", os.fsdecode(b"x\xff\x01y.html"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads(done.stdout)["view_file"], "x\ufffd\x01y.html")

    def test_a_browser_draws_all_bodies_and_goes_to_what_is_clicked(self):
        setup = copy.deepcopy(SETUP)
        setup["Fixtures"][0]["Name"] = EVIL
        self.write(program(), setup)
        report, data = self.view()
        check = self.self_check()
        self.assertEqual(check["errors"], [])
        bodies = data["bodies"] + data["tools"][0]["bodies"]
        self.assertEqual(check["meshes"], len(bodies))
        self.assertGreaterEqual(check["drawn"], len(bodies), "and the way of the tip")
        self.assertEqual(len(check["findings"]), len(report["collisions"]) + len(report["near_misses"]))
        told = sorted(report["collisions"] + report["near_misses"], key=lambda f: f["t_s"])
        for seen, finding in zip(check["findings"], told):
            self.assertAlmostEqual(seen["time"], finding["t_s"], places=6)
            self.assertEqual(sorted(seen["coloured"]), sorted(finding["bodies"]))
            self.assertIn(f"line {finding['line']}", seen["text"])
            table = shown(data["links"][TABLE_LINK], finding["t_s"])
            mark = at(table @ frame(data["part_frame"]["p"], data["part_frame"]["q"]), finding["place_mm"])
            np.testing.assert_allclose(seen["mark"], mark, atol=1e-3)
        # As it is drawn, each body stands where the data has it.
        for place in check["places"]:
            found = [shown(link, place["t"]) for link in data["links"]]
            self.assertEqual([b["name"] for b in place["bodies"]], [b["name"] for b in bodies])
            for drawn, body in zip(place["bodies"], bodies):
                corner = at(found[body["link"]] @ frame(body["p"], body["q"]), (10, 20, 30))
                np.testing.assert_allclose(drawn["corner"], corner, atol=1e-3, err_msg=f"{body['name']} at {place['t']} s")
            tip = np.linalg.inv(found[TABLE_LINK]) @ found[-1] @ np.append(data["tools"][0]["tip"], 1)
            np.testing.assert_allclose(place["tip"], tip[:3], atol=1e-3)

    def test_a_browser_shows_a_picture(self):
        self.write(program())
        report, _ = self.view()
        self.assertTrue(report["collisions"])
        scene = np.s_[40:400, 20:900]
        plain, found = (self.picture(part)[scene] for part in ("look=table", "finding=0&look=table"))
        background = np.array([0xE9, 0xED, 0xF0]) / 255
        drawn = np.abs(plain - background).max(axis=2) > 0.03
        self.assertGreater(drawn.mean(), 0.2)
        self.assertLess(drawn.mean(), 1.0)
        self.assertGreater(len(np.unique((plain * 255).astype(int).reshape(-1, 3), axis=0)), 50, "faces are shaded")

        def red(pixels):
            return ((pixels[..., 0] > 0.5) & (pixels[..., 1] < 0.2) & (pixels[..., 2] < 0.2)).sum()

        self.assertEqual(red(plain), 0)
        self.assertGreater(red(found), 200, "the clamp that the holder met")


if __name__ == "__main__":
    unittest.main()

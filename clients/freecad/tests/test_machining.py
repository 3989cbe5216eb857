"""A job against the built programs: simulated, machined by a real daemon, and kept in the document."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
import PathScripts.PathProfile as PathProfile
from appliance import BUILD, Appliance
from path_job import operation_of, plate_job, written
from rmac_freecad.jobs import read_job, tools_of
from rmac_freecad.machines import NoMachineFits, compare, fitting
from rmac_freecad.program import keep
from rmac_freecad.running import CutEnded, NotReady, check_tools, cut, look
from rmac_freecad.simulation import SimulationRefused, simulate

import rmac  # isort: skip

RMAC = str(BUILD / "bin/rmac")
MACHINE = "DMACXYZ"
AWAY = ("G0 X0 Y0 Z20", "G1 X10 F20", "G1 X60", "G1 X0")


class MachiningTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())

    def setUp(self):
        self.job = plate_job(self)
        self.job.Tools.Group[0].SpindleSpeed = 800  # the machine's spindle has 1000
        self.job.Document.recompute()
        self.client = self.enterContext(self.connect("cam"))
        self.enterContext(self.client.authority())
        self.client.load(MACHINE)
        self.client.cam.SetTool(1, 0.0, 2.5)
        self.mount(1)

    def connect(self, name):
        return rmac.connect(f"127.0.0.1:{self.appliance.port}", name)

    def mount(self, tool):
        """As the person at the machine does who is asked for it."""
        if self.client.cam.GetTools()["Mounted"] == tool:
            return
        with self.client.states() as states:
            self.client.start_cycle()
            self.client.cam.DoToolChange(tool)
            while not next(states)["tool_prompt"]:
                pass
            self.client.cam.ConfirmToolChange(tool)
        self.client.until_done()

    def profile(self):
        operation_of(self.job, PathProfile, "Profile")
        return read_job(self.job, rapid_mm_min=self.client.cam.GetMaxFeedrate())

    def away(self):
        written(self.job, AWAY)
        return read_job(self.job, rapid_mm_min=self.client.cam.GetMaxFeedrate())

    def simulated(self, program):
        return simulate(program, MACHINE, self.client.cam.GetTools(), rmac=RMAC)

    def test_a_simulated_job_tells_its_time_and_what_limited_it(self):
        found = self.simulated(self.profile())
        self.assertGreater(found.cycle_time_s, found.length_mm / 50)
        self.assertGreater(found.limited_by_s["feed"], 0)

    def test_simulation_and_machine_refuse_the_same_move_at_its_place(self):
        program = self.away()
        with self.assertRaises(SimulationRefused) as simulated:
            self.simulated(program)
        with self.assertRaises(CutEnded) as machined:
            list(cut(self.client, program))
        for refused in (simulated.exception, machined.exception):
            self.assertEqual(str(refused.place), "Custom, command 3 (G1)")
            self.assertIn("beyond its limit", refused.why)

    def test_a_tool_that_the_table_lacks_is_told_with_its_controller(self):
        self.job.Tools.Group[0].ToolNumber = 7
        self.job.Document.recompute()
        program = self.profile()
        for refused, attempt in ((SimulationRefused, lambda: self.simulated(program)), (CutEnded, lambda: list(cut(self.client, program)))):
            with self.assertRaises(refused) as told:
                attempt()
            self.assertIn("there is no tool 7 in the tool table", told.exception.why)
            self.assertEqual(told.exception.place.operation, self.job.Tools.Group[0].Label)

    def test_a_tool_that_is_wider_in_the_table_than_in_the_job_is_refused(self):
        operation_of(self.job, PathProfile, "Profile")
        for radius, told in ((3.0, "6 mm in the tool table of DMACXYZ, and of 5 mm in TC: Default Tool.*0.5 mm off"), (2.4, "4.8 mm"), (2.511, "0.011 mm off"), (2.489, "0.011 mm off")):
            self.client.cam.SetTool(1, 0.0, radius)
            with self.assertRaisesRegex(NotReady, told):
                check_tools(tools_of(self.job), look(self.client))
        for radius in (0.0, 2.491, 2.499, 2.5, 2.509):  # 0: nobody knows
            self.client.cam.SetTool(1, 0.0, radius)
            check_tools(tools_of(self.job), look(self.client))

    def test_a_job_is_cut_to_its_end(self):
        program = self.profile()
        places = list(cut(self.client, program))
        self.assertEqual(places, [program.place_of(index) for index in range(len(program))])
        end = [move.end for move in program.moves if move.end][-1]
        for joint, wanted in zip(self.client.state()["joints"], end):
            self.assertAlmostEqual(joint, wanted, 2)

    def test_a_spindle_that_is_too_slow_is_told_with_the_controller(self):
        self.job.Tools.Group[0].SpindleSpeed = 3000
        with self.assertRaises(CutEnded) as told:
            list(cut(self.client, self.profile()))
        self.assertIn("3000 rpm is above", told.exception.why)
        self.assertEqual(told.exception.place.operation, self.job.Tools.Group[0].Label)

    def test_a_lost_connection_is_told_at_its_place(self):
        written(self.job, ["G0 X0 Y0 Z20", "G1 X40 F20", "M0", "G1 Y5"])  # which nobody resumes from M0
        program = read_job(self.job, rapid_mm_min=self.client.cam.GetMaxFeedrate())
        with self.assertRaises(CutEnded) as ended:
            for place in cut(self.client, program):
                if place.code == "G0":
                    self.client._connection._socket.shutdown(2)
        self.assertEqual(ended.exception.place.operation, "Custom")
        self.assertIsInstance(ended.exception.__cause__, rmac.Interrupted)

    def test_machines_that_reach_the_part_are_ranked_by_time(self):
        operation_of(self.job, PathProfile, "Profile")
        mills = self.client.machines("Type = 'Mill'")
        fits = fitting(self.job, mills, self.client.cam.GetTools(), RMAC)
        self.assertIn(MACHINE, [fit.machine for fit in fits])
        times = [fit.found.cycle_time_s for fit in fits]
        self.assertEqual(times, sorted(times))

    def test_machines_that_keep_to_the_path_are_ranked_before_quicker_ones(self):
        written(self.job, ["G0 X0 Y0 Z0", "G1 X20 F30", "G1 Y20", "G1 X0", "G1 Y0"])
        mills = self.client.machines("Type = 'Mill'")
        fits = fitting(self.job, mills, self.client.cam.GetTools(), RMAC)
        off = sorted(fit.found.off_path_mm for fit in fits)
        self.assertGreater(off[0], 0)
        within_mm = (off[0] + off[-1]) / 2
        ranked = [fit.found for fit in fitting(self.job, mills, self.client.cam.GetTools(), RMAC, within_mm)]
        self.assertEqual(sorted(found.off_path_mm for found in ranked), off)
        keep = [found for found in ranked if found.off_path_mm <= within_mm]
        self.assertEqual(ranked[: len(keep)], sorted(keep, key=lambda found: found.cycle_time_s))
        self.assertEqual(ranked[len(keep) :], sorted(ranked[len(keep) :], key=lambda found: found.off_path_mm))
        self.assertTrue(0 < len(keep) < len(ranked), off)

    def test_a_machine_that_would_stop_cuts_nothing_and_one_without_models_is_of_unknown_accuracy(self):
        told = {"cycle_time_s": 3, "length_mm": 1, "limited_by_s": {}, "move_limits": []}
        stopped = {"line": 2, "why": "joint X swings"}
        answers = {"stops": json.dumps({**told, "dynamics": {"stopped": stopped, "path_peak_mm": 0.1}}),
                   "stops_at_once": json.dumps({**told, "dynamics": {"stopped": {**stopped, "line": 0}, "path_peak_mm": 0}}),
                   "no_models": json.dumps(told), "sound": json.dumps({**told, "dynamics": {"stopped": None, "path_peak_mm": 0.02}})}  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            fake = pathlib.Path(folder, "rmac")
            cases = "".join(f" *--dynamics*' {name} '*) echo '{said}'; exit {0 if name == 'sound' else 1};;\n" for name, said in answers.items() if name != "no_models")
            fake.write_text("#!/bin/sh\ncase \"$* \" in\n" + cases + " *--dynamics*) echo 'rmac: no models of its axes' >&2; exit 1;;\n"
                            + f" *) echo '{answers['no_models']}';;\nesac\n")
            fake.chmod(0o755)
            program = self.profile()
            fits, why = compare({name: program for name in answers}, self.client.cam.GetTools(), str(fake), within_mm=1)
        self.assertEqual([(fit.machine, fit.found.off_path_mm) for fit in fits], [("sound", 0.02), ("no_models", None)])
        self.assertEqual(set(why), {"stops", "stops_at_once"})
        self.assertIn(f"{program.place_of(1)}: the machine would stop: joint X swings", str(why["stops"]))

    def test_where_no_machine_reaches_the_part_each_one_s_reason_is_told(self):
        written(self.job, AWAY)
        with self.assertRaises(NoMachineFits) as none:
            fitting(self.job, self.client.machines(f"Name = '{MACHINE}'"), self.client.cam.GetTools(), RMAC)
        self.assertIn(f"{MACHINE}: Custom, command 3 (G1): ", str(none.exception))

    def test_a_second_station_is_told_who_holds_authority(self):
        with self.connect("other") as other, self.assertRaises(rmac.AuthorityHeld) as held, other.authority():
            pass
        self.assertIn("cam", str(held.exception))

    def test_without_the_command_line_client_it_says_what_to_do(self):
        with self.assertRaisesRegex(SimulationRefused, "give its path"):
            simulate(self.profile(), MACHINE, self.client.cam.GetTools(), rmac="/nowhere/rmac")

    def test_a_kept_program_is_saved_with_the_document_and_can_be_undone(self):
        document, program = self.job.Document, self.profile()
        name = keep(document, program, "Job").Name
        with tempfile.TemporaryDirectory() as folder:
            file = str(pathlib.Path(folder) / "kept.FCStd")
            document.saveCopy(file)
            opened = FreeCAD.openDocument(file)
            self.addCleanup(FreeCAD.closeDocument, opened.Name)
            self.assertEqual(opened.getObject(name).Text, program.text())


if __name__ == "__main__":
    unittest.main()

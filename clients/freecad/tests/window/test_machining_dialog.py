"""A job simulated and cut in the dialog, on a machine in virtual time, and what may go wrong."""

import unittest

import FreeCADGui
import PathScripts.PathProfile as PathProfile
from path_job import operation_of, written
from rmac_freecad.path import DONE, LIMITS
from rmac_freecad.window.jogging.jog_dialog import JogDialog
from rmac_freecad.window.machines.search_dialog import SearchDialog
from rmac_freecad.window.running.machining_dialog import MachiningDialog
from windowed import WindowTest, process_until

import rmac


class MachiningDialogTest(WindowTest):
    def setUp(self):
        super().setUp()
        client = self.connect("set-up")
        self.free(client)
        with client.authority():
            client.cam.SetFeedOverride(100)
            client.cam.SetPartFrame({"p": [0, 0, 0], "q": [1, 0, 0, 0]})
            client.cam.SetTool(1, 0.0, 2.5)
        if client.cam.GetTools()["Mounted"] != 1:
            self.mount(client)
        self.part_job = self.job()

    def mount(self, client):
        with client.authority(), client.states() as states:
            client.start_cycle()
            client.cam.DoToolChange(1)
            while not next(states)["tool_prompt"]:
                pass
            client.cam.ConfirmToolChange(1)
            client.until_done()

    def dialog(self, zero=True):
        dialog = self.opened(MachiningDialog(self.session))
        dialog.begin()
        process_until(lambda: dialog.headline.text() or dialog.message.refused, "the machine was looked at")
        dialog.at_machine_zero.setChecked(zero)
        return dialog

    def profile(self):
        operation_of(self.part_job, PathProfile, "Profile")

    def written(self, *lines):
        written(self.part_job, ("G0 X0 Y0 Z20", *lines))

    def in_mid_line(self):
        """The second command is being cut, a line that takes long even in virtual time."""
        self.written("G1 X40 F0.2", "G1 Y5 F20")
        dialog = self.dialog()
        dialog.cut_button.click()
        process_until(lambda: dialog.machining.program, "the job is read")
        line = next(number for number, move in enumerate(dialog.machining.program.moves) if isinstance(move, rmac.Line))
        process_until(lambda: dialog.machining.done == line and self.state()["pose"][0] > 2 and self.state()["moving"], "the line is being cut")
        return dialog

    def state(self):
        return self.session.station.state

    def test_a_simulated_job_tells_time_and_limits_and_colours_the_path(self):
        self.profile()
        dialog = self.dialog()
        dialog.simulate_button.click()
        self.told(dialog, "It takes")
        self.assertGreater(dialog.limits.topLevelItemCount(), 0)
        shown = {tuple(round(value, 2) for value in dialog.view.colour(number)) for number in range(10)}
        self.assertTrue(shown & {tuple(round(value, 2) for value in colour) for colour in LIMITS.values()}, shown)

    def test_a_job_is_cut_coloured_and_kept(self):
        self.profile()
        dialog = self.dialog()
        dialog.cut_button.click()
        self.told(dialog, "is cut")
        self.assertEqual(dialog.progress.value(), len(dialog.machining.program))
        self.assertEqual([round(value, 2) for value in dialog.view.colour(0)], list(DONE))
        kept = [one for one in self.part_job.Document.Objects if one.Label == "Job.rmac"]
        self.assertEqual([one.Text for one in kept], [dialog.machining.program.text()])
        process_until(lambda: self.state()["authority"] == "", "authority is given back")

    def test_the_path_leaves_the_view_with_the_dialog(self):
        self.profile()
        scene = FreeCADGui.ActiveDocument.ActiveView.getSceneGraph()
        before = scene.getNumChildren()
        dialog = self.dialog()
        dialog.simulate_button.click()
        self.told(dialog, "It takes")
        self.assertEqual(scene.getNumChildren(), before + 1)
        dialog.close()
        self.assertEqual(scene.getNumChildren(), before)

    def test_a_part_zero_that_was_not_set_is_asked_for(self):
        self.profile()
        dialog = self.dialog(zero=False)
        dialog.cut_button.click()
        self.refused(dialog, "part's zero was not set", "Part zero here")
        self.assertFalse(dialog.machining.running)

    def test_a_tool_that_the_table_lacks_is_added_with_its_length(self):
        self.part_job.Tools.Group[0].ToolNumber = 7
        self.part_job.Document.recompute()
        self.profile()
        dialog = self.dialog()
        dialog.cut_button.click()
        self.refused(dialog, "lacks tool 7", self.part_job.Tools.Group[0].Label)
        row = dialog.tools.rows[0]
        row.length.set_quantity(12.5)
        row.add.click()
        process_until(lambda: not dialog.tools.rows, "the tool is in the table")
        table = self.connect().cam.GetTools()["Tools"]
        added = next(tool for tool in table if tool["ToolNumber"] == 7)
        self.assertEqual((added["Length"], added["Radius"]), (12.5, 2.5))
        client = self.connect("set-up")
        with client.authority():
            client.cam.RemoveTool(7)

    def test_a_tool_that_is_too_long_is_told_as_that(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(1, 80.0, 2.5)
        self.profile()
        dialog = self.dialog()
        dialog.simulate_button.click()
        self.refused(dialog, "tool 1 is too long", "80 mm", "shorter one")

    def test_a_part_out_of_reach_is_not_blamed_on_the_tool(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(1, 5.0, 2.5)
        self.written("G1 X60 F20")
        dialog = self.dialog()
        dialog.simulate_button.click()
        self.refused(dialog, "Custom, command 2 (G1)", "beyond its limit")
        self.assertNotIn("too long", dialog.message.text())

    def test_a_part_frame_that_is_set_counts_in_the_simulation(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetPartFrame({"p": [-40, 0, 0], "q": [1, 0, 0, 0]})
        self.written("G1 X60 F20")
        dialog = self.dialog()
        self.assertFalse(dialog.at_machine_zero.isVisible())
        dialog.simulate_button.click()
        self.told(dialog, "It takes")

    def test_hold_resume_and_override_act_in_mid_cut(self):
        self.written("G1 X1 F1", "M0", "G1 X40 F1")
        dialog = self.dialog()
        dialog.cut_button.click()
        process_until(lambda: self.state() and self.state()["state"] == "Holding", "the program's stop holds it")
        process_until(lambda: dialog.run.resume.isEnabled(), "it may be resumed")
        dialog.run.override.setValue(50)
        process_until(lambda: self.state()["override_percent"] == 50, "the override is the machine's")
        dialog.run.resume.click()
        self.told(dialog, "is cut")
        self.assertEqual(self.state()["override_percent"], 50)

    def test_a_stop_in_mid_cut_is_told_at_its_place_and_nothing_goes_on(self):
        dialog = self.in_mid_line()
        dialog.run.stop.click()
        self.refused(dialog, "Custom, command 2 (G1)", "StopNow")
        self.assertFalse(dialog.machining.can_go_on)
        process_until(lambda: self.state()["authority"] == "" and not self.state()["moves_in_buffer"], "nothing is left")

    def test_a_lost_connection_in_mid_cut_is_told_and_gone_on_from(self):
        dialog = self.in_mid_line()
        self.session.station.client._connection._socket.shutdown(2)
        self.refused(dialog, "Custom, command 2 (G1)", "connection")
        process_until(lambda: dialog.go_on_button.isVisible(), "it may go on")
        self.assertFalse(dialog.machining.running)
        dialog.go_on_button.click()
        self.told(dialog, "is cut")
        self.assertAlmostEqual(self.connect().state()["joints"][1], 5, 2)

    def test_a_job_is_not_cut_where_another_station_has_authority(self):
        self.profile()
        dialog = self.dialog()
        with self.connect("the other CAM").authority():
            dialog.cut_button.click()
            self.refused(dialog, "Another station has authority", "the other CAM")
        self.assertFalse(dialog.machining.running)

    def test_jogging_and_loading_beside_a_cut_are_refused_and_end_it_not(self):
        jog, search = self.opened(JogDialog(self.session)), self.opened(SearchDialog(self.session))
        jog.begin()
        process_until(lambda: jog.rows, "it was jogged before")
        search.connect_and_list()
        process_until(lambda: search.list.machines, "machines are listed")
        self.written("G1 X1 F20", "M0", "G1 X2 F20")
        dialog = self.dialog()
        dialog.cut_button.click()
        process_until(lambda: self.state() and self.state()["state"] == "Holding", "it holds in its midst")
        jog.rows[0].plus.click()
        self.refused(jog, "A job is being cut")
        search.list.choose("SuginoXYZ")
        search.load_button.click()
        self.refused(search, "A job is being cut")
        jog.close()
        dialog.run.resume.click()
        self.told(dialog, "is cut")

    def test_a_dialog_stays_while_the_machine_cuts(self):
        self.written("G1 X1 F20", "M0")
        dialog = self.dialog()
        dialog.cut_button.click()
        process_until(lambda: self.state() and self.state()["state"] == "Holding", "it holds in its midst")
        dialog.close()
        self.assertTrue(dialog.isVisible())
        self.assertIn("Stop it first", dialog.message.text())
        dialog.run.stop.click()
        self.refused(dialog, "Custom")

    def test_a_tool_changed_by_hand_is_confirmed_in_the_dialog(self):
        with self.connect("set-up") as client, client.authority():
            client.cam.SetTool(2, 0.0, 2.5)
        self.part_job.Tools.Group[0].ToolNumber = 2
        self.part_job.Document.recompute()
        self.profile()
        dialog = self.dialog()
        dialog.cut_button.click()
        process_until(lambda: dialog.prompts.isVisible() and "2" in dialog.prompts.text.text(), "tool 2 is asked for")
        self.assertEqual(dialog.prompts.tool.value(), 2)
        dialog.prompts.confirm.click()
        self.told(dialog, "is cut")

    def test_a_job_that_is_not_understood_is_told_at_its_place(self):
        self.written("G91")
        dialog = self.dialog()
        dialog.simulate_button.click()
        self.refused(dialog, "Custom, command 2 (G91)")


class NoMachineTest(WindowTest):
    @classmethod
    def setUpClass(cls):
        from appliance import Appliance

        cls.appliance = cls.enterClassContext(Appliance())
        cls.address = f"127.0.0.1:{cls.appliance.port}"

    def test_without_a_machine_it_says_what_to_do(self):
        self.job()
        dialog = self.opened(MachiningDialog(self.session))
        dialog.begin()
        self.refused(dialog, "No machine is loaded", "Select machine")


if __name__ == "__main__":
    unittest.main()

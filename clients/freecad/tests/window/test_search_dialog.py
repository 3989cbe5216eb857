"""Machines searched, compared, looked at and loaded, in the dialog."""

import unittest

import FreeCAD
import PathScripts.PathProfile as PathProfile
from path_job import operation_of, written
from rmac_freecad.window.machines.search_dialog import SearchDialog
from windowed import MACHINE, WindowTest, process_until


class SearchDialogTest(WindowTest):
    def setUp(self):
        super().setUp()
        self.dialog = self.opened(SearchDialog(self.session))
        self.dialog.connect_and_list()
        process_until(lambda: self.dialog.list.machines, f"machines are listed; {self.dialog.message.text()}")

    def names(self):
        return [self.dialog.list.topLevelItem(number).text(0) for number in range(self.dialog.list.topLevelItemCount())]

    def search(self):
        self.dialog.edit_button.click()
        self.dialog.search_button.click()
        process_until(lambda: not self.dialog.search_button.isEnabled(), f"the search is over; {self.dialog.message.text()}")

    def test_fields_wait_for_edit(self):
        self.assertFalse(self.dialog.fields.isEnabled())
        self.assertFalse(self.dialog.search_button.isEnabled())
        self.dialog.edit_button.click()
        self.assertTrue(self.dialog.fields.isEnabled())

    def test_a_search_finds_the_dissertation_s_machine(self):
        fields = self.dialog.fields
        fields.type.setCurrentText("Mill")
        fields.joints.setValue(5)
        for length in (fields.length_mm, fields.width_mm, fields.depth_mm):
            length.set_quantity(150)
        fields.spindle_hp.setValue(5)
        self.search()
        self.assertEqual(self.names(), ["TarusXYZCA"])

    def test_a_feed_is_wanted_in_the_unit_that_freecad_shows(self):
        self.dialog.fields.feed_mm_min.set_quantity(2001 / 60)
        self.search()
        self.assertNotIn(MACHINE, self.names())
        self.dialog.fields.feed_mm_min.set_quantity(2000 / 60 - 1e-6)
        self.search()
        self.assertIn(MACHINE, self.names())

    def test_machines_that_fit_the_part_come_first_the_quickest_at_the_top(self):
        operation_of(self.job(), PathProfile, "Profile")
        self.dialog.fields.joints.setValue(3)
        self.search()
        self.dialog.fits_button.click()
        self.told(self.dialog, "can cut it")
        self.assertIn("s", self.dialog.list.topLevelItem(0).text(6))
        self.assertEqual(self.dialog.list.chosen.name, self.names()[0])
        off = [self.dialog.list.topLevelItem(number).text(7) for number in range(len(self.names()))]
        self.assertRegex(off[0], r"^0\.0\d+ mm$")

    def test_machines_that_keep_to_the_path_come_before_quicker_ones(self):
        operation_of(self.job(), PathProfile, "Profile")
        self.dialog.fields.joints.setValue(3)
        self.search()
        self.dialog.within.set_quantity(0.001)
        self.dialog.fits_button.click()
        self.told(self.dialog, "none is known to keep within 0.001 mm of the path")
        off = [float(text.split()[0]) for text in (self.dialog.list.topLevelItem(number).text(7) for number in range(len(self.names()))) if text]
        self.assertEqual(off, sorted(off))

    def test_where_no_machine_reaches_the_part_each_one_s_reason_is_told(self):
        written(self.job(), ("G0 X0 Y0 Z20", "G1 X10 F20", "G1 X600", "G1 X0"))
        self.dialog.fields.name.setText(MACHINE)
        self.dialog.fields.joints.setValue(3)
        self.search()
        self.dialog.fits_button.click()
        self.refused(self.dialog, "None of these machines", f"{MACHINE}: Custom, command 3 (G1): ", "beyond its limit")
        self.assertIn("no: Custom, command 3", self.dialog.list.topLevelItem(0).text(6))

    def test_without_the_program_that_simulates_it_says_where_to_give_its_path(self):
        operation_of(self.job(), PathProfile, "Profile")
        self.settings.rmac = "/nowhere/rmac"
        self.dialog.fits_button.click()
        self.refused(self.dialog, "program rmac", "Preferences")

    def test_without_a_job_it_says_so(self):
        self.dialog.fits_button.click()
        self.refused(self.dialog, "no Path job")

    def test_characteristics_show_the_machine_s_picture(self):
        self.dialog.list.choose(MACHINE)
        self.dialog.characteristics_button.click()
        shown = self.dialog.characteristics_dialog
        self.addCleanup(shown.hide)
        process_until(lambda: (shown.picture.pixmap() and not shown.picture.pixmap().isNull()) or shown.message.refused, "the picture is there")
        self.assertIsNone(shown.message.refused, shown.message.text())

    def test_the_selected_machine_is_loaded(self):
        self.dialog.list.choose("SuginoXYZ")
        self.dialog.load_button.click()
        self.told(self.dialog, "SuginoXYZ is loaded.")
        self.assertEqual(self.session.machine.name, "SuginoXYZ")
        self.assertEqual(self.connect().machine().name, "SuginoXYZ")

    def test_loading_while_another_station_has_authority_says_who(self):
        with self.connect("the other CAM").authority():
            self.dialog.list.choose(MACHINE)
            self.dialog.load_button.click()
            self.refused(self.dialog, "the other CAM", "Another station has authority")

    def test_an_address_where_nothing_listens_is_told_with_where_to_change_it(self):
        self.dialog.address.setText("unix:/nowhere")
        self.dialog.connect_and_list()
        self.refused(self.dialog, "/nowhere", "Preferences")

    def test_inches_are_shown(self):
        self.addCleanup(FreeCAD.Units.setSchema, FreeCAD.Units.getSchema())
        FreeCAD.Units.setSchema(3)
        self.dialog.connect_and_list()
        process_until(lambda: " in" in self.dialog.list.topLevelItem(0).text(3), "the working volume is in inches")


if __name__ == "__main__":
    unittest.main()

"""Lengths and feeds as the dialogs show them, in each of FreeCAD's schemes of units."""

import unittest

import FreeCAD
from rmac_freecad.window.quantity import LENGTH, QuantityField, feed_text, length_text, position_text, time_text


class QuantitiesTest(unittest.TestCase):
    def setUp(self):
        self.addCleanup(FreeCAD.Units.setSchema, FreeCAD.Units.getSchema())

    def test_what_is_small_stays_in_the_unit_of_what_is_large(self):
        for schema, texts in ((0, ("0.001 mm", "-20 mm", "2000 mm")), (3, ("0 in", "-0.7874 in", "78.7402 in")), (4, ("0.0001 cm", "-2 cm", "200 cm"))):
            FreeCAD.Units.setSchema(schema)
            self.assertEqual(tuple(length_text(mm) for mm in (0.001, -20, 2000)), texts)

    def test_positions_have_as_many_places_always_and_no_minus_zero(self):
        self.assertEqual([position_text(mm) for mm in (-0.0004, 12.5, -300)], ["0.000 mm", "12.500 mm", "-300.000 mm"])
        FreeCAD.Units.setSchema(3)
        self.assertEqual([position_text(mm) for mm in (-0.001, 12.7)], ["0.0000 in", "0.5000 in"])

    def test_feeds_are_shown_as_freecad_does(self):
        FreeCAD.Units.setSchema(6)
        self.assertEqual(feed_text(2000), "2000 mm/min")
        FreeCAD.Units.setSchema(3)
        self.assertEqual(feed_text(254), "10 in/min")

    def test_a_field_keeps_its_value_whatever_unit_it_shows(self):
        for schema in range(9):
            FreeCAD.Units.setSchema(schema)
            for mm in (12.7, 0.0254):
                field = QuantityField(LENGTH, mm)
                self.assertAlmostEqual(field.quantity, mm, delta=0.0006 if schema != 7 else 0.02, msg=f"schema {schema}")  # in feet four places are 0.03 mm

    def test_times_are_rounded_where_they_are_long(self):
        self.assertEqual([time_text(seconds) for seconds in (0.04, 59.94, 59.96, 119.7, 3600)], ["0.0 s", "59.9 s", "1 min 00 s", "2 min 00 s", "60 min 00 s"])

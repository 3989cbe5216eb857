"""Places on a part, and a real daemon that touches them on its simulated measuring machine (drivers/cmm/3-axis/CMM)."""

import math
import os
import sys
import threading
import unittest
from types import SimpleNamespace

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import numpy as np
import Part
from appliance import Appliance
from bending_mill import device_of, rigid
from FreeCAD import Vector
from rmac_freecad.master import deviations, fit_placement
from rmac_freecad.measuring import MeasuringRefused, Place, measure, places_on
from rmac_freecad.measuring.under_way import Measuring

import rmac  # isort: skip

TURN_DEG = 0.2  # of the part in that machine's description, about Z
TIP = {"tip_radius_mm": 1.0, "clearance_mm": 2.0, "safe_mm": -5.0}


def block():
    """What lies on the simulated machine, as its description has it."""
    return Part.makeBox(40, 30, 20, Vector(-20, -15, -40)).cut(Part.makeCylinder(8, 30, Vector(0, 0, -35)))


def face_of(shape, normal, kind="Part::GeomPlane"):
    return next(f"Face{number}" for number, face in enumerate(shape.Faces, 1) if face.Surface.TypeId == kind and (normal is None or face.normalAt(0, 0).dot(Vector(*normal)) > 0.99))


class PlacesTest(unittest.TestCase):
    def setUp(self):
        self.shape = block()
        self.top, self.bore = face_of(self.shape, (0, 0, 1)), face_of(self.shape, None, "Part::GeomCylinder")

    def places(self, names, **changes):
        return places_on(self.shape, names, **{"count": 5, "edge_mm": 2.0, **TIP, **changes})

    def test_places_are_on_their_face_off_its_edges_and_apart(self):
        places = self.places([self.top])
        self.assertEqual(len(places), 5)
        for place in places:
            self.assertAlmostEqual(place.point[2], -20, 9)
            np.testing.assert_allclose(place.normal, (0, 0, 1), atol=1e-12)
            self.assertLessEqual(max(abs(place.point[0]) - 18, abs(place.point[1]) - 13, 10 - np.hypot(*place.point[:2])), 1e-9)
        points = np.array([place.point for place in places])
        self.assertGreater(min(np.linalg.norm(a - b) for i, a in enumerate(points) for b in points[:i]), 8)

    def test_a_probe_that_comes_from_above_touches_nothing_but_its_place(self):
        narrow = Part.makeBox(30, 30, 20, Vector(0, 0, -40)).cut(Part.makeBox(10, 4.5, 10, Vector(10, 10, -30)))
        wall = face_of(narrow, (0, 1, 0))
        inner = next(f"Face{number}" for number, face in enumerate(narrow.Faces, 1) if face.Surface.TypeId == "Part::GeomPlane" and abs(face.CenterOfMass.y - 10) < 1e-6)
        for name in (wall, inner):
            self.assertTrue(name)
        self.assertTrue(places_on(narrow, [inner], count=2, edge_mm=1, **TIP))
        with self.assertRaisesRegex(MeasuringRefused, f"{inner} has no place 1 mm from its edges"):
            places_on(narrow, [inner], count=2, edge_mm=1, **{**TIP, "clearance_mm": 3.0})

    def test_a_narrow_rim_has_places(self):
        rim = Part.makeBox(100, 100, 12, Vector(0, 0, -40)).cut(Part.makeBox(92, 92, 20, Vector(4, 4, -34)))
        top = next(f"Face{number}" for number, face in enumerate(rim.Faces, 1) if abs(face.CenterOfMass.z + 28) < 1e-6 and face.BoundBox.ZLength < 1e-6)
        places = places_on(rim, [top], count=4, edge_mm=1.5, **TIP)
        self.assertEqual(len(places), 4)
        for place in places:
            x, y, _ = place.point
            self.assertTrue(1.5 <= min(x, y, 100 - x, 100 - y) <= 4 - 1.5 / math.sqrt(2), place)  # the most is in a corner

    def test_heights_between_which_the_tip_stays_are_kept(self):
        for place in self.places([self.bore], between_mm=(-32.0, -26.0)):
            self.assertTrue(-31 <= place.point[2] <= -27, place)
            self.assertAlmostEqual(np.hypot(*place.point[:2]), 8, 9)

    def test_what_makes_no_sense_is_refused(self):
        for told, names, changes in (("there is no Face99", ["Face99"], {}), ("no face was named", [], {}), ("has no place", [face_of(self.shape, (0, 0, -1))], {}),
                                     ("height to cross", [self.top], {"safe_mm": -19.5}), ("height to cross", [self.top], {"safe_mm": math.inf}), ("more than 0", [self.top], {"tip_radius_mm": 0})):  # fmt: skip
            with self.assertRaisesRegex(MeasuringRefused, told):
                self.places(names, **changes)


class UnderWayTest(unittest.TestCase):
    def test_nothing_begins_that_was_stopped_while_the_machine_was_looked_at(self):
        station = SimpleNamespace(stops=0, ask=lambda what, done, failed: done(what()))
        came = []

        def check(client):
            station.stops += 1
            return "looked"

        Measuring(station, lambda: None).start(SimpleNamespace(places=[None]), check, lambda *what: came.append(what), came.append)
        self.assertEqual(came, [(None, "looked")])


class MeasureTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """The measuring machine on rigid axes, on which a hit is as exact as its time."""
        appliance = Appliance(own_tree=True)
        with device_of(appliance, "CMM") as device:
            rigid(device)
            device["DigitalIOInterface"]["Parameters"]["part_bore_mm"][4] = 0  # open above, so that a tip over the bore touches nothing
        cls.appliance = cls.enterClassContext(appliance)

    def setUp(self):
        self.client = self.enterContext(rmac.connect(f"127.0.0.1:{self.appliance.port}", "FreeCAD"))
        with self.client.authority():
            self.client.load("CMM")
        self.shape = block()
        self.sides = [face_of(self.shape, normal) for normal in ((0, 0, 1), (-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0))]

    def places(self, names, count=3):
        return places_on(self.shape, names, count=count, edge_mm=2.0, between_mm=(-36.0, -5.0), **TIP)

    def measured(self, places, **changes):
        return measure(self.client, places, **{**TIP, **changes})

    def test_a_part_that_lies_turned_is_found_and_fits_its_model_there(self):
        touched = self.measured(self.places([*self.sides, face_of(self.shape, None, "Part::GeomCylinder")]))
        fit = fit_placement(self.shape, touched)
        np.testing.assert_allclose(np.degrees(fit.turn), (0, 0, TURN_DEG), atol=2e-4)
        np.testing.assert_allclose(tuple(fit.placement.Base), (0, 0, 0), atol=1e-3)
        self.assertGreater(abs(deviations(self.shape, touched).worst), 0.02)
        self.assertLess(abs(deviations(self.shape, touched, fit.placement).worst), 1e-3)

    def test_what_the_machine_refuses_is_told_with_the_place(self):
        gone = Place("Face9", (0.0, 0.0, -20.0), (0.0, 0.0, 1.0))  # there is the bore
        with self.assertRaisesRegex(MeasuringRefused, "place 3 of 3, on Face9 at X 0, Y 0, Z -20: .*the part is not where it was looked for"):
            self.measured([*self.places(self.sides[:1], 2), gone])
        with self.client.authority():
            self.client.cam.StopNow()
            self.client.load("CMM")

    def test_an_appliance_that_ends_meanwhile_is_told_with_the_place(self):
        appliance = Appliance(pace="real-time")
        appliance.ends_with = -9
        with appliance, rmac.connect(f"127.0.0.1:{appliance.port}", "FreeCAD") as client, client.events() as events:
            with client.authority():
                client.load("CMM")
            ends = threading.Thread(target=lambda: next(event for event in events if event.kind == "Hit") and appliance.process.kill())
            ends.start()
            try:
                with self.assertRaisesRegex(MeasuringRefused, "place [12] of 3, on Face.*: .*connection"):
                    measure(client, self.places(self.sides[:1]), **TIP)
            finally:
                ends.join()

    def test_a_connection_that_ended_before_is_told_with_what_to_do(self):
        places = self.places(self.sides[:1], 1)
        with rmac.connect(f"127.0.0.1:{self.appliance.port}", "FreeCAD") as client:
            client.close()
            with self.assertRaisesRegex(rmac.ConnectionLost, r"nothing of this was sent: client\.reconnect\(\) connects again"):
                measure(client, places, **TIP)
            client.reconnect()
            self.assertEqual(len(measure(client, places, **TIP)), 1)

    def test_another_station_that_has_authority_is_told(self):
        with rmac.connect(f"127.0.0.1:{self.appliance.port}", "lathe hand") as other, other.authority(), self.assertRaisesRegex(rmac.AuthorityHeld, "lathe hand"):
            self.measured(self.places(self.sides[:1], 1))

    def test_a_stop_from_elsewhere_ends_it_and_the_machine_rests(self):
        places, told = self.places(self.sides[:1]), []
        with rmac.connect(f"127.0.0.1:{self.appliance.port}", "operator") as other:

            def stop(done):
                told.append(done)
                other.cam.StopNow()

            with self.assertRaisesRegex(MeasuringRefused, "place 2 of 3, on Face"):
                self.measured(places, told=stop)
            self.assertEqual(told, [1])
            state = other.at_rest()
            self.assertEqual((state["moves_in_buffer"], state["authority"]), (0, ""))

    def test_without_machine_places_or_numbers_it_says_what_to_do(self):
        places = self.places(self.sides[:1], 2)
        for told, given, changes in (("no place to be measured", [], {}), ("place 2, on Face9, is no place", [places[0], Place("Face9", (math.nan, 0.0, 0.0), (0.0, 0.0, 1.0))], {}),
                                     ("speed_mm_s is 0; give more than 0", places, {"speed_mm_s": 0.0}), ("safe_mm is inf", places, {"safe_mm": math.inf})):  # fmt: skip
            with self.assertRaisesRegex(MeasuringRefused, told):
                self.measured(given, **changes)
        with self.client.authority():
            self.client.device.Unload()
        with self.assertRaisesRegex(MeasuringRefused, "no machine is loaded"):
            self.measured(places)


if __name__ == "__main__":
    unittest.main()

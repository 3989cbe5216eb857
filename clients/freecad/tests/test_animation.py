"""The machine in the document follows the one that a daemon moves: where bodies and tip are, swaps, and what is missing."""

import math
import os
import sys
import threading
import time
import unittest

sys.path.append(os.path.join(os.environ["RMAC_SOURCE"], "tests/system"))

import FreeCAD
from appliance import Appliance
from rmac_freecad.animation import ABOUT_BASE, ABOUT_PART, Follower, draw_machine
from rmac_freecad.animation.model import TIP

import rmac  # isort: skip

BOUND_S = 120
NEAR_MM = 1e-6


class Followed(unittest.TestCase):
    PACE = "as-fast-as-computed"

    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance(pace=cls.PACE))

    def setUp(self):
        self.mover = self.enterContext(self.connect("mover"))
        self.enterContext(self.mover.authority())
        self.watcher = self.enterContext(self.connect("FreeCAD"))
        self.document = FreeCAD.newDocument("Animated")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)

    def connect(self, name):
        return rmac.connect(f"127.0.0.1:{self.appliance.port}", name)

    def follow(self, about=ABOUT_PART):
        return self.enterContext(Follower(self.watcher, self.document, about))

    def until(self, follower, condition):
        """Updates it until then."""
        end = time.monotonic() + BOUND_S
        while True:
            moved = follower.update()
            if condition(moved):
                return
            self.assertLess(time.monotonic(), end, f"it did not come to this; it says {follower.told!r}")

    def stand_at(self, *joints):
        self.mover.run([rmac.MoveJoints(joints)]).wait()

    def near(self, place, wanted, what=""):
        self.assertLess(FreeCAD.Vector(*place).distanceToPoint(FreeCAD.Vector(*wanted)), NEAR_MM, f"{what} at {place}, not at {wanted}")


class AnimationTest(Followed):
    def test_each_body_is_drawn_with_the_size_and_place_that_its_device_json_says(self):
        self.mover.load("SuginoXYZAC", virtual=True)
        model = draw_machine(self.watcher, self.document)
        turntable, cradle = model.objects["turntable"], model.objects["cradle"]
        self.assertAlmostEqual(turntable.Shape.Volume, math.pi * 90**2 * 30, delta=1e-3)
        self.near(turntable.Shape.CenterOfMass, (0, 0, -115), "the turntable")
        box = cradle.Shape.BoundBox
        self.near((box.XMin, box.YMin, box.ZMin), (-180, -90, -165))
        self.near((box.XMax, box.YMax, box.ZMax), (180, 90, -135))
        self.assertEqual(len(model.objects), len(model.geometry.bodies) + 1)
        model.remove()
        self.assertEqual(self.document.Objects, [])

    def test_bodies_go_where_their_links_do(self):
        self.mover.load("SuginoXYZAC", virtual=True)
        follower = self.follow(ABOUT_BASE)
        self.stand_at(40, -30, 20, 90, 0)  # X, Y and Z carry the head, which is drawn at 0 0 195
        self.until(follower, lambda moved: moved and follower.model.objects["head"].Placement.Base.distanceToPoint(FreeCAD.Vector(40, -30, 215)) < NEAR_MM)
        at = follower.model.objects
        self.near(at["bed"].Placement.Base, (0, 100, -450), "the bed stands on the ground")
        self.near(at["column"].Placement.Base, (0 + 40, 475, 50), "X carries the column")
        self.near(at["ram"].Placement.Base, (0 + 40, 250 - 30, 430), "X and Y carry the ram")
        # By a quarter the cradle has turned the table upright about X, towards or away from the door.
        table, cradle = at["turntable"].Placement, at["cradle"].Placement
        self.assertAlmostEqual(abs(table.Rotation.multVec(FreeCAD.Vector(0, 0, 1)).y), 1, places=9)
        self.assertAlmostEqual((table.Base - cradle.Base).Length, 35, places=6, msg="as far apart as they were")

    def test_another_machine_is_drawn_when_it_is_loaded_and_none_when_it_is_unloaded(self):
        self.mover.load("SuginoXYZAC", virtual=True)
        follower = self.follow()
        self.until(follower, lambda moved: moved)
        self.assertIn("cradle", follower.model.objects)
        self.mover.load("DMACXYZ", virtual=True)
        self.until(follower, lambda moved: moved and follower.told == "DMACXYZ")
        self.assertNotIn("cradle", follower.model.objects)
        self.assertEqual([one.Label for one in self.document.RootObjects], ["DMACXYZ"])
        self.mover.device.Unload()
        self.until(follower, lambda moved: "no machine is loaded" in follower.told)
        self.assertEqual(self.document.Objects, [])

    def test_what_somebody_deletes_is_not_moved_any_more(self):
        self.mover.load("DMACXYZ", virtual=True)
        follower = self.follow()
        self.until(follower, lambda moved: moved)
        self.document.removeObject(follower.model.objects[TIP].Name)
        self.until(follower, lambda moved: follower.told == "the machine was taken out of the document")


class MovingTest(Followed):
    PACE = "real-time"

    def test_the_tip_goes_along_the_path_of_the_part_that_is_drawn(self):
        self.mover.load("SuginoXYZAC", virtual=True)
        self.mover.cam.SetPartFrame({"p": [5, -10, 30], "q": [1, 0, 0, 0]})
        self.mover.cam.SetFeedrate(2000)
        self.mover.run([rmac.MoveTo((0, 0, 0))]).wait()
        follower = self.follow()
        start, end = FreeCAD.Vector(0, 0, 0), FreeCAD.Vector(40, 20, 5)
        line = rmac.Line(tuple(start), (*end, 0.0, math.sin(0.4), math.cos(0.4)))
        cut = threading.Thread(target=self.mover.run([line]).wait)
        cut.start()
        self.addCleanup(cut.join)
        places = []

        def there(moved):
            if moved:
                places.append(follower.model.objects[TIP].Placement.Base)
            return places and places[-1].distanceToPoint(end) < NEAR_MM

        self.until(follower, there)
        for place in places:
            self.assertLess(place.distanceToLine(start, end - start), 1e-3, f"{place} is off the line")
        self.assertGreater(len({round(place.x, 3) for place in places}), 20, "it moves, and does not jump")


if __name__ == "__main__":
    unittest.main()

"""STEP files of strangers: what they hold is found from the shape alone, and what cannot be right is told before a path is planned."""

import pathlib
import tempfile
import unittest
from types import SimpleNamespace

import FreeCAD
import Import
import numpy as np
import Part
import rmac_freecad  # noqa: F401
from FreeCAD import Vector
from rmac_freecad.holes import Drilling, read_holes
from rmac_freecad.jobs.refusal import JobRefused
from rmac_freecad.parts import PartRefused, check_size, open_step, recognise
from rmac_freecad.pockets import outline_of

INCH = """#9900=(CONVERSION_BASED_UNIT('INCH',#9901)LENGTH_UNIT()NAMED_UNIT(#9902));
#9901=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#9903);
#9902=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);
#9903=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));
ENDSEC;"""


def plate(x=0.0):
    """A pocket with an island, a through hole, a blind one, and a slot that is open at the side."""
    pocket = Part.makeBox(20, 16, 10, Vector(x + 4, 7, 7))
    rounded = pocket.makeFillet(3, [edge for edge in pocket.Edges if abs(edge.tangentAt(edge.FirstParameter).z) > 0.5])
    shape = Part.makeBox(60, 30, 12, Vector(x, 0, 0)).cut(rounded.cut(Part.makeCylinder(3, 20, Vector(x + 14, 15, 0))))
    shape = shape.cut(Part.makeCylinder(2.5, 20, Vector(x + 34, 8, -4))).cut(Part.makeCylinder(4, 20, Vector(x + 34, 20, 5)))
    return shape.cut(Part.makeBox(20, 6, 10, Vector(x + 45, 12, 9)))


def block_without(*tools):
    """60 × 30 × 12 mm; tools are taken away."""
    shape = Part.makeBox(60, 30, 12)
    for tool in tools:
        shape = shape.cut(tool)
    return shape


def bore(diameter, bottom, height=20, x=20.0, y=15.0):
    return Part.makeCylinder(diameter / 2, height, Vector(x, y, bottom))


class WhatIsThereTest(unittest.TestCase):
    """A wrong hole is worse than none: the drill goes down in rapids to 1 mm above its top, and further where it is through."""

    def holes(self, *tools):
        return [tuple(round(float(value), 6) for value in (hole.diameter_mm, hole.bottom, hole.top, hole.through)) for hole in recognise(block_without(*tools)).holes]

    def test_a_blind_hole_is_not_through_whatever_its_end_is(self):
        point, ball = Part.makeCone(0, 2.5, 1.5, Vector(20, 15, 2.5)), Part.makeSphere(2.5, Vector(20, 15, 4))
        for end in ((), (point,), (ball,)):
            self.assertEqual(self.holes(bore(5, 4), *end), [(5, 4, 12, False)])
        self.assertEqual(recognise(block_without(bore(5, 4), point)).free_form, (), "the point is the drill's")

    def test_a_wider_bore_ends_at_its_ledge_and_drills_begin_above_it(self):
        self.assertEqual(self.holes(bore(5, -4), bore(9, 6)), [(5, 0, 12, True), (9, 6, 12, False)])
        self.assertEqual(self.holes(bore(5, -4), bore(9, 11)), [(5, 0, 12, True), (9, 11, 12, False)])
        sunk = block_without(bore(5, -4), Part.makeCone(2.5, 4.5, 2, Vector(20, 15, 10)))
        self.assertEqual([(hole.top, hole.through) for hole in recognise(sunk).holes], [(12, True)])
        self.assertEqual(len(recognise(sunk).free_form), 1)
        plain = block_without(bore(5, -4))
        rounded = plain.makeFillet(2, [edge for edge in plain.Edges if isinstance(edge.Curve, Part.Circle) and edge.CenterOfMass.z > 11])
        self.assertEqual([(round(hole.top, 6), hole.through) for hole in recognise(rounded).holes], [(12, True)])

    def test_what_is_not_open_above_is_neither_hole_nor_pocket(self):
        self.assertEqual(self.holes(bore(5, -4, 9)), [], "it is drilled from below")
        self.assertEqual(self.holes(bore(5, -4, 6), bore(5, 4)), [(5, 4, 12, False)], "between the two is a web")
        self.assertEqual(self.holes(bore(5, -4, 7), bore(5, 9)), [(5, 9, 12, False)])
        for hollow in (bore(10, 4, 4), Part.makeBox(20, 10, 4, Vector(10, 10, 4)), Part.makeBox(20, 10, 4, Vector(10, 10, 4)).fuse(Part.makeBox(20, 4, 10, Vector(10, 13, 6)))):
            found = recognise(block_without(hollow))
            self.assertEqual((found.holes, found.recesses), ((), ()))

    def test_halves_above_each_other_are_no_hole_and_a_hole_that_a_groove_crosses_is_one(self):
        groove = Part.makeBox(60, 20, 2, Vector(0, 5, 5))
        slot = bore(6, -4).fuse(bore(6, -4, x=40.0)).fuse(Part.makeBox(20, 6, 20, Vector(20, 12, -4))).removeSplitter()
        self.assertEqual(self.holes(slot, groove), [])
        self.assertEqual(self.holes(bore(6, -4, y=0.0), Part.makeBox(60, 5, 2, Vector(0, 0, 5))), [])
        self.assertEqual(self.holes(bore(6, -4), groove), [(6, 0, 12, True)])

    def test_an_island_whose_wall_is_where_a_floor_is_looked_at_is_no_roof(self):
        island = Part.makeBox(6, 4, 12, Vector(13, 13, 0))  # places are at tenths of the floor's sides: X 13, 19, …
        found = recognise(block_without(Part.makeBox(30, 16, 20, Vector(10, 7, 6)).cut(island)))
        self.assertEqual([(recess.z, recess.islands) for recess in found.recesses], [(6, 1)])

    def test_of_many_holes_each_is_found(self):
        places = [(3 + 5.5 * i, 3 + 4 * j, -4 if (i + j) % 2 else 5) for i in range(10) for j in range(6)]
        found = recognise(block_without(Part.makeCompound([bore(2, z, x=x, y=y) for x, y, z in places]))).holes
        np.testing.assert_allclose(sorted((hole.x, hole.y, hole.bottom) for hole in found), sorted((x, y, max(z, 0)) for x, y, z in places), atol=1e-9)
        self.assertEqual(sum(hole.through for hole in found), 30)

    def test_halves_are_put_together_wherever_they_are(self):
        for number in range(1, 30):
            shape, x = Part.makeBox(60, 30, 12), 10 + number * 25.4 / 32
            for half in (0, 180):
                shape = shape.cut(Part.makeCylinder(2, 12, Vector(x, 15.08125, 0), Vector(0, 0, 1), 180).rotated(Vector(x, 15.08125, 0), Vector(0, 0, 1), half))
            self.assertEqual(len(recognise(shape).holes), 1, x)

    def test_a_pocket_goes_up_over_fillets_and_chamfers_of_its_walls(self):
        box = Part.makeBox(30, 16, 20, Vector(10, 7, 5))
        upright = box.makeFillet(3, [edge for edge in box.Edges if edge.BoundBox.ZLength > 1])
        floor = upright.makeFillet(1, [edge for edge in upright.Edges if abs(edge.BoundBox.ZMax - 5) < 1e-6])
        self.assertEqual([(round(one.z, 6), round(one.top, 6)) for one in recognise(block_without(floor)).recesses], [(5, 12)])
        rounded = block_without(box.makeFillet(2, box.Edges))
        rim = [edge for edge in rounded.Edges if abs(edge.BoundBox.ZMin - 12) < 1e-6 and 5 < edge.CenterOfMass.x < 45 and 5 < edge.CenterOfMass.y < 25]
        for shape in (rounded, rounded.makeChamfer(0.5, rim)):
            self.assertEqual([(round(one.z, 6), round(one.top, 6)) for one in recognise(shape).recesses], [(5, 12)])


    def test_a_hole_or_a_deeper_pocket_in_a_floor_is_no_island_and_what_stands_in_it_is_one(self):
        document = FreeCAD.newDocument("floors")
        self.addCleanup(FreeCAD.closeDocument, document.Name)
        pocket, deeper, boss = Part.makeBox(30, 16, 20, Vector(10, 7, 8)), Part.makeBox(10, 8, 20, Vector(20, 11, 4)), Part.makeCylinder(2, 20, Vector(25, 15, 0))
        for tools, islands in (((pocket, bore(5, -4)), 0), ((pocket, deeper), 0), ((pocket.fuse(deeper).cut(boss),), 1), ((pocket.cut(boss), bore(5, -4, x=15.0)), 1)):
            part = document.addObject("Part::Feature", "Part")
            part.Shape = block_without(*tools)
            floor = next(recess.floor for recess in recognise(part.Shape).recesses if recess.z == 8)
            self.assertEqual(len(outline_of(part, floor).contours), 1 + islands)


class StrangersTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.addCleanup(lambda: [FreeCAD.closeDocument(name) for name in FreeCAD.listDocuments()])

    def written(self, *shapes, name="part.step"):
        file = self.folder / name
        (shapes[0] if len(shapes) == 1 else Part.makeCompound(shapes)).exportStep(str(file))
        return file

    def test_what_there_is_to_machine_is_found_from_the_shape(self):
        found = recognise(open_step(self.written(plate())).Shape)
        self.assertEqual([(recess.z, round(recess.top, 6), recess.islands) for recess in found.recesses], [(7.0, 12.0, 1)])
        self.assertEqual(len(found.recesses[0].walls), 8 + 1)
        holes = [(round(hole.x, 6), round(hole.y, 6), round(hole.diameter_mm, 6), round(hole.bottom, 6), round(hole.top, 6), hole.through) for hole in found.holes]
        self.assertEqual(holes, [(34, 8, 5, 0, 12, True), (34, 20, 8, 5, 12, False)])
        self.assertEqual((found.free_form, len(found.outline), len(found.tops)), ((), 4, 2))  # the island's top is one

    def test_cylinders_that_are_cut_in_two_are_one_hole_and_round_islands_and_fillets_are_none(self):
        halves = Part.makeBox(20, 20, 8).cut(Part.makeBox(5, 0.001, 8, Vector(0, 0, 0)))
        for half in (0, 180):
            halves = halves.cut(Part.makeCylinder(3, 8, Vector(10, 10, 0), Vector(0, 0, 1), 180).rotated(Vector(10, 10, 0), Vector(0, 0, 1), half))
        self.assertEqual([round(hole.diameter_mm, 6) for hole in recognise(halves).holes], [6])
        boss = Part.makeBox(20, 20, 4).fuse(Part.makeCylinder(3, 8, Vector(10, 10, 0)))
        self.assertEqual(recognise(boss).holes, ())

    def test_bent_faces_that_look_up_are_free_form_and_those_that_look_down_are_not(self):
        surface = Part.BSplineSurface()
        surface.interpolate([[Vector(10 * i, 8 * j, (i * j) % 3) for j in range(4)] for i in range(4)])
        top = surface.toShape().extrude(Vector(0, 0, -20)).common(Part.makeBox(60, 60, 30, Vector(0, 0, -10)))
        found = recognise(top)
        self.assertEqual([top.getElement(name).Surface.TypeId for name in found.free_form], ["Part::GeomBSplineSurface"])
        turned = top.rotated(Vector(0, 0, 0), Vector(1, 0, 0), 180)
        self.assertEqual(recognise(turned).free_form, ())

    def test_a_file_in_inches_is_as_large_as_it_says(self):
        file = self.written(Part.makeBox(2, 1, 0.5))
        text = file.read_text()
        unit = next(line for line in text.split(";") if "LENGTH_UNIT()" in line.replace(" ", "") and "MILLI" in line)
        number = unit.split("=")[0].strip()
        body, _, tail = text.replace(unit + ";", "").replace(number + ",", "#9900,").replace(number + ")", "#9900)").rpartition("ENDSEC;")
        file.write_text(body + INCH + tail)
        box = open_step(file).Shape.BoundBox
        np.testing.assert_allclose((box.XLength, box.YLength, box.ZLength), (50.8, 25.4, 12.7), rtol=1e-6)

    def test_an_assembly_as_freecad_writes_it_is_opened_by_the_number_of_its_solid(self):
        document = FreeCAD.newDocument("assembly")
        features = [document.addObject("Part::Feature", name) for name in ("Housing", "Lid")]
        for feature, x in zip(features, (0, 80)):
            feature.Shape = plate()
            feature.Placement.Base = Vector(x, 0, 5)
        file = self.folder / "Träger zwei.step"
        Import.export(features, str(file))
        with self.assertRaisesRegex(PartRefused, r"holds 2 solids: Solid 1 \(60 × 30 × 12 mm\), Solid 2 "):
            open_step(file)
        boxes = [open_step(file, f"Solid {number}").Shape.BoundBox for number in (1, 2)]
        self.assertEqual(sorted(round(box.XMin, 6) for box in boxes), [0, 80])
        self.assertEqual([round(box.ZMin, 6) for box in boxes], [5, 5])

    def test_several_solids_are_told_and_one_of_them_is_taken_by_its_name(self):
        file = self.written(plate(), plate(80))
        before = set(FreeCAD.listDocuments())
        with self.assertRaisesRegex(PartRefused, r"holds 2 solids: .* \(60 × 30 × 12 mm\).*name the one") as told:
            open_step(file)
        self.assertEqual(set(FreeCAD.listDocuments()), before, "no document stays")
        label = str(told.exception).split(", ")[1].split(" (")[0]
        self.assertAlmostEqual(open_step(file, label).Shape.BoundBox.XMin, 80, 6)
        with self.assertRaisesRegex(PartRefused, "none of them is Cover"):
            open_step(file, "Cover")

    def test_files_that_hold_no_solid_are_told(self):
        with self.assertRaisesRegex(PartRefused, "no such file"):
            open_step(self.folder / "gone.step")
        with self.assertRaisesRegex(PartRefused, "holds no solid"):
            open_step(self.written(Part.makePlane(10, 10)))
        broken = self.folder / "broken.step"
        broken.write_text("nothing of the kind")
        with self.assertRaisesRegex(PartRefused, "broken.step"):
            open_step(broken)

    def test_a_part_that_is_too_large_is_told_with_the_unit_that_it_may_have(self):
        machine = SimpleNamespace(name="Mill", working_volume_mm=(100.0, 100.0, 100.0))
        check_size(Part.makeBox(100, 50, 20), machine)
        with self.assertRaisesRegex(PartRefused, "choose a larger machine$"):
            check_size(Part.makeBox(110, 50, 20), machine)
        with self.assertRaisesRegex(PartRefused, "exported as inches, it would be 60, 40, 12 mm"):
            check_size(Part.makeBox(60 * 25.4, 40 * 25.4, 12 * 25.4), machine)
        with self.assertRaisesRegex(PartRefused, "drawn in inches"):
            check_size(Part.makeBox(1.5, 1, 0.3), machine)


class HolesTest(unittest.TestCase):
    DRILL = Drilling(tool=3, diameter_mm=5, feed_mm_min=100, spindle_rpm=800, safe_mm=20, peck_mm=4, beyond_mm=1.5)

    def setUp(self):
        self.holes = recognise(plate()).holes

    def drilled(self, holes=None, **changes):
        return read_holes("Holes", self.holes[:1] if holes is None else holes, Drilling(**{**self.DRILL.__dict__, **changes}), rapid_mm_min=2000)

    def test_a_drill_goes_through_as_far_as_it_was_told_and_only_downwards_at_its_feed(self):
        program = self.drilled()
        ends = [move.end for move in program.moves if move.end is not None]
        self.assertEqual({tuple(end[:2]) for end in ends}, {(34.0, 8.0)})
        self.assertAlmostEqual(min(end[2] for end in ends), -1.5, 9)
        lines = [move for move in program.moves if move.start is not None]
        self.assertEqual([round(move.end[2], 6) for move in lines], [9, 5, 1, -1.5])
        self.assertTrue(all(move.end[2] < move.start[2] for move in lines))
        self.assertEqual(ends[-1][2], 20)

    def test_a_blind_hole_ends_at_its_floor(self):
        program = self.drilled(self.holes[1:], diameter_mm=8)
        self.assertAlmostEqual(min(move.end[2] for move in program.moves if move.end is not None), 5, 9)

    def test_what_makes_no_sense_is_refused_with_the_hole(self):
        with self.assertRaisesRegex(JobRefused, "Holes, hole 2 at X 34 Y 20: it is 8 mm wide, and the drill 5 mm"):
            self.drilled(self.holes)
        with self.assertRaisesRegex(JobRefused, "above the hole's top"):
            self.drilled(safe_mm=12.5)
        with self.assertRaisesRegex(JobRefused, "no hole"):
            self.drilled([])
        for name, value in (("feed_mm_min", 0), ("spindle_rpm", float("nan")), ("peck_mm", -1), ("tool", 0), ("diameter_mm", True)):
            with self.assertRaisesRegex(JobRefused, name if name != "tool" else "tool's number"):
                self.drilled(**{name: value})


if __name__ == "__main__":
    unittest.main()

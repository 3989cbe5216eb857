"""The master model against points whose truth is known: parts that were moved, turned, and made too deep, by seeds."""

import dataclasses
import math
import unittest

import FreeCAD
import numpy as np
import Part
import PartDesign  # noqa: F401  its types of objects
import rmac_freecad  # noqa: F401
import Sketcher
from FreeCAD import Placement, Rotation, Vector
from rmac_freecad.master import MasterRefused, correct_parameters, correct_placement, corrected_frame, deviations, fit_parameters, fit_placement, show_deviations
from rmac_freecad.measuring import Place, Touched

NOISE_MM = 0.002


def bent():
    """A block whose top is bent."""
    surface = Part.BSplineSurface()
    surface.interpolate([[Vector(-24 + 12 * i, -18 + 12 * j, math.sin(i) + math.cos(j)) for j in range(4)] for i in range(5)])
    return Part.makeBox(40, 30, 20, Vector(-20, -15, -20)).common(surface.toShape().extrude(Vector(0, 0, -40)))


def scattered(shape, count, chance, faces=None):
    """Random places of each face that does not look down."""
    found = []
    for number, face in enumerate(shape.Faces, 1):
        name, left = f"Face{number}", count
        a, b, c, d = face.ParameterRange
        while left and (faces is None or name in faces):
            u, v = a + (b - a) * chance.uniform(0.1, 0.9), c + (d - c) * chance.uniform(0.1, 0.9)
            if face.normalAt(u, v).z < -0.5:
                break
            if face.isPartOfDomain(u, v):
                found.append(Place(name, tuple(face.valueAt(u, v)), tuple(face.normalAt(u, v))))
                left -= 1
    return found


def lain(places, placement, off):
    """As a part that lies there is measured; `off` along its normals. A probe that comes along the nominal normal lands beside the place."""
    touched = []
    for place, by in zip(places, off):
        point = placement.multVec(Vector(*place.point)) + placement.Rotation.multVec(Vector(*place.normal)) * float(by)
        touched.append(Touched(place, tuple(point)))
    return touched


def random_placement(chance, mm, degrees):
    turn = chance.normal(size=3)
    return Placement(Vector(*chance.uniform(-mm, mm, 3)), Rotation(Vector(*turn), float(chance.uniform(0.2, 1) * degrees)))


def corners(placement):
    return np.array([tuple(placement.multVec(Vector(x, y, z))) for x in (-20, 20) for y in (-15, 15) for z in (-20, 0)])


class PlacementTest(unittest.TestCase):
    def setUp(self):
        self.shape = bent()

    def test_without_noise_the_part_is_found_where_it_lies(self):
        for seed in range(4):
            with self.subTest(seed=seed):
                chance = np.random.default_rng(seed)
                truth = random_placement(chance, 0.3, 0.3)
                places = scattered(self.shape, 4, chance)
                fit = fit_placement(self.shape, lain(places, truth, np.zeros(len(places))))
                np.testing.assert_allclose(corners(fit.placement), corners(truth), atol=1e-6)
                self.assertLess(np.abs(fit.after).max(), 1e-6)
                self.assertGreater(np.abs(fit.before).max(), 0.02)

    def test_under_noise_it_is_as_far_off_as_it_says(self):
        squared = []
        for seed in range(10, 30):
            chance = np.random.default_rng(seed)
            truth = random_placement(chance, 0.2, 0.1)
            places = scattered(self.shape, 5, chance)
            fit = fit_placement(self.shape, lain(places, truth, chance.normal(0, NOISE_MM, len(places))))
            off = corners(fit.placement) - corners(truth)
            for corner, by in zip(corners(Placement()), off):
                squared.append(float(by @ by) / fit.uncertainty_at(corner) ** 2)
                self.assertLess(np.linalg.norm(by), 4 * fit.uncertainty_at(corner), seed)
        self.assertGreater(np.mean(squared), 0.5)  # neither half as sure as it might be, nor twice as sure as it is
        self.assertLess(np.mean(squared), 1.7)

    def test_deviations_are_those_that_the_part_was_given(self):
        chance = np.random.default_rng(5)
        truth, places = random_placement(chance, 0.2, 0.1), scattered(self.shape, 6, chance)
        off = np.zeros(len(places))
        off[3] = 0.05
        found = deviations(self.shape, lain(places, truth, off), truth)
        np.testing.assert_allclose(found.off, off, atol=1e-6)
        self.assertAlmostEqual(found.worst, 0.05, 6)
        self.assertAlmostEqual(found.rms, 0.05 / math.sqrt(len(places)), 6)

    def test_what_the_places_leave_free_is_told_by_its_name(self):
        chance = np.random.default_rng(1)
        for normal, free in (((1, 0, 0), "place along X"), ((0, 1, 0), "place along Y")):
            places = [place for place in scattered(self.shape, 6, chance) if abs(np.dot(place.normal, normal)) < 0.9]
            flat = [place for place in places if max(map(abs, place.normal)) > 1 - 1e-9]
            with self.assertRaisesRegex(MasterRefused, free):
                fit_placement(self.shape, lain(flat, Placement(), np.zeros(len(flat))))

    def test_too_few_places_no_numbers_and_another_part_are_refused(self):
        places = scattered(self.shape, 4, np.random.default_rng(2))
        with self.assertRaisesRegex(MasterRefused, "one more tells how sure"):
            fit_placement(self.shape, lain(places[:6], Placement(), np.zeros(6)))
        touched = lain(places, Placement(), np.zeros(len(places)))
        with self.assertRaisesRegex(MasterRefused, "no number"):
            fit_placement(self.shape, [*touched[1:], Touched(places[0], (math.nan, 0, 0))])
        with self.assertRaisesRegex(MasterRefused, "no face of the model is within"):
            fit_placement(Part.makeBox(5, 5, 5), touched)

    def test_no_places_no_numbers_and_faces_without_places_are_told(self):
        places = scattered(self.shape, 4, np.random.default_rng(2))
        touched = lain(places, Placement(), np.zeros(len(places)))
        with self.assertRaisesRegex(MasterRefused, "no place was measured"):
            deviations(self.shape, [])
        with self.assertRaisesRegex(MasterRefused, "no place was measured on Face77"):
            deviations(self.shape, touched).of(["Face77"])
        nowhere = Place("Face1", (math.nan, 0.0, 0.0), (0.0, 0.0, 1.0))
        for one in (Touched(places[0], (math.nan, 0, 0)), Touched(nowhere, (0, 0, 0))):
            for ask in (deviations, fit_placement):
                with self.assertRaisesRegex(MasterRefused, "is no number"):
                    ask(self.shape, [*touched, one])

    def test_the_corrected_frame_lays_the_model_where_the_part_is(self):
        chance = np.random.default_rng(3)
        truth, places = Placement(Vector(0.1, -0.2, 0.05), Rotation(Vector(0, 0, 1), 0.2)), scattered(self.shape, 4, chance)
        fit = fit_placement(self.shape, lain(places, truth, np.zeros(len(places))))
        frame = {"p": [3, 4, 5], "q": [math.cos(0.4), 0, 0, math.sin(0.4)]}
        stood = Placement(Vector(3, 4, 5), Rotation(Vector(0, 0, 1), math.degrees(0.8)))
        for upright in (False, True):
            found = corrected_frame(frame, fit, upright)
            w, *xyz = found["q"]
            np.testing.assert_allclose(corners(Placement(Vector(*found["p"]), Rotation(*xyz, w))), corners(stood * truth), atol=1e-5)

    def test_an_upright_frame_has_no_tilt_and_keeps_the_middle_of_the_places(self):
        places = scattered(self.shape, 4, np.random.default_rng(4))
        truth = Placement(Vector(0.1, 0, 0), Rotation(Vector(1, 0.5, 0.2), 0.3))
        fit = fit_placement(self.shape, lain(places, truth, np.zeros(len(places))))
        found = corrected_frame({"p": [0, 0, 0], "q": [1, 0, 0, 0]}, fit, upright=True)
        np.testing.assert_allclose(found["q"][1:3], 0, atol=1e-12)
        w, *xyz = found["q"]
        middle = Placement(Vector(*found["p"]), Rotation(*xyz, w)).multVec(Vector(*fit.centre))
        np.testing.assert_allclose(tuple(middle), fit.centre + fit.shift, atol=1e-9)


class DocumentTest(unittest.TestCase):
    def setUp(self):
        self.document = FreeCAD.newDocument("master")
        self.addCleanup(FreeCAD.closeDocument, self.document.Name)
        self.document.UndoMode = 1

    def plate(self):
        """A block with a pocket and a hole, whose depth and width are cells of a spreadsheet."""
        add = self.document.addObject
        sheet = add("Spreadsheet::Sheet", "Dimensions")
        for row, (alias, value) in enumerate((("Depth", "5 mm"), ("Width", "9 mm"), ("Twice", "=Depth * 2"), ("Count", "3"), ("Unused", "7 mm")), 1):
            sheet.set(f"A{row}", value)
            sheet.setAlias(f"A{row}", alias)
        self.document.recompute()
        block, pocket, hole = add("Part::Box", "Block"), add("Part::Box", "Pocket"), add("Part::Cylinder", "Hole")
        block.Length, block.Width, block.Height = 40, 30, 12
        pocket.Length, pocket.Width = 14, 12
        pocket.setExpression("Height", "Dimensions.Depth + 1 mm")
        pocket.setExpression("Placement.Base.z", "12 mm - Dimensions.Depth")
        pocket.Placement.Base = Vector(4, 9, 7)
        hole.Height = 20
        hole.setExpression("Radius", "Dimensions.Width / 2")
        hole.Placement.Base = Vector(29, 15, -4)
        first, part = add("Part::Cut", "First"), add("Part::Cut", "Plate")
        first.Base, first.Tool = block, pocket
        part.Base, part.Tool = first, hole
        self.document.recompute()
        return sheet, part

    def measured(self, part, depth_more, width_more, seed, noise=0.0):
        chance = np.random.default_rng(seed)
        placement = random_placement(chance, 0.2, 0.1)
        places = scattered(part.Shape, 5, chance)
        off = chance.normal(0, noise, len(places)) if noise else np.zeros(len(places))
        for number, place in enumerate(places):
            off[number] -= depth_more if abs(place.point[2] - 7) < 1e-6 and place.normal[2] > 0.9 else 0
            off[number] -= width_more / 2 if part.Shape.getElement(place.face).Surface.TypeId == "Part::GeomCylinder" else 0
        return lain(places, placement, off), placement

    def test_parameters_and_place_are_told_apart(self):
        sheet, part = self.plate()
        for seed in range(3):
            touched, placement = self.measured(part, 0.08, -0.05, seed)
            fit = fit_parameters(part, sheet, ["Depth", "Width"], touched)
            np.testing.assert_allclose(fit.values, (5.08, 8.95), atol=2e-5)
            np.testing.assert_allclose(corners(fit.placement), corners(placement), atol=5e-5)
            self.assertEqual((sheet.Depth.Value, sheet.Width.Value), (5, 9))
            self.assertEqual(self.document.UndoCount, 0, "the fit left no step behind")

    def test_under_noise_a_parameter_is_as_far_off_as_it_says(self):
        sheet, part = self.plate()
        for seed in range(20, 24):
            touched, _ = self.measured(part, 0.1, 0.04, seed, NOISE_MM)
            fit = fit_parameters(part, sheet, ["Depth", "Width"], touched)
            for value, true, sure in zip(fit.values, (5.1, 9.04), fit.uncertainty):
                self.assertLess(abs(value - true), 4 * sure, seed)
                self.assertLess(sure, 2 * NOISE_MM)

    def test_a_corrected_parameter_is_one_step_that_can_be_undone(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0.1, 0.0, 1)
        volume = part.Shape.Volume
        correct_parameters(part, fit_parameters(part, sheet, ["Depth"], [one for one in touched if part.Shape.getElement(one.place.face).Surface.TypeId != "Part::GeomCylinder"]))
        self.assertAlmostEqual(part.Shape.Volume, volume - 14 * 12 * 0.1, 1)
        self.assertEqual(self.document.UndoCount, 1)
        self.document.undo()
        self.document.recompute()
        self.assertEqual(sheet.Depth.Value, 5)
        self.assertAlmostEqual(part.Shape.Volume, volume, 6)

    def test_a_model_that_breaks_with_what_was_measured_stays_as_it_was(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0, 0, 1)
        fit = dataclasses.replace(fit_parameters(part, sheet, ["Width"], touched), values=(-1.0,))
        written, volume = sheet.getContents("A2"), part.Shape.Volume
        for mode in (0, 1):
            self.document.UndoMode = mode
            with self.assertRaisesRegex(MasterRefused, "Width -1.0000 mm the model cannot be computed: Hole"):
                correct_parameters(part, fit)
            self.assertEqual(sheet.getContents("A2"), written)
            self.assertAlmostEqual(part.Shape.Volume, volume, 6)

    def test_a_length_in_inches_is_corrected_as_any_other(self):
        sheet, part = self.plate()
        sheet.set("A1", "0.2 in")
        self.document.recompute()
        chance = np.random.default_rng(2)
        places = scattered(part.Shape, 5, chance)
        off = [-0.06 if abs(place.point[2] - (12 - 5.08)) < 1e-6 and place.normal[2] > 0.9 else 0.0 for place in places]
        for mode in (0, 1):
            self.document.UndoMode = mode
            written, volume = sheet.getContents("A1"), part.Shape.Volume
            fit = fit_parameters(part, sheet, ["Depth"], lain(places, Placement(), off))
            self.assertEqual(sheet.getContents("A1"), written, "the fit leaves the cell as it was written")
            self.assertAlmostEqual(part.Shape.Volume, volume, 6)
        np.testing.assert_allclose((fit.nominal[0], fit.values[0]), (5.08, 5.14), atol=2e-5)
        correct_parameters(part, fit)
        self.assertAlmostEqual(sheet.Depth.Value, 5.14, 4)

    def test_cells_that_are_no_free_length_are_refused(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0, 0, 1)
        for names, told in ((["Hight"], "no cell with the alias"), (["Twice"], "is computed"), (["Count"], "no length"), (["Unused"], "do not hold its Unused"), ([], "no parameter")):
            with self.assertRaisesRegex(MasterRefused, told):
                fit_parameters(part, sheet, names, touched)
            self.assertEqual(sheet.Depth.Value, 5)

    def test_sizes_and_a_place_that_are_no_numbers_or_none_are_refused(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0, 0, 1)
        for given, told in (([], "no place was measured"), ([Touched(touched[0].place, (math.nan, 0, 0)), *touched[1:]], "is no number")):
            with self.assertRaisesRegex(MasterRefused, told):
                fit_parameters(part, sheet, ["Depth"], given)

    def test_a_size_that_is_far_off_is_told_with_the_value_that_was_tried(self):
        sheet, part = self.plate()
        with self.assertRaisesRegex(MasterRefused, "with Depth [678]..*, no face of the model is within 0.5 mm of .*nearer to what they are"):
            fit_parameters(part, sheet, ["Depth"], self.measured(part, 2.5, 0.0, 1)[0])
        self.assertEqual(sheet.Depth.Value, 5)

    def test_what_else_is_broken_in_the_document_does_not_matter(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0.08, 0, 1)
        self.document.addObject("Part::Cut", "Unfinished")
        self.document.recompute()
        fit = fit_parameters(part, sheet, ["Depth"], touched)
        correct_parameters(part, fit)
        self.assertAlmostEqual(sheet.Depth.Value, 5.08, 4)

    def test_sizes_of_a_model_within_another_part_are_fitted_where_it_stands(self):
        sheet, part = self.plate()
        holder = self.document.addObject("App::Part", "Holder")
        holder.addObject(part)
        holder.Placement = Placement(Vector(5, 6, 7), Rotation(Vector(0, 0, 1), 30))
        self.document.recompute()
        shape, chance = part.Shape.copy(), np.random.default_rng(4)
        shape.Placement = part.getGlobalPlacement()
        places = scattered(shape, 5, chance)
        off = [-0.08 if abs(place.point[2] - 14) < 1e-6 and place.normal[2] > 0.9 else 0.0 for place in places]
        truth = random_placement(chance, 0.2, 0.1)
        fit = fit_parameters(part, sheet, ["Depth"], lain(places, truth, off))
        self.assertAlmostEqual(fit.values[0], 5.08, 4)
        np.testing.assert_allclose(corners(fit.placement), corners(truth), atol=1e-4)

    def test_an_object_or_a_cell_that_is_gone_is_told(self):
        sheet, part = self.plate()
        touched, _ = self.measured(part, 0.05, 0, 1)
        sizes, place = fit_parameters(part, sheet, ["Depth"], touched), fit_placement(part.Shape, touched)
        other = FreeCAD.newDocument("other")
        self.addCleanup(lambda: [FreeCAD.closeDocument(name) for name in FreeCAD.listDocuments() if name == other.Name])
        foreign = other.addObject("Spreadsheet::Sheet", "Dimensions")
        foreign.set("A1", "5 mm")
        foreign.setAlias("A1", "Depth")
        other.recompute()
        with self.assertRaisesRegex(MasterRefused, "is in the document other"):
            fit_parameters(part, foreign, ["Depth"], touched)
        sheet.setAlias("A1", "")
        with self.assertRaisesRegex(MasterRefused, "no cell with the alias Depth"):
            correct_parameters(part, sizes)
        box = other.addObject("Part::Box", "Gone")
        other.removeObject("Gone")
        for ask in (lambda: correct_placement(box, place), lambda: correct_parameters(box, sizes), lambda: fit_parameters(box, sheet, ["Width"], touched)):
            with self.assertRaisesRegex(MasterRefused, "not there any more"):
                ask()

    def test_sizes_of_a_part_that_lies_far_off_are_fitted_too(self):
        sheet, part = self.plate()
        for seed in range(2):
            chance = np.random.default_rng(seed)
            truth, places = random_placement(chance, 5, 5), scattered(part.Shape, 5, chance)
            off = [-0.08 if abs(place.point[2] - 7) < 1e-6 and place.normal[2] > 0.9 else 0.0 for place in places]
            fit = fit_parameters(part, sheet, ["Depth", "Width"], lain(places, truth, off))
            np.testing.assert_allclose(fit.values, (5.08, 9), atol=2e-5)
            np.testing.assert_allclose(corners(fit.placement), corners(truth), atol=5e-5)

    def test_a_placement_is_corrected_once(self):
        _, part = self.plate()
        touched, _ = self.measured(part, 0, 0, 1)
        fit = fit_placement(part.Shape, touched)
        correct_placement(part, fit)
        corrected = part.Placement
        with self.assertRaisesRegex(MasterRefused, "corrected already"):
            correct_placement(part, fit)
        np.testing.assert_allclose(part.Placement.Matrix.A, corrected.Matrix.A, atol=1e-12)
        self.document.undo()
        correct_placement(part, fit)
        np.testing.assert_allclose(part.Placement.Matrix.A, corrected.Matrix.A, atol=1e-12)

    def test_an_object_that_is_attached_is_refused_and_stays(self):
        _, part = self.plate()
        touched, _ = self.measured(part, 0, 0, 1)
        fit = fit_placement(part.Shape, touched)
        attached = self.document.addObject("Part::Box", "Attached")
        attached.Support, attached.MapMode = [(part, "Face1")], "FlatFace"
        self.document.recompute()
        stood = attached.Placement
        with self.assertRaisesRegex(MasterRefused, "Attached is attached"):
            correct_placement(attached, fit)
        np.testing.assert_allclose(attached.Placement.Matrix.A, stood.Matrix.A, atol=1e-12)

    def body(self):
        """A pad of a body, which stands where its sketch does."""
        body = self.document.addObject("PartDesign::Body", "Body")
        sketch, corners = body.newObject("Sketcher::SketchObject", "Sketch"), ((-20, -15), (20, -15), (20, 15), (-20, 15))
        for number, corner in enumerate(corners):
            sketch.addGeometry(Part.LineSegment(Vector(*corner, 0), Vector(*corners[(number + 1) % 4], 0)), False)
        for number in range(4):
            sketch.addConstraint(Sketcher.Constraint("Coincident", number, 2, (number + 1) % 4, 1))
        pad = body.newObject("PartDesign::Pad", "Pad")
        pad.Profile, pad.Length = sketch, 10
        self.document.recompute()
        return body, pad

    def test_of_a_body_the_whole_is_moved_to_where_a_feature_of_it_lies(self):
        body, pad = self.body()
        truth, places = random_placement(np.random.default_rng(8), 0.2, 0.1), scattered(pad.Shape, 4, np.random.default_rng(8))
        for feature in (pad, body):
            correct_placement(feature, fit_placement(pad.Shape, lain(places, truth, np.zeros(len(places)))))
            pad.touch()
            self.document.recompute()
            np.testing.assert_allclose(corners(pad.getGlobalPlacement()), corners(truth), atol=1e-6)
            self.document.undo()
            np.testing.assert_allclose(corners(pad.getGlobalPlacement()), corners(Placement()), atol=1e-12)

    def test_an_object_that_does_not_stay_where_it_is_put_is_refused_and_stays(self):
        class Fixed:
            def execute(self, feature):
                feature.Shape, feature.Placement = bent(), Placement()

        fixed = self.document.addObject("Part::FeaturePython", "Fixed")
        fixed.Proxy = Fixed()
        self.document.recompute()
        places = scattered(fixed.Shape, 4, np.random.default_rng(8))
        fit = fit_placement(fixed.Shape, lain(places, Placement(Vector(0.1, 0, 0), Rotation()), np.zeros(len(places))))
        fixed.touch()
        for mode in (0, 1):
            self.document.UndoMode = mode
            with self.assertRaisesRegex(MasterRefused, "Fixed does not stay where it was put"):
                correct_placement(fixed, fit)
            np.testing.assert_allclose(corners(fixed.Placement), corners(Placement()), atol=1e-12)

    def test_a_corrected_placement_is_one_step_that_can_be_undone_also_within_another_part(self):
        holder = self.document.addObject("App::Part", "Holder")
        feature = self.document.addObject("Part::Feature", "Solid")
        feature.Shape = bent()
        holder.addObject(feature)
        holder.Placement = Placement(Vector(5, 6, 7), Rotation(Vector(0, 0, 1), 30))
        self.document.recompute()
        shape = Part.getShape(feature).copy()
        shape.Placement = feature.getGlobalPlacement()
        chance = np.random.default_rng(8)
        truth, places = random_placement(chance, 0.2, 0.1), scattered(shape, 4, chance)
        fit = fit_placement(shape, lain(places, truth, np.zeros(len(places))))
        stood, steps = feature.Placement, self.document.UndoCount
        correct_placement(feature, fit)
        np.testing.assert_allclose(corners(feature.getGlobalPlacement()), corners(truth * holder.Placement), atol=1e-5)
        self.assertEqual(self.document.UndoCount, steps + 1)
        self.document.undo()
        np.testing.assert_allclose(feature.Placement.Matrix.A, stood.Matrix.A, atol=1e-12)

    def test_deviations_are_shown_at_their_places_with_their_values(self):
        shape = bent()
        places = scattered(shape, 2, np.random.default_rng(9))
        found = deviations(shape, lain(places, Placement(), np.full(len(places), 0.01)))
        shown = show_deviations(self.document, found)
        self.assertEqual(len(shown.Shape.Solids), len(places))
        np.testing.assert_allclose(shown.Deviation, 0.01, atol=1e-6)
        for place, ball in zip(places, shown.Shape.Solids):
            np.testing.assert_allclose(tuple(ball.CenterOfMass), place.point, atol=1e-6)


if __name__ == "__main__":
    unittest.main()

"""The verdict sees what is wrong with a run: each test breaks a good one in one way."""

import json
import pathlib
import sys
import unittest
from types import SimpleNamespace
from unittest import mock

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

import numpy as np  # noqa: E402

import verdict  # noqa: E402

OFF = (0.11, -0.09, 0.05, 0.05)
BOUNDS = json.loads((verdict.HERE / "bounds.json").read_text())


class Placement:
    """Stands for FreeCAD's: points of a part that lies there."""

    def __init__(self, x, y, z, degrees):
        turn = np.radians(degrees)
        self.rotation = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
        self.shift = np.array([x, y, z])


def moved(placement, points):
    return points @ placement.rotation.T + placement.shift


class Deviations(SimpleNamespace):
    def of(self, names):
        return self


def good():
    """A session, which is its own inspection, and its truth: with nothing wrong."""
    place = lambda face: SimpleNamespace(face=face)  # noqa: E731
    hole = SimpleNamespace(faces=("Face4",))
    found = SimpleNamespace(free_form=("Face1",), recesses=(SimpleNamespace(floor="Face3", islands=1),), holes=(hole,) * 4)
    places = [place("Face1"), place("Face2"), place("Face3")]
    off = np.array([0.02, 0.001, -0.05])
    fit = SimpleNamespace(placement=Placement(*OFF), turn=np.radians([0, 0, OFF[3]]), uncertainty_at=lambda point: 0.001)
    steps = SimpleNamespace(seconds=lambda name: 1.0)
    user = SimpleNamespace(
        found=found, programs={"sweep": [1, 2]}, dry={"sweep": SimpleNamespace(cycle_time_s=3.0)}, scallop_mm=0.05, datums=[SimpleNamespace(place=places[1])],
        touched=places, before=Deviations(rms=0.1, worst=-0.2), after=Deviations(rms=0.02, worst=-0.05), again=Deviations(off=off.copy()), fit=fit, moved=True, undone=True,
        parameters=SimpleNamespace(names=("PocketDepth", "HoleDiameter"), nominal=(4.0, 8.0), values=(4.05, 8.03), uncertainty=(0.001, 0.001)),
        corrected=Deviations(rms=0.001), sized=lambda: ["Face3"], steps=steps, began=0.0, sent=9.0, first_motion=9.5,
    )  # fmt: skip
    truth = SimpleNamespace(places=places, off=off, on_face=np.array([0.0, 0.05]), pocket_depth=4.05, hole_diameter=8.03, place_off=OFF)
    return user, truth


class Verdict(unittest.TestCase):
    def judged(self, breaks=None):
        user, truth = good()
        if breaks is not None:
            breaks(user, truth)
        with mock.patch.object(verdict, "_moved", moved):
            return verdict.judge(user, user, truth, BOUNDS)

    def broken(self, breaks, *told):
        rows, line = self.judged(breaks)
        self.assertFalse(line["ok"])
        bad = [what for what, *_, fine in rows if not fine]
        self.assertEqual(len(bad), len(told), bad)
        for what, words in zip(bad, told):
            self.assertIn(words, what)

    def test_a_good_run_is_fine(self):
        rows, line = self.judged()
        self.assertEqual([what for what, *_, fine in rows if not fine], [])
        self.assertTrue(line["ok"])

    def test_every_bound_is_held_against_something(self):
        _, line = self.judged()
        self.assertEqual(set(BOUNDS) - set(line) - {"parameter_error_um"}, set())

    def test_paths_that_gouge_or_leave_too_much(self):
        self.broken(lambda user, truth: truth.on_face.__setitem__(0, -0.0011), "cut into")
        self.broken(lambda user, truth: truth.on_face.__setitem__(1, 0.053), "highest scallop")

    def test_a_part_that_was_cut_wrong(self):
        def wrong(number, by):
            def breaks(user, truth):
                truth.off[number] += by
                user.again.off[number] += by

            return breaks

        self.broken(wrong(1, 0.012), "flat datums")
        self.broken(wrong(1, -0.012), "flat datums")
        self.broken(wrong(0, -0.032), "deepest place")
        self.broken(wrong(0, 0.042), "highest place")

    def test_a_part_that_was_found_where_it_is_not(self):
        self.broken(lambda user, truth: setattr(user.fit, "placement", Placement(OFF[0] + 0.006, *OFF[1:])), "Corners of the part off", "stated uncertainty")
        self.broken(lambda user, truth: setattr(user.fit, "placement", Placement(OFF[0] + 0.0035, *OFF[1:])), "stated uncertainty")
        self.broken(lambda user, truth: setattr(user.fit, "turn", np.radians([0, 0, -OFF[3]])), "Turn about Z")

    def test_a_probe_that_tells_something_else_than_was_cut(self):
        self.broken(lambda user, truth: user.again.off.__setitem__(0, 0.03), "Measured again")

    def test_a_model_that_was_corrected_wrong_or_not_at_all(self):
        self.broken(lambda user, truth: setattr(user.parameters, "values", (4.0, 8.03)), "PocketDepth")
        self.broken(lambda user, truth: setattr(user.parameters, "values", (4.05, 7.97)), "HoleDiameter")
        self.broken(lambda user, truth: setattr(user, "undone", False), "undone in one step")
        self.broken(lambda user, truth: setattr(user.corrected, "rms", 0.02), "corrected master model")

    def test_a_face_that_was_not_recognised_and_a_motion_that_comes_late(self):
        self.broken(lambda user, truth: setattr(user.found, "holes", user.found.holes[1:]), "found in the STEP file")
        self.broken(lambda user, truth: setattr(user, "first_motion", 11.5), "first move sent")


if __name__ == "__main__":
    unittest.main()

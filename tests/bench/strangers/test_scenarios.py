"""The scenarios themselves: options that the drive has, reasons that are regular expressions, names of their own."""

import re
import shlex
import unittest

import scenarios
from drive import Drive
from manners import manners_of


class Scenarios(unittest.TestCase):
    def test_make_a_drive_that_lacks_what_they_say(self):
        """Red when an option names an object that the drive has not yet when it is made, or has all the same."""
        for scenario in (scenario for kind in scenarios.KINDS for scenario in scenarios.of(kind)):
            with self.subTest(scenario.name):
                manners = manners_of(shlex.split(scenario.options))
                drive = Drive(lambda *_: None, 1, manners, 0.0)
                there = {index for index, _ in drive.d.values}
                self.assertFalse(there & {index for index in manners.absent if isinstance(index, int)})
                for key, value in manners.value:
                    self.assertEqual(drive.d.get(*key), value)

    def test_can_be_run(self):
        every = [scenario for kind in scenarios.KINDS for scenario in scenarios.of(kind)]
        for scenario in every:
            manners_of(shlex.split(scenario.options))
            re.compile(scenario.text)
            self.assertTrue(scenario.text or scenario.verdict != scenarios.REFUSED, f"{scenario.name}: a refusal has a reason")
        names = [scenario.name for scenario in every]
        self.assertEqual(len(names), len(set(names)))


if __name__ == "__main__":
    unittest.main()

"""The scenarios themselves: options that the drive has, reasons that are regular expressions, names of their own."""

import re
import shlex
import unittest

import scenarios
from manners import manners_of


class Scenarios(unittest.TestCase):
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

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LOG = (ROOT / "CHANGELOG.md").read_text()


class Changelog(unittest.TestCase):
    def test_tells_of_the_version_that_is_built(self):
        version = re.search(r"project\(rmac VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        self.assertRegex(LOG, rf"(?m)^## \[{re.escape(version)}\] - \d{{4}}-\d\d-\d\d$")

    def test_has_no_sentence_that_was_cut_off(self):
        for entry in re.findall(r"(?m)^- .*(?:\n  .*)*", LOG):
            with self.subTest(entry[:80]):
                self.assertRegex(entry, r"[.:)]\Z")

    def test_has_no_leftovers_of_a_merge(self):
        self.assertNotRegex(LOG, r"(?m)^(<{7}|={7}|>{7})")


if __name__ == "__main__":
    unittest.main()

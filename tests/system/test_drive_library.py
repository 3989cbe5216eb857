"""The descriptions of CANopen drives as shipped: all sound, none in another's way, and no value without its page."""

import copy
import json
import pathlib
import random
import re
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE

LIBRARY = SOURCE / "etc" / "drives"
# Made with the appliance and tried on it; all others are from data sheets.
OUR_OWN = "rmac-vdrive"
NEEDED = ["Name", "Manual", "Tried", "VendorId", "ProductCode"]
SAYS_WHERE_FROM = {"Name", "Manual", "Pages", "Tried"}
DONE, FAILED = 0, 1


def shipped():
    return {file.stem: json.loads(file.read_text(encoding="utf-8")) for file in sorted(LIBRARY.glob("*.json"))}


def without(document, key):
    return {name: value for name, value in document.items() if name != key}


def faults(stem, document):
    """What the library's rules have against a description; the daemon has its own, of form and sense."""
    found = []
    if stem != OUR_OWN:
        if document.get("Tried") != "never":
            found.append("Tried: none of these drives was tried")
        cited = SAYS_WHERE_FROM | document.get("Pages", {}).keys()
        found += [f"Pages: none for {key}" for key in sorted(document.keys() - cited)]
        if not re.search(r"FileRevision \w+|edition|revision", document.get("Manual", "")):
            found.append("Manual: no revision of it is named")
        if not re.search(r"\b(19|20)\d\d-\d\d", document.get("Manual", "")):
            found.append("Manual: no date of it is named")
    # The next firmware may have what this one lacks, and would be kept from using it.
    if document.get("RevisionNumber", {}).keys() != {"Min", "Max"}:
        found.append("RevisionNumber: a data sheet speaks for its own revisions alone; Min and Max are needed")
    if not re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)+", stem):
        found.append("the name is none of <vendor>-<product>")
    return found


def check(documents):
    """What rmacd --check has against a library of these descriptions: its exit code and its words."""
    with tempfile.TemporaryDirectory() as folder:
        library = pathlib.Path(folder) / "drives"
        library.mkdir()
        for stem, document in documents.items():
            text = document if isinstance(document, str) else json.dumps(document)
            (library / f"{stem}.json").write_text(text, encoding="utf-8")
        config = pathlib.Path(folder) / "rmacd.json"
        config.write_text(json.dumps({"drives_folder": str(library)}), encoding="utf-8")
        done = subprocess.run([BUILD / "bin" / "rmacd", "--check", "--config", config], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=60, check=False)
        return done.returncode, done.stderr


class ShippedDescriptions(unittest.TestCase):
    def test_are_there(self):
        self.assertIn(OUR_OWN, shipped())
        self.assertGreater(len(shipped()), 1)

    def test_are_all_taken_together_by_the_daemon(self):
        self.assertEqual(check(shipped()), (DONE, ""))

    def test_say_where_each_value_comes_from_and_that_it_was_not_tried(self):
        for stem, document in shipped().items():
            with self.subTest(stem):
                self.assertEqual(faults(stem, document), [])

    def test_guard_by_remote_frames_only_drives_that_know_no_heartbeat(self):
        for stem, document in shipped().items():
            if document.get("NodeGuarding"):
                with self.subTest(stem):
                    for index in ("100Ch", "100Dh", "1016h"):
                        self.assertIn(index, document["Pages"]["NodeGuarding"])


class BrokenDescriptions(unittest.TestCase):
    """One file broken among the others, in ways that the daemon must see: red when one of them passes."""

    def test_are_refused_by_file(self):
        chance = random.Random(402)
        documents = shipped()
        ways = {
            "cut off": lambda document: json.dumps(document)[:chance.randrange(1, len(json.dumps(document)))],
            "less a key": lambda document: without(document, chance.choice(NEEDED)),
            "a key that nobody knows": lambda document: document | {f"Skip{chance.randrange(100)}": True},
            "a page of nothing": lambda document: document | {"Pages": {f"Key{chance.randrange(100)}": "page 1"}},
            "no number": lambda document: document | {"ProductCode": "0x10"},
            "both mappings": lambda document: document | {"FixedMapping": True, "StoreAfterMapping": True},
        }
        for stem, document in documents.items():
            way = chance.choice(sorted(ways))
            with self.subTest(stem, way=way):
                code, words = check(documents | {stem: ways[way](copy.deepcopy(document))})
                self.assertEqual(code, FAILED)
                self.assertIn(f"{stem}.json", words)

    def test_for_a_drive_that_another_is_for_are_refused_with_both(self):
        for stem, document in shipped().items():
            with self.subTest(stem):
                code, words = check(shipped() | {"maker-double": document})
                self.assertEqual(code, FAILED)
                for name in (f"{stem}.json", "maker-double.json"):
                    self.assertIn(name, words)

    def test_break_the_librarys_own_rules(self):
        for stem, document in shipped().items():
            broken = {"the revisions are open": document | {"RevisionNumber": {"Min": 0}},
                      "all revisions": without(document, "RevisionNumber")}
            if stem != OUR_OWN:
                key = random.Random(stem).choice(sorted(document["Pages"]))
                broken |= {"no pages": without(document, "Pages"), "tried": document | {"Tried": "a mill"},
                           f"no page of {key}": document | {"Pages": without(document["Pages"], key)},
                           "no revision": document | {"Manual": "a manual of 2020-02"},
                           "no date": document | {"Manual": "a manual, revision C"}}
            for what, changed in broken.items():
                with self.subTest(stem, what=what):
                    self.assertNotEqual(faults(stem, changed), [])
        self.assertNotEqual(faults("Maker", shipped()[OUR_OWN]), [])


if __name__ == "__main__":
    unittest.main()

"""docs/api-effects.md has each of the dissertation's functions once, and the tests that it names are there."""

import pathlib
import re
import unittest

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
OURS = " †"


def rows(document):
    """Interface, then the cells of a row, of each table of a document."""
    interface = ""
    for line in (SOURCE / document).read_text().splitlines():
        if line.startswith("## "):
            interface = line[3:]
        elif line.startswith("| `"):
            yield interface, [cell.strip() for cell in line.strip("|").split(" | ")]


def unit_tests():
    texts = "".join(file.read_text() for file in (SOURCE / "tests/unit").rglob("*_test.cpp"))
    return {".".join(test) for test in re.findall(r"TEST(?:_[FP])?\((\w+),\s*(\w+)\)", texts)}


def system_tests():
    for file in (SOURCE / "tests/system").glob("test_*.py"):
        yield file.stem
        for name in re.findall(r"def test_(\w+)", file.read_text()):
            yield f"{file.stem} {name}"


class Effects(unittest.TestCase):
    def test_each_function_is_there_once(self):
        functions = [cells[0].strip("`") for _, cells in rows("docs/api.md") if "." in cells[0] and OURS not in cells[0]]
        told = [f"{interface}.{cells[0].strip('`')}" for interface, cells in rows("docs/api-effects.md")]
        self.assertEqual(len(functions), 143)
        self.assertEqual(told, functions)

    def test_what_observes_each_is_there(self):
        known = unit_tests() | set(system_tests())
        for interface, (function, effect, test) in rows("docs/api-effects.md"):
            with self.subTest(function=f"{interface}.{function}"):
                self.assertTrue(effect)
                self.assertTrue(test.replace("`", "") in known, f"there is no test {test}")


if __name__ == "__main__":
    unittest.main()

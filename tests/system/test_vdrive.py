"""`rmac-vdrive` and `rmac bus scan` as far as they go without a CAN interface: the rest is shown on the virtual bench."""

import os
import pathlib
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["RMAC_BUILD"])
SOURCE = pathlib.Path(os.environ["RMAC_SOURCE"])
SHEET = SOURCE / "gateway/simulators/vdrive/rmac-vdrive.eds"


def call(program, *words):
    return subprocess.run([BUILD / "bin" / program, *map(str, words)], capture_output=True, text=True, timeout=60)


class VirtualDrive(unittest.TestCase):
    def test_prints_the_data_sheet_that_it_is_made_from(self):
        done = call("rmac-vdrive", "--print-eds")
        self.assertEqual((done.returncode, done.stdout), (0, SHEET.read_text()))

    def test_shares_no_protocol_code_with_the_master(self):
        included = [line for file in (SOURCE / "gateway/simulators/vdrive").glob("*.?pp") for line in file.read_text().splitlines()
                    if line.startswith("#include") and "canopen" in line]
        self.assertEqual(included, [])

    def test_helps_with_its_commands(self):
        self.assertIn("NODE mute on|off", call("rmac-vdrive", "--help").stdout)

    def test_says_what_is_missing_or_wrong(self):
        for words, code, message in (
                ((), 2, "an interface and at least one node are needed"),
                (("no-such-can",), 2, "an interface and at least one node are needed"),
                (("no-such-can", 128), 2, "NODE: Value 128 not in range"),
                (("no-such-can", 1, 1), 1, "node 1 is given twice"),
                (("no-such-can", 1, "--at", "soon 1 mute on"), 1, "does not begin with seconds and a blank"),
                (("no-such-can", 1, "--commands", "/no/such/fifo"), 1, "/no/such/fifo: cannot be opened for commands"),
                (("no-such-can", 1), 1, "CAN interface no-such-can: ")):
            with self.subTest(words=words):
                done = call("rmac-vdrive", *words)
                self.assertEqual(done.returncode, code, done.stderr)
                self.assertIn(message, done.stderr)

    def test_names_the_line_of_a_wrong_data_sheet(self):
        with tempfile.TemporaryDirectory(prefix="rmac-test-") as folder:
            file = pathlib.Path(folder) / "mine.eds"
            text = SHEET.read_text().replace("DataType=0x0004", "DataType=four", 1)
            file.write_text(text)
            line = text[:text.index("DataType=four")].count("\n") + 1
            done = call("rmac-vdrive", "--eds", file, "no-such-can", 1)
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"mine.eds:{line}: DataType is \"four\"", done.stderr)


    def test_refuses_a_data_sheet_of_another_device(self):
        with tempfile.TemporaryDirectory(prefix="rmac-test-") as folder:
            file = pathlib.Path(folder) / "mine.eds"
            file.write_text(SHEET.read_text().replace("[6084]\nParameterName=Profile deceleration\nObjectType=0x7\nDataType=0x0007",
                                                      "[6084]\nParameterName=Profile deceleration\nObjectType=0x7\nDataType=0x0006"))
            text = file.read_text().replace("DefaultValue=13107200", "DefaultValue=1000")
            file.write_text(text)
            done = call("rmac-vdrive", "--eds", file, "no-such-can", 1)
        self.assertEqual(done.returncode, 1)
        self.assertIn("mine.eds: 6084h:00 (Profile deceleration) is of another type", done.stderr)


class BusScan(unittest.TestCase):
    def test_says_what_is_wrong_with_the_interface(self):
        done = call("rmac", "bus", "scan", "no-such-can")
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith("rmac: CAN interface no-such-can: "), done.stderr)

    def test_stores_nothing_where_there_is_no_interface(self):
        for command in ("store", "restore"):
            done = call("rmac", "bus", command, "no-such-can", 3)
            self.assertEqual(done.returncode, 1)
            self.assertTrue(done.stderr.startswith("rmac: CAN interface no-such-can: "), done.stderr)
            self.assertEqual(call("rmac", "bus", command, "no-such-can", 128).returncode, 2)

    def test_wants_an_interface_and_a_folder_that_exists(self):
        self.assertEqual(call("rmac", "bus", "scan").returncode, 2)
        self.assertEqual(call("rmac", "bus", "scan", "can0", "--eds", "/no/such/folder").returncode, 2)

    def test_moves_and_sets_nothing_where_there_is_no_interface(self):
        for words in (("lss", "scan", "no-such-can"), ("lss", "assign", "no-such-can", 4), ("lss", "bit-rate", "no-such-can", 500000),
                      ("move", "no-such-can", 1, "--mode", "pp", "--amount", -100, "--within", 200)):
            with self.subTest(words=words):
                done = call("rmac", "bus", *words)
                self.assertEqual(done.returncode, 1)
                self.assertTrue(done.stderr.startswith("rmac: CAN interface no-such-can: "), done.stderr)

    def test_wants_to_know_what_to_move_and_how_far(self):
        for words in (("move", "can0", 1), ("move", "can0", 1, "--mode", "walk", "--amount", 1, "--within", 2),
                      ("move", "can0", 1, "--mode", "pp", "--amount", 1, "--within", 0), ("lss",),
                      ("lss", "assign", "can0", 127), ("lss", "assign", "can0", 4, "--identity", 1, 2, 3)):
            with self.subTest(words=words):
                self.assertEqual(call("rmac", "bus", *words).returncode, 2)


if __name__ == "__main__":
    unittest.main()

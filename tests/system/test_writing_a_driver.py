"""docs/writing-a-driver.md, done as it is written: against an installation, in an empty folder, with its own commands."""

import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from appliance import BUILD, SOURCE, Appliance

PAGE = SOURCE / "docs/writing-a-driver.md"
EXAMPLE = SOURCE / "docs/examples/table-scara"
UPPER_ARM, FOREARM = 200, 150


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGE.read_text(), re.DOTALL | re.MULTILINE)


def tip(joints):
    """Where the tool interface is, by the definition of the machine."""
    shoulder, hand = math.radians(joints[0]), math.radians(joints[0] + joints[1])
    return (UPPER_ARM * math.cos(shoulder) + FOREARM * math.cos(hand),
            UPPER_ARM * math.sin(shoulder) + FOREARM * math.sin(hand), joints[2])


class WritingADriver(unittest.TestCase):
    def test_page_quotes_the_files_of_the_example(self):
        quoted = blocks("cmake") + blocks("cpp") + blocks("json")
        files = {file.name: file.read_text() for file in EXAMPLE.iterdir()}
        self.assertEqual(sorted(quoted), sorted(files.values()))
        for name in files:
            self.assertIn(f"### {name}\n", PAGE.read_text())

    def test_commands_of_the_page_lead_to_a_machine_that_moves(self):
        folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        prefix = folder / "usr"
        subprocess.run(["cmake", "--install", BUILD, "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
        work = folder / "table-scara"
        shutil.copytree(EXAMPLE, work)
        (tree,) = prefix.glob("lib/**/rmac/drivers")
        with Appliance(program=prefix / "sbin/rmacd", device_tree=str(tree)) as appliance:
            environment = os.environ | {"PATH": f"{prefix}/bin:{os.environ['PATH']}", "RMAC_PORT": str(appliance.port),
                                        "CMAKE_PREFIX_PATH": str(prefix)}
            said = []
            for command in "".join(blocks("sh")).splitlines():
                ours = command.replace("/usr", str(prefix)).removeprefix("sudo ")
                done = subprocess.run(ours, shell=True, cwd=work, env=environment, stdin=subprocess.DEVNULL,
                                      capture_output=True, text=True, timeout=240, check=False)
                self.assertEqual((done.returncode, done.stderr), (0, ""), f"{command}\n{done.stdout}")
                said.append(done.stdout)
            self.assertTrue(any("TableScara may go live" in text for text in said), said)
            state = appliance.client().state()
            self.assertEqual(state["mechanism"], "TableScara")
            for value, wanted in zip(tip(state["joints"]), (250, -50, -20)):
                self.assertAlmostEqual(value, wanted, delta=0.02)


if __name__ == "__main__":
    unittest.main()

"""`rmac bus load`: what a machine's CAN buses carry at worst, from its device.json, without a daemon."""

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["RMAC_BUILD"])
SOURCE = pathlib.Path(os.environ["RMAC_SOURCE"])


class BusLoad(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.file = pathlib.Path(folder.name) / "device.json"
        self.device = json.loads((SOURCE / "drivers/mill/3-axis/DMACXYZ/device.json").read_text())

    def load(self, parameters, *options, spindle_bus="can0", sensor_bus="can0"):
        for actuator in self.device["Actuators"]:
            actuator["Bus"] = "can0"
        self.device["Joints"][2]["ForceSensor"]["Bus"] = sensor_bus
        self.device["Spindles"][0].update(Bus=spindle_bus, Axis=3 if spindle_bus == "can0" else 0)
        self.device["DigitalControlInterface"] = {"Module": "CANopenInterface", "Parameters": parameters}
        self.file.write_text(json.dumps(self.device))
        return subprocess.run([BUILD / "bin" / "rmac", "bus", "load", self.file, *options], capture_output=True, text=True)

    def test_knows_the_drives_of_a_library(self):
        """A machine that names its drive is refused with a description that is wrong, and no other machine is."""
        drives = self.file.parent / "drives"
        drives.mkdir()
        (drives / "maker-drive.json").write_text(json.dumps(
            {"Name": "a", "Manual": "b", "Tried": "never", "VendorId": 1, "ProductCode": 2, "SdoTimeout": 0}))
        parameters = {"node": [1, 2, 3, 4], "tpdo": "6041:00/16"}
        self.assertEqual(self.load(parameters, "--drives", drives).stderr, "")
        refused = self.load(parameters | {"drive_1": "maker-drive"}, "--drives", drives)
        self.assertEqual(refused.returncode, 1)
        self.assertIn("maker-drive.json: /SdoTimeout is 0", refused.stderr)

    def test_tells_each_bus_with_its_bits(self):
        done = self.load({"can0.node": [1, 2, 3], "can1.node": 4, "can1.mode": 3, "can0.tpdo": "6041:00/16 6064:00/32"},
                         "--json", spindle_bus="can1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        table, head = json.loads(done.stdout)
        # Three times 4 and 6 bytes beside SYNC; once 6 and 6 bytes. With all that could be stuffed whatever the identifiers: 55, 95, 115.
        self.assertEqual((table["bus"], table["axes"], table["cyclic_bits"]), ("can0", 3, 53 + (92 + 93 + 92) + (111 + 112 + 111)))
        self.assertEqual((head["bus"], head["axes"], head["cyclic_bits"]), ("can1", 1, 53 + 112 + 111))
        self.assertTrue(table["fits"] and head["fits"])

    def test_takes_a_machine_by_its_name_or_its_folder(self):
        answers = []
        for machine in ("TarusXYZCA", SOURCE / "drivers/mill/5-axis/TarusXYZCA"):
            done = subprocess.run([BUILD / "bin" / "rmac", "bus", "load", machine, "--device-tree", BUILD / "drivers", "--json"],
                                  capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            answers.append(json.loads(done.stdout))
        self.assertEqual([bus["bus"] for bus in answers[0]], ["can0", "can1"])
        self.assertEqual(answers[0], answers[1])
        done = subprocess.run([BUILD / "bin" / "rmac", "bus", "load", "Nobody", "--device-tree", BUILD / "drivers"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn('there is no machine "Nobody"', done.stderr)
        self.assertIn("TarusXYZCA", done.stderr)

    def test_counts_a_bus_that_a_force_sensor_has_for_itself(self):
        parameters = {"can0.node": [1, 2, 3, 4], "can1.node": 5, "can1.second_tpdo": "6401:01/16"}
        done = self.load(parameters, "--json", "--period", "0.002", sensor_bus="can1")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([(bus["bus"], bus["axes"]) for bus in json.loads(done.stdout)], [("can0", 4), ("can1", 1)])

    def test_fails_above_the_share_and_says_what_helps(self):
        parameters = {"node": [1, 2, 3, 4], "mode": [10, 10, 10, 3], "rpdo": "6040:00/16 607A:00/32 6071:00/16"}
        parameters["tpdo"] = "6041:00/16 6064:00/32 6077:00/16"
        done = self.load(parameters)
        self.assertEqual(done.returncode, 1)
        self.assertIn("  111 ", done.stdout)
        self.assertEqual(done.stderr.splitlines(), [
            "rmac: bus can0: 4 axes in a cycle of 1 ms need 1110 bits, 111.0 % of the 1000 that 1000000 bit/s give; its share "
            "is 80 %. Take a cycle of 1.39 ms or more, spread the axes over several buses, or map less"])
        self.assertEqual(self.load(parameters, "--period", "0.002").returncode, 0)

    def test_names_a_parameter_that_is_wrong(self):
        done = self.load({"node": [1, 2, 3, 200]})
        self.assertEqual(done.returncode, 1)
        self.assertIn("CANopenInterface, bus can0: node is 200; allowed is a whole number from 1 to 127", done.stderr)

    def test_holds_the_drives_against_their_data_sheet(self):
        folder = self.file.parent / "canopen"
        folder.mkdir()
        sheet = (SOURCE / "gateway/simulators/vdrive/rmac-vdrive.eds").read_text()
        (folder / "servo.eds").write_text(sheet)
        parameters = {"node": [1, 2, 3, 4], "mode": [10, 10, 10, 3], "eds": "servo"}
        self.assertEqual(self.load(parameters, "--period", "0.002").stderr, "")
        line = sheet[:sheet.index("[6066]")].count("\n") + 1
        done = self.load(dict(parameters, tpdo="6041:00/16 6066:00/16"), "--period", "0.002")
        self.assertEqual(done.returncode, 1)
        self.assertIn(f"axis 0: {folder}/servo.eds:{line}: 6066h:00 (Following error time out) cannot be mapped into a PDO",
                      done.stderr)
        done = self.load(dict(parameters, eds="other"), "--period", "0.002")
        self.assertIn(f"there is no EDS other: no file other.eds in {folder}, ", done.stderr)
        self.assertIn("/modules/canopen", done.stderr)

    def test_finds_a_data_sheet_that_is_there_for_all_machines(self):
        shared = BUILD / "drivers" / "modules" / "canopen"
        name = f"test-{os.getpid()}"
        shared.mkdir(exist_ok=True)
        sheet = shared / f"{name}.eds"
        self.addCleanup(sheet.unlink)
        shutil.copy(SOURCE / "gateway/simulators/vdrive/rmac-vdrive.eds", sheet)
        self.assertEqual(self.load({"node": [1, 2, 3, 4], "mode": [10, 10, 10, 3], "eds": name}, "--period", "0.002").stderr, "")

    def test_refuses_a_machine_without_a_can_bus(self):
        done = subprocess.run([BUILD / "bin" / "rmac", "bus", "load", SOURCE / "drivers/mill/3-axis/DMACXYZ/device.json"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("its drives are reached by SimulatedInterface, which is no CAN bus", done.stderr)


if __name__ == "__main__":
    unittest.main()

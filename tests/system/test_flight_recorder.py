"""The flight recorder of a real daemon: a fault leaves a record that `rmac trace` lists, fetches and draws."""

import csv
import json
import pathlib
import tempfile
import unittest

from appliance import Appliance
from bending_mill import device_of, rigid

PNG = b"\x89PNG\r\n\x1a\n"


class FlightRecorder(unittest.TestCase):
    def start(self, **configuration):
        appliance = Appliance(own_tree=True, **configuration)
        with device_of(appliance) as device:
            rigid(device)
        return self.enterContext(appliance)

    def fault(self, appliance):
        """Moves until the machine faults; the events of the fault and of its record."""
        client = appliance.client("operator")
        client.call("subscribe", topics=["events"])
        client.call("authority.acquire")
        client.call("Device.Load", Name="DMACXYZ")
        # So weak a loop that the first motion is a fault.
        client.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[15, 0, 0.1])
        client.call("RMAC_Config.Apply")
        client.call("RMAC_CAM.JogJoint", JntNum=0, Distance=50)
        fault = client.wait_note("events", lambda event: event["kind"] == "Fault")
        record = client.wait_note("events", lambda event: event["kind"].startswith("FlightRecord"))
        return client, fault, record

    def rmac(self, appliance, *words):
        done = appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return done.stdout

    def test_a_fault_is_recorded_fetched_and_drawn(self):
        appliance = self.start(flight_recorder={"seconds": 1})
        client, fault, record = self.fault(appliance)
        self.assertEqual((record["kind"], record["record"]), ("FlightRecord", fault["record"]))
        self.assertIn("stands still", fault["message"])
        self.assertEqual(client.state()["last_stop"], fault)

        status = self.rmac(appliance, "status")
        self.assertIn(f"cycle {fault['cycle']}", status)
        self.assertIn(f"rmac trace plot {fault['record']}", status)
        self.assertIn(fault["message"], status)
        self.assertIn("rmac reset", status)
        self.assertIn(fault["record"], self.rmac(appliance, "trace"))
        listed = json.loads(self.rmac(appliance, "--json", "trace", "list"))
        self.assertEqual([entry["cycle"] for entry in listed], [fault["cycle"]])
        self.assertTrue((appliance.folder / "state" / "flight-records" / f"{fault['record']}.flight").exists())

        with tempfile.TemporaryDirectory() as folder:
            table, picture = pathlib.Path(folder, "fault.csv"), pathlib.Path(folder, "fault.png")
            self.rmac(appliance, "trace", "export", fault["record"], "--output", str(table))
            self.rmac(appliance, "trace", "plot", "--output", str(picture))
            with table.open(newline="") as file:
                rows = list(csv.DictReader(file))
            self.assertTrue(picture.read_bytes().startswith(PNG))
        cycles = [int(row["cycle"]) for row in rows]
        self.assertEqual(cycles, list(range(cycles[0], cycles[0] + len(cycles))))
        first = next(row for row in rows if row["fault"] != "None")
        self.assertEqual((int(first["cycle"]), first["fault"]), (fault["cycle"], "StandsStill"))
        error = max(abs(float(first[f"q{joint}"]) - float(first[f"a{joint}"])) for joint in (1, 2, 3))
        self.assertEqual(error, abs(float(first["fault_value"])))
        self.assertGreater(error, float(first["fault_bound"]))

    def test_asked_for_without_authority(self):
        appliance = self.enterContext(Appliance(flight_recorder={"seconds": 0.1, "files": 1}))
        refused = appliance.rmac("trace", "record")
        self.assertEqual(refused.returncode, 1)
        self.assertIn("no mechanism is loaded", refused.stderr)
        empty = appliance.rmac("trace", "export")
        self.assertEqual(empty.returncode, 1)
        self.assertIn("no flight record yet", empty.stderr)
        client = appliance.operator()
        recorded = client.state()["cycle"] + 100  # From here on the mechanism is in, whenever that was.
        client.call("subscribe", topics=["state"])
        client.wait_note("state", lambda state: state["cycle"] > recorded)
        client.call("unsubscribe")
        for _ in range(2):
            told = self.rmac(appliance, "trace", "record")
        self.assertEqual(len(json.loads(self.rmac(appliance, "--json", "trace"))), 1)
        rows = list(csv.DictReader(self.rmac(appliance, "trace", "export", "-o", "-").splitlines()))
        self.assertEqual(len(rows), 100)
        self.assertIn(f"cycles {rows[0]['cycle']} to {rows[-1]['cycle']}", told)

    def test_a_folder_that_cannot_be_written_is_told_and_stops_nothing(self):
        appliance = self.start(flight_recorder={"folder": "/dev/null/records"})
        client, fault, record = self.fault(appliance)
        self.assertEqual((record["kind"], record["record"]), ("FlightRecordFailed", fault["record"]))
        self.assertIn("/dev/null/records", record["message"])
        self.assertTrue(client.call("RMAC_CAM.Reset"))
        self.assertEqual(client.state()["mechanism"], "DMACXYZ")


if __name__ == "__main__":
    unittest.main()

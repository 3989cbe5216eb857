"""The nine steps of section 4.8, from the model to the part, with `rmac` alone, on each machine of the device tree."""

import csv
import json
import unittest

from appliance import Appliance, line, pose

# Its drives are on CAN buses that a test does not have, so it is gone through in virtual mode.
ON_CAN = {"TarusXYZCA"}
# Step 1, the model: a square of 10 mm in the plane z = 0, which every mill reaches.
CORNERS = [(5, 5, 0), (15, 5, 0), (15, 15, 0), (5, 15, 0), (5, 5, 0)]
# And of the measuring machine: the top of the block that lies on it (drivers/cmm/3-axis/CMM/device.json).
TOP, TIP_RADIUS = -20.0, 1.0


def square():
    """Step 2, the process plan of a mill."""
    requests = [("SetFeedrate", {"Feedrate": 1200}),
                ("MoveToPathTarget", {"MoveID": 1, "TargetFrame": pose(*CORNERS[0])})]
    return requests + [("MoveAlongLine", line(start, end, number))
                       for number, (start, end) in enumerate(zip(CORNERS, CORNERS[1:]), 2)]


def touch():
    """Step 2, of the measuring machine."""
    points = [(15, 0), (0, 12), (-15, 0)]
    requests = [("CycleStart", {"Mode": "AUTOMATIC"})]  # a point is measured before the next move is sent
    for number, (x, y) in enumerate(points):
        requests.append(("MoveToXYZ", {"MoveID": 10 * number, "x": x, "y": y, "z": -14, "Speed": 20}))
        requests.append(("AutoMeasure", {"MoveID": 10 * number + 1, "x": x, "y": y, "z": TOP + TIP_RADIUS,
                                         "Speed": 20}))
    return requests


class NineSteps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())
        listed = json.loads(cls.appliance.rmac("--json", "machines").stdout)
        cls.machines = {machine["Name"]: machine for machine in listed}

    def rmac(self, *words):
        done = self.appliance.rmac(*words)
        self.assertEqual(done.returncode, 0, f"rmac {' '.join(words)}: {done.stderr}")
        return done.stdout

    def program(self, name, requests):
        file = self.appliance.folder / f"{name}.rmac"
        file.write_text("".join(
            json.dumps({"jsonrpc": "2.0", "id": i, "method": "RMAC_CAM." + function, "params": params}) + "\n"
            for i, (function, params) in enumerate(requests)))
        return str(file)

    def go_through(self, name):
        machine = self.machines[name]
        measures = machine["Type"] == "CMM"
        requests = touch() if measures else square()
        program = self.program(name, requests)
        # 3. Search and select: by what the machine is, and by whether it can do the program.
        found = json.loads(self.rmac(
            "--json", "machines", "--type", machine["Type"], "--joints", str(machine["NumberOfJoints"]), "--fits",
            program, "--device-tree", str(self.appliance.tree)))
        candidate, = (one for one in found if one["Name"] == name)
        self.assertTrue(candidate["Fits"], candidate.get("WhyNot"))
        # 4. The device driver manager tells of its driver.
        shown = json.loads(self.rmac("--json", "show", name))
        self.assertEqual((shown["Name"], shown["NumberOfJoints"]), (name, machine["NumberOfJoints"]))
        # 5. and 6. The driver is loaded, and configures the controller.
        virtual = ["--virtual"] if name in ON_CAN else []
        self.rmac("load", name, *virtual)
        loaded = json.loads(self.rmac("--json", "show", name))
        self.assertEqual(len(loaded["Joints"]), machine["NumberOfJoints"])
        # 7. to 9. The program goes to the driver, and the machine works.
        self.rmac("home")
        record = self.appliance.folder / f"{name}.csv"
        done = json.loads(self.rmac("--json", "run", program, "--record", str(record)))
        self.assertEqual(done["moves"], len([one for one in requests if "MoveID" in one[1]]))
        with open(record, newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        last = [float(rows[-1][axis]) for axis in "xyz"]
        if measures:
            lowest = min(float(row["z"]) for row in rows)
            self.assertLess(lowest, TOP + TIP_RADIUS + 1e-3, "it touched the top")
            self.assertGreater(lowest, TOP, "and stopped there")
        else:
            for value, wanted in zip(last, CORNERS[-1]):
                self.assertAlmostEqual(value, wanted, delta=1e-6)
            for corner in CORNERS:
                nearest = min(max(abs(float(row[axis]) - wanted) for axis, wanted in zip("xyz", corner))
                              for row in rows)
                self.assertLess(nearest, 0.05, f"corner {corner}")
        self.rmac("unload")

    def test_every_machine_goes_from_the_model_to_the_part(self):
        self.assertGreaterEqual(len(self.machines), 9)
        for name in self.machines:
            with self.subTest(machine=name):
                self.go_through(name)


if __name__ == "__main__":
    unittest.main()

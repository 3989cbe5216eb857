"""Machines with other axes than the tree gives them: rigid ones, or (DMACXYZ) of two masses with resonances of one's own."""

import contextlib
import json
import unittest

import numpy as np
from appliance import Appliance

RAD_PER_MM = 2 * np.pi / 5
MOTOR, TABLE = 0.93e-5, 1.27e-5  # kg·m² at the shaft, on either side of the spring
NOISY = {"torque_ripple": [0.01] * 8, "encoder_noise_counts": [1] * 8, "encoder_interpolation_counts": [2] * 8}
BENDING = ("stiffness_nm_rad", "load_inertia_kg_m2", "presliding_turns", "cogging", *NOISY)
# What suits rigid axes, by the bus that they are on: Kp = 44.8 m, Ki = 90 Kp, Kd = 0.32 m, and what feedforward knows of them.
STIFF = {
    "sim0": {"X": [1550, 140000, 11.1], "Y": [1820, 164000, 13.0], "Z": [1195, 107500, 8.5]},
    "sugino0": {"X": [10610, 955100, 75.8, 0.03948, 0.2369, 94.25, 0], "Y": [12730, 1146000, 90.96, 0.03948, 0.2842, 94.25, 0],
                "Z": [9197, 827700, 65.69, 0.03948, 0.2053, 75.4, 119.4], "A": [1900, 171000, 13.57, 0.01414, 0.04241, 9, 0],
                "C": [1583, 142500, 11.31, 0.01414, 0.03534, 9, 0]},
    # For drives that answer a cycle late: Kp = 15 m, Ki = 60 Kp, Kd = 0.22 m.
    "can0": {"X": [44400, 2664000, 651.4, 0.03948, 2.961, 377, 0], "Y": [38490, 2309000, 564.5, 0.03948, 2.566, 377, 0],
             "Z": [32570, 1954000, 477.6, 0.03948, 2.171, 314.2, 628.3], "C": [848, 50900, 12.44, 0.01414, 0.05655, 13.5, 0],
             "A": [848, 50900, 12.44, 0.01414, 0.05655, 13.5, 0]},
}
STIFF["tarus0"] = STIFF["can0"]


def rigid(device, **parameters):
    """Its axes, as these parameters of the simulated bus have them beside what is no bending, with loops for such and nothing else."""
    bus = device["DigitalControlInterface"]["Parameters"]
    for name in [name for name in bus if name.rpartition(".model.")[2] in BENDING]:
        del bus[name]
    bus.update(parameters)
    for actuator in device["Actuators"]:
        actuator.pop("Cogging", None)
    for data in device["Joints"] + device["HeldJoints"]:
        data["Gains"] = gains = list(STIFF[device["Actuators"][0]["Bus"]][data["Name"]])
        of_pid = {"rest_band": 0.002, "load": 117.7 if data["Name"] == "Z" else 0}
        data["ServoControlLaw"]["Parameters"] = of_pid if len(gains) == 3 else {"lead_s": 0.0017}
        for filters in ("Resonances", "LowPass"):
            data.pop(filters, None)


@contextlib.contextmanager
def device_of(appliance, name="DMACXYZ"):
    """That machine's data in the tree of its own that the appliance has; what becomes of it is written there."""
    file = next(appliance.tree.glob(f"*/*/{name}/device.json"))
    device = json.loads(file.read_text())
    yield device
    file.write_text(json.dumps(device))


def bend(appliance, hz, joint, heavier=1.0, **more):
    """Has its axes swing at `hz`, so many times heavier than it says, with `joint` in the data of these joints, and `more` parameters of the
    simulated bus."""
    motor, table = MOTOR * heavier, TABLE * heavier
    stiffness = (2 * np.pi * hz) ** 2 * motor * table / (motor + table)
    with device_of(appliance) as device:
        rigid(device, **{
            "stiffness_nm_rad": [stiffness] * 3 + [0] * 5, "load_inertia_kg_m2": [table] * 3 + [0] * 5,
            "inertia_kg_m2": [motor + table] * 3 + [2.2e-5] * 5,
            "presliding_turns": [0.002] * 8, "cogging": [0.02] * 8, **more})
        for data in device["Joints"][:3]:
            data.update(joint)


def on_two_motors(appliance, axis=4):
    """Has X of that mill moved by two motors, its own and this axis of the bus, which is as that, under twice the gains."""
    with device_of(appliance) as device:
        device["ActuatorMap"] = {"Module": "TransmissionMap", "Parameters": {
            "transmissions": "gantry screw screw", "t1": [5, 1], "t2": [5, 1], "t3": [5, 1]}}
        device["Actuators"].insert(1, {**device["Actuators"][0], "Axis": axis})
        joint = device["Joints"][0]
        joint.update({"Gains": [2 * gain for gain in joint["Gains"]], "MaxEffort": 2 * joint["MaxEffort"]})
        parameters = device["DigitalControlInterface"]["Parameters"]
        for name in ("stiffness_nm_rad", "load_inertia_kg_m2", "inertia_kg_m2"):
            if name in parameters:
                parameters[name][axis] = parameters[name][0]


class TuningTest(unittest.TestCase):
    def rmac(self, appliance, *words):
        done = appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (0, ""), words)
        return done.stdout

    @contextlib.contextmanager
    def bending(self, hz, joint, heavier=1.0, load=True):
        """DMACXYZ, with axes of two masses that swing at `hz`, so many times heavier than it says, and `joint` in the
        data of its first three."""
        appliance = Appliance(own_tree=True, flight_recorder={"seconds": 30})
        bend(appliance, hz, joint, heavier)
        with appliance:
            if load:
                self.rmac(appliance, "load", "DMACXYZ")
            yield appliance

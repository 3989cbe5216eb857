"""DMACXYZ with other axes than the tree gives it: rigid ones, or of two masses with resonances of one's own."""

import json

import numpy as np

MOTOR, TABLE = 0.93e-5, 1.27e-5  # kg·m² at the shaft, on either side of the spring
NOISY = {"torque_ripple": [0.01] * 8, "encoder_noise_counts": [1] * 8, "encoder_interpolation_counts": [2] * 8}
STIFF = {"X": [1550, 140000, 11.1], "Y": [1820, 164000, 13.0], "Z": [1195, 107500, 8.5]}  # docs/servo.md: Kp = 44.8 m, ...


def rigid(device, **parameters):
    """Its axes, as these parameters of the simulated bus have them, with PID for such and nothing else."""
    device["DigitalControlInterface"]["Parameters"] = parameters
    for actuator in device["Actuators"]:
        actuator.pop("Cogging", None)
    for data in device["Joints"] + device["HeldJoints"]:
        data["Gains"] = STIFF[data["Name"]]
        data["ServoControlLaw"]["Parameters"] = {"rest_band": 0.002, "load": 117.7 if data["Name"] == "Z" else 0}
        for filters in ("Resonances", "LowPass"):
            data.pop(filters, None)


def bend(appliance, hz, joint, heavier=1.0, **more):
    """Writes it into the tree of its own that the appliance has: resonances at `hz`, so many times heavier than it says, `joint` in the data
    of these joints, and `more` parameters of the simulated bus."""
    file = next(appliance.tree.glob("*/*/DMACXYZ/device.json"))
    device = json.loads(file.read_text())
    motor, table = MOTOR * heavier, TABLE * heavier
    stiffness = (2 * np.pi * hz) ** 2 * motor * table / (motor + table)
    rigid(device, **{
        "stiffness_nm_rad": [stiffness] * 3 + [0] * 5, "load_inertia_kg_m2": [table] * 3 + [0] * 5,
        "inertia_kg_m2": [motor + table] * 3 + [2.2e-5] * 5,
        "presliding_turns": [0.002] * 8, "cogging": [0.02] * 8, **more})
    for data in device["Joints"][:3]:
        data.update(joint)
    file.write_text(json.dumps(device))

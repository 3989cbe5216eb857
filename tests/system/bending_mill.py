"""DMACXYZ whose first three axes are two masses, stick and cog, as docs/simulated-bus.md assumes them."""

import json

import numpy as np

MOTOR, TABLE = 0.93e-5, 1.27e-5  # kg·m² at the shaft, on either side of the spring
NOISY = {"torque_ripple": [0.01] * 8, "encoder_noise_counts": [1] * 8, "encoder_interpolation_counts": [2] * 8}


def bend(appliance, hz, joint, heavier=1.0, **more):
    """Writes it into the tree of its own that the appliance has: resonances at `hz`, so many times heavier than it says, `joint` in the data
    of these joints, and `more` parameters of the simulated bus."""
    file = next(appliance.tree.glob("*/*/DMACXYZ/device.json"))
    device = json.loads(file.read_text())
    motor, table = MOTOR * heavier, TABLE * heavier
    stiffness = (2 * np.pi * hz) ** 2 * motor * table / (motor + table)
    device["DigitalControlInterface"]["Parameters"] = {
        "stiffness_nm_rad": [stiffness] * 3 + [0] * 5, "load_inertia_kg_m2": [table] * 3 + [0] * 5,
        "inertia_kg_m2": [motor + table] * 3 + [2.2e-5] * 5,
        "presliding_turns": [0.002] * 8, "cogging": [0.02] * 8, **more}
    for data in device["Joints"][:3]:
        data.update(joint)
    device["Joints"][2]["ServoControlLaw"]["Parameters"]["load"] = [117.7]
    file.write_text(json.dumps(device))

"""The chain of SuginoXYZAC from the part to the tool (C A X Y Z), by formulas that share nothing with the appliance. mm and degrees, part frame."""

import clamping
import numpy as np

CRADLE = -60.0  # height of the line about which A turns, machine frame


def places(joints, along):
    """Where the point of the tool's axis that is `along` above its tip is against the part, for each row of joints."""
    x, y, z, a, c = joints[:, :5].T
    a, c = np.radians(a), np.radians(c)
    z = z - clamping.TOOL_LENGTH + along - CRADLE
    y, z = y * np.cos(a) - z * np.sin(a), y * np.sin(a) + z * np.cos(a)
    return np.stack([x * np.cos(c) - y * np.sin(c), x * np.sin(c) + y * np.cos(c), z + CRADLE], axis=1) - clamping.PART_FRAME


def joints(pose):
    """Joints that bring the tool there, (tip, axis); of the two ways the one that turns C by less than 90 degrees."""
    i, j, k = pose[3:] / np.linalg.norm(pose[3:])
    side = -1 if j > 0 else 1
    a, c = side * np.arccos(k), np.arctan2(side * i, -side * j)
    x, y, z = pose[:3] + clamping.PART_FRAME
    x, y, z = x * np.cos(c) + y * np.sin(c), -x * np.sin(c) + y * np.cos(c), z - CRADLE
    y, z = y * np.cos(a) + z * np.sin(a), -y * np.sin(a) + z * np.cos(a)
    return [x, y, z + CRADLE + clamping.TOOL_LENGTH, np.degrees(a), np.degrees(c)]

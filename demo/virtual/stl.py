"""Binary STL, in and out."""

import numpy as np

RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def write(file, points, triangles):
    table = np.zeros(len(triangles), RECORD)
    table["corners"] = points[triangles]
    normals = np.cross(table["corners"][:, 1] - table["corners"][:, 0], table["corners"][:, 2] - table["corners"][:, 0])
    table["normal"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    file.write_bytes(b"\0" * 80 + np.uint32(len(table)).tobytes() + table.tobytes())


def corners(file):
    """Those of all triangles, (n, 3)."""
    data = file.read_bytes()
    table = np.frombuffer(data, RECORD, count=int(np.frombuffer(data, "<u4", 1, 80)[0]), offset=84)
    return table["corners"].reshape(-1, 3).astype(float)

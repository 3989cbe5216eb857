"""Draws the bodies of a machine, as its device.json has them under Geometry, with all joints at 0."""

import pathlib
import struct

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

AROUND = np.linspace(0, 2 * np.pi, 33)[:-1]
INCH_MM = 25.4
MOST_FACES = 20000  # more are not seen, and take matplotlib minutes


def box(size):
    x, y, z = np.array(size) / 2
    corners = np.array([[sx * x, sy * y, sz * z] for sz in (-1, 1) for sy in (-1, 1) for sx in (-1, 1)])
    return [corners[list(face)] for face in ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))]


def rings(radii_and_heights):
    """The faces of what turns about z: between each ring and the next, and both ends."""
    circles = [np.column_stack((r * np.cos(AROUND), r * np.sin(AROUND), np.full(len(AROUND), z))) for r, z in radii_and_heights]
    faces = [circles[0], circles[-1]]
    for low, high in zip(circles, circles[1:]):
        faces += [np.array([low[i - 1], low[i], high[i], high[i - 1]]) for i in range(len(AROUND))]
    return faces


def read_mesh(path, unit):
    """Triangles of an STL, text or binary, or an OBJ file."""
    data = pathlib.Path(path).read_bytes()
    scale = INCH_MM if unit == "inch" else 1.0
    if path.suffix.lower() == ".obj":
        words = [line.split() for line in data.decode().splitlines() if line[:2] in ("v ", "f ")]
        points = np.array([[float(c) for c in w[1:4]] for w in words if w[0] == "v"]) * scale
        numbers = [[int(c.split("/")[0]) for c in w[1:]] for w in words if w[0] == "f"]
        return [points[[n - 1 if n > 0 else n for n in face]] for face in numbers]
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
    if len(data) == 84 + 50 * count:
        facets = np.frombuffer(data, np.dtype([("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")]), count, 84)
        return list(facets["p"] * scale)
    corners = [[float(c) for c in line.split()[1:4]] for line in data.decode().splitlines() if line.split()[:1] == ["vertex"]]
    return list(np.array(corners).reshape(-1, 3, 3) * scale)


def faces(shape, folder):
    kind, of = next(iter(shape.items()))
    if kind == "Box":
        return box(of["Size"])
    if kind == "Mesh":
        return read_mesh(folder / of["File"], of.get("Unit", "mm"))[:MOST_FACES]
    if kind == "Sphere":
        lean = np.linspace(-np.pi / 2, np.pi / 2, 17)
        return rings([(of["Radius"] * np.cos(a), of["Radius"] * np.sin(a)) for a in lean])
    half = of["Height"] / 2
    return rings([(of["Radius"], -half), (of["Radius"] if kind == "Cylinder" else of.get("TopRadius", 0), half)])


def turn(pose):
    """The rotation of `q`, or the shortest one that brings z to `axis`."""
    if "q" in pose:
        w, v = pose["q"][0], np.array(pose["q"][1:])
    else:
        axis = np.array(pose.get("axis", [0, 0, 1]), float)
        if axis[2] < -1 + 1e-12:
            return np.diag([1.0, -1.0, -1.0])
        w, v = 1 + axis[2], np.array([-axis[1], axis[0], 0.0])
        size = np.sqrt(w * w + v @ v)
        w, v = w / size, v / size
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


def draw_bodies(axes, device, folder):
    corners = []
    for body in device["Geometry"]:
        pose = body.get("Pose", {"p": [0, 0, 0]})
        placed = [face @ turn(pose).T + np.array(pose["p"]) for face in faces(body["Shape"], folder)]
        axes.add_collection3d(Poly3DCollection(placed, facecolor=body.get("Colour", "#9aa3ab"), edgecolor="#00000030",
                                               linewidth=0.3, alpha=0.75))
        corners.append(np.concatenate(placed))
    corners = np.concatenate(corners)
    low, high = corners.min(axis=0), corners.max(axis=0)
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]), xlabel="mm")
    axes.set_box_aspect(high - low, zoom=0.95)
    axes.tick_params(labelsize=7, pad=-2)
    axes.view_init(elev=22, azim=-60)
    axes.set_title("Bodies, all joints at 0", fontsize=9)

"""The part: a block whose top is a free form, by a formula. Part frame, mm; z is 0 at its foot."""

import numpy as np

LENGTH, WIDTH = 60.0, 40.0  # along x and y, about the middle
STOCK_HEIGHT = 20.5


def height(x, y):
    """Of the top; it goes on beside the block."""
    return 19 - x**2 / 260 - y**2 / 200 + x * y / 400 + 0.8 * np.sin(x / 8) * np.cos(y / 12)


def slopes(x, y):
    """dz/dx and dz/dy."""
    along = -x / 130 + y / 400 + 0.1 * np.cos(x / 8) * np.cos(y / 12)
    across = -y / 100 + x / 400 - 0.8 / 12 * np.sin(x / 8) * np.sin(y / 12)
    return along, across


def surface(x, y):
    """Points of the top and its unit normals, (…, 3) each."""
    x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
    along, across = slopes(x, y)
    normals = np.stack([-along, -across, np.ones_like(x)], axis=-1)
    return np.stack([x, y, height(x, y)], axis=-1), normals / np.linalg.norm(normals, axis=-1, keepdims=True)


def mesh(step):
    """The part as a closed surface, its triangles' normals outwards: (points, triangles)."""
    columns, rows = round(LENGTH / step) + 1, round(WIDTH / step) + 1
    y, x = np.meshgrid(np.linspace(-WIDTH / 2, WIDTH / 2, rows), np.linspace(-LENGTH / 2, LENGTH / 2, columns), indexing="ij")
    top = surface(x, y)[0].reshape(-1, 3)
    points = np.concatenate([top, top * [1, 1, 0]])
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (n.ravel() for n in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    cap = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    foot = cap[:, ::-1] + len(top)
    rim = np.concatenate([number[0], number[1:, -1], number[-1, -2::-1], number[-2:0:-1, 0]])
    after = np.roll(rim, -1)
    walls = np.concatenate([np.stack([rim, rim + len(top), after + len(top)], 1), np.stack([rim, after + len(top), after], 1)])
    return points, np.concatenate([cap, foot, walls])

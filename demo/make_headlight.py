"""Makes headlight.json: the free-form surface that the demo machines.

A lamp glass about 80 x 60 x 20 mm on a flat rim: a broad dome that is drawn out into a tail on one side, with a shallow
valley across its brow, so that the surface bends both ways. Poles are set by a height function at the Greville
abscissae and then shifted in plan, so the surface is what its poles and weights say and no graph over a grid.
Run it only to change the shape; the demo reads the file.
"""

import argparse
import json
import pathlib

import numpy as np

import nurbs

DEGREE = 5
HALF_LENGTH_MM, HALF_WIDTH_MM, HEIGHT_MM = 40.0, 30.0, 20.0
FLAT_POLES = DEGREE + 1  # this many rows of poles at zero height make the outermost knot span exactly flat
FINE_SPANS, FINE_SPAN_MM = 4, 1.3
RIM_MM = 2.2  # width of the outermost, flat, knot span


def knot_vector(half, spans):
    """Clamped; fine spans beside the rim, so that the rows of flat poles end close to it."""
    edge = half - RIM_MM - FINE_SPAN_MM * np.arange(FINE_SPANS)
    middle = np.linspace(-edge[-1], edge[-1], spans + 1)
    return np.concatenate([[-half] * (DEGREE + 1), -edge[:-1], middle, edge[-2::-1], [half] * (DEGREE + 1)])


def greville(knots):
    return np.array([knots[i + 1 : i + DEGREE + 1].mean() for i in range(len(knots) - DEGREE - 1)])


def bell(r):
    """1 at the centre, 0 from r = 1 on, with a broad crown."""
    r = np.clip(r, 0, 1)
    return 0.5 * (1 + np.cos(np.pi * r**1.2))


def height(x, y):
    peak_x, peak_y = -6.0, -2.0
    reach_x = np.where(x < peak_x, 29.6, 42.0)  # a blunt nose and a long tail
    taper = 1 - 0.22 * np.clip((x - peak_x) / 40, 0, 1) ** 2
    reach_y = np.where(y < peak_y, 23.0, 27.8) * taper
    r = (np.abs((x - peak_x) / reach_x) ** 2.4 + np.abs((y - peak_y) / reach_y) ** 2.4) ** (1 / 2.4)
    valley = 3.6 * np.exp(-(((y - 0.3 * (x - 10) - 1) / 6.0) ** 2)) * np.exp(-(((x - 12) / 17) ** 2))
    return HEIGHT_MM * 1.07 * bell(r) - valley * bell(r) ** 0.5


def make():
    knots = knot_vector(HALF_LENGTH_MM, 14), knot_vector(HALF_WIDTH_MM, 11)
    x, y = np.meshgrid(greville(knots[0]), greville(knots[1]), indexing="ij")
    z = height(x, y)
    for axis in (0, 1):
        index = np.arange(z.shape[axis])
        edge = (index < FLAT_POLES) | (index >= z.shape[axis] - FLAT_POLES)
        z[edge if axis == 0 else (slice(None), edge)] = 0.0
    lift = z / HEIGHT_MM
    points = np.stack([x + 1.2 * lift * np.sin(y / 11), y + 1.6 * lift * np.cos(x / 17), z], axis=2)
    weights = 1 + 0.15 * lift**2
    return {
        "description": "Lamp glass on a flat rim, millimetres: a rational B-spline surface, poles [u][v][xyz].",
        "degrees": [DEGREE, DEGREE],
        "knots": [np.round(k, 6).tolist() for k in knots],
        "points": np.round(points, 6).tolist(),
        "weights": np.round(weights, 6).tolist(),
    }


def properties(surface, samples=400):
    (u0, u1), (v0, v1) = surface.domain
    u, v = [g.ravel() for g in np.meshgrid(np.linspace(u0, u1, samples), np.linspace(v0, v1, samples))]
    points, normals = surface.normal(u, v)
    low, high = surface.principal_curvatures(u, v)
    return {
        "size_mm": np.ptp(points, axis=0).round(3).tolist(),
        "steepest_deg": round(float(np.degrees(np.arccos(normals[:, 2].min()))), 2),
        "smallest_concave_radius_mm": round(float(1 / high.max()), 3),
        "smallest_convex_radius_mm": round(float(-1 / low.min()), 3),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", default=pathlib.Path(__file__).with_name("headlight.json"))
    arguments = parser.parse_args()
    with open(arguments.output, "w", encoding="utf-8") as file:
        json.dump(make(), file)
        file.write("\n")
    print(properties(nurbs.Surface.read(arguments.output)))


if __name__ == "__main__":
    main()

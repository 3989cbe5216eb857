"""A machine that does exactly as told: records for testing the checks, made without the appliance.

Every move is a fifth-order rest-to-rest law along the move's own geometry, slow enough for all limits.
"""

import numpy as np

import entities
from record import Record

PERIOD_S = 0.001


def sampled(move, speed_mm_s):
    """Tip positions of one move at the cycle, from rest to rest."""
    shape = move.shape
    cycles = max(int(np.ceil(1.875 * shape.length_mm / speed_mm_s / PERIOD_S)), 150)
    tau = np.arange(1, cycles + 1) / cycles
    s = shape.length_mm * tau**3 * (10 + tau * (6 * tau - 15))
    if isinstance(shape, entities.Line):
        points = shape.start + (shape.end - shape.start) * (s / max(shape.length_mm, 1e-300))[:, None]
    elif isinstance(shape, entities.Arc):
        angle = (s / shape.radius)[:, None]
        points = shape.centre + shape.radius * (np.cos(angle) * shape.first + np.sin(angle) * shape.second)
    else:
        # a smooth interpolation of the parameter over arc length keeps third differences meaningful
        from scipy.interpolate import make_interp_spline

        points = shape.curve(np.clip(make_interp_spline(shape.s, shape.t, k=5)(s), *shape.curve.domain))
    return s, points


def run(program, noise_um=3.0, seed=1, speed_mm_s=24.0, loop_speed_mm_s=4.0, held=()):
    """Record of a program run by an ideal planner and servo loops with a few micrometres of error, on rigid axes."""
    joints = 2 if program.mechanism == "DMACXY" else 3
    s, tips, ids = [], [], []
    for move in program.moves:
        short = move.shape.length_mm < 12
        move_s, points = sampled(move, min(loop_speed_mm_s if short else speed_mm_s, move.feed_mm_min / 60 * 0.99))
        s.append(move_s)
        tips.append(points)
        ids.append(np.full(len(points), move.id))
    s, tips, ids = np.concatenate(s), np.vstack(tips), np.concatenate(ids)
    q = (tips + program.part_origin_mm)[:, :joints]
    rows = len(q)
    qd = np.gradient(q, PERIOD_S, axis=0)
    measured = q + np.random.default_rng(seed).normal(0, noise_um * 1e-3 / 3, q.shape).clip(-1e-3 * noise_um, 1e-3 * noise_um)
    measured = np.column_stack([measured, *[np.full(rows, h) for h in held]])
    pose = np.column_stack([tips, np.tile([0.0, 0.0, 1.0], (rows, 1))])
    feed = np.linalg.norm(np.gradient(tips, PERIOD_S, axis=0), axis=1)
    return Record(
        np.arange(rows) * PERIOD_S, ids, s, feed, pose, q, qd, np.gradient(qd, PERIOD_S, axis=0), measured, measured.copy()
    )  # fmt: skip

"""Arithmetic of three numbers, without numpy."""

from __future__ import annotations

import math


def mixed(a: tuple[float, ...], b: tuple[float, ...], t: float) -> tuple[float, ...]:
    return tuple((1 - t) * x + t * y for x, y in zip(a, b))


def turned(a: tuple[float, ...], b: tuple[float, ...], t: float) -> tuple[float, ...]:
    """Along the great circle from one axis to another."""
    angle = math.atan2(math.hypot(*cross(a, b)), dot(a, b))
    if angle < 1e-9:
        return a
    return tuple((math.sin((1 - t) * angle) * x + math.sin(t * angle) * y) / math.sin(angle) for x, y in zip(a, b))


def dot(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    return sum(x * y for x, y in zip(a, b))


def cross(a: tuple[float, ...], b: tuple[float, ...]) -> tuple[float, ...]:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])

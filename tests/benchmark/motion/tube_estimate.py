#!/usr/bin/python3
"""What the rose in 1 mm lines takes at least, about, on any path within 0.01 mm of them.

A circle of chords stands for each place of the rose. In a period of one line, the curve swings about the arc within the
tube; a linear program finds the swing with the least third derivative, which jerk bounds at an even speed. Jerk and
acceleration are each axis' own: across the path there is the more of them the less it runs along an axis, up to √2
times as much, where what is beside it along the path does not matter. Neither the start nor the end counts. Shares nothing with the planner. Prints one line of JSON.
"""
import json

import numpy as np
from scipy.optimize import linprog

LINE_MM, TOLERANCE_MM, FEED_MM_S, ACCELERATION, JERK = 1.0, 0.01, 100.0, 2000.0, 50000.0
PLACES = 80


def least_swing(curvature):
    """Largest third derivative, and largest curvature, of the best curve in the tube."""
    step = LINE_MM / PLACES
    along = (np.arange(PLACES) + 0.5) * step / LINE_MM - 0.5
    arc = curvature * LINE_MM ** 2 / 8 * (1 - (2 * along) ** 2)  # off its chord
    one = np.eye(PLACES)
    third = (np.roll(one, 2, 1) - 3 * np.roll(one, 1, 1) + 3 * one - np.roll(one, -1, 1)) / step ** 3
    none, bound = np.zeros((PLACES, 1)), np.ones((PLACES, 1))
    rows = np.vstack([np.hstack([one, none]), np.hstack([-one, none]),
                      np.hstack([third, -bound]), np.hstack([-third, -bound])])
    most = np.concatenate([TOLERANCE_MM - arc, TOLERANCE_MM + arc, np.zeros(2 * PLACES)])
    found = linprog(np.append(np.zeros(PLACES), 1), A_ub=rows, b_ub=most,
                    bounds=[(None, None)] * PLACES + [(0, None)], method="highs")
    swing = found.x[:PLACES]
    bend = (np.roll(swing, -1) - 2 * swing + np.roll(swing, 1)) / step ** 2
    return found.x[-1], np.max(np.abs(curvature - bend))


def main():
    angle = np.linspace(0, 2 * np.pi, 20001)
    r, slope, bend = 30 + 10 * np.cos(5 * angle), -50 * np.sin(5 * angle), -250 * np.cos(5 * angle)
    rate = np.hypot(r, slope)
    curvature = np.abs((r * r + 2 * slope * slope - r * bend) / rate ** 3)
    table = np.linspace(0, 0.6, 25)
    third, largest = np.array([least_swing(value) for value in table]).T
    third, largest = np.interp(curvature, table, third), np.interp(curvature, table, largest)
    heading = angle + np.arctan2(r, slope)
    across = np.abs(np.sin(heading)) + np.abs(np.cos(heading))
    speed = np.minimum(FEED_MM_S, np.minimum(np.sqrt(across * ACCELERATION / np.maximum(largest, 1e-9)),
                                             np.cbrt(across * JERK / np.maximum(third, 1e-9))))
    print(json.dumps({"name": "rose_lines_1mm_estimate", "value": round(float(np.trapz(rate / speed, angle)), 3),
                      "unit": "s", "target": "", "ok": True, "note": "any path in the tube, start and end apart"}))


if __name__ == "__main__":
    main()

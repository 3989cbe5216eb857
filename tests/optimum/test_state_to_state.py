"""No shorter duration than that of fastest_profile reaches the goal: asked of a linear program, which knows nothing of
phases. For a duration, the jerk is piecewise constant on a grid; the program finds the largest and the smallest
distance with the wanted end, and the goal must lie outside of both."""
import os
import subprocess
import unittest

import numpy as np
from scipy.optimize import linprog

STEPS = 80


def inside(case, v, a):
    settled = v + a * abs(a) / (2 * case[10])
    return case[6] <= settled <= case[7]


def random_cases(count):
    random = np.random.default_rng(7)
    cases = []
    while len(cases) < count:
        top, bottom = 1.0, -np.exp(random.uniform(-1, 0.5))
        up, down = np.exp(random.uniform(-1, 1.5)), -np.exp(random.uniform(-1, 1.5))
        jerk = np.exp(random.uniform(-0.5, 2.5))
        goal = random.uniform(-1, 1) * np.exp(random.uniform(-4, 1))
        case = (0.0, random.uniform(bottom, top), random.uniform(down, up),
                goal, random.uniform(bottom, top), random.uniform(down, up), bottom, top, down, up, jerk)
        if inside(case, case[1], case[2]) and inside(case, case[4], -case[5]):
            cases.append(case)
    return cases


def reach(case, duration):
    """Smallest and largest position at the end, or None where the wanted velocity and acceleration cannot be met."""
    p0, v0, a0, _, v1, a1, bottom, top, down, up, jerk = case
    h = duration / STEPS
    node, step = np.meshgrid(np.arange(1, STEPS + 1), np.arange(STEPS), indexing="ij")
    since = (node - step) * h
    begun = node > step
    a = np.where(begun, h, 0)
    v = np.where(begun, h * (since - h / 2), 0)
    p = np.where(begun, (since**3 - (since - h) ** 3) / 6, 0)[-1]
    t = np.arange(1, STEPS + 1) * h
    rows = np.vstack([a, -a, v, -v])
    most = np.concatenate([np.full(STEPS, up - a0), np.full(STEPS, a0 - down), top - (v0 + a0 * t), v0 + a0 * t - bottom])
    ends = []
    for sign in (1, -1):
        found = linprog(sign * p, A_ub=rows, b_ub=most, A_eq=np.vstack([a[-1], v[-1]]),
                        b_eq=[a1 - a0, v1 - v0 - a0 * duration], bounds=(-jerk, jerk), method="highs")
        if found.status != 0:
            return None
        ends.append(p0 + v0 * duration + a0 * duration**2 / 2 + p @ found.x)
    return ends


class FastestProfile(unittest.TestCase):
    def test_no_shorter_duration_reaches_the_goal(self):
        cases = random_cases(30)
        text = "\n".join(" ".join(f"{x:.17g}" for x in case) for case in cases)
        answer = subprocess.run([os.environ["RMAC_PROBE"]], input=text, text=True, capture_output=True, check=True)
        reached = 0
        for case, duration in zip(cases, map(float, answer.stdout.split()), strict=True):
            for part in (0.2, 0.4, 0.6, 0.8, 0.9, 0.97):
                ends = reach(case, part * duration)
                self.assertFalse(ends and ends[0] <= case[3] <= ends[1], (case, part, duration))
            ends = reach(case, 1.02 * duration)
            reached += bool(ends and ends[0] - 1e-3 <= case[3] <= ends[1] + 1e-3)
        # The program does find what can be reached: in almost all cases a little more time is enough.
        self.assertGreater(reached, 20)


if __name__ == "__main__":
    unittest.main()

"""What tests of `rmac simulate --view` share: a machine, a program, the page's data, and a browser that opens the page."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from appliance import BUILD
from test_collisions import FEED, SETUP, TOOLS, cut, to

CHROMIUM = pathlib.Path("/usr/bin/chromium")
CRADLE = -60  # height of the line about which A turns
TABLE_LINK, BASE_LINK = 0, 2
# Between two of the 60 looks a second joints gain speed: 2 m/s² or 600 °/s² half a metre away, over a sixtieth.
BETWEEN_LOOKS_MM = 3 * 0.5 * 10.5 * 1000 / 60**2 / 8


def program():
    """Over the stock with cuts, the table tilted and turned, then with the holder into the clamp."""
    lines = [to(0, 40, 100), FEED]
    for number, y in enumerate(range(-20, 21, 10)):
        lines += [to(-50, y, 60, move_id=10 + 4 * number), to(-50, y, 27, move_id=11 + 4 * number),
                  cut((-50, y, 27), (20, y, 27), 12 + 4 * number), to(20, y, 60, move_id=13 + 4 * number)]
    return lines + [to(0, 0, 150, move_id=30), to(10, -20, 130, a=-40, c=130, move_id=31), to(0, 0, 150, move_id=32),
                    to(34, 0, 100, move_id=33), to(34, 0, 31, move_id=34), to(42, 0, 31, move_id=35), to(42, 0, 100, move_id=36)]


def moves_at_random(count):
    """Of all five axes at once, as fast as they can."""
    random = np.random.default_rng(3)
    low, high = (-200, -200, 150, -30, -180), (200, 200, 230, 30, 180)
    return [to(*random.uniform(low, high), move_id=number) for number in range(1, count + 1)]


def about(axis, degrees):
    """A turn about x or z of the machine."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.eye(4)
    a, b = {"x": (1, 2), "z": (0, 1)}[axis]
    matrix[a, a], matrix[a, b], matrix[b, a], matrix[b, b] = c, -s, s, c
    return matrix


def moved(x=0.0, y=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def chain(joints):
    """How the links of SuginoXYZAC are moved against the ground, by its description: seen from the table, a positive C
    turns the tool by C, so that the table turns by -C; A likewise, about a line 60 mm below."""
    x, y, z, a, c = joints
    cradle = moved(z=CRADLE) @ about("x", -a) @ moved(z=-CRADLE)
    return [cradle @ about("z", -c), cradle, np.eye(4), moved(x), moved(x, y), moved(x, y, z)]


def turned(q):
    """The matrix of a quaternion w x y z."""
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def frame(p, q):
    matrix = moved(*p)
    matrix[:3, :3] = turned(q)
    return matrix


def shown(link, t):
    """How the page's data has a link moved at a time: a straight way and a turn at an even rate between two keys."""
    times, p, q = np.array(link["t"]), np.array(link["p"]).reshape(-1, 3), np.array(link["q"]).reshape(-1, 4)
    j = min(int(np.searchsorted(times, t, "right")), len(times) - 1)
    i = max(j - 1, 0)
    share = float(np.clip((t - times[i]) / (times[j] - times[i]), 0, 1)) if j > i else 0.0
    ends = q[i] / np.linalg.norm(q[i]), q[j] / np.linalg.norm(q[j])
    cosine = ends[0] @ ends[1]
    angle = np.arccos(min(abs(cosine), 1))
    if angle < 1e-9:
        turn = ends[0]
    else:
        turn = (np.sin((1 - share) * angle) * ends[0] + np.sign(cosine) * np.sin(share * angle) * ends[1]) / np.sin(angle)
    return frame(p[i] + share * (p[j] - p[i]), turn) @ moved(*(-np.array(link["middle"])))


def at(matrix, point):
    return (matrix @ np.append(point, 1))[:3]


class ViewCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rmac-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.page = self.folder / "view.html"

    def write(self, requests, setup=None, tools=None):
        (self.folder / "tools").mkdir(exist_ok=True)
        (self.folder / "tools/SuginoXYZAC.json").write_text(json.dumps(tools or TOOLS))
        (self.folder / "setup.json").write_text(json.dumps(setup or SETUP))
        (self.folder / "program.rmac").write_text("".join(json.dumps(r) + "\n" for r in requests))

    def run_rmac(self, *words, machine="SuginoXYZAC", with_setup=True):
        on = ["--machine", machine] if machine else []
        on += ["--setup", self.folder / "setup.json"] if with_setup else []
        return subprocess.run([BUILD / "bin/rmac", "simulate", self.folder / "program.rmac", "--tools", self.folder / "tools",
                               *on, *words], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=300, check=False)

    def view(self, *words, **options):
        done = self.run_rmac("--json", "--view", self.page, *words, **options)
        self.assertEqual(len(done.stdout.splitlines()), 1, done.stderr)
        return json.loads(done.stdout), self.data()

    def data(self):
        found = re.search(r'<script type="application/json" id="film">\n(.*?)\n</script>', self.page.read_text(), re.S)
        self.assertIsNotNone(found)
        return json.loads(found.group(1))

    def browse(self, hash_part, *words):
        """What Chromium prints that opens the page; without a network, a sound or a screen."""
        if not CHROMIUM.exists():
            print(f"\nNOT TESTED IN A BROWSER: {CHROMIUM} is missing; ./packages.sh packages-cad.txt", file=sys.stderr)
            self.skipTest(f"{CHROMIUM} is missing")
        environment = os.environ | {"HOME": str(self.folder), "XDG_RUNTIME_DIR": str(self.folder)}
        done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                               f"--user-data-dir={self.folder}/browser", "--window-size=1300,850",
                               "--host-resolver-rules=MAP * ~NOTFOUND", "--virtual-time-budget=4000", *words,
                               f"file://{self.page}#{hash_part}"], env=environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=300, check=False)
        self.assertEqual(done.returncode, 0, done.stderr[-2000:])
        return done.stdout

    def self_check(self):
        text = self.browse("self-check", "--dump-dom")
        found = re.search(r'<pre id="self-check" hidden="">(.*?)</pre>', text, re.S)
        self.assertIsNotNone(found, "the page did not come to its end: " + text[-500:])
        return json.loads(found.group(1).replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&"))

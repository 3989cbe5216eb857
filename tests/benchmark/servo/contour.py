"""Circles of 50 mm with axes that bend, stick, cog and ripple: what `rmac tune` alone makes of them.

DMACXYZ of docs/simulated-bus.md with a resonance at 274 Hz, 1 % of ripple and an encoder that errs. It begins with gains that hold it, two joints
are tuned with --apply, and a circle is cut at each feed. Deviations from the circle as the encoders show them, and of the load, which no loop sees.
"""

import json
import math
import sys

import numpy as np
from appliance import SOURCE, Appliance, pose, run_to_rest, wait_for_rest
from bending_mill import NOISY, bend
from figures import Figures

sys.path.insert(0, str(SOURCE / "gateway/rmac/plots"))
from measure_following import reversal_spikes  # noqa: E402
from servo_model import read_record  # noqa: E402

HELD = {"Gains": [120, 2000, 1.2], "MaxFollowingError": 1}
RADIUS = 25.0
FEEDS = (2000, 500, 100)


def tune(appliance, *words):
    for joint in ("0", "1"):
        done = appliance.rmac("--json", "tune", joint, "--travel", "20", "-o", str(appliance.folder / "tune.png"), "--apply", *words)
        if done.returncode != 0:
            sys.exit(done.stderr)


def record(appliance, begin):
    """Columns of what was after `begin` (t_s)."""
    name = json.loads(appliance.rmac("--json", "trace", "record").stdout)["name"]
    file = next(path for path in (appliance.folder / "state").rglob(name + "*") if path.is_file())
    return read_record(file, begin)[1]


def circle(appliance, client, feed):
    """Angles and deviations in mm, of motors and of loads: of the second turn, or, where that takes longer than a record holds, of the first 225
    degrees after rest."""
    slow = feed < 300
    client.call("RMAC_CAM.SetFeedrate", Feedrate=feed)
    begin = client.state()["t_s"]
    end = pose(-RADIUS * math.sqrt(0.5), -RADIUS * math.sqrt(0.5), 0) if slow else pose(RADIUS, 0, 0)
    for move in (1,) if slow else (1, 2):
        client.call("RMAC_CAM.MoveAlongArc", MoveID=move, RotSign=1, Closed=not slow, CenterPoint=pose(0, 0, 0), StartPoint=pose(RADIUS, 0, 0),
                    EndPoint=end)
    run_to_rest(client)
    columns = record(appliance, begin)
    angle = np.unwrap(np.arctan2(columns["q2"], columns["q1"]))
    turn = angle - angle[0] > (0.01 if slow else 1.75 * math.pi)
    motors = np.hypot(columns["a1"], columns["a2"]) - RADIUS
    return angle[turn], motors[turn], (np.hypot(columns["truth1"], columns["truth2"]) - RADIUS)[turn]


def rows(figures, name, words, targets):
    """Of the tree's own machine, or, with words for `rmac tune`, of one that is tuned by it."""
    with Appliance(own_tree=True, flight_recorder={"seconds": 60}) as appliance:
        if words is not None:
            bend(appliance, 274, HELD, **NOISY)
        if (done := appliance.rmac("load", "DMACXYZ")).returncode != 0:
            sys.exit(done.stderr)
        if words is not None:
            tune(appliance, *words)
        client = appliance.client()
        client.call("authority.acquire")
        client.call("RMAC_CAM.SetFeedrate", Feedrate=2000)
        client.call("RMAC_CAM.MoveToJointTarget", MoveID=1, JointTargetFrame={"joints": [RADIUS, 0, 0]})
        run_to_rest(client)
        wait_for_rest(client)
        for feed in FEEDS:
            angle, motors, loads = circle(appliance, client, feed)
            rms = [1e3 * float(np.sqrt(np.mean(one ** 2))) for one in (motors, loads)]
            note = "" if targets else "friction turns round with the velocity, cogging is left to the loop"
            figures.add(f"contour_rms_F{feed}_{name}", rms[0], "um", 1.2 if targets else None, note or "by the encoders")
            figures.add(f"contour_rms_F{feed}_{name}_at_the_tool", rms[1], "um", None, "of the loads, which no loop sees")
            figures.add(f"quadrant_spike_F{feed}_{name}", 1e3 * max(map(abs, reversal_spikes(angle, motors))), "um", 3 if targets and feed == 500 else None)


def main():
    figures = Figures()
    rows(figures, "as_it_comes", None, True)
    rows(figures, "tuned", (), False)
    rows(figures, "tuned_creeping", ("--creep",), True)
    return 0 if figures.table() else 1


if __name__ == "__main__":
    sys.exit(main())

"""Requests beside a cut in real pace: how long an answer takes, and how many moves a second a client can send."""

import json
import statistics
import sys
import time

from appliance import Appliance, line, pose, run_to_rest
from figures import Figures

REAL_TIME = {"degraded_allowed": True, "lock_memory": True}


def round_trips(figures, calls):
    """Of RMAC_CAM.GetState, the longest answer that clients ask for again and again."""
    with Appliance(pace="real-time", real_time=REAL_TIME) as appliance:
        operator = appliance.operator()
        operator.call("RMAC_CAM.SetFeedrate", Feedrate=600)
        for number in range(2000):
            x = 20 * (number % 2)
            operator.call("RMAC_CAM.MoveAlongLine", **line((x, 0, 0), (20 - x, 0, 0), number))
        operator.call("RMAC_CAM.CycleStart", Mode="AUTOMATIC")
        operator.call("subscribe", topics=["events"])
        operator.wait_note("events", lambda event: event["kind"] == "MoveStarted")
        panel = appliance.client("panel")
        times_ms = []
        for _ in range(calls):
            asked = time.perf_counter()
            state = panel.state()
            times_ms.append(1000 * (time.perf_counter() - asked))
        if not state["moving"]:
            raise RuntimeError("the cut ended before the calls")
        operator.call("RMAC_CAM.StopNow")
    times_ms.sort()
    cases = f"{calls} GetState while a machine cuts"
    figures.add("round_trip_median", statistics.median(times_ms), "ms", 2, cases)
    figures.add("round_trip_p99", times_ms[int(0.99 * calls)], "ms", 5, cases)


def moves_a_second(figures, moves):
    """Lines and NURBS, one request a line, sent without waiting for the answers, into an empty queue at rest."""
    arc = [pose(x, y, 0)["p"] for x, y in ((0, 0), (0.1, 0.2), (0.3, 0.2), (0.4, 0))]
    back = arc[::-1]
    kinds = {
        "lines": lambda number: ("RMAC_CAM.MoveAlongLine", line((0.1 * (number % 2), 0, 0), (0.1 - 0.1 * (number % 2), 0, 0), number)),
        "nurbs": lambda number: ("RMAC_CAM.MoveAlongNurbs", {"MoveID": number, "Nurbs": {
            "degree": 3, "knots": [0, 0, 0, 0, 1, 1, 1, 1], "weights": [1, 1, 1, 1], "points": arc if number % 2 == 0 else back}}),
    }
    for name, move in kinds.items():
        with Appliance() as appliance:
            operator = appliance.operator()
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=600)
            requests = b""
            for number in range(moves):
                method, params = move(number)
                requests += json.dumps({"jsonrpc": "2.0", "id": number + 1, "method": method, "params": params}).encode() + b"\n"
            began = time.perf_counter()
            operator.send_bytes(requests)
            for _ in range(moves):
                answer = operator.read_line()
                if answer.get("result") is not True:
                    raise RuntimeError(f"{name}: {answer}")
            took_s = time.perf_counter() - began
            operator.call("RMAC_CAM.StopNow")
        figures.add_least(f"moves_in_{name}", moves / took_s, "1/s", 5000, f"{moves} requests")


def main():
    quick = "--quick" in sys.argv[1:]
    figures = Figures()
    round_trips(figures, 500 if quick else 5000)
    moves_a_second(figures, 1000 if quick else 9000)
    sys.exit(0 if figures.table() else 1)


main()

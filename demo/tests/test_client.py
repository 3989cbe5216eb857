"""The client against a small server in this process that answers as the appliance does."""

import json
import pathlib
import socketserver
import sys
import threading
import unittest

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE.parent)]

from client import STILL_ROWS, Client, Recorder, Refused  # noqa: E402


def sample(cycle, q, moving=True):
    return {
        "cycle": cycle, "t_s": cycle * 1e-3, "moving": moving, "move_id": 7, "s_mm": 1.5, "feed_mm_s": 2.0,
        "pose": [q, 0.0, 0.0, 0.0, 0.0, 1.0], "q": [q, 0.0], "qd": [1.0, 0.0], "qdd": [0.0, 0.0],
        "a": [q + 0.001, 0.0], "held": [-25.0],
    }  # fmt: skip


class Appliance(socketserver.StreamRequestHandler):
    """Answers every call; refuses the move with number 13; streams ten cycles of motion after a subscription."""

    def handle(self):
        for line in self.rfile:
            request = json.loads(line)
            self.server.seen.append(request["method"])
            answer = {"jsonrpc": "2.0", "id": request["id"], "result": True}
            if request["params"].get("MoveID") == 13:
                del answer["result"]
                answer["error"] = {"code": -32004, "message": "too far", "data": {"minorName": "MACHINE_ERR_TRAVEL_LIMIT"}}
            if request["method"] == "RMAC_CAM.GetState":
                answer["result"] = {"state": "Running", "moves_in_buffer": 0, "moving": False, "cycle": 9, "move_id": 7}
            self.wfile.write((json.dumps(answer) + "\n").encode())
            if request["method"] == "subscribe":
                samples = [sample(n, n * 0.5) for n in range(10)]
                note = {"jsonrpc": "2.0", "method": "joints", "params": {"samples": samples}}
                self.wfile.write((json.dumps(note) + "\n").encode())


class Wire(unittest.TestCase):
    def setUp(self):
        self.server = socketserver.ThreadingTCPServer(("127.0.0.1", 0), Appliance)
        self.server.daemon_threads = True
        self.server.seen = []
        threading.Thread(target=self.server.serve_forever, daemon=True).start()
        self.client = Client(*self.server.server_address)

    def tearDown(self):
        self.client.close()
        self.server.shutdown()
        self.server.server_close()

    def test_a_program_is_sent_in_order_and_its_cycles_are_recorded(self):
        self.client.recorder = Recorder()
        requests = [{"method": f"RMAC_CAM.M{n}", "params": {"MoveID": n}} for n in range(10)]
        self.client.call("subscribe", topics=["joints"], rate_hz=1000)
        self.client.run(requests, window=3)
        self.client.wait_until_done(seconds=5)
        self.assertEqual(self.server.seen[2:12], [r["method"] for r in requests])
        record = self.client.recorder.record()
        self.assertEqual(record.joints, 2)
        self.assertEqual(record.a[-1].tolist(), [4.501, 0.0, -25.0])
        self.assertEqual(len(record.t), 10)

    def test_a_refused_move_stops_the_program(self):
        requests = [{"method": "RMAC_CAM.MoveAlongLine", "params": {"MoveID": n}} for n in (12, 13, 14)]
        with self.assertRaises(Refused) as caught:
            self.client.run(requests, window=1)
        self.assertEqual(caught.exception.minor, "MACHINE_ERR_TRAVEL_LIMIT")
        self.assertEqual(self.server.seen[-1], "RMAC_CAM.StopNow")


class Rows(unittest.TestCase):
    def test_rests_are_cut_short_and_motion_is_whole(self):
        recorder = Recorder()
        for cycle in range(3000):
            recorder.add(sample(cycle, 0.0 if cycle < 1000 else min(cycle - 1000, 500) * 0.01))
        record = recorder.record()
        self.assertEqual(recorder.lost, 0)
        self.assertEqual(len(record.t), STILL_ROWS + 501 - 1 + STILL_ROWS)
        self.assertAlmostEqual(record.t[0], (1001 - STILL_ROWS) * 1e-3)

    def test_a_lost_sample_is_counted(self):
        recorder = Recorder()
        for cycle in (0, 1, 2, 5, 6):
            recorder.add(sample(cycle, cycle * 0.1))
        self.assertEqual(recorder.lost, 1)

    def test_a_record_of_nothing_is_an_error(self):
        recorder = Recorder()
        recorder.add(sample(0, 0.0))
        self.assertRaises(RuntimeError, recorder.record)


if __name__ == "__main__":
    unittest.main()

"""What clients send and do not read takes no more memory than there is for it, and the greedy go first."""

import socket
import time
import unittest

from appliance import BUILD, Appliance

CLIENTS = 46
MIB = 1 << 20
# A sanitizer keeps what was freed for a while.
SANITIZED = "RMAC_SANITIZE:STRING=\n" not in (BUILD / "CMakeCache.txt").read_text()


def peak_mib(process):
    with open(f"/proc/{process.pid}/status", encoding="utf-8") as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024


class Memory(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.operator = self.appliance.operator()

    def crowd(self, text):
        """Clients that send a text, and read nothing."""
        crowd = []
        for _ in range(CLIENTS):
            client = self.enterContext(socket.create_connection(("127.0.0.1", self.appliance.port), timeout=60))
            client.sendall(b'{"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.Ok"}\n')
            crowd.append(client)
        for client in crowd:
            try:
                client.sendall(text)
            except OSError:  # it was cut off
                pass
        return crowd

    def assert_fine(self):
        self.assertEqual(self.operator.state()["mechanism"], "DMACXYZ")
        self.assertTrue(self.operator.call("RMAC_CAM.StopNow"))
        if not SANITIZED:
            self.assertLess(peak_mib(self.appliance.process), 400)

    def test_lines_without_an_end(self):
        self.crowd(b'{"jsonrpc":"2.0","id":2,"method":"' + b"x" * (7 * MIB))
        self.assert_fine()

    def test_answers_that_nobody_reads(self):
        self.crowd(b'{"jsonrpc":"2.0","id":2,"method":"rpc.discover"}\n' * 200)
        give_up = time.monotonic() + 200
        while not any("cut off" in line for line in self.appliance.log):  # the requests take their time
            self.assertLess(time.monotonic(), give_up)
            self.assert_fine()

    def test_lines_that_would_grow(self):
        for element in ("[]", "{}", '""', '{"":0}'):
            elements = ",".join([element] * ((8 * MIB - 100) // (len(element) + 1)))
            answer = self.appliance.client("grower").exchange(
                f'{{"jsonrpc":"2.0","id":2,"method":"RMAC_CAM.Ok","params":[{elements}]}}')
            self.assertIn("MiB of memory", answer["error"]["message"])
        self.assert_fine()


if __name__ == "__main__":
    unittest.main()

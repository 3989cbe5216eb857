"""Connections to those that are no appliance, or a broken one."""

import asyncio
import pathlib
import tempfile
import tomllib
import unittest

import rmac
import rmac.aio
from peer import GREETING, Peer
from rmac.address import parse_address


class ConnectingTest(unittest.TestCase):
    def test_addresses_are_read(self):
        self.assertEqual(str(parse_address("host")), "host:7402")
        self.assertEqual(str(parse_address("host:1")), "host:1")
        self.assertEqual((parse_address("[::1]:7").host, parse_address("[::1]:7").port), ("::1", 7))
        self.assertEqual(parse_address("unix:/run/rmac/rmacd.sock").path, "/run/rmac/rmacd.sock")
        for wrong in ("", "a:b:c", "host:", "host:0", "host:65536", "unix:", "::1"):
            self.assertRaises(rmac.CannotConnect, parse_address, wrong)
        for wrong in (None, 7402, ("localhost", 7402), pathlib.Path("/run/rmac/rmacd.sock"), b"host:1"):
            with self.assertRaisesRegex(rmac.CannotConnect, "is no address: give it as text"):
                rmac.connect(wrong)

    def test_a_wrong_path_is_told_as_such(self):
        with self.assertRaisesRegex(rmac.CannotConnect, "^unix:/nowhere: there is no such file"):
            rmac.connect("unix:/nowhere")
        with tempfile.NamedTemporaryFile() as file, self.assertRaisesRegex(rmac.CannotConnect, "no socket"):
            rmac.connect(f"unix:{file.name}")

    def test_nobody_there_is_told(self):
        with Peer() as peer:
            address = peer.address
        with self.assertRaisesRegex(rmac.CannotConnect, "rmacd running"):
            rmac.connect(address)

    def test_an_appliance_of_another_version_is_refused_unless_asked_otherwise(self):
        with Peer(lambda request: GREETING | {"version": "9.9.9"}) as peer:
            with self.assertRaisesRegex(rmac.VersionMismatch, "9.9.9"):
                rmac.connect(peer.address)
            rmac.connect(peer.address, check=False).close()

    def test_a_server_of_something_else_is_told_apart(self):
        for answer in (b"HTTP/1.1 400 Bad Request\r\n\r\n", {"hello": "world"}, 7):
            with Peer(lambda request, answer=answer: answer) as peer, self.assertRaisesRegex(rmac.ProtocolError, "no RMAC appliance"):
                rmac.connect(peer.address)

    def test_a_connection_that_ends_ends_what_waits_for_it(self):
        with Peer(lambda request: GREETING if request["method"] == "hello" else None) as peer, rmac.connect(peer.address) as client:
            with self.assertRaises(rmac.ConnectionLost):
                client.state()
            with self.assertRaisesRegex(rmac.ConnectionLost, r"closed the connection; nothing of this was sent: client\.reconnect\(\)"):
                client.state()
            self.assertIsInstance(client.lost, rmac.ConnectionLost)
            client.reconnect()
            self.assertIsNone(client.lost)

    def test_so_does_one_of_asyncio(self):
        async def ask(address):
            async with await rmac.aio.connect(address) as client:
                with self.assertRaises(rmac.ConnectionLost):
                    await client.state()
                with self.assertRaisesRegex(rmac.ConnectionLost, r"nothing of this was sent: await client\.reconnect\(\) .*, await client\.state\(\)"):
                    await client.state()
                self.assertNotIn("sent", str(client.lost))

        with Peer(lambda request: GREETING if request["method"] == "hello" else None) as peer:
            asyncio.run(ask(peer.address))

    def test_what_is_asked_behind_an_end_of_any_kind_has_an_error_of_its_own(self):
        def answers(request):
            return GREETING if request["method"] == "hello" else b"no JSON\n"

        def check(again, ended):
            self.assertIsInstance(ended, rmac.ProtocolError)
            self.assertIsNot(again, ended)
            self.assertIs(again.__cause__, ended)
            self.assertIn("nothing of this was sent", str(again))

        async def ask(address):
            async with await rmac.aio.connect(address) as client:
                with self.assertRaises(rmac.ProtocolError):
                    await client.state()
                with self.assertRaises(rmac.ConnectionLost) as again:
                    await client.state()
                check(again.exception, client.lost)

        with Peer(answers) as peer:
            with rmac.connect(peer.address) as client:
                with self.assertRaises(rmac.ProtocolError):
                    client.state()
                with self.assertRaises(rmac.ConnectionLost) as again:
                    client.state()
                check(again.exception, client.lost)
            asyncio.run(ask(peer.address))

    def test_an_answer_that_does_not_come_is_told(self):
        with Peer(lambda request: GREETING if request["method"] == "hello" else b"") as peer:
            with rmac.connect(peer.address, answer_within_s=0.05) as client, self.assertRaisesRegex(rmac.NotAnswered, "GetState"):
                client.state()

    def test_many_answers_that_do_not_come_are_told_as_one(self):
        with Peer(lambda request: GREETING if request["method"] == "hello" else b"") as peer:
            with rmac.connect(peer.address, answer_within_s=0.05) as client, self.assertRaises(rmac.NotAnswered):
                client.machines()

    def test_what_is_no_name_of_a_host_is_told(self):
        with self.assertRaisesRegex(rmac.CannotConnect, "no name"):
            rmac.connect("a..b:7402")

    def test_all_that_can_go_wrong_is_an_rmac_error_and_what_python_has_of_it(self):
        self.assertTrue(issubclass(rmac.CannotConnect, ConnectionError))
        self.assertTrue(issubclass(rmac.InvalidValue, ValueError))
        self.assertTrue(issubclass(rmac.NotAnswered, TimeoutError))
        for name in rmac.__all__:
            kind = getattr(rmac, name)
            if isinstance(kind, type) and issubclass(kind, Exception):
                self.assertTrue(issubclass(kind, rmac.RmacError), name)

    def test_the_package_has_the_version_of_the_api_that_it_was_made_for(self):
        project = tomllib.loads((pathlib.Path(__file__).parents[1] / "pyproject.toml").read_text())
        self.assertEqual(project["project"]["version"], rmac.API_VERSION)

    def test_the_package_says_that_it_is_typed(self):
        self.assertTrue((pathlib.Path(rmac.__file__).parent / "py.typed").is_file())


if __name__ == "__main__":
    unittest.main()

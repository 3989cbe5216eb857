"""Requests, answers, and lines that come in pieces; no sockets."""

import concurrent.futures
import json
import random
import unittest

from rmac.errors import InvalidValue, ProtocolError, Refused, TravelLimit, refusal
from rmac.wire.call import Call
from rmac.wire.exchange import Exchange


def answer(request_id, **members):
    return json.dumps({"jsonrpc": "2.0", "id": request_id, **members}).encode() + b"\n"


class ExchangeTest(unittest.TestCase):
    def setUp(self):
        self.heard = []
        self.exchange = Exchange(lambda topic, params: self.heard.append((topic, params)))

    def ask(self, method="m", **params):
        reply = concurrent.futures.Future()
        return json.loads(self.exchange.ask(Call(method, params), reply)), reply

    def test_each_answer_reaches_its_request_however_the_bytes_come(self):
        for seed in range(30):
            draw = random.Random(seed)
            asked = [self.ask(f"m{number}") for number in range(20)]
            data = b""
            for number, (request, _) in draw.sample(list(enumerate(asked)), len(asked)):
                data += answer(request["id"], result=number)
                data += b'{"jsonrpc":"2.0","method":"state","params":{"n":1}}\n'
            while data:
                piece = draw.randint(1, 80)
                self.exchange.receive(data[:piece])
                data = data[piece:]
            self.assertEqual([reply.result(0) for _, reply in asked], list(range(20)), f"seed {seed}")
        self.assertEqual(len(self.heard), 30 * 20)

    def test_a_refusal_is_the_exception_of_its_minor_code_with_the_appliances_words(self):
        request, reply = self.ask("RMAC_CAM.MoveAlongLine")
        error = {"code": -32004, "message": "10 mm beyond", "data": {"minorCode": 4, "minorName": "MACHINE_ERR_TRAVEL_LIMIT"}}
        self.exchange.receive(answer(request["id"], error=error))
        with self.assertRaises(TravelLimit) as caught:
            reply.result(0)
        self.assertEqual((caught.exception.message, caught.exception.minor), ("10 mm beyond", 4))
        self.assertIn("RMAC_CAM.MoveAlongLine: 10 mm beyond", str(caught.exception))

    def test_a_code_of_a_later_appliance_is_a_refusal_all_the_same(self):
        self.assertIs(type(refusal("m", {"code": -32999, "message": "new"})), Refused)

    def test_a_batch_tells_of_each_of_its_requests_whether_it_was_taken(self):
        reply = concurrent.futures.Future()
        sent = json.loads(self.exchange.ask_batch([("a", "{}"), ("b", "{}"), ("c", "{}")], reply))
        answers = [{"id": sent[0]["id"], "result": True}, {"id": sent[1]["id"], "error": {"code": -32004, "message": "no"}},
                   {"id": sent[2]["id"], "result": True}]
        self.exchange.receive(json.dumps(answers[::-1]).encode() + b"\n")
        outcomes = reply.result(0)
        self.assertEqual([type(one) for one in outcomes], [type(None), TravelLimit, type(None)])
        self.assertEqual(outcomes[1].method, "b")

    def test_a_batch_that_is_refused_as_a_whole_is_refused_for_each(self):
        reply = concurrent.futures.Future()
        sent = json.loads(self.exchange.ask_batch([("a", "{}"), ("b", "{}")], reply))
        self.exchange.receive(answer(sent[0]["id"], error={"code": -32600, "message": "too many"}))
        self.assertEqual([one.code for one in reply.result(0)], [-32600, -32600])

    def test_what_ends_breaks_every_promise(self):
        replies = [self.ask()[1] for _ in range(3)]
        self.exchange.end(ProtocolError("over"))
        for reply in replies:
            self.assertRaises(ProtocolError, reply.result, 0)

    def test_strangers_are_told_from_appliances_by_their_first_bytes(self):
        for greeting in (b"SSH-2.0-OpenSSH", b"HTTP/1.1 400 Bad Request\r\n", b"[]\n", b"7\n", b"\n"):
            with self.assertRaises(ProtocolError, msg=greeting) as caught:
                Exchange(print).receive(greeting)
            self.assertIn("no RMAC appliance", str(caught.exception))

    def test_what_the_appliance_could_not_read_is_everybodys_error(self):
        with self.assertRaisesRegex(ProtocolError, "could not read.*parse error"):
            self.exchange.receive(answer(None, error={"code": -32700, "message": "parse error"}))

    def test_numbers_that_are_not_finite_are_named_and_not_sent(self):
        for value, place in ((float("nan"), "Position"), ([1.0, float("inf")], r"Position\[1\]"), ({"p": [float("nan")]}, r"Position.p\[0\]")):
            with self.assertRaisesRegex(InvalidValue, place):
                self.ask("RMAC_CAM.MoveAllAxis", Position=value)
        with self.assertRaisesRegex(InvalidValue, "object has no form"):
            self.ask("m", value=object())

    def test_numpys_scalars_and_arrays_are_numbers(self):
        try:
            import numpy
        except ImportError:
            self.skipTest("needs numpy")
        request, _ = self.ask("m", a=numpy.float32(0.5), b=numpy.arange(3.0), c=numpy.int64(7), d=[numpy.float64(1.5)])
        self.assertEqual(request["params"], {"a": 0.5, "b": [0, 1, 2], "c": 7, "d": [1.5]})
        with self.assertRaisesRegex(InvalidValue, r"b\[1\] is nan"):
            self.ask("m", b=numpy.array([1, numpy.nan]))

    def test_what_is_left_out_is_not_sent(self):
        request, _ = self.ask("m", given=False, left_out=None)
        self.assertEqual(request["params"], {"given": False})


if __name__ == "__main__":
    unittest.main()

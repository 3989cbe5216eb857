"""Bad input: each kind gets its own error, and nothing else changes."""

import json
import os
import pathlib
import select
import socket
import unittest

from appliance import Appliance, line, pose, run_to_rest

PARSE_ERROR, INVALID_REQUEST, METHOD_NOT_FOUND, INVALID_PARAMS = -32700, -32600, -32601, -32602
AUTHORITY_REQUIRED, AUTHORITY_HELD, REQUEST_TOO_LARGE = -32040, -32041, -32043


def nurbs(**changes):
    """A cubic that stays within the machine, with changes that make it bad."""
    curve = {"degree": 3, "knots": [0, 0, 0, 0, 1, 1, 1, 1],
             "points": [[0, 0, 0], [10, 0, 0], [20, 10, 0], [30, 10, 0]], "weights": [1, 1, 1, 1]}
    return curve | changes


class BadInput(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.appliance = cls.enterClassContext(Appliance())
        cls.operator = cls.appliance.operator()
        cls.operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)

    def picture(self):
        """What a refused request must leave as it was."""
        state = self.operator.state()
        kept = ("mechanism", "state", "moving", "moves_in_buffer", "authority", "override_percent", "virtual")
        return {key: state[key] for key in kept} | {"pose": state["pose"]}

    def setUp(self):
        self.before = self.picture()

    def tearDown(self):
        after = self.picture()
        for value, wanted in zip(after.pop("pose"), self.before.pop("pose")):
            self.assertAlmostEqual(value, wanted, delta=0.02)
        self.assertEqual(after, self.before)

    def assert_error(self, answer, code, *words):
        self.assertIn("error", answer)
        self.assertEqual(answer["error"]["code"], code, answer["error"])
        for word in words:
            self.assertIn(word, answer["error"]["message"])

    def assert_refused(self, minor, words, method, **params):
        refusal = self.operator.refusal(method, **params)
        self.assertEqual(refusal.minor, minor, refusal)
        for word in words:
            self.assertIn(word, refusal.message)
        return refusal

    def test_malformed_json_is_a_parse_error(self):
        answer = self.operator.exchange('{"jsonrpc": "2.0", "id": 1, "method": ')
        self.assert_error(answer, PARSE_ERROR, "JSON")
        self.assertIsNone(answer["id"])

    def test_bytes_that_are_not_text_are_a_parse_error(self):
        self.operator.send_bytes(bytes(range(128, 256)) + b"\n")
        self.assert_error(self.operator.read_line(), PARSE_ERROR)

    def test_deep_nesting_is_a_parse_error(self):
        self.assert_error(self.operator.exchange("[" * 100_000), PARSE_ERROR, "nested")

    def test_json_that_is_no_request_is_an_invalid_request(self):
        self.assert_error(self.operator.exchange("42"), INVALID_REQUEST)
        self.assert_error(self.operator.exchange('{"jsonrpc": "2.0", "id": 3}'), INVALID_REQUEST, "method")

    def test_unknown_method_is_named(self):
        self.assert_error(self.operator.ask("RMAC_CAM.MoveByMagic"), METHOD_NOT_FOUND, "RMAC_CAM.MoveByMagic")

    def test_wrong_type_names_parameter_value_and_expectation(self):
        answer = self.operator.ask("RMAC_CAM.SetFeedrate", Feedrate="fast")
        self.assert_error(answer, INVALID_PARAMS, "Feedrate", "fast", "number")

    def test_missing_and_unknown_parameters_are_named(self):
        self.assert_error(self.operator.ask("RMAC_CAM.SetFeedrate"), INVALID_PARAMS, "Feedrate")
        self.assert_error(self.operator.ask("RMAC_CAM.SetFeedrate", Feedrate=1, Colour=2), INVALID_PARAMS, "Colour")

    def test_nan_and_infinity_are_parse_errors_that_say_so(self):
        for number in ("NaN", "Infinity", "-Infinity"):
            answer = self.operator.exchange(
                '{"jsonrpc": "2.0", "id": 5, "method": "RMAC_CAM.SetFeedrate", "params": {"Feedrate": %s}}' % number)
            self.assert_error(answer, PARSE_ERROR, "finite")

    def test_number_beyond_double_is_refused(self):
        answer = self.operator.exchange(
            '{"jsonrpc": "2.0", "id": 6, "method": "RMAC_CAM.SetFeedrate", "params": {"Feedrate": 1e999}}')
        self.assertIn(answer["error"]["code"], (PARSE_ERROR, INVALID_PARAMS))

    def test_nurbs_with_decreasing_knots_is_refused(self):
        curve = nurbs(knots=[0, 0, 0, 0, 1, 0.5, 1, 1])
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["knot"], "RMAC_CAM.MoveAlongNurbs",
                            MoveID=1, Nurbs=curve)

    def test_nurbs_with_too_few_points_is_refused(self):
        curve = nurbs(points=[[0, 0, 0], [10, 0, 0], [20, 0, 0]], weights=[1, 1, 1], knots=[0, 0, 0, 0, 1, 1, 1])
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["points"], "RMAC_CAM.MoveAlongNurbs",
                            MoveID=1, Nurbs=curve)

    def test_nurbs_whose_counts_do_not_fit_is_refused(self):
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["knots"], "RMAC_CAM.MoveAlongNurbs",
                            MoveID=1, Nurbs=nurbs(knots=[0, 0, 0, 1, 1, 1]))

    def test_nurbs_with_a_weight_of_zero_is_refused(self):
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["weight"], "RMAC_CAM.MoveAlongNurbs",
                            MoveID=1, Nurbs=nurbs(weights=[1, 0, 1, 1]))

    def test_move_outside_the_limits_names_joint_amount_and_place(self):
        refusal = self.assert_refused("MACHINE_ERR_TRAVEL_LIMIT", ["X"], "RMAC_CAM.MoveAlongLine",
                                      **line((0, 0, 0), (62.5, 0, 0)))
        self.assertRegex(refusal.message, r"\b12\.5\d*\s*mm")
        self.assertRegex(refusal.message, r"\b(50|62\.5)\.?\d*\s*mm")

    def test_move_that_leaves_the_limits_only_in_between_is_refused(self):
        curve = nurbs(points=[[0, 0, 0], [0, 90, 0], [10, 90, 0], [10, 0, 0]])
        self.assert_refused("MACHINE_ERR_TRAVEL_LIMIT", ["Y"], "RMAC_CAM.MoveAlongNurbs", MoveID=1, Nurbs=curve)

    def test_move_that_does_not_start_where_the_queue_ends_is_refused(self):
        refusal = self.operator.refusal("RMAC_CAM.MoveAlongLine", **line((0.5, 0, 0), (10, 0, 0)))
        self.assertIn("0.5", refusal.message)

    def test_feed_over_the_maximum_is_refused_and_not_clamped(self):
        self.assert_refused("MACHINE_ERR_SPEED_LIMIT", ["2000"], "RMAC_CAM.SetFeedrate", Feedrate=2001)

    def test_frame_that_is_no_rotation_is_refused(self):
        refusal = self.operator.refusal("RMAC_CAM.SetPartFrame", PartFrame={"p": [0, 0, 0], "q": [0, 0, 0, 0]})
        self.assertIn(refusal.code, (INVALID_PARAMS, -32014))

    def test_what_a_drive_cannot_do_is_refused_with_its_reason(self):
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["force"], "RMAC_Config.SetMechanismSpindleControlMethod",
                            DMACServoControlMethod="DMAC_FORCE_CONTROL")
        self.operator.call("RMAC_Config.SetMechanismSpindleControlMethod", DMACServoControlMethod="DMAC_POSITION_CONTROL")
        self.assert_refused("MACHINE_ERR_INVALID_PARAMETER_VALUE", ["spindle 0 (bus sim0, axis 3)", "mode 3", "angle"],
                            "RMAC_Config.Apply")
        self.operator.call("RMAC_Config.SetMechanismSpindleControlMethod", DMACServoControlMethod="DMAC_VELOCITY_CONTROL")

    def test_move_without_authority_is_refused(self):
        watcher = self.appliance.client("watcher")
        answer = watcher.ask("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (1, 0, 0)))
        self.assert_error(answer, AUTHORITY_REQUIRED, "operator")

    def test_second_client_that_jogs_is_refused_and_told_who_has_authority(self):
        second = self.appliance.client("second")
        self.assert_error(second.ask("authority.acquire"), AUTHORITY_HELD, "operator")
        self.assert_error(second.ask("RMAC_CAM.JogJoint", JntNum=0, Distance=1), AUTHORITY_REQUIRED, "operator")

    def test_line_of_100_mb_gets_an_error_and_is_not_kept(self):
        before_kb = self.resident_kb()
        error = flood(self.appliance.port, megabytes=100)
        self.assert_error(error, REQUEST_TOO_LARGE)
        self.assertLess(self.resident_kb() - before_kb, 50_000)

    def resident_kb(self):
        status = pathlib.Path(f"/proc/{self.appliance.process.pid}/status").read_text()
        return next(int(row.split()[1]) for row in status.splitlines() if row.startswith("VmRSS"))


def flood(port, megabytes):
    """Sends one endless line until the appliance answers; its answer."""
    chunk = b"x" * 1_000_000
    with socket.create_connection(("127.0.0.1", port), timeout=60) as sender:
        for _ in range(megabytes):
            view = memoryview(chunk)
            while view:
                readable, writable, _ = select.select([sender], [sender], [], 60)
                if readable:
                    return json.loads(sender.makefile("rb").readline())
                if writable:
                    view = view[sender.send(view):]
        sender.sendall(b"\n")
        return json.loads(sender.makefile("rb").readline())


class FilesThatAreNoText(unittest.TestCase):
    """Their names and contents come back in messages."""

    def test_are_told_of_in_single_requests_and_in_batches(self):
        with Appliance(own_tree=True) as appliance:
            folder = pathlib.Path(os.fsdecode(os.fsencode(appliance.tree) + b"/mill/2-axis/\xff\xfe"))
            folder.mkdir()
            (folder / "device.json").write_bytes(b'{"MechanismName": "\xff\n')
            (appliance.folder / "state/tools").mkdir()
            (appliance.folder / "state/tools/DMACXYZ.json").write_bytes(b"\xff\x1b")
            client = appliance.client()
            client.call("authority.acquire")
            told = client.exchange('[{"jsonrpc": "2.0", "id": 1, "method": "DeviceDriverManager.Rescan"}]')
            self.assertEqual(len(told[0]["result"]["problems"]), 1)
            self.assertIn("?", told[0]["result"]["problems"][0]["message"])
            refusal = client.refusal("Device.Load", Name="DMACXYZ")
            self.assertIn("DMACXYZ.json: line 1, column 1 is not JSON", refusal.message)
            self.assertNotIn("\x1b", refusal.message)
            self.assertTrue(client.call("DeviceDriverManager.Rescan"))

    def test_module_of_gigabytes_is_refused_without_being_read(self):
        with Appliance(own_tree=True) as appliance:
            client = appliance.client()
            client.call("authority.acquire")
            with open(appliance.tree / "mill/2-axis/DMACXY/DMACXYKinematics.so", "r+b") as module:
                module.truncate(3 << 30)
            refusal = client.refusal("Device.Load", Name="DMACXY")
            self.assertIn("DMACXYKinematics.so has 3221225472 bytes; at most 67108864 are read", refusal.message)


class MotionAfterBadInput(unittest.TestCase):
    def test_the_same_connection_moves_on_after_its_errors(self):
        with Appliance() as appliance:
            operator = appliance.operator()
            operator.exchange("{")
            operator.refusal("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (99, 0, 0)))
            operator.call("RMAC_CAM.SetFeedrate", Feedrate=1500)
            operator.call("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (5, 0, 0)))
            operator.call("RMAC_CAM.MoveToPathTarget", MoveID=2, TargetFrame=pose(5, 5, 0))
            state = run_to_rest(operator)
            for value, wanted in zip(state["pose"][:3], (5, 5, 0)):
                self.assertAlmostEqual(value, wanted, delta=0.02)


if __name__ == "__main__":
    unittest.main()

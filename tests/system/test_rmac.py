"""The command line client: exit codes, one line of complaint, programs and records."""

import csv
import itertools
import json
import os
import pathlib
import pty
import select
import signal
import subprocess
import unittest

from appliance import BUILD, Appliance, line, pose
from bending_mill import device_of, rigid

DONE, FAILED, USAGE = 0, 1, 2
HELD = ("holds the machine", "holds the machine as the operator")  # what a run is told of `rmac hold`


def start_rmac(test, *words, stdin=subprocess.DEVNULL, **options):
    """The client, which ends with the test however that ends."""
    rmac = test.enterContext(subprocess.Popen(
        [BUILD / "bin" / "rmac", "--port", str(test.appliance.port), *words],
        stdin=stdin, stderr=subprocess.PIPE, **options))
    test.addCleanup(rmac.kill)
    return rmac


def request(method, **params):
    return json.dumps({"jsonrpc": "2.0", "id": 1, "method": method, "params": params})


class Usage(unittest.TestCase):
    """Needs no daemon."""

    def rmac(self, *words):
        return subprocess.run([BUILD / "bin" / "rmac", *words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              timeout=60, check=False)

    def test_wrong_words_are_usage_errors(self):
        for words in ([], ["fly"], ["jog"], ["jog", "--joint", "x", "--distance", "1"], ["override", "201"], ["load"],
                      ["machines", "--sql", "SELECT 1", "--joints", "5"], ["run"], ["status", "--nonsense"]):
            done = self.rmac(*words)
            self.assertEqual(done.returncode, USAGE, words)
            self.assertEqual(done.stdout, "")
            self.assertTrue(done.stderr)

    def test_what_is_no_command_and_no_number_is_named(self):
        for words, named in ((["fly"], "fly"), (["bus", "fly"], "fly"), (["--fly"], "--fly"),
                             (["override", "nan"], "nan"), (["jog", "--joint", "0", "--distance", "inf"], "inf"),
                             (["tune", "0", "--travel", "nan"], "nan"),
                             (["jog", "--direction", "1", "nan", "0", "--distance", "1"], "nan"),
                             (["bus", "load", "device.json", "--period", "nan"], "nan"),
                             (["jog", "--joint", "0", "--distance", "1", "--tool"], "--direction")):
            done = self.rmac(*words)
            self.assertEqual(done.returncode, USAGE, words)
            self.assertIn(named, done.stderr, words)

    def test_help_and_version_are_no_errors(self):
        self.assertEqual(self.rmac("--help").returncode, DONE)
        self.assertEqual(self.rmac("run", "--help").returncode, DONE)
        self.assertRegex(self.rmac("--version").stdout, r"^\d+\.\d+\.\d+")

    def test_no_appliance_is_one_line_that_says_where_was_looked(self):
        done = self.rmac("--socket", "/nonexistent/rmacd.sock", "status")
        self.assertEqual((done.returncode, done.stdout), (FAILED, ""))
        self.assertEqual(len(done.stderr.splitlines()), 1)
        self.assertIn("/nonexistent/rmacd.sock", done.stderr)
        self.assertIn("no appliance answers at " + "a" * 300, self.rmac("--socket", "a" * 300, "status").stderr)


class Operating(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance(own_tree=True))

    def rmac(self, *words):
        done = self.appliance.rmac(*words)
        self.assertEqual((done.returncode, done.stderr), (DONE, ""), words)
        return done.stdout

    def state(self):
        return json.loads(self.rmac("--json", "status"))

    def assert_fails(self, *words):
        done = self.appliance.rmac(*words)
        self.assertEqual(done.returncode, FAILED, words)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_load_jog_home_and_unload(self):
        self.assertIsNone(self.state()["mechanism"])
        self.rmac("load", "DMACXYZ")
        self.rmac("jog", "--joint", "1", "--distance", "-2.5")
        self.assertAlmostEqual(self.state()["joints"][1], -2.5, delta=0.02)
        self.rmac("home")
        self.assertAlmostEqual(self.state()["joints"][1], 0, delta=0.02)
        self.assertEqual(self.state()["authority"], "")
        self.rmac("unload")
        self.assertIsNone(self.state()["mechanism"])

    def test_status_names_the_machine(self):
        self.rmac("load", "DMACXYZ", "--virtual")
        self.assertIn("DMACXYZ, virtual", self.rmac("status"))

    def test_jog_over_the_limit_fails_and_moves_nothing(self):
        self.rmac("load", "DMACXYZ")
        self.assertIn("X", self.assert_fails("jog", "--joint", "0", "--distance", "51"))
        self.assertAlmostEqual(self.state()["joints"][0], 0, delta=0.02)

    def test_moving_what_is_not_loaded_fails(self):
        self.assertRegex(self.rmac("status"), r"last error +none")
        self.assert_fails("jog", "--joint", "0", "--distance", "1")
        self.assertRegex(self.rmac("status"), r"last error +MACHINE_ERR_")
        self.assert_fails("load", "Nonsense")

    def test_hold_resume_override_and_stop_are_accepted_at_rest(self):
        self.rmac("load", "DMACXYZ")
        self.rmac("override", "50")
        self.assertEqual(self.state()["override_percent"], 50)
        self.rmac("stop")

    def test_reset_leaves_a_fault_and_moves_nothing(self):
        with device_of(self.appliance) as device:
            rigid(device)
        self.rmac("load", "DMACXYZ")
        self.assertIn("there is no fault to reset", self.assert_fails("reset"))
        weak = self.appliance.client("weak")
        weak.call("authority.acquire")
        weak.call("RMAC_Config.SetMechanismJointServoControlGains", JntNum=0, ServoControlGains=[15, 0, 0.1])
        weak.call("RMAC_Config.Apply")
        weak.call("authority.release")
        self.assertIn("stands still", self.assert_fails("jog", "--joint", "0", "--distance", "50"))
        self.assertEqual(self.state()["state"], "Faulted")
        self.assertIn("then reset", self.assert_fails("home"))
        self.rmac("reset")
        reset = self.state()
        self.assertEqual((reset["state"], reset["moving"], reset["moves_in_buffer"]), ("Idle", False, 0))
        self.assertNotIn("rmac reset", self.rmac("status"))
        self.rmac("load", "DMACXYZ")  # with the gains of its file
        self.rmac("jog", "--joint", "0", "--distance", "1")
        self.assertAlmostEqual(self.state()["joints"][0], reset["joints"][0] + 1, delta=0.05)

    def test_socket_serves_as_well_as_the_port(self):
        socket = self.appliance.folder / "state" / "rmacd.sock"
        done = subprocess.run([BUILD / "bin" / "rmac", "--socket", socket, "--json", "status"], capture_output=True,
                              text=True, timeout=60, check=True)
        self.assertEqual(json.loads(done.stdout)["state"], "Idle")

    def test_events_tell_of_a_load_until_interrupted(self):
        events = start_rmac(self, "--json", "events", stdout=subprocess.PIPE, bufsize=0)
        watcher = self.appliance.client("watcher")
        watcher.call("subscribe", topics=["events"])
        # The client above subscribes at its own time: loads are repeated until it tells of one.
        heard = json.loads(self.load_until_heard(events.stdout))
        self.assertIn("kind", heard)
        events.send_signal(signal.SIGINT)
        events.stdout.read()
        self.assertEqual(events.wait(timeout=60), DONE)

    def load_until_heard(self, stream):
        heard = b""
        for _ in range(200):
            self.rmac("load", "DMACXYZ")
            while select.select([stream], [], [], 0)[0]:
                heard += os.read(stream.fileno(), 65536)
            if b"\n" in heard:
                return heard.splitlines()[0]
        raise AssertionError("rmac events told of no load")


class Programs(unittest.TestCase):
    def setUp(self):
        self.appliance = self.enterContext(Appliance())
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, DONE)

    def program(self, *lines):
        file = self.appliance.folder / "part.rmac"
        file.write_text("\n".join(lines) + "\n")
        return str(file)

    def square(self, side=4.0, rounds=1):
        """A positioning move and four lines a round."""
        corners = [(0, 0, 0), (side, 0, 0), (side, side, 0), (0, side, 0), (0, 0, 0)]
        start = [request("RMAC_CAM.MoveToPathTarget", MoveID=9, TargetFrame=pose(0, 0, 0))]
        return start + [request("RMAC_CAM.MoveAlongLine", **line(start, end, move_id=number))
                        for _ in range(rounds) for number, (start, end) in enumerate(zip(corners, corners[1:]), start=1)]

    def test_run_reports_moves_and_cycle_time(self):
        program = self.program(request("RMAC_CAM.SetFeedrate", Feedrate=1500), "", *self.square())
        done = self.appliance.rmac("--json", "run", program)
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))
        report = json.loads(done.stdout)
        self.assertEqual(report["moves"], 5)
        # 16 mm at 25 mm/s, and some for the corners.
        self.assertGreater(report["cycle_time_s"], 16 / 25)
        self.assertLess(report["cycle_time_s"], 3)

    def test_record_has_one_row_a_cycle_and_every_column(self):
        program = self.program(request("RMAC_CAM.SetFeedrate", Feedrate=1500), *self.square())
        record = self.appliance.folder / "record.csv"
        done = self.appliance.rmac("run", program, "--record", str(record))
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))
        with record.open() as file:
            rows = list(csv.DictReader(file))
        wanted = "t_s,move_id,s_mm,feed_mm_s,x,y,z,i,j,k,q1,q2,q3,qd1,qd2,qd3,qdd1,qdd2,qdd3,a1,a2,a3,error1,error2,error3".split(",")
        self.assertEqual(list(rows[0]), wanted)
        times = [float(row["t_s"]) for row in rows]
        steps = {round((later - earlier) * 1000) for earlier, later in zip(times, times[1:])}
        self.assertEqual(steps, {1})
        self.assertAlmostEqual(max(float(row["q1"]) for row in rows), 4, delta=1e-9)
        self.assertEqual({int(row["move_id"]) for row in rows} - {0}, {9, 1, 2, 3, 4})
        for before, after in zip(rows, rows[1:]):
            moved = float(after["q1"]) - float(before["q1"])
            self.assertLessEqual(abs(moved), 200 / 1000 * 1.001)
        self.assertLess(max(abs(float(row["q1"]) - float(row["a1"])) for row in rows), 0.2)

    def test_many_moves_stream_through_a_small_queue(self):
        with Appliance(queue_capacity=8) as small:
            program = self.program(request("RMAC_CAM.SetFeedrate", Feedrate=2000), *self.square(side=1, rounds=25))
            done = small.rmac("--json", "run", "--machine", "DMACXYZ", program)
            self.assertEqual((done.returncode, done.stderr), (DONE, ""))
            self.assertEqual(json.loads(done.stdout)["moves"], 101)

    def test_program_may_start_its_own_cycle(self):
        program = self.program(request("RMAC_CAM.SetFeedrate", Feedrate=1500), *self.square(),
                               request("RMAC_CAM.CycleStart", Mode="AUTOMATIC"))
        done = self.appliance.rmac("--json", "run", program)
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))

    def test_program_may_swap_the_mechanism_between_moves(self):
        program = self.program(
            request("RMAC_CAM.SetFeedrate", Feedrate=1500), *self.square(),
            request("Device.Load", Name="DMACXY"),
            request("RMAC_CAM.SetFeedrate", Feedrate=1500), *self.square()[1:])
        record = self.appliance.folder / "swap.csv"
        done = self.appliance.rmac("--json", "run", program, "--record", str(record))
        self.assertEqual((done.returncode, done.stderr), (DONE, ""))
        self.assertEqual(json.loads(done.stdout)["moves"], 9)
        second = pathlib.Path(record.parent, "swap-2.csv")
        self.assertIn(",q2,qd1,", second.read_text().splitlines()[0])

    def test_virtual_run_leaves_drives_alone(self):
        program = self.program(request("Device.Load", Name="DMACXYZ"), request("RMAC_CAM.SetFeedrate", Feedrate=1500),
                               request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(3, 0, 0)))
        self.assertEqual(self.appliance.rmac("run", "--virtual", program).returncode, DONE)
        self.assertTrue(json.loads(self.appliance.rmac("--json", "status").stdout)["virtual"])
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, DONE)
        state = json.loads(self.appliance.rmac("--json", "status").stdout)
        self.assertAlmostEqual(state["joints"][0], 0, delta=0.02)

    def assert_run_fails(self, place, *lines):
        done = self.appliance.rmac("run", self.program(*lines))
        self.assertEqual((done.returncode, done.stdout), (FAILED, ""))
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn(place, done.stderr)
        state = json.loads(self.appliance.rmac("--json", "status").stdout)
        self.assertEqual((state["moving"], state["moves_in_buffer"], state["authority"]), (False, 0, ""))
        return done.stderr

    def test_syntax_error_is_found_before_anything_moves(self):
        self.assert_run_fails("part.rmac:7", request("RMAC_CAM.SetFeedrate", Feedrate=1500), *self.square(), "{broken")
        state = json.loads(self.appliance.rmac("--json", "status").stdout)
        self.assertAlmostEqual(state["joints"][0], 0, delta=0.02)

    def test_what_no_appliance_would_take_is_found_before_anything_moves(self):
        feed = request("RMAC_CAM.SetFeedrate", Feedrate=1500)
        twice = '{"jsonrpc": "2.0", "id": 1, "method": "RMAC_CAM.SetFeedrate", "params": {"Feedrate": 1, "Feedrate": 2}}'
        for bad, reason in ((twice, '"Feedrate" stands twice'), (feed.replace("params", "parms"), 'no member "parms"'),
                            ("[" * 100, "nested"), ("x" * (9 << 20), "8388608"), ("\0", "JSON")):
            self.assertIn(reason, self.assert_run_fails("part.rmac:7", feed, *self.square(), bad))

    def test_refused_request_names_its_line_and_the_machines_reason(self):
        message = self.assert_run_fails("part.rmac:3", request("RMAC_CAM.SetFeedrate", Feedrate=1500),
                                        self.square()[0], request("RMAC_CAM.MoveAlongLine", **line((0, 0, 0), (77, 0, 0))))
        self.assertIn("X", message)

    def test_missing_file_and_unwritable_record_fail_in_one_line(self):
        for words in (["run", "/nonexistent.rmac"],
                      ["run", self.program(*self.square()), "--record", "/nonexistent/record.csv"]):
            done = self.appliance.rmac(*words)
            self.assertEqual((done.returncode, done.stdout), (FAILED, ""))
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_program_held_by_another_client_is_refused(self):
        other = self.appliance.client("other")
        other.call("authority.acquire")
        done = self.appliance.rmac("run", self.program(*self.square()))
        self.assertEqual(done.returncode, FAILED)
        self.assertIn("other", done.stderr)


class InterruptedProgram(unittest.TestCase):
    """A program under way, at the machine's real pace, that a person meddles with."""

    def setUp(self):
        self.appliance = self.enterContext(Appliance(pace="real-time"))
        self.assertEqual(self.appliance.rmac("load", "DMACXYZ").returncode, DONE)
        self.watcher = self.appliance.client("watcher")
        self.watcher.call("subscribe", topics=["state"], rate_hz=100)
        self.file = self.appliance.folder / "slow.rmac"
        self.file.write_text(request("RMAC_CAM.SetFeedrate", Feedrate=120) + "\n" +
                             request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(40, 0, 0)) + "\n")

    def run_until_moving(self, stdin=subprocess.DEVNULL):
        run = start_rmac(self, "run", self.file, stdin=stdin, text=True)
        self.watcher.wait_note("state", lambda state: state["moving"] and state["pose"][0] > 0.2)
        return run

    def assert_fails(self, run, message, told=()):
        """`told`: what others did meanwhile, before the complaint."""
        lines = run.stderr.read().splitlines()
        self.assertEqual(len(lines), len(told) + 1, lines)
        for line_told, words in zip(lines, (*told, message)):
            self.assertIn(words, line_told)
        self.assertEqual(run.wait(timeout=60), FAILED)
        state = self.watcher.state()
        self.assertEqual((state["moving"], state["moves_in_buffer"], state["state"]), (False, 0, "Idle"))

    def test_ctrl_c_stops_the_machine(self):
        run = self.run_until_moving()
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted")

    def test_stop_from_another_terminal_ends_the_run(self):
        run = self.run_until_moving()
        self.assertEqual(self.appliance.rmac("stop").returncode, DONE)
        self.assert_fails(run, "stopped")

    def test_second_program_is_refused_and_the_first_goes_on(self):
        run = self.run_until_moving()
        second = self.appliance.rmac("run", str(self.file))
        self.assertEqual(second.returncode, FAILED)
        self.assertIn("holds motion authority", second.stderr)
        state = self.watcher.state()
        self.assertEqual((state["state"], state["moves_in_buffer"]), ("Running", 1))
        self.watcher.wait_note("state", lambda later: later["moving"] and later["pose"][0] > state["pose"][0] + 0.2)
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted")

    def test_program_after_one_that_was_killed_runs_its_own_moves_alone(self):
        run = self.run_until_moving()
        run.kill()
        run.wait()
        rest = self.watcher.wait_note("state", lambda state: state["authority"] == "" and state["state"] == "Idle")
        self.assertEqual((rest["moving"], rest["moves_in_buffer"]), (False, 0))
        self.file.write_text(request("RMAC_CAM.SetFeedrate", Feedrate=1500) + "\n" +
                             request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(0, 1, 0)) + "\n")
        second = self.appliance.rmac("run", str(self.file))
        self.assertEqual(second.returncode, DONE, second.stderr)
        state = self.watcher.state()
        for value, wanted in zip(state["pose"], (0, 1, 0)):
            self.assertAlmostEqual(value, wanted, delta=0.02)

    def test_program_that_waits_keeps_its_lease_where_silence_ends_it(self):
        with Appliance(pace="real-time", lease_timeout_s=2) as appliance:
            self.assertEqual(appliance.rmac("load", "DMACXYZ").returncode, DONE)
            self.file.write_text(request("RMAC_CAM.SetFeedrate", Feedrate=120) + "\n" +
                                 request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(10, 0, 0)) + "\n")
            done = appliance.rmac("run", str(self.file))  # 5 s
            self.assertEqual(done.returncode, DONE, done.stderr)

    def test_hold_from_another_terminal_is_resumed_by_enter(self):
        keyboard, terminal = pty.openpty()
        run = self.run_until_moving(stdin=terminal)
        self.assertEqual(self.appliance.rmac("hold").returncode, DONE)
        held = self.watcher.wait_note("state", lambda state: state["state"] == "Holding" and not state["moving"])
        self.assertTrue(held["held_by"])
        os.write(keyboard, b"\n")
        self.watcher.wait_note("state", lambda state: state["moving"] and state["pose"][0] > held["pose"][0] + 0.1)
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted", HELD)
        os.close(keyboard)
        os.close(terminal)

    def test_held_program_runs_back_by_a_distance_that_is_typed(self):
        keyboard, terminal = pty.openpty()
        run = self.run_until_moving(stdin=terminal)
        self.watcher.wait_note("state", lambda state: state["pose"][0] > 1)
        self.assertEqual(self.appliance.rmac("hold").returncode, DONE)
        held = self.watcher.wait_note("state", lambda state: state["state"] == "Holding" and not state["moving"])
        notes = itertools.count()

        def ran_back(state):
            # Asked again while it stands where it was held: the machine may just have come to rest, and refused.
            if next(notes) % 100 == 0 and not state["moving"] and state["pose"][0] > held["pose"][0] - 0.1:
                os.write(keyboard, b"0.5\n")
            return state["state"] == "Holding" and not state["moving"] and state["pose"][0] < held["pose"][0] - 0.4

        back = self.watcher.wait_note("state", ran_back)
        self.assertTrue(back["held_by"], "it is still the operator's")
        self.assertAlmostEqual(back["pose"][0], held["pose"][0] - 0.5, delta=0.05)
        os.write(keyboard, b"\n")
        self.watcher.wait_note("state", lambda state: state["pose"][0] > held["pose"][0] + 0.1)
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted", HELD)
        os.close(keyboard)
        os.close(terminal)

    # Red when a panel's commands are refused beside a program, or take its lease, which drops its queue.
    def test_panel_sets_the_feed_holds_and_resumes_beside_a_run(self):
        run = self.run_until_moving()
        self.assertEqual(self.appliance.rmac("override", "50").returncode, DONE)
        self.watcher.wait_note("state", lambda state: abs(state["feed_set_mm_min"] - 60) < 1)
        self.assertEqual(self.appliance.rmac("hold").returncode, DONE)
        held = self.watcher.wait_note("state", lambda state: state["state"] == "Holding" and not state["moving"])
        self.assertRegex(self.appliance.rmac("status").stdout, r"rmac .* holds the machine; to go on: rmac resume")
        self.assertEqual(self.appliance.rmac("resume").returncode, DONE)
        self.watcher.wait_note("state", lambda state: state["moving"] and state["pose"][0] > held["pose"][0] + 0.1)
        self.assertEqual(self.watcher.state()["held_by"], "")
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted", ("sets the feed override to 50 %", *HELD, "resumes"))

    def test_prompt_of_a_run_holds_and_sets_the_feed(self):
        keyboard, terminal = pty.openpty()
        run = self.run_until_moving(stdin=terminal)
        os.write(keyboard, b"50%\n")
        self.watcher.wait_note("state", lambda state: abs(state["feed_set_mm_min"] - 60) < 1)
        os.write(keyboard, b"h\n")
        held = self.watcher.wait_note("state", lambda state: state["held_by"] and not state["moving"])
        self.assertEqual(held["state"], "Holding")
        self.watcher.wait_note("state", lambda state: state["operator"] == "")
        os.write(keyboard, b"\n")
        self.watcher.wait_note("state", lambda state: state["moving"] and state["pose"][0] > held["pose"][0] + 0.1)
        run.send_signal(signal.SIGINT)
        self.assert_fails(run, "interrupted")
        os.close(keyboard)
        os.close(terminal)

    # Red when a person takes the last stop of a run that went well for a fault, or an old error for one of it.
    def test_run_that_went_well_leaves_no_stop_but_its_end(self):
        self.assertEqual(self.appliance.rmac("jog", "--joint", "0", "--distance", "1000").returncode, FAILED)
        self.assertRegex(self.appliance.rmac("status").stdout, r"last error, \S+ s ago: this move takes joint X")
        self.assertEqual(self.appliance.rmac("reset").returncode, DONE)
        self.file.write_text(request("RMAC_CAM.SetFeedrate", Feedrate=1500) + "\n" +
                             request("RMAC_CAM.MoveToPathTarget", MoveID=1, TargetFrame=pose(0.5, 0, 0)) + "\n")
        self.assertEqual(self.appliance.rmac("run", str(self.file)).returncode, DONE)
        rest = self.watcher.wait_note("state", lambda state: state["state"] == "Idle" and state["last_stop"])
        self.assertEqual(rest["last_stop"]["message"], "the cycle has ended: all that was queued is done")
        status = self.appliance.rmac("status").stdout
        self.assertRegex(status, r"last error +none")
        self.assertRegex(status, r"last stop \(Stopped\), \S+ s ago: .*: the cycle has ended")

    def test_rmacd_that_ends_under_a_program_is_told(self):
        run = self.run_until_moving()
        self.appliance.process.send_signal(signal.SIGTERM)
        # The daemon stops the machine first; which of the two the client hears of depends on the turn it gets.
        self.assertRegex(run.stderr.read(), "the connection .* ended|the cycle was stopped")
        self.assertEqual(run.wait(timeout=60), FAILED)

    def test_jog_by_velocity_lasts_until_ctrl_c(self):
        jog = start_rmac(self, "jog", "--joint", "0", "--velocity", "4", text=True)
        self.watcher.wait_note("state", lambda state: jog.poll() is not None or state["pose"][0] > 0.2)
        jog.send_signal(signal.SIGINT)
        complaint = jog.stderr.read()
        if jog.wait(timeout=60) != DONE:
            # Too busy a computer to renew it in time: then it stops, and is no longer there to be renewed.
            self.assertRegex(complaint, "a jog needs it Idle|coming to rest")
        self.watcher.wait_note("state", lambda state: state["state"] == "Idle" and not state["moving"])

    def test_jog_by_velocity_ends_when_it_is_not_renewed(self):
        operator = self.appliance.operator()
        operator.call("RMAC_CAM.JogPath", Direction=[0, 0, -1], Velocity=10)
        self.watcher.wait_note("state", lambda state: state["moving"])
        rest = self.watcher.wait_note("state", lambda state: state["state"] == "Idle" and not state["moving"])
        self.assertGreater(rest["pose"][2], -3)  # 200 ms at 10 mm/s, and the way to rest
        self.assertTrue(rest["authority"].startswith("operator"), rest["authority"])


if __name__ == "__main__":
    unittest.main()

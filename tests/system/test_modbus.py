"""Spindle drives behind Modbus, on pymodbus's servers: each register map that is shipped against a peer that keeps its
manual, mbpoll reading beside the appliance, and what happens when a drive trips or goes away."""

import contextlib
import json
import logging
import signal
import subprocess
import time
import unittest

import modbus_drives
from appliance import STOP_BOUND_S, Appliance
from client import Refused

logging.disable()  # pymodbus calls it an error when its server ends
TOLERANCE_RPM = 20
RPM_PER_HZ = 60
RESETS = 20
# Python answers, on a machine that may be busy: nothing here is lost, only late.
PATIENCE = {"deadline_ms": 10000, "stale_ms": 60000, "boot_timeout_s": 60}


def set_spindle(appliance, parameters):
    """DMACXYZ with its axes on the simulated bus and its spindle on Modbus."""
    file = appliance.tree / "mill/3-axis/DMACXYZ/device.json"
    device = json.loads(file.read_text())
    device["Spindles"][0].update(Bus="spindle0", Axis=0, RatedTorque=0)
    device["DigitalControlInterface"]["Parameters"] = {
        "spindle0.interface": "ModbusInterface",
        **{f"spindle0.{name}": value for name, value in parameters.items()}}
    file.write_text(json.dumps(device))


class Machine:
    """The appliance with a drive as its spindle. A context manager."""

    def __init__(self, served, register_map, **parameters):
        self.served = served
        self.parameters = {"map": register_map, "slave": 1, "rpm_per_hz": RPM_PER_HZ, **served.parameters(), **PATIENCE,
                           **parameters}

    def __enter__(self):
        with contextlib.ExitStack() as stack:
            self.appliance = Appliance(pace="real-time", own_tree=True)
            set_spindle(self.appliance, self.parameters)
            stack.enter_context(self.appliance)
            self.operator = self.appliance.operator()
            self.watcher = self.appliance.client("watcher")
            self.watcher.call("subscribe", topics=["state"], rate_hz=100)
            self.watcher.call("subscribe", topics=["events"])
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *error):
        self._stack.__exit__(*error)

    def turn(self, rpm):
        self.operator.call("RMAC_CAM.SetSpindleRPM", SpindleNumber=0, RPM=rpm)
        self.served.drive.wait_for(lambda drive: abs(drive.turning_hz * RPM_PER_HZ - rpm) < TOLERANCE_RPM)
        self.watcher.wait_note("state", lambda state: abs(state["spindle_rpm"][0] - rpm) < TOLERANCE_RPM)

    def reset(self):
        """Asks again, as an operator would, where a drive on a slow line takes longer to leave its fault than a reset waits."""
        for left in reversed(range(RESETS)):
            try:
                return self.operator.call("RMAC_CAM.Reset")
            except Refused as refusal:
                if left == 0 or "the fault is still there" not in refusal.message:
                    raise

    def wait_fault(self):
        message = self.watcher.wait_note("events", lambda event: event["kind"] == "Fault")["message"]
        self.watcher.wait_note("state", lambda state: state["state"] == "Faulted")
        return message


class RegisterMaps(unittest.TestCase):
    def check(self, drive, register_map, wire=modbus_drives.ServedOnTcp, **parameters):
        with wire(drive) as served, Machine(served, register_map, **parameters) as machine:
            for rpm in (600, 900, -300, 0, 750):
                machine.turn(rpm)
            drive.trip()
            self.assertIn(drive.fault_words, machine.wait_fault())
            drive.wait_for(lambda drive: drive.turning_hz == 0)
            machine.reset()
            drive.wait_for(lambda drive: not drive.tripped and drive.turning_hz == 0)
            machine.turn(600)
            self.assertEqual(machine.appliance.end(), 0)
            self.assertEqual(drive.turning_hz, 0, "the spindle outlived the appliance")

    def test_delta_vfd_b(self):
        self.check(modbus_drives.DeltaVfdB(), "delta-vfd-b")

    def test_automationdirect_gs2(self):
        self.check(modbus_drives.Gs2(), "automationdirect-gs2")

    def test_toshiba_vf_s11(self):
        self.check(modbus_drives.VfS11(), "toshiba-vf-s11")

    def test_hitachi_wj200(self):
        self.check(modbus_drives.Wj200(), "hitachi-wj200")

    def test_powtran_pi500(self):
        self.check(modbus_drives.Pi500(), "powtran-pi500", maximum_hz=modbus_drives.Pi500.maximum_hz)

    def test_on_a_serial_line(self):
        self.check(modbus_drives.DeltaVfdB(), "delta-vfd-b", modbus_drives.ServedOnRtu)

    def test_on_a_serial_line_one_register_at_a_time(self):
        self.check(modbus_drives.VfS11(), "toshiba-vf-s11", modbus_drives.ServedOnRtu)


class Spindle(unittest.TestCase):
    def test_another_master_reads_what_the_appliance_wrote(self):
        with modbus_drives.ServedOnTcp(modbus_drives.DeltaVfdB()) as served, Machine(served, "delta-vfd-b") as machine:
            machine.turn(600)
            read = subprocess.run(
                ["mbpoll", "-m", "tcp", "-p", str(served.port), "-a", "1", "-t", "4", "-r", str(0x2000), "-c", "2", "-0", "-1",
                 "-q", "127.0.0.1"], capture_output=True, text=True, timeout=60, check=True)
            values = [line.split()[1] for line in read.stdout.splitlines() if line.startswith("[")]
            self.assertEqual(values, [str(0x12), "1000"], read.stdout)

    def test_it_stops_with_the_other_drives(self):
        # What any fault of the machine, an emergency stop among them, does to its drives.
        with modbus_drives.ServedOnTcp(modbus_drives.DeltaVfdB()) as served, Machine(served, "delta-vfd-b") as machine:
            machine.turn(600)
            machine.appliance.process.send_signal(signal.SIGTERM)
            served.drive.wait_for(lambda drive: drive.turning_hz == 0)

    def test_asking_for_the_end_again_and_again_does_not_kill_it(self):
        # The drive's own thread lives almost to the end of the process.
        with modbus_drives.ServedOnTcp(modbus_drives.DeltaVfdB()) as served, Machine(served, "delta-vfd-b") as machine:
            machine.turn(600)
            end = time.monotonic() + STOP_BOUND_S
            while machine.appliance.process.poll() is None:
                self.assertLess(time.monotonic(), end, "it does not end")
                machine.appliance.process.send_signal(signal.SIGTERM)
            self.assertEqual(machine.appliance.process.returncode, 0)
            self.assertEqual(served.drive.turning_hz, 0)

    def test_a_drive_that_goes_away_faults_the_machine_and_stays_stopped(self):
        drive = modbus_drives.DeltaVfdB()
        with modbus_drives.ServedOnTcp(drive) as served:
            machine = self.enterContext(Machine(served, "delta-vfd-b", stale_ms=2000, deadline_ms=1000))
            machine.turn(600)
        self.assertIn("drive of spindle 0 (bus spindle0, axis 0): the drive does not answer", machine.wait_fault())
        state = machine.operator.state()
        self.assertEqual((state["state"], state["spindle_rpm"]), ("Faulted", [0]))

    def test_a_drive_that_is_not_there_is_named_and_the_machine_is_not_loaded(self):
        with Appliance(own_tree=True) as appliance:
            set_spindle(appliance, {"map": "delta-vfd-b", "slave": 5, "device": "/dev/no-such-port", "boot_timeout_s": 0.2})
            operator = appliance.client("operator")
            operator.call("authority.acquire")
            refusal = operator.refusal("Device.Load", Name="DMACXYZ")
            self.assertIn("bus spindle0 did not come up: slave 5 at /dev/no-such-port was not reached within 0.2 s: "
                          "/dev/no-such-port: cannot be opened: No such file or directory", refusal.message)
            self.assertIsNone(operator.state()["mechanism"])


class RemoteIo(unittest.TestCase):
    def test_carries_outputs_and_inputs_and_faults_the_machine_when_it_goes_away(self):
        device = modbus_drives.RemoteIo()
        with Appliance(pace="real-time", own_tree=True) as appliance:
            with modbus_drives.ServedOnTcp(device) as served:
                file = appliance.tree / "mill/3-axis/DMACXYZ/device.json"
                data = json.loads(file.read_text())
                data["DigitalIOInterface"] = {
                    "Module": "ModbusIOInterface", "Inputs": {"Door": 3}, "Outputs": {"Coolant": 5},
                    "Parameters": {"map": "generic-remote-io", **served.parameters(), **PATIENCE, "deadline_ms": 1000,
                                   "stale_ms": 2000}}
                file.write_text(json.dumps(data))
                operator = appliance.operator()
                watcher = appliance.client("watcher")
                watcher.call("subscribe", topics=["state"], rate_hz=100)
                operator.call("RMAC_CAM.TurnCoolantOn")
                device.wait_for(lambda device: device.values["coil", 5] == 1)
                device.switch(3, 1)
                watcher.wait_note("state", lambda state: state["inputs"] == 1 << 3)
                operator.call("RMAC_CAM.TurnCoolantOff")
                device.wait_for(lambda device: device.values["coil", 5] == 0)
            watcher.wait_note("state", lambda state: state["state"] == "Faulted")


if __name__ == "__main__":
    unittest.main()

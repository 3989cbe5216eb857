"""The drive itself, by the standard, without a bus, and once on python3-can's virtual one. `python3 -m unittest` in this folder."""

import struct
import threading
import unittest

from drive import Drive
from manners import manners_of
from power import Power
from nmt import State

NODE = 5
CYCLE_S = 0.002


class Bench:
    """A drive, a clock, and a master that is nothing but frames."""

    def __init__(self, *words):
        self.now, self.sent = 100.0, []
        self.drive = Drive(lambda identifier, data: self.sent.append((identifier, bytes(data))), NODE, manners_of(words), self.now)
        self.run(0)

    def run(self, seconds):
        end = self.now + seconds
        while (at := self.drive.next_at) is not None and at <= end:
            self.now = max(self.now, at)
            self.drive.poll(self.now)
        self.now = end
        self.drive.poll(self.now)

    def put(self, identifier, data=b"", remote=False):
        self.drive.handle(identifier, bytes(data), self.now, remote)

    def take(self, identifier):
        found = [data for one, data in self.sent if one == identifier]
        self.sent = [frame for frame in self.sent if frame[0] != identifier]
        return found

    def ask(self, request, within_s=0.0):
        self.put(0x600 + NODE, request)
        self.run(within_s)
        return self.take(0x580 + NODE)

    def write(self, index, sub, value, size, within_s=0.0):
        """The abort code, or 0."""
        request = bytes([0x23 | (4 - size) << 2]) + struct.pack("<HB", index, sub) + (value & 0xFFFFFFFF).to_bytes(4, "little")
        (answer,) = self.ask(request, within_s)
        return struct.unpack("<I", answer[4:])[0] if answer[0] == 0x80 else 0

    def read(self, index, sub=0, within_s=0.0):
        (answer,) = self.ask(bytes([0x40]) + struct.pack("<HB", index, sub) + bytes(4), within_s)
        return answer

    def value(self, index, sub=0):
        return struct.unpack("<I", self.read(index, sub)[4:])[0]

    def abort(self, index, sub=0):
        answer = self.read(index, sub)
        assert answer[0] == 0x80, answer
        return struct.unpack("<I", answer[4:])[0]

    def map(self, communication, words, identifier):
        """By CiA 301, 7.5.2.36."""
        remote = 0x40000000 if communication >= 0x1800 else 0
        codes = [self.write(communication, 1, 0x80000000 | remote | identifier, 4), self.write(communication, 2, 1, 1),
                 self.write(communication + 0x200, 0, 0, 1)]
        codes += [self.write(communication + 0x200, sub, word, 4) for sub, word in enumerate(words, 1)]
        return codes + [self.write(communication + 0x200, 0, len(words), 1), self.write(communication, 1, remote | identifier, 4)]

    def configure(self, mode=8):
        target = {8: 0x607A0020, 9: 0x60FF0020, 10: 0x60710010}[mode]
        codes = self.map(0x1400, [0x60400010, target], 0x200 + NODE) + self.map(0x1800, [0x60410010, 0x60640020], 0x180 + NODE)
        codes += [self.write(0x6060, 0, mode, 1), self.write(0x60C2, 1, 2, 1), self.write(0x60C2, 2, -3, 1)]
        assert not any(codes), codes
        self.target_size = 2 if mode == 10 else 4
        self.put(0, [1, NODE])

    def cycle(self, controlword, target=None):
        """(statusword, position) of the answer."""
        position = self.status[1] if hasattr(self, "status") else 0
        target = position if target is None else target
        self.put(0x200 + NODE, struct.pack("<H", controlword) + target.to_bytes(self.target_size, "little", signed=True))
        self.put(0x80)
        (answer,) = self.take(0x180 + NODE)
        self.run(CYCLE_S)
        self.status = struct.unpack("<Hi", answer)
        return self.status

    def enable(self):
        for word in (0x06, 0x06, 0x07, 0x07, 0x0F, 0x0F):
            self.cycle(word)
        return self.status[0] & 0x6F


class Communication(unittest.TestCase):
    def test_boots_into_pre_operational_with_one_boot_up_message(self):
        bench = Bench()
        self.assertEqual(bench.take(0x700 + NODE), [b"\0"])
        self.assertEqual(bench.drive.nmt.state, State.PRE_OPERATIONAL)
        for command, state in ((1, State.OPERATIONAL), (2, State.STOPPED), (0x80, State.PRE_OPERATIONAL)):
            bench.put(0, [command, 0])
            self.assertEqual(bench.drive.nmt.state, state)
        bench.put(0, [1, NODE + 1])
        self.assertEqual(bench.drive.nmt.state, State.PRE_OPERATIONAL, "it was told somebody else")

    def test_a_stopped_node_answers_no_sdo(self):
        bench = Bench()
        bench.put(0, [2, NODE])
        self.assertEqual(bench.ask(b"\x40\x00\x10\0\0\0\0\0"), [])

    def test_tells_its_state_each_period_of_1017h(self):
        bench = Bench()
        bench.take(0x700 + NODE)
        bench.write(0x1017, 0, 50, 2)
        bench.run(0.2)
        self.assertEqual(bench.take(0x700 + NODE), [b"\x7f"] * 5, "at once, and after each of four periods")
        bench.put(0, [0x82, NODE])
        bench.run(0.2)
        self.assertEqual(bench.take(0x700 + NODE), [b"\0"], "a reset of the communication ends it")

    def test_refuses_by_the_codes_of_the_standard(self):
        bench = Bench()
        self.assertEqual(bench.abort(0x5000), 0x06020000)
        self.assertEqual(bench.abort(0x1018, 9), 0x06090011)
        self.assertEqual(bench.write(0x6041, 0, 1, 2), 0x06010002)
        self.assertEqual(bench.write(0x6040, 0, 1, 4), 0x06070012)
        self.assertEqual(bench.write(0x6071 - 0x11, 0, 77, 1), 0x06090030)
        self.assertEqual(bench.write(0x6071, 0, 1, 1), 0x06070013)

    def test_maps_in_the_standards_order_only(self):
        bench = Bench()
        self.assertEqual(bench.write(0x1A00, 0, 0, 1), 0x08000022, "while the PDO exists")
        self.assertEqual(bench.write(0x1800, 1, 0x40000000 | 0x581, 4), 0x06090030, "an identifier of SDO")
        self.assertEqual(bench.write(0x1800, 1, 0x40000000 | 0x190, 4), 0x08000022, "another identifier while it exists")
        self.assertEqual(bench.write(0x1800, 1, 0xC0000000 | 0x185, 4), 0)
        self.assertEqual(bench.write(0x1A00, 1, 0x60410010, 4), 0x08000022, "while it has contents")
        self.assertEqual(bench.write(0x1A00, 0, 0, 1), 0)
        self.assertEqual(bench.write(0x1A00, 1, 0x60400010, 4), 0x06040041)
        self.assertEqual(bench.write(0x1A00, 1, 0x60990010, 4), 0x06020000)
        for sub, word in enumerate((0x60640020, 0x606C0020, 0x60770010), 1):
            self.assertEqual(bench.write(0x1A00, sub, word, 4), 0)
        self.assertEqual(bench.write(0x1A00, 0, 3, 1), 0x06040042)
        self.assertEqual(bench.write(0x1A00, 0, 2, 1), 0)
        self.assertEqual(bench.write(0x1800, 2, 250, 1), 0x06090030)

    def test_misses_the_heartbeat_of_its_master(self):
        bench = Bench()
        bench.configure()
        bench.write(0x6007, 0, 3, 2)
        bench.write(0x1016, 1, 127 << 16 | 75, 4)
        bench.enable()
        bench.run(1)
        self.assertEqual(bench.drive.nmt.state, State.OPERATIONAL, "it watches from the first heartbeat on")
        bench.put(0x77F, [5])
        bench.enable()
        self.assertEqual(bench.drive.axis.power.state, Power.ENABLED)
        bench.run(0.074 - 6 * CYCLE_S)
        self.assertEqual(bench.drive.axis.power.state, Power.ENABLED)
        bench.run(0.002)
        self.assertEqual(bench.drive.nmt.state, State.PRE_OPERATIONAL)
        self.assertEqual(bench.take(0x80 + NODE)[0][:2], b"\x30\x81")
        bench.run(0.1)
        self.assertEqual(bench.drive.axis.power.state, Power.DISABLED, "by a quick stop")

    def test_goes_back_to_power_on_values(self):
        bench = Bench("--value", "6502:00=80")
        bench.write(0x6085, 0, 7, 4)
        bench.write(0x1016, 1, 5, 4)
        bench.put(0, [0x82, NODE])
        self.assertEqual((bench.value(0x6085), bench.value(0x1016, 1)), (7, 0))
        bench.put(0, [0x81, NODE])
        self.assertEqual(bench.value(0x6085), 2600000)
        self.assertEqual(bench.value(0x6502), 0x80)


class Motion(unittest.TestCase):
    def test_goes_through_the_power_states(self):
        bench = Bench()
        bench.configure()
        seen = [bench.cycle(word)[0] for word in (0, 0x06, 0x07, 0x0F, 0x0F)]
        self.assertEqual([word & 0x6F for word in seen], [0x40, 0x40, 0x21, 0x23, 0x27])
        self.assertTrue(all(word & 0x200 for word in seen), "remote")
        self.assertEqual(bench.cycle(0x02)[0] & 0x6F, 0x27)
        self.assertEqual(bench.cycle(0x02)[0] & 0x6F, 0x40, "a quick stop at rest is over at once")

    def test_follows_positions_a_cycle_later(self):
        bench = Bench()
        bench.configure()
        bench.enable()
        places = [bench.cycle(0x0F, target)[1] for target in (10, 20, 30, 40, 40)]
        self.assertEqual(places, [0, 10, 20, 30, 40])

    def test_turns_by_a_velocity_and_by_a_torque(self):
        for mode, target in ((9, 1000), (10, 100)):
            bench = Bench()
            bench.configure(mode)
            bench.enable()
            for _ in range(500):
                place = bench.cycle(0x0F, target)[1]
            # 52 per mille beyond friction
            wanted = {9: 998, 10: 0.5 * 52 * 0.318e-3 / 1.64e-5 * 131072 / 6.2831853 * 0.998**2}[mode]
            self.assertAlmostEqual(place, wanted, delta=0.01 * wanted)

    def test_a_fault_goes_by_a_rising_edge_alone(self):
        bench = Bench("--fault-at-boot", "7305")
        bench.configure()
        self.assertEqual(bench.cycle(0x80)[0] & 0x4F, 0x08)
        bench.drive.axis.power.fail(0x1000)
        for _ in range(3):
            self.assertEqual(bench.cycle(0x80)[0] & 0x4F, 0x08, "the bit stays where it was")
        bench.cycle(0)
        bench.cycle(0x80)
        self.assertEqual(bench.cycle(0x80)[0] & 0x4F, 0x40)


class Manners(unittest.TestCase):
    def test_refuses_by_the_code_it_was_told(self):
        bench = Bench("--refuse", "60C2=06010000", "1018:04=06090011", "--refuse-write", "1402=08000022", "--absent", "6007")
        self.assertEqual(bench.abort(0x60C2, 1), 0x06010000)
        self.assertEqual(bench.abort(0x1018, 4), 0x06090011)
        self.assertEqual(bench.value(0x1018, 3), 0x10001)
        self.assertEqual(bench.value(0x1402, 1), 0x405)
        self.assertEqual(bench.write(0x1402, 1, 0x80000405, 4), 0x08000022)
        self.assertEqual(bench.abort(0x6007), 0x06020000)

    def test_fixed_mapping_holds_what_it_was_told(self):
        bench = Bench("--fixed-mapping", "--tpdo", "60410010 60640020 60770010")
        self.assertEqual([bench.value(0x1A00, sub) for sub in range(5)], [3, 0x60410010, 0x60640020, 0x60770010, 0])
        self.assertEqual(bench.write(0x1800, 1, 0xC0000185, 4), 0)
        self.assertEqual(bench.write(0x1A00, 0, 0, 1), 0x06010002)

    def test_sdo_answers_get_lost(self):
        bench = Bench("--sdo-ignore-first", "1")
        self.assertEqual([len(bench.ask(b"\x40\x00\x10\0\0\0\0\0")) for _ in range(3)], [0, 1, 1])
        bench = Bench("--sdo-lose-every", "3")
        self.assertEqual([len(bench.ask(b"\x40\x00\x10\0\0\0\0\0")) for _ in range(6)], [1, 1, 0, 1, 1, 0])
        bench = Bench("--sdo-wrong-index-once")
        self.assertEqual([bench.read(0x1000)[1] for _ in range(2)], [1, 0])
        bench = Bench("--sdo-twice")
        self.assertEqual(len(bench.ask(b"\x40\x00\x10\0\0\0\0\0")), 2)

    def test_sdo_answers_come_late(self):
        bench = Bench("--sdo-delay-ms", "700")
        self.assertEqual(bench.ask(b"\x40\x00\x10\0\0\0\0\0", 0.69), [])
        bench.run(0.02)
        self.assertEqual(len(bench.take(0x580 + NODE)), 1)
        bench.ask(b"\x40\x00\x10\0\0\0\0\0")
        bench.put(0x600 + NODE, b"\x80\x00\x10\0\0\0\x04\x05")
        bench.run(1)
        self.assertEqual(bench.take(0x580 + NODE), [], "its client gave up")

    def test_a_server_works_on_when_its_client_gave_up(self):
        for manner, answers in (("", 1), ("--sdo-queues", 2)):
            bench = Bench("--sdo-delay-ms", "700", "--sdo-deaf-to-abort", *manner.split())
            bench.ask(b"\x40\x00\x10\0\0\0\0\0", 0.5)
            bench.ask(b"\x80\x00\x10\0\0\0\x04\x05")
            self.assertEqual(len(bench.ask(b"\x40\x00\x10\0\0\0\0\0", 0.25)), 1)
            bench.run(2)
            self.assertEqual(len(bench.take(0x580 + NODE)), answers - 1)

    def test_the_server_knows_expedited_transfers_alone(self):
        bench = Bench("--expedited-only", "--no-blocks")
        self.assertEqual(bench.value(0x1000), 0x20192)
        self.assertEqual(bench.abort(0x1008), 0x05040001)
        self.assertEqual(bench.ask(b"\xA0\x08\x10\0\x7F\0\0\0")[0], b"\x80\x08\x10\0\x01\0\x04\x05")

    def test_the_server_tells_values_in_other_ways(self):
        self.assertEqual(Bench("--no-sizes").read(0x6041), b"\x42\x41\x60\0\0\0\0\0")
        self.assertEqual(Bench("--stale-bytes").read(0x6041), b"\x4B\x41\x60\0\0\0\xA5\xA5")
        bench = Bench("--always-segmented")
        self.assertEqual(bench.read(0x1018, 2), b"\x41\x18\x10\x02\x04\0\0\0")
        self.assertEqual(bench.ask(b"\x60" + bytes(7)), [b"\x07\x02\x04\0\0\0\0\0"])

    def test_boots_slowly_and_repeats_its_boot_up_message(self):
        bench = Bench("--boot-s", "2", "--boot-ups", "3", "--obeys-start-while-booting")
        bench.put(0, [1, 0])
        bench.run(1.99)
        self.assertEqual(bench.sent, [])
        bench.run(0.02)
        self.assertEqual(bench.drive.nmt.state, State.OPERATIONAL)
        bench.run(0.5)
        self.assertEqual(bench.take(0x700 + NODE), [b"\0"] * 3)

    def test_resets_itself_for_a_while(self):
        bench = Bench("--resets-itself-s", "3.5")
        bench.run(10)
        self.assertEqual(len(bench.take(0x700 + NODE)), 1)
        bench.put(0, [0x81, NODE])
        bench.run(10)
        self.assertEqual(len(bench.take(0x700 + NODE)), 4)

    def test_starts_itself_and_is_mapped_before(self):
        bench = Bench("--starts-itself", "--mapped-before-start")
        self.assertEqual(bench.drive.nmt.state, State.OPERATIONAL)
        self.assertEqual(bench.write(0x1800, 1, 0xC0000185, 4), 0x08000022)
        bench.put(0, [0x80, NODE])
        self.assertEqual(bench.write(0x1800, 1, 0xC0000185, 4), 0)

    def test_guarding_toggles(self):
        bench = Bench("--guarding-only")
        self.assertEqual(bench.abort(0x1017), 0x06020000)
        bench.take(0x700 + NODE)
        for _ in range(3):
            bench.put(0x700 + NODE, remote=True)
        self.assertEqual(bench.take(0x700 + NODE), [b"\x7F", b"\xFF", b"\x7F"])

    def test_guarding_watches_the_master(self):
        for words, asks, lost in ((["--guarding-only"], False, 0), (["--guarding-only"], True, 1), (["--guarding-only", "--life-from-writing"], False, 1)):
            bench = Bench(*words)
            self.assertEqual(bench.abort(0x1016), 0x06020000)
            bench.write(0x100C, 0, 50, 2)
            bench.write(0x100D, 0, 2, 1)
            if asks:
                for _ in range(5):
                    bench.put(0x700 + NODE, remote=True)
                    bench.run(0.09)
                self.assertEqual(bench.drive.counts["masters_lost"], 0)
            bench.run(0.2)
            self.assertEqual(bench.drive.counts["masters_lost"], lost)

    def test_positions_are_late(self):
        prompt, late = Bench(), Bench("--position-delay", "3")
        told = []
        for bench in (prompt, late):
            bench.configure()
            bench.enable()
            told.append([bench.cycle(0x0F, 100 * n)[1] for n in range(1, 20)])
        self.assertEqual(told[0][3:-3], told[1][6:])
        self.assertNotEqual(told[0][-1], told[1][-1])

    def test_storms_and_remembers(self):
        bench = Bench("--emcy-at-boot", "40", "--history", "1000", "8130")
        self.assertEqual(len(bench.take(0x80 + NODE)), 40)
        self.assertEqual([bench.value(0x1003, sub) for sub in range(3)], [2, 0x1000, 0x8130])
        self.assertEqual(bench.value(0x1001), 0x81)

    def test_the_statusword_is_late_and_has_bits_of_its_own(self):
        bench = Bench("--status-delay", "3", "--status-set", "C000", "--status-clear", "0200")
        bench.configure()
        words = [bench.cycle(0x06)[0] for _ in range(8)]
        self.assertEqual([word & 0x6F for word in words], [0x40] * 4 + [0x21] * 4)
        self.assertTrue(all(word & 0xC200 == 0xC000 for word in words))

    def test_the_power_states_take_their_time(self):
        bench = Bench("--not-ready-s", "0.5", "--enable-s", "0.1")
        bench.configure()
        self.assertEqual(bench.cycle(0x06)[0] & 0x6F, 0)
        bench.run(0.5)
        self.assertEqual(bench.enable(), 0x23)
        bench.run(0.1)
        bench.cycle(0x0F)
        self.assertEqual(bench.cycle(0x0F)[0] & 0x6F, 0x27)
        bench = Bench("--quick-stop-at-boot")
        bench.configure()
        bench.run(1)
        self.assertEqual([bench.cycle(word)[0] & 0x6F for word in (0x06, 0x0F, 0x00, 0x00)], [0x07, 0x07, 0x07, 0x40])

    def test_a_fault_takes_its_time_to_go(self):
        bench = Bench("--fault-at-boot", "2310", "--fault-reset-s", "0.02")
        bench.configure()
        bench.cycle(0x80)
        bench.put(0, [0x81, NODE])
        bench.configure()
        self.assertEqual(bench.cycle(0)[0] & 0x4F, 0x08, "no reset of the node ends it")
        bench.cycle(0x80)
        for _ in range(8):
            self.assertEqual(bench.cycle(0x80)[0] & 0x4F, 0x08)
        for _ in range(5):
            bench.cycle(0x80)
        self.assertEqual(bench.status[0] & 0x4F, 0x40)

    def test_pdos_are_late_missing_or_too_many(self):
        bench = Bench("--skips-first-sync", "2", "--tpdo-delay-ms", "1", "--chatters")
        bench.configure()
        bench.run(0)
        bench.take(0x180 + NODE)
        for answers in (0, 0, 1):
            bench.put(0x80)
            self.assertEqual(bench.take(0x180 + NODE), [])
            bench.run(0.001)
            self.assertEqual(len(bench.take(0x180 + NODE)), answers)
        bench.run(0.05)
        self.assertGreaterEqual(len(bench.take(0x380 + NODE)), 9)


class OnPythonCan(unittest.TestCase):
    def test_answers_on_a_virtual_bus(self):
        import can
        with can.Bus("strangers", interface="virtual") as ours, can.Bus("strangers", interface="virtual") as its:
            def serve():
                drive = Drive(lambda identifier, data: its.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False)),
                              NODE, manners_of(), 0.0)
                drive.poll(0.0)
                message = its.recv(10)
                drive.handle(message.arbitration_id, message.data, 0.0)

            node = threading.Thread(target=serve)
            node.start()
            self.assertEqual(bytes(ours.recv(10).data), b"\0")
            ours.send(can.Message(arbitration_id=0x600 + NODE, data=b"\x40\x00\x10\0\0\0\0\0", is_extended_id=False))
            self.assertEqual(bytes(ours.recv(10).data), b"\x43\x00\x10\0\x92\x01\x02\0")
            node.join()


if __name__ == "__main__":
    unittest.main()

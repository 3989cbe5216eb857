#include <gmock/gmock.h>

#include "conformance/control_interface_conformance.hpp"
#include "on_vcan.hpp"

// The socket, and the master while nothing goes wrong.
namespace rmac::bench {
namespace {

TEST(SocketCan, CarriesWhatItsFiltersAskForWithTheKernelsTime) {
  const auto from = open_port();
  constexpr std::uint16_t kWanted[] = {0x181, 0x701};
  const auto to = open_port(kWanted);
  for (std::uint16_t id = 0; id < 0x800; ++id) ASSERT_TRUE(from->send({.id = id, .size = 2, .data = {7, 9}}));
  CanFrame frame;
  for (const std::uint16_t id : kWanted) {
    ASSERT_TRUE(to->receive(frame));
    EXPECT_EQ(frame, (CanFrame{.id = id, .size = 2, .data = {7, 9}}));
    EXPECT_GT(frame.stamp.count(), 0);
  }
  EXPECT_FALSE(to->receive(frame));
  EXPECT_EQ(to->health().received, 2U);
}

TEST(SocketCan, CountsWhatWasLostBecauseNobodyFetchedIt) {
  const auto from = open_port();
  const auto to = open_port();
  constexpr std::uint64_t kFrames = 20000;
  for (std::uint64_t i = 0; i < kFrames; ++i) from->send({.id = 0x100, .size = 8});
  CanFrame frame;
  while (to->receive(frame)) {
  }
  from->send({.id = 0x100, .size = 8});  // the kernel tells the number with the next frame that it keeps
  ASSERT_TRUE(to->receive(frame));
  EXPECT_EQ(to->health().received + to->health().overflowed, kFrames + 1);
  EXPECT_GT(to->health().overflowed, 0U);
}

TEST(SocketCan, SaysWhatIsWrongWithAnInterface) {
  const auto absent = SocketCanPort::open("no-such-can", {}, 1);
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().message,
            "CAN interface no-such-can: there is none of this name; bring it up with systemctl enable --now "
            "rmac-can@no-such-can");
  set_link("down");
  const auto down = SocketCanPort::open(interface_name(), {}, 1);
  set_link("up");
  ASSERT_FALSE(down.has_value());
  EXPECT_THAT(down.error().message, testing::HasSubstr("it is down; bring it up with"));
  const auto narrow = SocketCanPort::open(interface_name(), {}, 1'000'000);
  ASSERT_FALSE(narrow.has_value());
  EXPECT_THAT(narrow.error().message, testing::HasSubstr("one cycle can need 1000000; set TXQUEUELEN in"));
}

TEST(CanopenOnVcan, ConformsToThePort) {
  Drives drives({1, 2});
  Master master({{"node", {1, 2}}});
  conformance::ControlInterfaceConformance(master, 1).check();
}

TEST(CanopenOnVcan, MissesNoAnswerOfThreeDrivesAtOneKilohertz) {
  Drives drives({1, 2, 3});
  Master master({{"node", {1, 2, 3}}, {"mode", {8}}, {"load_share", {100}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  const auto missed_before = master.counters().missed_answers;
  constexpr int kCycles = 5000;
  int failed = 0;
  for (int i = 0; i < kCycles; ++i) {
    for (auto& command : master.commands) command.target_position_counts = i;
    failed += master.cycle(DriveWish::Operational) ? 0 : 1;
  }
  std::printf("cycles %d, failed %d, missed answers %lu\n", kCycles, failed,
              static_cast<unsigned long>(master.counters().missed_answers - missed_before));
  EXPECT_EQ(failed, 0);
  EXPECT_EQ(master.counters().missed_answers, missed_before);
  EXPECT_NEAR(master.feedback[2].position_counts, kCycles, 5);
  master.stop();
}

TEST(CanopenOnVcan, StopsEveryDriveWhenItsCycleEnds) {
  Drives drives({1, 2});
  Master master({{"node", {1, 2}}});
  ASSERT_TRUE(master.start().has_value());
  master.enable_all();
  const auto port = open_port();
  const auto until = port->now() + milliseconds(150);  // two heartbeats, and half of one for the emulation
  CanFrame frame;
  for (; port->now() < until; port->wait(until - port->now())) {
    while (port->receive(frame)) {
    }
  }
  for (const std::size_t drive : {0U, 1U}) EXPECT_EQ(drives.state(drive), PowerStates::QuickStop);
}

}  // namespace
}  // namespace rmac::bench

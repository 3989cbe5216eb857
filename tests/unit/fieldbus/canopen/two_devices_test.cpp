// Two devices of one node id: what shows them, and what some devices do that does not.
#include <gmock/gmock.h>

#include <random>

#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using test::CanopenBench;
using test::CanWire;
using test::PowerStates;
using test::VirtualDrive;
using testing::HasSubstr;
using testing::IsEmpty;

class TwoDevices : public CanopenBench {
 protected:
  VirtualDrive& add(std::uint8_t node, std::uint32_t serial, double counts = 0) {
    VirtualDrive& drive = wire_.add(node);
    drive.put_at(counts);
    if (serial == 0) {
      drive.remove(0x1018, 4);
    } else {
      drive.set_bytes({0x1018, 4}, {static_cast<std::uint8_t>(serial), static_cast<std::uint8_t>(serial >> 8), 0, 0});
    }
    return drive;
  }
  void make_position(const std::vector<double>& nodes) {
    make({{"node", nodes}, {"mode", {8}}, {"load_share", {100}}});
  }
  /// A cycle in which each drive is told to be where it says that it is.
  void hold(DriveWish wish) {
    for (std::size_t i = 0; i < commands_.size(); ++i) {
      commands_[i].target_position_counts = feedback_[i].position_counts;
    }
    cycle(wish);
  }
  /// Holds until a drive is silent, as a machine does that stops on it.
  [[nodiscard]] bool stops_within(int cycles, std::size_t axis) {
    for (int i = 0; i < cycles; ++i) {
      hold(DriveWish::Operational);
      if (!feedback_[axis].online) return true;
    }
    return false;
  }
  void enable_holding() {
    for (int i = 0; i < 20; ++i) hold(DriveWish::Operational);
    for (const DriveFeedback& words : feedback_) {
      ASSERT_EQ(drive_state(words.statusword), DriveState::OperationEnabled);
    }
  }
};

// Red when what a node tells of itself is read once, or when the second answer to a question is passed over.
TEST_F(TwoDevices, AreRefusedAtBootByTheirSerialNumbers) {
  add(1, 0x11);
  add(1, 0x22);
  make_position({1});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0): two devices have this node id: 1018h:04 was told as 11h and as 22h; give each an id of "
            "its own (rmac bus scan shows them). Where the drive was exchanged, unload and load the machine");
}

// Red when the PDOs of one SYNC are not counted.
TEST_F(TwoDevices, AreRefusedAtBootByTheirAnswersToOneSync) {
  add(1, 0, 0);
  add(1, 0, 11400);
  make_position({1});
  EXPECT_THAT(start_error(), HasSubstr("node 1 (axis 0): two devices have this node id: one SYNC was answered more"));
}

TEST_F(TwoDevices, AreNoticedInOperationByABootUpMessage) {
  add(1, 0x11);
  add(2, 0x33);
  make_position({1, 2});
  start();
  enable_holding();
  VirtualDrive& second = add(2, 0x22, 5000);
  EXPECT_TRUE(stops_within(2, 1));
  EXPECT_THAT(master_->silence_text(1).value_or(""), HasSubstr("node 2 (axis 1) sent a boot-up message in operation"));
  for (int i = 0; i < 2000; ++i) {
    hold(DriveWish::Operational);
    ASSERT_FALSE(feedback_[1].online);
  }
  EXPECT_THAT(master_->silence_text(1).value_or(""), HasSubstr("1018h:04 was told as 33h and as 22h"));
  EXPECT_FALSE(master_->silence_text(0).has_value());
  EXPECT_EQ(second.position(), 5000);
  second.power_off();
  for (int i = 0; i < 2000 && !feedback_[1].online; ++i) cycle(DriveWish::Off);
  EXPECT_TRUE(feedback_[1].online) << "one of the two was taken off";
}

TEST_F(TwoDevices, AreNoticedInOperationByTheirAnswersToOneSync) {
  add(1, 0x11);
  make_position({1});
  start();
  enable_holding();
  int spoken = 0;
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id != kSyncId || ++spoken > 20) return;
    wire_.inject({.id = 0x181, .size = 8, .data = {0x27, 0x06, 0x10, 0x27}});
  };
  EXPECT_TRUE(stops_within(15, 0));
  EXPECT_EQ(master_->counters().duplicates, 1U);
}

// Red when heartbeats are not counted, or their number is held against a fixed time.
TEST_F(TwoDevices, AreNoticedInOperationByTwiceTheHeartbeats) {
  add(1, 0x11);
  make_position({1});
  start();
  enable_holding();
  bool stopped = false;
  for (int i = 0; i < 400 && !stopped; ++i) {
    if (i % 50 == 25) wire_.inject({.id = 0x701, .size = 1, .data = {5}});
    hold(DriveWish::Operational);
    stopped = !feedback_[0].online;
  }
  EXPECT_TRUE(stopped);
  EXPECT_THAT(master_->silence_text(0).value_or(""), HasSubstr("there are twice the heartbeats of one"));
}

TEST_F(TwoDevices, AreShownByAScan) {
  add(1, 0x11);
  add(1, 0x22);
  add(2, 0);
  add(2, 0);
  add(3, 0x44);
  const auto port = wire_.open();
  const auto found = scan_bus(*port);
  ASSERT_TRUE(found.has_value());
  ASSERT_EQ(found->size(), 3U);
  EXPECT_TRUE((*found)[0].two_identities);
  EXPECT_FALSE((*found)[1].two_identities);
  EXPECT_TRUE((*found)[1].answers_twice);
  EXPECT_FALSE((*found)[2].two_identities);
  EXPECT_FALSE((*found)[2].answers_twice);
}

TEST_F(TwoDevices, AreNotMovedByAnyCommandWhereverTheyStandAndWhenTheyCome) {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    master_.reset();
    wire_ = CanWire();
    std::mt19937 random(seed);
    const bool with_serials = random() % 2 == 0;
    const double away = (random() % 2 == 0 ? 1 : -1) * static_cast<double>(1 + random() % 200000);
    std::vector<VirtualDrive*> drives{&add(1, 0x11, 300), &add(2, with_serials ? 0x21 : 0, 700)};
    make_position({1, 2});
    const bool at_boot = random() % 3 == 0;
    const std::uint32_t serial = with_serials ? 0x22 : 0;
    if (at_boot) {
      drives.push_back(&add(2, serial, 700 + away));
      ASSERT_THAT(start_error(), HasSubstr("node 2 (axis 1): two devices have this node id")) << "seed " << seed;
    } else {
      start();
      enable_holding();
      for (auto left = random() % 100; left > 0; --left) hold(DriveWish::Operational);
      wire_.pass(microseconds(random() % 1000));
      drives.push_back(&add(2, serial, 700 + away));
      ASSERT_TRUE(stops_within(3, 1)) << "seed " << seed;
      // Stopped; then someone resets and starts again, and again.
      for (int i = 0; i < 600; ++i) {
        hold(i % 200 < 50 ? DriveWish::Off : DriveWish::Operational);
        ASSERT_FALSE(feedback_[1].online) << "seed " << seed;
      }
    }
    for (const VirtualDrive* drive : drives) {
      const bool enabled = drive->state() == PowerStates::OperationEnabled;
      ASSERT_FALSE(enabled && drive->node() == 2) << "seed " << seed;
      ASSERT_EQ(drive->velocity(), 0) << "seed " << seed;
    }
    ASSERT_EQ(drives[0]->position(), 300) << "seed " << seed;
    ASSERT_EQ(drives[1]->position(), 700) << "seed " << seed;
    ASSERT_EQ(drives[2]->position(), 700 + away) << "seed " << seed;
  }
}

/// One device, however it behaves, is one.
class OneDevice : public TwoDevices {
 protected:
  void runs_for(int cycles_of_it) {
    const auto started = master_->start();
    ASSERT_TRUE(started.has_value()) << started.error().message;
    cycle();
    for (int i = 0; i < cycles_of_it; ++i) {
      commands_[0].target_position_counts = i;
      cycle(DriveWish::Operational);
      ASSERT_EQ(master_->counters().nodes_lost, 0U) << master_->silence_text(0).value_or("");
    }
    EXPECT_TRUE(feedback_[0].online);
    EXPECT_EQ(drive_state(feedback_[0].statusword), DriveState::OperationEnabled);
  }
};

TEST_F(OneDevice, MaySendItsBootUpMessageTwice) {
  for (const int gap_ms : {0, 5, 40, 90, 150, 200}) {
    master_.reset();
    wire_ = CanWire();
    VirtualDrive& drive = add(1, 0x11);
    drive.boot_ups = 2;
    drive.boot_up_gap = milliseconds(gap_ms);
    make_position({1});
    runs_for(500);
    ASSERT_FALSE(HasFailure()) << gap_ms << " ms after each other";
  }
}

TEST_F(OneDevice, MayTakeItsTimeToBoot) {
  VirtualDrive& drive = add(1, 0x11);
  drive.boot_time = milliseconds(900);
  make_position({1});
  runs_for(500);
}

TEST_F(OneDevice, MayHaveNoSerialNumberAndNoIdentity) {
  add(1, 0);
  add(2, 0).remove(0x1018);
  make_position({1, 2});
  runs_for(500);
}

TEST_F(OneDevice, MayTellItsSerialNumberOnlyToItsMaker) {
  VirtualDrive& drive = add(1, 0x11);
  drive.refuse_reading({0x1018, 4}, 0x06010000);
  make_position({1});
  runs_for(500);
}

TEST_F(OneDevice, MaySendItsAnswersByEventsToo) {
  add(1, 0x11).event_driven = true;
  make_position({1});
  runs_for(500);
}

TEST_F(OneDevice, MayBeatSomewhatFasterThanItWasTold) {
  add(1, 0x11).heartbeat_step = 40;
  add(2, 0x11).heartbeat_step = 7;
  make_position({1, 2});
  runs_for(2000);
}

TEST_F(OneDevice, MayStandBehindAGatewayThatRepeatsFrames) {
  add(1, 0x11);
  make_position({1});
  wire_.gateway = [](const CanFrame& frame) {
    // A doubled SDO answer breaks the transfers of any master; what comes unasked is what counts here.
    const bool unasked = frame.id < 0x580 || frame.id >= 0x700;
    return unasked ? std::vector<CanWire::Time>{{}, {}} : std::vector<CanWire::Time>{{}};
  };
  runs_for(1000);
}

TEST_F(OneDevice, MayStandBehindAGatewayThatIsLate) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    master_.reset();
    wire_ = CanWire();
    add(1, seed % 2 == 0 ? 0x11 : 0);
    make({{"node", {1}}, {"mode", {8}}, {"missed_answers", {3}}});
    std::mt19937 random(seed);
    CanWire::Time free_from{0};
    wire_.gateway = [&](const CanFrame& frame) {
      if (frame.id >= 0x580 && frame.id < 0x700) return std::vector<CanWire::Time>{{}};
      const CanWire::Time at = std::max(free_from, wire_.now() + microseconds(random() % 2000));  // never overtaken
      free_from = at;
      std::vector<CanWire::Time> copies{at - wire_.now()};
      if (random() % 4 == 0) copies.push_back(copies[0]);
      return copies;
    };
    runs_for(600);
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
    wire_.gateway = nullptr;
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen

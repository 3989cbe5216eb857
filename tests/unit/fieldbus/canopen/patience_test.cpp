// Drives that take their time, or lose something: what a boot puts up with.
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using test::CanopenBench;
using test::CanWire;
using test::VirtualDrive;
using testing::HasSubstr;

class PatientBoot : public CanopenBench {
 protected:
  VirtualDrive& fresh_drive() {
    master_.reset();
    wire_ = CanWire();
    return wire_.add(1);
  }
  /// Hands on SDO answers but for those that `lost` names by their number, from 0.
  void lose_answers(const std::function<bool(int number)>& lost) {
    answers_ = 0;
    wire_.gateway = [this, lost](const CanFrame& frame) {
      const bool answer = frame.id >= 0x580 && frame.id < 0x600;
      return answer && lost(answers_++) ? std::vector<CanWire::Time>() : std::vector<CanWire::Time>{{}};
    };
  }
  /// Cycles until the drive answers.
  [[nodiscard]] bool comes_back(int most_cycles) {
    for (int i = 0; i < most_cycles && !feedback_[0].online; ++i) cycle(DriveWish::Off);
    return feedback_[0].online;
  }

  int answers_ = 0;
};

// Red when a node is reset every second: one that obeys while it boots would never have booted.
TEST_F(PatientBoot, LetsADriveBootThatObeysResetsMeanwhile) {
  for (const int boot_ms : {0, 300, 999, 1001, 1500, 2500, 4900}) {
    fresh_drive().boot_time = milliseconds(boot_ms);
    make({{"node", {1}}, {"mode", {8}}});
    ASSERT_EQ(start_error(), "it started") << boot_ms << " ms";
    int resets = 0;
    wire_.listen = [&](const CanFrame& frame) { resets += frame.id == 0 && frame.data[0] == 130 ? 1 : 0; };
    cycle();
    EXPECT_TRUE(comes_back(10));
    wire_.pass(milliseconds(300));  // the drive misses its master
    cycles(60, DriveWish::Off);
    ASSERT_FALSE(feedback_[0].online);
    ASSERT_TRUE(comes_back(boot_ms + 1500)) << boot_ms << " ms";
    EXPECT_EQ(resets, 1) << boot_ms << " ms";
    wire_.listen = nullptr;
  }
}

// Red when a node that starts by itself is set up in Operational, where it may refuse the parameters of its PDOs.
TEST_F(PatientBoot, HoldsADriveInPreOperationalWhileItIsSetUp) {
  fresh_drive();
  make({{"node", {1}}, {"mode", {8}}});
  std::vector<std::uint8_t> commands;  // of NMT, and 0 for a question
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id == 0 && frame.data[1] == 1) commands.push_back(frame.data[0]);
    if (frame.id == 0x601 && (commands.empty() || commands.back() != 0)) commands.push_back(0);
  };
  ASSERT_EQ(start_error(), "it started");
  wire_.listen = nullptr;
  constexpr std::uint8_t kPreOperational = 128, kStart = 1;
  ASSERT_GE(commands.size(), 3U);
  const auto question = std::find(commands.begin(), commands.end(), 0);
  ASSERT_NE(question, commands.begin());
  EXPECT_EQ(*(question - 1), kPreOperational);
  EXPECT_EQ(commands.back(), kStart);
}

// Red when it is not reset again, whether it shows by its heartbeats that it did not hear, or by nothing.
TEST_F(PatientBoot, ResetsADriveAgainThatDidNotHear) {
  for (const bool beats : {true, false}) {
    for (const int deaf : {1, 2}) {
      VirtualDrive& drive = fresh_drive();
      drive.set(0x1017, 0, beats ? 100 : 0, 2);
      drive.deaf_to_resets = deaf;
      make({{"node", {1}}});
      EXPECT_EQ(start_error(), "it started") << deaf << " times";
    }
  }
}

// Red when a drive that has just booted by itself, and waits for what it is to be told, is reset once more.
TEST_F(PatientBoot, SetsUpADriveThatStartedAnewByItselfWithoutAReset) {
  VirtualDrive& drive = fresh_drive();
  make({{"node", {1}}, {"mode", {8}}});
  start();
  ASSERT_TRUE(comes_back(10));
  int resets = 0;
  wire_.listen = [&](const CanFrame& frame) { resets += frame.id == 0 && frame.data[0] == 130 ? 1 : 0; };
  drive.power_off();
  drive.power_on(wire_.now());
  wire_.pass(milliseconds(1));
  cycle();
  cycle();
  ASSERT_FALSE(feedback_[0].online);
  EXPECT_TRUE(comes_back(2000));
  EXPECT_EQ(resets, 0);
}

TEST_F(PatientBoot, PutsUpWithAnyOneLostSdoAnswer) {
  int answers = 1;
  for (int lost = 0; lost < answers; ++lost) {
    fresh_drive();
    lose_answers([lost](int number) { return number == lost; });
    make({{"node", {1}}, {"mode", {8}}}, {{"setup", "6085:00/32=70000"}});
    ASSERT_EQ(start_error(), "it started") << "without answer " << lost;
    answers = answers_;
  }
  EXPECT_GT(answers, 40) << "hardly anything was lost";
}

TEST_F(PatientBoot, PutsUpWithSomeLostSdoAnswers) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    fresh_drive();
    std::mt19937 random(seed);
    int in_a_row = 0;
    lose_answers([&](int) {
      const bool lost = in_a_row < 2 && random() % 6 == 0;
      in_a_row = lost ? in_a_row + 1 : 0;
      return lost;
    });
    make({{"node", {1}}, {"mode", {8}}});
    ASSERT_EQ(start_error(), "it started") << "seed " << seed;
  }
}

// Red when tries have no bound.
TEST_F(PatientBoot, GivesUpADriveThatFallsSilent) {
  fresh_drive();
  lose_answers([](int number) { return number >= 7; });
  make({{"node", {1}}});
  const auto before = wire_.now();
  EXPECT_THAT(start_error(), HasSubstr("node 1 (axis 0) did not answer when "));
  EXPECT_LT(wire_.now() - before, std::chrono::seconds(4));
}

// Red when a drive that tells all that is needed, and says nothing to a question that it does not know, is refused.
TEST_F(PatientBoot, PassesOverWhatADriveDoesNotAnswerWhereItIsNotNeeded) {
  for (const test::Object& object : {test::Object{0x603F, 0}, {0x1018, 4}, {0x6502, 0}, {0x60C2, 1}, {0x1802, 1}}) {
    VirtualDrive& drive = fresh_drive();
    drive.silent = {object};
    make({{"node", {1}}, {"mode", {8}}});
    const auto before = wire_.now();
    ASSERT_EQ(start_error(), "it started") << to_string(object);
    ASSERT_THAT(master_->start_notes(),
                testing::Contains(testing::AllOf(HasSubstr(to_string(object)), HasSubstr("was passed over"))));
    EXPECT_LT(wire_.now() - before, std::chrono::seconds(6)) << "tries are few";
    enable_all();
  }
}

// Red when what is needed may be passed over in silence.
TEST_F(PatientBoot, RefusesADriveThatDoesNotAnswerToWhatIsNeeded) {
  fresh_drive().silent = {{0x1016, 1}};
  make({{"node", {1}}});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) did not answer when 1016h:01 was written: SDO protocol timed out; a drive that takes "
            "longer to answer needs a "
            "longer sdo_timeout_ms");
}

// Red when a boot-up message that never ends has no reason that helps.
TEST_F(PatientBoot, SaysWhatABootUpMessageWithoutEndMayBe) {
  VirtualDrive& drive = fresh_drive();
  drive.boot_ups = 1000;
  drive.boot_up_gap = milliseconds(20);
  drive.sdo_time = milliseconds(15);
  make({{"node", {1}}});
  const auto before = wire_.now();
  const std::string error = start_error();
  EXPECT_THAT(error, HasSubstr("check its supply"));
  EXPECT_THAT(error, HasSubstr("rmac bus scan"));
  EXPECT_LT(wire_.now() - before, std::chrono::seconds(3));
}

TEST_F(PatientBoot, WaitsForADriveThatAnswersLongAfterItsBootUpMessage) {
  fresh_drive().sdo_after = milliseconds(4000);
  make({{"node", {1}}});
  EXPECT_EQ(start_error(), "it started");
}

// Red when a drive that is not ready is refused, or when what is optional is left out until it is.
TEST_F(PatientBoot, WaitsForADriveWhoseStateForbidsToWriteAtFirst) {
  VirtualDrive& drive = fresh_drive();
  drive.writable_after = milliseconds(1500);
  make({{"node", {1}}});
  EXPECT_EQ(start_error(), "it started");
  EXPECT_TRUE(master_->start_notes().empty());
  EXPECT_EQ(drive.value(0x1801, 1) >> 31, 1U) << "a PDO that nobody counted stays valid";
  master_->stop();
  drive.writable_after = std::chrono::hours(1);
  EXPECT_THAT(start_error(), HasSubstr("(08000022h), and has FFh there; it is needed "));
}

// Red when the time of an answer is the same for all drives.
TEST_F(PatientBoot, WaitsForADriveThatIsKnownToBeSlow) {
  fresh_drive().sdo_time = milliseconds(700);
  make({{"node", {1}}});
  EXPECT_EQ(start_error(),
            "node 1 (axis 0) did not answer when 1000h:00 was read: SDO protocol timed out; a drive that takes longer "
            "to answer needs a "
            "longer sdo_timeout_ms");
  make({{"node", {1}}, {"sdo_timeout_ms", {1000}}});
  EXPECT_EQ(start_error(), "it started");
}

TEST_F(PatientBoot, PutsUpWithSdoAnswersThatComeTwice) {
  fresh_drive();
  wire_.gateway = [](const CanFrame&) { return std::vector<CanWire::Time>{{}, milliseconds(1)}; };
  make({{"node", {1}}, {"mode", {8}}});
  EXPECT_EQ(start_error(), "it started");
}

// Red when a later boot-up message takes a node that is set up for one that fell away.
TEST_F(PatientBoot, PutsUpWithABootUpMessageThatIsRepeatedWhileItIsSlow) {
  for (const int gap_ms : {1, 100, 700, 1500}) {
    VirtualDrive& drive = fresh_drive();
    drive.boot_ups = 4;
    drive.boot_up_gap = milliseconds(gap_ms);
    drive.sdo_time = milliseconds(150);
    make({{"node", {1}}});
    EXPECT_EQ(start_error(), "it started") << gap_ms << " ms after each other";
  }
}

}  // namespace
}  // namespace rmac::fieldbus::canopen

// How a node is brought up, question by question, on a clock that counts milliseconds.
#include "canopen/node_boot.hpp"

#include <gmock/gmock.h>

#include "unit/fieldbus/canopen/can_wire.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;
using test::CanWire;
using test::Object;
using test::VirtualDrive;
using State = NodeBoot::State;
using Kind = BootProblem::Kind;

constexpr ObjectAddress kMode{0x6060, 0}, kError{0x603F, 0};

class BootAlone : public testing::Test {
 protected:
  void make(std::map<std::string, std::vector<double>> numbers = {}, double period_s = 0.001) {
    numbers.try_emplace("node", std::vector<double>{5});
    auto config = read_canopen_config("can0", numbers, {}, period_s);
    ASSERT_TRUE(config) << config.error().message;
    boot_ = std::make_unique<NodeBoot>(*config, 5);
    port_ = wire_.open();
    boot_->begin(port_->now());
  }
  void pass(milliseconds time) {
    for (const nanoseconds end = port_->now() + time; port_->now() < end;) {
      CanFrame frame;
      while (port_->receive(frame)) boot_->receive(frame, port_->now());
      while (boot_->next_frame(port_->now(), frame)) {
        sent_.push_back({port_->now(), frame});
        port_->send(frame);
      }
      port_->wait(milliseconds(1));
    }
  }
  /// How long it takes until it is in this state.
  milliseconds until(State state, milliseconds most = seconds(20)) {
    const nanoseconds begin = port_->now();
    while (boot_->state() != state && port_->now() < begin + most) pass(milliseconds(1));
    EXPECT_EQ(boot_->state(), state);
    return std::chrono::duration_cast<milliseconds>(port_->now() - begin);
  }
  /// When commands of network management, or questions for an object, were sent.
  std::vector<milliseconds> times_of(const std::function<bool(const CanFrame&)>& which) const {
    std::vector<milliseconds> times;
    for (const auto& [time, frame] : sent_) {
      if (which(frame)) times.push_back(std::chrono::duration_cast<milliseconds>(time));
    }
    return times;
  }
  std::vector<milliseconds> commands(std::uint8_t command) const {
    return times_of([=](const CanFrame& frame) { return frame.id == 0 && frame.data[0] == command; });
  }
  std::vector<milliseconds> questions(ObjectAddress object) const {
    return times_of([=](const CanFrame& frame) {
      return frame.id == 0x605 && frame.data[0] != 0x80 && word_at(&frame.data[1]) == object.index &&
             frame.data[3] == object.sub;
    });
  }
  void say_heartbeat(std::uint8_t state) { boot_->receive({.id = 0x705, .size = 1, .data = {state}}, port_->now()); }

  CanWire wire_;
  VirtualDrive& drive_ = wire_.add(5);
  std::unique_ptr<CanPort> port_;
  std::unique_ptr<NodeBoot> boot_;
  std::vector<std::pair<nanoseconds, CanFrame>> sent_;
};

TEST_F(BootAlone, StartsANodeEachSecondUntilItSaysThatItIsOperational) {
  make();
  drive_.sends_heartbeats = false;
  until(State::Starting);
  EXPECT_EQ(until(State::Failed), seconds(5));
  EXPECT_EQ(boot_->problem().kind, Kind::NoStart);
  EXPECT_EQ(boot_->problem().waited, seconds(5));
  const auto starts = commands(1);
  ASSERT_EQ(starts.size(), 5U);
  for (std::size_t i = 1; i < starts.size(); ++i) EXPECT_EQ(starts[i] - starts[i - 1], seconds(1));
}

TEST_F(BootAlone, WatchesANodeForFourHeartbeatsOrTwentyCyclesWhicheverIsLonger) {
  struct Case {
    double heartbeat_ms, period_s;
    milliseconds proving;
  };
  for (const Case& one : {Case{50, 0.001, milliseconds(200)}, Case{100, 0.001, milliseconds(400)},
                          Case{2, 0.004, milliseconds(80)}, Case{5, 0.002, milliseconds(40)}}) {
    drive_.sends_heartbeats = true;
    make({{"heartbeat_ms", {one.heartbeat_ms}}}, one.period_s);
    until(State::Configuring);
    drive_.sends_heartbeats = false;  // they are said below
    until(State::Starting);
    pass(milliseconds(1));
    say_heartbeat(5);
    EXPECT_EQ(boot_->state(), State::Proving);
    EXPECT_NEAR(double(until(State::Operational).count()), double(one.proving.count()), 1) << one.heartbeat_ms;
  }
}

TEST_F(BootAlone, GoesBackToStartingWhereANodeFallsOutOfOperationalWhileItIsWatched) {
  make();
  until(State::Proving);
  drive_.sends_heartbeats = false;
  say_heartbeat(127);
  EXPECT_EQ(boot_->state(), State::Starting);
  pass(milliseconds(1));
  say_heartbeat(4);
  EXPECT_EQ(boot_->state(), State::Starting) << "stopped is not operational";
  say_heartbeat(5);
  EXPECT_EQ(boot_->state(), State::Proving);
}

TEST_F(BootAlone, TakesEightRestartsAndNoMore) {
  make();
  drive_.answers_sdo = false;
  until(State::Configuring);
  for (int restart = 1; restart <= 9; ++restart) {
    say_heartbeat(0);
    EXPECT_EQ(boot_->state(), restart <= 8 ? State::Configuring : State::Failed) << restart;
  }
  EXPECT_EQ(boot_->problem().kind, Kind::Restarts);
  boot_->begin(port_->now());
  say_heartbeat(0);
  EXPECT_EQ(boot_->state(), State::Configuring) << "each boot has its own";
}

TEST_F(BootAlone, TakesEightFallsOutOfOperationalAndNoMore) {
  make();
  until(State::Proving);
  drive_.sends_heartbeats = false;
  // Its boot-up message was no restart, and is counted with them.
  for (int fall = 1; fall <= 9; ++fall) {
    say_heartbeat(127);
    EXPECT_EQ(boot_->state(), fall <= 8 ? State::Starting : State::Failed) << fall;
    if (fall <= 8) say_heartbeat(5);
  }
}

TEST_F(BootAlone, FailsWhereANodeStartsAnewInOperation) {
  make();
  until(State::Operational);
  say_heartbeat(0);
  EXPECT_EQ(boot_->state(), State::Failed);
  EXPECT_EQ(boot_->problem().kind, Kind::Restarted);
  say_heartbeat(0);
  EXPECT_EQ(boot_->state(), State::Failed) << "until it is begun anew";
}

TEST_F(BootAlone, AsksANodeThatIsNotReadyEachTenthOfASecondForTwoSeconds) {
  for (const std::uint32_t code : {0x08000022U, 0x060A0023U}) {
    drive_.refuse_writing({0x6060, 0}, code);
    make();
    sent_.clear();
    until(State::Failed);
    EXPECT_EQ(boot_->problem().kind, Kind::Refused);
    EXPECT_EQ(boot_->problem().object, kMode);
    EXPECT_EQ(boot_->problem().found, code);
    const auto asked = questions(kMode);
    ASSERT_GE(asked.size(), 19U);
    ASSERT_LE(asked.size(), 21U);
    for (std::size_t i = 1; i < asked.size(); ++i) {
      EXPECT_GE(asked[i] - asked[i - 1], milliseconds(100)) << i;
      EXPECT_LE(asked[i] - asked[i - 1], milliseconds(105)) << i;
    }
    drive_.allow({0x6060, 0});
  }
}

TEST_F(BootAlone, AsksANodeThatRefusesForGoodOnce) {
  drive_.refuse_writing({0x6060, 0}, 0x06010002);
  make();
  until(State::Failed);
  EXPECT_EQ(questions(kMode).size(), 1U);
}

TEST_F(BootAlone, AsksThreeTimesWhereAnAnswerIsMissing) {
  drive_.silent = {{0x6060, 0}};
  make();
  until(State::Failed);
  EXPECT_EQ(boot_->problem().kind, Kind::NoAnswer);
  EXPECT_EQ(boot_->problem().object, kMode);
  EXPECT_EQ(boot_->problem().expected, 10U) << "what was to be written";
  EXPECT_TRUE(boot_->problem().writing);
  const auto asked = questions(kMode);
  ASSERT_EQ(asked.size(), 3U);
  for (std::size_t i = 1; i < 3; ++i) EXPECT_NEAR(double((asked[i] - asked[i - 1]).count()), 500, 3);
}

// Its abort "SDO protocol timed out": it waited for what was lost on the way, and may be asked anew.
TEST_F(BootAlone, AsksThreeTimesWhereTheNodeMissedSomething) {
  drive_.refuse_writing({0x6060, 0}, 0x05040000);
  make();
  until(State::Failed);
  EXPECT_EQ(boot_->problem().object, kMode);
  EXPECT_EQ(questions(kMode).size(), 3U);
}

// Red when an optional object holds a machine up, or a node that died meanwhile passes for one that does not know it.
TEST_F(BootAlone, AsksWhetherItIsThereBeforeItPassesOverAnObjectThatIsNotAnswered) {
  drive_.silent = {{0x603F, 0}};
  make();
  until(State::Operational);
  EXPECT_EQ(questions(kError).size(), 3U);
  EXPECT_EQ(questions({0x1000, 0}).size(), 2U) << "as its device type, and as a sign of life";
  ASSERT_EQ(boot_->notes().size(), 1U);
  EXPECT_EQ(boot_->notes()[0].object, kError);
  EXPECT_EQ(boot_->notes()[0].found, sdo_abort::kTimeout);

  make();
  sent_.clear();
  until(State::Configuring);
  while (questions(kError).empty()) pass(milliseconds(1));
  drive_.answers_sdo = false;
  until(State::Failed);
  EXPECT_EQ(boot_->problem().kind, Kind::NoAnswer);
  EXPECT_EQ(questions(kError).size(), 3U);
  EXPECT_EQ(questions({0x1000, 0}).size(), 4U) << "as its device type, and three times as a sign of life";
}

TEST_F(BootAlone, AsksANodeThatNeverAnsweredForAsLongAsItMayBoot) {
  make();
  drive_.answers_sdo = false;
  until(State::Configuring);
  const auto waited = until(State::Failed);
  EXPECT_GE(waited, seconds(5));
  EXPECT_LE(waited, milliseconds(5510)) << "the last question has its time";
  EXPECT_EQ(boot_->problem().kind, Kind::NoAnswer);
}

TEST_F(BootAlone, WaitsForABootUpMessageAsLongAsItIsTold) {
  drive_.power_off();
  make({{"boot_timeout_s", {0.7}}});
  EXPECT_EQ(until(State::Failed), milliseconds(701));
  EXPECT_EQ(boot_->problem().kind, Kind::NoBootUp);
  EXPECT_EQ(boot_->problem().waited, milliseconds(700));
}

// Red when an old value is told of an object that is not there any more.
TEST_F(BootAlone, ForgetsAReadingThatIsNotToldAgain) {
  drive_.set_bytes({0x603F, 0}, {0x11, 0x86});
  make();
  until(State::Operational);
  EXPECT_EQ(boot_->error_code(), 0x8611);
  for (const std::uint32_t code : {0x06020000U, 0x06010001U}) {
    drive_.refuse_reading({0x603F, 0}, code);
    boot_->begin(port_->now());
    until(State::Operational);
    EXPECT_EQ(boot_->error_code(), 0);
    drive_.allow({0x603F, 0});
    boot_->begin(port_->now());
    until(State::Operational);
    EXPECT_EQ(boot_->error_code(), 0x8611);
  }
}

TEST_F(BootAlone, NotesWhatWasRefusedOnceAndNotWhatIsAbsent) {
  drive_.refuse_writing({0x1802, 1}, 0x06010002);
  drive_.refuse_reading({0x1018, 4}, 0x06010001);  // asked twice
  drive_.remove(0x6502);
  make();
  until(State::Operational);
  const auto notes = boot_->notes();
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_EQ(notes[0].object, (ObjectAddress{0x1018, 4}));
  EXPECT_EQ(notes[0].found, 0x06010001U);
  EXPECT_FALSE(notes[0].writing);
  EXPECT_EQ(notes[0].kind, Kind::Refused);
  EXPECT_EQ(notes[1].object, (ObjectAddress{0x1802, 1}));
  EXPECT_EQ(notes[1].expected, 0xC0000385U) << "what was to be written";
  EXPECT_TRUE(notes[1].writing);
}

/// Parameters of a PDO that are constant, and what is wanted.
TEST_F(BootAlone, NotesAMappingThatIsConstantAsOneMatter) {
  drive_.set_bytes({0x1A00, 0}, {3});
  drive_.set_bytes({0x1A00, 1}, {0x10, 0, 0x41, 0x60});
  drive_.set_bytes({0x1A00, 2}, {0x20, 0, 0x64, 0x60});
  drive_.set_bytes({0x1A00, 3}, {0x10, 0, 0x77, 0x60});
  for (std::uint8_t sub = 0; sub < 4; ++sub) drive_.refuse_writing({0x1A00, sub}, 0x06010002);
  make();
  until(State::Operational);
  const auto notes = boot_->notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].kind, Kind::Constant);
  EXPECT_EQ(notes[0].object.index, 0x1A00);
  drive_.set_bytes({0x1A00, 2}, {0x20, 0, 0x63, 0x60});
  boot_->begin(port_->now());
  until(State::Failed);
  EXPECT_EQ(boot_->problem().object, (ObjectAddress{0x1A00, 2}));
  EXPECT_EQ(boot_->problem().kept, 0x60630020U);
  EXPECT_EQ(boot_->problem().expected, 0x60640020U);
}

TEST_F(BootAlone, TakesOnlyWhatIsTheNodesOwn) {
  make();
  until(State::Operational);
  for (const CanFrame& frame :
       {CanFrame{.id = 0x706, .size = 1}, CanFrame{.id = 0x705, .size = 2}, CanFrame{.id = 0x705, .size = 0},
        CanFrame{.id = 0x586, .size = 8, .data = {0x43, 0x18, 0x10, 4, 9}}}) {
    boot_->receive(frame, port_->now());
    EXPECT_EQ(boot_->state(), State::Operational) << frame.id;
  }
  boot_->receive({.id = 0x585, .size = 8, .data = {0x43, 0x18, 0x10, 4, 9}}, port_->now());
  EXPECT_EQ(boot_->state(), State::Failed);
  EXPECT_EQ(boot_->problem().kind, Kind::TwoIdentities);
  EXPECT_EQ(boot_->problem().object, (ObjectAddress{0x1018, 4}));
  EXPECT_EQ(boot_->problem().expected, 0x405U);
  EXPECT_EQ(boot_->problem().found, 9U);
  boot_->forget_identity();
  boot_->begin(port_->now());
  EXPECT_EQ(boot_->problem().kind, Kind::None);
}

}  // namespace
}  // namespace rmac::fieldbus::canopen

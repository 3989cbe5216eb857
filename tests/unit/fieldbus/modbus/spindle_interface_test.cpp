#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/modbus/spindle_drive.hpp"
#include "unit/fieldbus/modbus/still_clock.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;
using Wire = ModbusPeer::Wire;
using Manner = ModbusPeer::Manner;

class ModbusSpindle : public testing::TestWithParam<Wire> {
 protected:
  ModbusSpindle() : peer(GetParam()) {
    bank.on_write = turn;
    peer.respond([this](const Bytes& request) { return bank.answer(request); });
    config.line.endpoint = peer.endpoint();
    config.line.deadline = 60s;  // however busy the computer is, an honest peer answers within a minute
    config.line.period = 2ms;
    config.line.first_pause = config.line.longest_pause = 0ms;
    config.line.now = clock.now();
    config.boot_timeout = 60s;
    config.axes = {{.slave = 4, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  }

  void bring_up() {
    spindle = std::make_unique<SpindleInterface>(config);
    const auto started = spindle->start();
    ASSERT_TRUE(started) << started.error().message;
  }

  /// One cycle of a master with that wish.
  const DriveFeedback& cycle(DriveWish wish, std::int32_t rpm, bool reset = false) {
    command[0].controlword = next_controlword(feedback[0].statusword, wish, reset, command[0].controlword);
    command[0].mode = DriveMode::ProfileVelocity;
    command[0].target_velocity_rpm = rpm;
    EXPECT_TRUE(spindle->exchange(command, feedback));
    return feedback[0];
  }
  /// Cycles until `reached`; false when it gave up.
  bool run_until(DriveWish wish, std::int32_t rpm, const std::function<bool(const DriveFeedback&)>& reached,
                 bool reset = false) {
    Patience patience(*spindle);
    while (!reached(cycle(wish, rpm, reset))) {
      if (patience.ends()) return false;
      std::this_thread::yield();
    }
    return true;
  }
  bool run_at(std::int32_t rpm) {
    return run_until(DriveWish::Operational, rpm, [rpm](const DriveFeedback& words) {
      return words.online && words.velocity_rpm == rpm && drive_state(words.statusword) == DriveState::OperationEnabled;
    });
  }
  bool drive_was_told(std::uint16_t command_value) {
    return peer.wait_for([command_value](const Bytes& request) {
      return request == Bytes{4, 6, 0, kCommand, 0, static_cast<std::uint8_t>(command_value)};
    });
  }

  /// Cycles until the line's thread has begun and ended a whole round.
  bool a_round_passes(DriveWish wish, std::int32_t rpm) {
    const std::uint64_t before = spindle->counters().rounds;
    return run_until(wish, rpm, [&](const DriveFeedback&) { return spindle->counters().rounds > before + 1; });
  }
  [[nodiscard]] DriveState state() const { return drive_state(feedback[0].statusword); }

  RegisterBank bank;
  ModbusPeer peer;
  StillClock clock;
  SpindleLineConfig config;
  std::unique_ptr<SpindleInterface> spindle;
  std::array<DriveCommand, 1> command{};
  std::array<DriveFeedback, 1> feedback{};
};

INSTANTIATE_TEST_SUITE_P(Wires, ModbusSpindle, testing::Values(Wire::Tcp, Wire::Rtu),
                         [](const auto& wire) { return wire.param == Wire::Tcp ? "Tcp" : "Rtu"; });

TEST_P(ModbusSpindle, TurnsAtTheSpeedThatIsWanted) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  EXPECT_EQ(bank.get(kHolding, kSpeedCommand), 250);
  EXPECT_EQ(bank.get(kHolding, kCommand), kForward);
  ASSERT_TRUE(run_at(3000));
  ASSERT_TRUE(run_at(-600));
  EXPECT_EQ(bank.get(kHolding, kCommand), kBackward);
  ASSERT_TRUE(run_at(0));
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
}

TEST_P(ModbusSpindle, IsToldItsSpeedBeforeItRuns) {
  bring_up();
  static_cast<void>(peer.take_requests());
  ASSERT_TRUE(run_at(1500));
  std::vector<std::uint8_t> order;
  for (const Bytes& request : peer.take_requests()) {
    if (request[1] == 6) order.push_back(request[3]);
  }
  const auto run = std::find(order.begin(), order.end(), kCommand);
  EXPECT_NE(std::find(order.begin(), run, kSpeedCommand), run);
}

TEST_P(ModbusSpindle, StopsOnEveryWishButOperational) {
  bring_up();
  for (const DriveWish wish : {DriveWish::QuickStop, DriveWish::Off}) {
    ASSERT_TRUE(run_at(1500));
    static_cast<void>(peer.take_requests());
    cycle(wish, 1500);
    EXPECT_TRUE(drive_was_told(kStop));
    EXPECT_TRUE(run_until(wish, 1500, [](const DriveFeedback& words) { return words.velocity_rpm == 0; }));
  }
}

TEST_P(ModbusSpindle, StopsWithTheAppliance) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  spindle->stop();
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
  EXPECT_FALSE(cycle(DriveWish::Operational, 1500).online);
  EXPECT_NE(drive_state(feedback[0].statusword), DriveState::OperationEnabled);
  EXPECT_TRUE(spindle->start());
  EXPECT_TRUE(run_at(1500)) << "and starts anew when it is told";
}

TEST_P(ModbusSpindle, ReportsAFaultInItsDrivesWordsUntilItIsReset) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  bank.set(kHolding, kFault, 7);
  bank.set(kHolding, kStatus, 4);
  bank.set(kHolding, kActual, 0);
  const auto in_fault = [](const DriveFeedback& words) { return drive_state(words.statusword) == DriveState::Fault; };
  ASSERT_TRUE(run_until(DriveWish::Operational, 1500, in_fault));
  EXPECT_EQ(feedback[0].error_code, 7);
  EXPECT_EQ(spindle->fault_text(0, feedback[0].error_code), "a drive: over-voltage");
  EXPECT_EQ(spindle->fault_text(0, 8), "a drive: see its manual");
  EXPECT_EQ(spindle->fault_text(1, 7), "unknown") << "there is no such axis";
  EXPECT_TRUE(drive_was_told(kStop)) << "it must not run on when its fault is reset";
  ASSERT_TRUE(run_until(
      DriveWish::QuickStop, 1500, [&](const DriveFeedback& words) { return !in_fault(words); }, true));
  EXPECT_EQ(bank.get(kHolding, kActual), 0) << "nothing starts by itself";
  EXPECT_TRUE(run_at(1500));
}

TEST_P(ModbusSpindle, TellsTheCodeOfATripThatCameAfterItsCodeWasRead) {
  constexpr std::uint16_t kEarlyFault = kStatus - 1;
  config.axes[0].map.most_per_read = 1;
  config.axes[0].map.fault_code = Place{kHolding, kEarlyFault};
  std::atomic<bool> trips{false};
  peer.respond([&](const Bytes& request) {
    const Bytes answer = bank.answer(request);
    if (request[1] == 3 && request[3] == kEarlyFault && trips.exchange(false)) {
      bank.set(kHolding, kEarlyFault, 7);
      bank.set(kHolding, kStatus, 4);
    }
    return answer;
  });
  config.line.deadline = 50ms;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  trips = true;
  ASSERT_TRUE(run_until(DriveWish::Operational, 1500,
                        [](const DriveFeedback& words) { return drive_state(words.statusword) == DriveState::Fault; }));
  EXPECT_EQ(feedback[0].error_code, 7);
  spindle->stop();  // before what it asks is gone
}

TEST_P(ModbusSpindle, ThatSomeoneElseStoppedIsDroppedAfterTwoSeconds) {
  config.stale = 60s;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  bank.set(kHolding, kCommand, 0);
  bank.set(kHolding, kStatus, 0);
  bank.set(kHolding, kActual, 0);
  clock.pass(2s);
  ASSERT_TRUE(a_round_passes(DriveWish::Operational, 1500));
  EXPECT_EQ(state(), DriveState::OperationEnabled) << "it has that long to begin to turn";
  clock.pass(1ms);
  EXPECT_TRUE(run_until(DriveWish::Operational, 1500, [this](const DriveFeedback& words) {
    return words.online && state() == DriveState::SwitchOnDisabled;
  }));
  EXPECT_TRUE(drive_was_told(kStop));
}

TEST_P(ModbusSpindle, ThatSomeoneElseStoppedIsDroppedThoughAnswersAreLostJustThen) {
  config.stale = 60s;
  config.line.deadline = 50ms;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  peer.behave(Manner::Silent);
  bank.set(kHolding, kCommand, 0);
  bank.set(kHolding, kStatus, 0);
  bank.set(kHolding, kActual, 0);
  static_cast<void>(peer.take_requests());
  const std::uint64_t before = peer.requests();
  ASSERT_TRUE(
      run_until(DriveWish::Operational, 1500, [&](const DriveFeedback&) { return peer.requests() > before + 2; }));
  peer.behave(Manner::Honest);
  clock.pass(2001ms);
  EXPECT_TRUE(run_until(DriveWish::Operational, 1500, [this](const DriveFeedback& words) {
    return words.online && state() == DriveState::SwitchOnDisabled;
  }));
  for (const Bytes& request : peer.take_requests()) {
    EXPECT_NE(request, (Bytes{4, 6, 0, kCommand, 0, static_cast<std::uint8_t>(kForward)})) << "it is told to run again";
  }
}

TEST_P(ModbusSpindle, IsToldAgainWhatItDidNotTake) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  bank.set(kHolding, kTaken, 1);
  static_cast<void>(peer.take_requests());
  EXPECT_TRUE(peer.wait_for([](const Bytes& request) { return request == Bytes{4, 6, 0, kSpeedCommand, 0, 250}; }));
}

TEST_P(ModbusSpindle, GoesOfflineWhenWhatWasReadGrowsOldAndComesBackDisabled) {
  config.line.deadline = 50ms;
  config.stale = 400ms;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  for (const Manner manner : {Manner::Silent, Manner::WrongId, Manner::Garbage, Manner::Resetting}) {
    SCOPED_TRACE(testing::Message() << "manner " << static_cast<int>(manner));
    peer.behave(manner);
    clock.pass(400ms);
    EXPECT_TRUE(cycle(DriveWish::Operational, 1500).online) << "whatever comes from now on is of no use; what came, is";
    EXPECT_EQ(feedback[0].velocity_rpm, 1500);
    clock.pass(1ms);
    EXPECT_FALSE(cycle(DriveWish::Operational, 1500).online);
    EXPECT_NE(state(), DriveState::OperationEnabled);
    EXPECT_EQ(feedback[0].velocity_rpm, 0) << "an old speed is none";
    peer.behave(Manner::Honest);
    ASSERT_TRUE(run_until(DriveWish::Off, 1500, [](const DriveFeedback& words) { return words.online; }));
    ASSERT_TRUE(run_until(DriveWish::Off, 1500, [](const DriveFeedback& words) { return words.velocity_rpm == 0; }))
        << "it is stopped as soon as it can be reached";
    ASSERT_TRUE(run_at(1500));
  }
}

// Red when the cause is told at boot alone: a fault in operation said that the drive does not answer, whatever it did.
TEST_P(ModbusSpindle, TellsInOperationWhyItIsSilentAndCountsIt) {
  config.line.deadline = 50ms;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  EXPECT_EQ(spindle->silence_text(1), std::nullopt);
  struct Case {
    Manner manner;
    const char* says;
    const char* why;
    std::uint64_t LineCounters::*count;
  };
  const bool tcp = GetParam() == Wire::Tcp;
  std::vector<Case> cases{
      {Manner::Silent, "the drive does not answer: ", "no whole answer within 50 ms", &LineCounters::timeouts},
      {Manner::WrongId, "the drive is not understood: ", "another slave answered", &LineCounters::wrong_answers},
      {Manner::Busy, "the drive is busy: ", "refused with exception 6: it is busy", &LineCounters::busy}};
  if (tcp) {
    cases.push_back({Manner::WrongLength, "the drive is not understood: ", "counts other bytes than came",
                     &LineCounters::wrong_answers});
    cases.push_back(
        {Manner::Resetting, "the drive does not answer: ", "the connection broke", &LineCounters::disconnects});
  }
  for (const Case& one : cases) {
    SCOPED_TRACE(one.why);
    const std::uint64_t before = spindle->counters().*one.count;
    std::string text;
    peer.behave(one.manner);
    ASSERT_TRUE(run_until(DriveWish::Operational, 1500, [&](const DriveFeedback&) {
      text = spindle->silence_text(0).value_or("");
      return text.find(one.why) != std::string::npos;
    }));
    EXPECT_THAT(text, testing::StartsWith(one.says));
    EXPECT_THAT(text, HasSubstr(": slave 4, "));
    EXPECT_THAT(text, HasSubstr("(since the start "));
    EXPECT_GT(spindle->counters().*one.count, before);
    clock.pass(config.busy + 1ms);
    EXPECT_FALSE(cycle(DriveWish::Operational, 1500).online);
    peer.behave(Manner::Honest);
    ASSERT_TRUE(run_until(DriveWish::Off, 0, [](const DriveFeedback& words) { return words.online; }));
    EXPECT_NE(spindle->silence_text(0), std::nullopt) << "who asks late is told, too";
    ASSERT_TRUE(run_at(1500));
  }
  spindle->stop();
  ASSERT_TRUE(spindle->start());
  EXPECT_EQ(spindle->counters().busy, 0U) << "counts are since the start";
}

// Red when a drive that answers "busy" counts as one that does not answer, and when one is busy for ever.
TEST_P(ModbusSpindle, ThatIsBusyRunsOnForAWhileAndTakesItsStopAsSoonAsItCan) {
  config.stale = 400ms;
  config.busy = 3s;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  peer.behave(Manner::Busy);
  const auto says_so_once_more = [this] {
    // The first of them may be the answer to what was asked before.
    const std::uint64_t so_far = spindle->counters().busy;
    return run_until(DriveWish::Operational, 1500,
                     [&](const DriveFeedback&) { return spindle->counters().busy > so_far + 1; });
  };
  ASSERT_TRUE(says_so_once_more());
  for (int tenths = 0; tenths < 30; ++tenths) {
    clock.pass(100ms);
    ASSERT_TRUE(says_so_once_more());
    ASSERT_TRUE(cycle(DriveWish::Operational, 1500).online) << tenths;
    ASSERT_EQ(feedback[0].velocity_rpm, 1500);
  }
  clock.pass(1ms);
  EXPECT_FALSE(cycle(DriveWish::Operational, 1500).online) << "what it told last is too old even for that";
  const std::uint64_t asked = peer.requests();
  ASSERT_TRUE(run_until(DriveWish::Off, 0, [&](const DriveFeedback&) { return peer.requests() > asked + 6; }));
  const auto refused = peer.take_requests();
  const Bytes stop{4, 6, 0, kCommand, 0, kStop};
  EXPECT_GT(std::count(refused.begin(), refused.end(), stop), 1) << "a stop that was not taken is told again";
  peer.behave(Manner::Honest);
  EXPECT_TRUE(
      run_until(DriveWish::Off, 0, [](const DriveFeedback& words) { return words.online && words.velocity_rpm == 0; }));
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
}

// Red when what a drive said of being busy holds without end: it may have gone since.
TEST_P(ModbusSpindle, ThatWasBusyAndIsSilentSinceIsOfflineWhenThatGrowsOld) {
  config.line.deadline = 50ms;
  config.stale = 400ms;
  config.busy = 60s;
  bring_up();
  ASSERT_TRUE(run_at(1500));
  peer.behave(Manner::Busy);
  ASSERT_TRUE(
      run_until(DriveWish::Operational, 1500, [this](const DriveFeedback&) { return spindle->counters().busy > 1; }));
  peer.behave(Manner::Silent);
  ASSERT_TRUE(run_until(DriveWish::Operational, 1500,
                        [this](const DriveFeedback&) { return spindle->counters().timeouts > 0; }));
  clock.pass(400ms);
  EXPECT_TRUE(cycle(DriveWish::Operational, 1500).online);
  clock.pass(1ms);
  EXPECT_FALSE(cycle(DriveWish::Operational, 1500).online);
}

/// Answers that it is busy to every write that comes, each of which takes `takes`, but to the first `first`.
struct BusyAtTheEnd {
  RegisterBank& bank;
  StillClock& clock;
  std::chrono::milliseconds takes;
  int most;
  int refused = 0;
  Bytes operator()(const Bytes& request) {
    if (request[1] != 6 || refused >= most) return bank.answer(request);
    ++refused;
    clock.pass(takes);
    return {request[0], static_cast<std::uint8_t>(request[1] | 0x80U), 6};
  }
};

// Red when a drive that is busy just then is left turning by an appliance that ends.
TEST_P(ModbusSpindle, ThatIsBusyIsStoppedWithTheApplianceAllTheSame) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  peer.respond(BusyAtTheEnd{bank, clock, 300ms, 8});
  spindle->stop();
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
  spindle.reset();
  peer.vanish();  // before what it asks is gone
}

TEST_P(ModbusSpindle, ThatIsBusyWithoutEndKeepsTheApplianceForThreeSecondsAtItsEnd) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  static_cast<void>(peer.take_requests());
  peer.respond(BusyAtTheEnd{bank, clock, 1s, 1000});
  spindle->stop();
  const auto told = peer.take_requests();
  const auto stops = std::count(told.begin(), told.end(), Bytes{4, 6, 0, kCommand, 0, kStop});
  EXPECT_GE(stops, 3);
  EXPECT_LE(stops, 6) << "three more, as to any other that does not take it";
  spindle.reset();
  peer.vanish();
}

TEST_P(ModbusSpindle, IsOfflineWhenTheLineIsGone) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  peer.vanish();
  clock.pass(config.stale + 1ms);
  EXPECT_FALSE(cycle(DriveWish::QuickStop, 0).online);
  spindle->stop();  // in bounded time, though nobody answers
}

// Red when a pause is not kept, does not double or is forgotten before a device answers.
TEST(ModbusSpindleLine, IsOpenedAgainWithPausesThatDoubleUntilADeviceAnswers) {
  StillClock clock;
  RegisterBank bank;
  ModbusPeer peer(Wire::Tcp);
  peer.respond([&bank](const Bytes& request) { return bank.answer(request); });
  SpindleLineConfig config;
  config.line.endpoint = peer.endpoint();
  config.line.deadline = 60s;
  config.line.period = 1ms;
  config.line.first_pause = 40ms;
  config.line.longest_pause = 100ms;
  config.line.now = clock.now();
  config.boot_timeout = 60s;
  config.axes = {{.slave = 1, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  SpindleInterface spindle(std::move(config));
  ASSERT_TRUE(spindle.start());
  const auto rounds_pass = [&](std::uint64_t more) {
    const std::uint64_t before = spindle.counters().rounds;
    while (spindle.counters().rounds < before + more) std::this_thread::yield();
  };
  const auto becomes = [&](std::uint64_t LineCounters::*count, std::uint64_t value) {
    while (spindle.counters().*count < value) std::this_thread::yield();
    rounds_pass(2);  // by then the line has seen what came of it
    return spindle.counters().*count == value;
  };
  std::uint64_t opened = 1, broke = 0;
  for (int run = 0; run < 2; ++run) {
    peer.behave(Manner::Resetting);
    ASSERT_TRUE(becomes(&LineCounters::disconnects, ++broke));
    for (const auto pause : {40ms, 80ms, 100ms, 100ms}) {
      clock.pass(pause - 1ms);
      rounds_pass(3);
      ASSERT_EQ(spindle.counters().connected, opened) << "before " << pause.count() << " ms have passed";
      clock.pass(1ms);
      ASSERT_TRUE(becomes(&LineCounters::connected, ++opened)) << "after " << pause.count() << " ms";
      ASSERT_TRUE(becomes(&LineCounters::disconnects, ++broke));
    }
    peer.behave(Manner::Honest);
    clock.pass(100ms);
    ASSERT_TRUE(becomes(&LineCounters::connected, ++opened));
    ASSERT_EQ(spindle.counters().disconnects, broke);
  }
}

TEST(ModbusSpindleStart, NamesTheSlaveThatDoesNotAnswer) {
  ModbusPeer peer(Wire::Rtu);
  peer.behave(Manner::Silent);
  SpindleLineConfig config;
  config.line.endpoint = peer.endpoint();
  config.line.deadline = 20ms;
  config.line.period = 5ms;
  config.boot_timeout = 10ms;
  config.axes = {{.slave = 9, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  SpindleInterface spindle(std::move(config));
  const auto started = spindle.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, MinorCode::CommTimeout);
  EXPECT_THAT(started.error().message, HasSubstr("slave 9 at /dev/pts/"));
  EXPECT_THAT(started.error().message, HasSubstr("was not reached within 0.01 s: "));
  EXPECT_THAT(started.error().message, HasSubstr("no whole answer within 20 ms"));
}

TEST(ModbusSpindleStart, SaysWhatTheSlaveDidInPlaceOfAnAnswer) {
  for (const auto& [manner, why] : {std::pair(Manner::WrongId, "another slave answered"),
                                    std::pair(Manner::WrongLength, "counts other bytes than came"),
                                    std::pair(Manner::Busy, "refused with exception 6: it is busy")}) {
    StillClock clock;
    ModbusPeer peer(Wire::Tcp);
    peer.behave(manner);
    SpindleLineConfig config;
    config.line.endpoint = peer.endpoint();
    config.line.deadline = 30s;  // however busy the computer is, the peer answers
    config.line.period = 5ms;
    config.line.first_pause = 1ms;
    config.line.longest_pause = 5ms;
    config.line.now = [&clock, now = clock.now()] {  // it is patient with one that is busy, at the end
      clock.pass(100ms);
      return now();
    };
    config.boot_timeout = 100ms;
    config.axes = {{.slave = 9, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
    SpindleInterface spindle(std::move(config));
    const auto started = spindle.start();
    ASSERT_FALSE(started);
    EXPECT_THAT(started.error().message, HasSubstr("was not reached within 0.1 s: "));
    EXPECT_THAT(started.error().message, HasSubstr(why));
  }
}

}  // namespace
}  // namespace rmac::fieldbus::modbus

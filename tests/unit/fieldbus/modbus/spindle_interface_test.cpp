#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rmac/motion/drive_power.hpp"
#include "unit/fieldbus/modbus/spindle_drive.hpp"

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
  }

  void bring_up(std::chrono::milliseconds stale = 30s, const SpindleMap& drives_map = spindle_map(),
                std::chrono::milliseconds deadline = 50ms, std::chrono::milliseconds busy = 60s) {
    SpindleLineConfig config;
    config.line.endpoint = peer.endpoint();
    config.line.deadline = deadline;
    config.line.period = 2ms;
    config.line.first_pause = 1ms;
    config.line.longest_pause = 5ms;
    config.stale = stale;
    config.busy = busy;
    config.boot_timeout = 60s;
    config.axes = {{.slave = 4, .rpm_per_hz = 60, .maximum_hz = 0, .map = drives_map}};
    spindle = std::make_unique<SpindleInterface>(std::move(config));
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
  /// Cycles until `reached`; false when a minute did not do.
  bool run_until(DriveWish wish, std::int32_t rpm, const std::function<bool(const DriveFeedback&)>& reached,
                 bool reset = false) {
    const auto give_up = Clock::now() + 60s;
    while (!reached(cycle(wish, rpm, reset))) {
      if (Clock::now() > give_up) return false;
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

  RegisterBank bank;
  ModbusPeer peer;
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
  bring_up(30s, spindle_map(), 60s);  // however busy the computer is, what is told last is answered
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
  EXPECT_TRUE(drive_was_told(kStop)) << "it must not run on when its fault is reset";
  ASSERT_TRUE(run_until(
      DriveWish::QuickStop, 1500, [&](const DriveFeedback& words) { return !in_fault(words); }, true));
  EXPECT_EQ(bank.get(kHolding, kActual), 0) << "nothing starts by itself";
  EXPECT_TRUE(run_at(1500));
}

TEST_P(ModbusSpindle, TellsTheCodeOfATripThatCameAfterItsCodeWasRead) {
  constexpr std::uint16_t kEarlyFault = kStatus - 1;
  SpindleMap one_by_one = spindle_map();
  one_by_one.most_per_read = 1;
  one_by_one.fault_code = Place{kHolding, kEarlyFault};
  std::atomic<bool> trips{false};
  peer.respond([&](const Bytes& request) {
    const Bytes answer = bank.answer(request);
    if (request[1] == 3 && request[3] == kEarlyFault && trips.exchange(false)) {
      bank.set(kHolding, kEarlyFault, 7);
      bank.set(kHolding, kStatus, 4);
    }
    return answer;
  });
  bring_up(30s, one_by_one);
  ASSERT_TRUE(run_at(1500));
  trips = true;
  ASSERT_TRUE(run_until(DriveWish::Operational, 1500,
                        [](const DriveFeedback& words) { return drive_state(words.statusword) == DriveState::Fault; }));
  EXPECT_EQ(feedback[0].error_code, 7);
  spindle->stop();  // before what it asks is gone
}

TEST_P(ModbusSpindle, ThatSomeoneElseStoppedIsDropped) {
  bring_up();
  ASSERT_TRUE(run_at(1500));
  bank.set(kHolding, kCommand, 0);
  bank.set(kHolding, kStatus, 0);
  bank.set(kHolding, kActual, 0);
  EXPECT_TRUE(run_until(DriveWish::Operational, 1500, [](const DriveFeedback& words) {
    return words.online && drive_state(words.statusword) == DriveState::SwitchOnDisabled;
  }));
  EXPECT_TRUE(drive_was_told(kStop));
}

TEST_P(ModbusSpindle, ThatSomeoneElseStoppedIsDroppedThoughAnswersAreLostJustThen) {
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
  EXPECT_TRUE(run_until(DriveWish::Operational, 1500, [](const DriveFeedback& words) {
    return words.online && drive_state(words.statusword) == DriveState::SwitchOnDisabled;
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
  constexpr auto kStale = 400ms;
  bring_up(kStale);
  ASSERT_TRUE(run_at(1500));
  for (const Manner manner : {Manner::Silent, Manner::WrongId, Manner::Garbage, Manner::Resetting}) {
    SCOPED_TRACE(testing::Message() << "manner " << static_cast<int>(manner));
    peer.behave(manner);
    // Whatever comes from now on is of no use: nothing is online once all before is stale.
    const auto stale_at = Clock::now() + kStale;
    ASSERT_TRUE(run_until(DriveWish::Operational, 1500, [&](const DriveFeedback& words) {
      EXPECT_FALSE(words.online && Clock::now() > stale_at + 10s);
      return !words.online;
    }));
    EXPECT_NE(drive_state(feedback[0].statusword), DriveState::OperationEnabled);
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
  bring_up(700ms, spindle_map(), 300ms, 800ms);
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
      {Manner::Silent, "the drive does not answer: ", "no whole answer within 300 ms", &LineCounters::timeouts},
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
    peer.behave(one.manner);
    ASSERT_TRUE(run_until(DriveWish::Operational, 1500, [](const DriveFeedback& words) { return !words.online; }));
    const std::string text = spindle->silence_text(0).value_or("");
    EXPECT_THAT(text, testing::StartsWith(one.says));
    EXPECT_THAT(text, HasSubstr(": slave 4, "));
    EXPECT_THAT(text, HasSubstr(one.why));
    EXPECT_THAT(text, HasSubstr("(since the start "));
    EXPECT_GT(spindle->counters().*one.count, before);
    peer.behave(Manner::Honest);
    ASSERT_TRUE(run_until(DriveWish::Off, 0, [](const DriveFeedback& words) { return words.online; }));
    // On a busy computer one of the first honest answers may be late, and that is the cause from then on.
    EXPECT_THAT(spindle->silence_text(0).value_or(""), AnyOf(HasSubstr(one.why), HasSubstr(cases.front().why)))
        << "who asks late is told, too";
    ASSERT_TRUE(run_at(1500));
  }
  spindle->stop();
  ASSERT_TRUE(spindle->start());
  EXPECT_EQ(spindle->counters().busy, 0U) << "counts are since the start";
}

// Red when a drive that answers "busy" counts as one that does not answer.
TEST_P(ModbusSpindle, ThatIsBusyRunsOnAndTakesItsStopAsSoonAsItCan) {
  bring_up(400ms);
  ASSERT_TRUE(run_at(1500));
  peer.behave(Manner::Busy);
  const auto begun = Clock::now();
  Clock::time_point looked = begun, busy_after = begun;  // it said that it is since then
  for (std::uint64_t told = 0; looked - begun < 1s;) {
    const DriveFeedback words = cycle(DriveWish::Operational, 1500);
    // On a computer that has no time for the line nobody says anything.
    if (told > 0 && Clock::now() - busy_after < 300ms) {
      ASSERT_TRUE(words.online);
      ASSERT_EQ(words.velocity_rpm, 1500);
    }
    const std::uint64_t so_far = spindle->counters().busy;
    if (std::exchange(told, so_far) != so_far) busy_after = looked;
    looked = Clock::now();
  }
  const std::uint64_t asked = peer.requests();
  ASSERT_TRUE(run_until(DriveWish::Off, 0, [&](const DriveFeedback&) { return peer.requests() > asked + 6; }));
  const auto refused = peer.take_requests();
  const Bytes stop{4, 6, 0, kCommand, 0, kStop};
  EXPECT_GT(std::count(refused.begin(), refused.end(), stop), 1) << "a stop that was not taken is told again";
  peer.behave(Manner::Honest);
  EXPECT_TRUE(run_until(DriveWish::Off, 0, [](const DriveFeedback& words) { return words.velocity_rpm == 0; }));
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
}

// Red when a drive that is busy just then is left turning by an appliance that ends.
TEST_P(ModbusSpindle, ThatIsBusyIsStoppedWithTheApplianceAllTheSame) {
  bring_up(30s, spindle_map(), 60s);
  ASSERT_TRUE(run_at(1500));
  std::atomic<int> refusals{8};
  peer.respond([&](const Bytes& request) {
    if (request[1] == 6 && refusals.fetch_sub(1) > 0) return Bytes{4, 0x86, 6};
    return bank.answer(request);
  });
  spindle->stop();
  EXPECT_EQ(bank.get(kHolding, kCommand), kStop);
  spindle.reset();
  peer.vanish();  // before what it asks is gone
}

TEST_P(ModbusSpindle, IsOfflineWhenTheLineIsGone) {
  bring_up(400ms);
  ASSERT_TRUE(run_at(1500));
  peer.vanish();
  EXPECT_TRUE(run_until(DriveWish::QuickStop, 0, [](const DriveFeedback& words) { return !words.online; }));
  spindle->stop();  // in bounded time, though nobody answers
}

TEST(ModbusSpindleStart, ReachesADriveThatGivesOneRegisterAtATime) {
  RegisterBank bank;  // outlives the peer, which answers from it
  bank.most_per_read = 1;
  ModbusPeer peer(Wire::Rtu);
  peer.respond([&](const Bytes& request) { return bank.answer(request); });
  SpindleLineConfig config;
  config.line.endpoint = peer.endpoint();
  config.line.period = 5ms;
  config.boot_timeout = 60s;
  config.axes = {{.slave = 9, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  config.axes[0].map.most_per_read = 1;
  SpindleInterface spindle(std::move(config));
  const auto started = spindle.start();
  EXPECT_TRUE(started) << started.error().message;
}

TEST(ModbusSpindleLine, IsOpenedAgainWithPausesThatDouble) {
  ModbusPeer peer(Wire::Tcp);
  peer.behave(Manner::Resetting);
  SpindleLineConfig config;
  config.line.endpoint = peer.endpoint();
  config.line.period = 1ms;
  config.line.first_pause = 40ms;
  config.boot_timeout = 60s;
  config.axes = {{.slave = 1, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  SpindleInterface spindle(std::move(config));
  const auto begun = Clock::now();
  // After the fourth request three pauses have passed.
  std::thread behave([&peer] {
    for (int requests = 0; requests < 4; requests = static_cast<int>(peer.requests())) std::this_thread::yield();
    peer.respond([](const Bytes& request) { return RegisterBank().answer(request); });
    peer.behave(Manner::Honest);
  });
  EXPECT_TRUE(spindle.start());
  behave.join();
  EXPECT_GE(Clock::now() - begun, 40ms + 80ms + 160ms);
}

TEST(ModbusSpindleStart, NamesTheSlaveThatDoesNotAnswer) {
  ModbusPeer peer(Wire::Rtu);
  peer.behave(Manner::Silent);
  SpindleLineConfig config;
  config.line.endpoint = peer.endpoint();
  config.line.deadline = 20ms;
  config.line.period = 5ms;
  config.boot_timeout = 200ms;
  config.axes = {{.slave = 9, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()}};
  SpindleInterface spindle(std::move(config));
  const auto started = spindle.start();
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, MinorCode::CommTimeout);
  EXPECT_THAT(started.error().message, HasSubstr("slave 9 at /dev/pts/"));
  EXPECT_THAT(started.error().message, HasSubstr("was not reached within 0.2 s: "));
  EXPECT_THAT(started.error().message, HasSubstr("no whole answer within 20 ms"));
}

TEST(ModbusSpindleStart, SaysWhatTheSlaveDidInPlaceOfAnAnswer) {
  for (const auto& [manner, why] : {std::pair(Manner::WrongId, "another slave answered"),
                                    std::pair(Manner::WrongLength, "counts other bytes than came"),
                                    std::pair(Manner::Busy, "refused with exception 6: it is busy")}) {
    ModbusPeer peer(Wire::Tcp);
    peer.behave(manner);
    SpindleLineConfig config;
    config.line.endpoint = peer.endpoint();
    config.line.deadline = 30s;  // however busy the computer is, the peer answers
    config.line.period = 5ms;
    config.line.first_pause = 1ms;
    config.line.longest_pause = 5ms;
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

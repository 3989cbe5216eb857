#include "rmac/fieldbus/modbus/line.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "unit/fieldbus/modbus/modbus_peer.hpp"
#include "unit/fieldbus/modbus/still_clock.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Kind = Failure::Kind;

tl::unexpected<Failure> fails(Kind kind, int code = 0, const char* why = "why") {
  return tl::unexpected<Failure>({kind, code, why});
}

/// A slave that is what a test says. The line's thread asks it.
struct ScriptedStation final : Station {
  explicit ScriptedStation(int number) : number_(number) {}
  [[nodiscard]] int slave() const noexcept override { return number_; }
  Answer<> serve(Client& client) override {
    ++served;
    return on_serve ? on_serve(client) : Answer<>();
  }
  void forget() noexcept override { ++forgotten; }
  Answer<> make_safe(Client&) override {
    ++made_safe;
    return on_safe ? on_safe(made_safe) : Answer<>();
  }

  std::function<Answer<>(Client&)> on_serve;
  std::function<Answer<>(int)> on_safe;
  std::atomic<int> served{0}, forgotten{0}, made_safe{0};

 private:
  int number_;
};

class ModbusLine : public testing::Test {
 protected:
  ModbusLine() {
    config.endpoint = peer.endpoint();
    config.deadline = 60s;
    config.period = 1ms;
    config.first_pause = config.longest_pause = 0ms;
    config.now = clock.now();
  }
  ~ModbusLine() override {
    if (line) line->stop();
  }
  Expected<> start(std::chrono::milliseconds patience = 60s) {
    line = std::make_unique<Line>(config, std::vector<Station*>{&first, &second});
    return line->start(patience);
  }
  /// Waits until the line has begun and ended that many rounds.
  void rounds_pass(std::uint64_t more) const {
    const std::uint64_t before = line->counters().rounds;
    const auto give_up = Clock::now() + 60s;
    while (line->counters().rounds <= before + more) {
      ASSERT_LT(Clock::now(), give_up);
      std::this_thread::yield();
    }
  }

  ModbusPeer peer{ModbusPeer::Wire::Tcp};
  StillClock clock;
  LineConfig config;
  ScriptedStation first{1}, second{2};
  std::unique_ptr<Line> line;
};

TEST_F(ModbusLine, ServesItsStationsInTurn) {
  std::vector<int> order;
  first.on_serve = [&](Client&) -> Answer<> {
    order.push_back(1);
    return {};
  };
  second.on_serve = [&](Client&) -> Answer<> {
    order.push_back(2);
    return {};
  };
  ASSERT_TRUE(start());
  rounds_pass(2);
  line->stop();
  ASSERT_GE(order.size(), 4U);
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i % 2 == 0 ? 1 : 2);
  EXPECT_EQ(line->counters().connected, 1U);
  EXPECT_EQ(line->counters().failures, 0U);
  EXPECT_EQ(first.forgotten, 1) << "when the line was opened";
}

// Red when the device behind one that takes the connection with it each time is never served first.
TEST_F(ModbusLine, BeginsTheNextRoundBehindADeviceThatTookTheConnectionWithIt) {
  std::vector<int> order;
  first.on_serve = [&](Client& client) -> Answer<> {
    order.push_back(1);
    if (first.served == 1) return {};
    client.disconnect();
    return fails(Kind::Timeout);
  };
  second.on_serve = [&](Client&) -> Answer<> {
    order.push_back(2);
    return {};
  };
  ASSERT_TRUE(start());
  rounds_pass(3);
  line->stop();
  order.resize(6);
  EXPECT_THAT(order, ElementsAre(1, 2, /* fails: */ 1, 2, /* from now on the other one first: */ 2, 1));
}

// Red when a line that broke is opened at once for the next device, and when devices are not told that it was closed.
TEST_F(ModbusLine, WaitsForItsPauseWhenItBroke) {
  config.first_pause = config.longest_pause = 1h;
  first.on_serve = [&](Client& client) -> Answer<> {
    if (first.served != 2) return {};
    client.disconnect();
    return fails(Kind::Disconnected);
  };
  ASSERT_TRUE(start());
  rounds_pass(5);
  EXPECT_EQ(first.served, 2);
  EXPECT_EQ(second.served, 1);
  EXPECT_EQ(second.forgotten, 1) << "when it was opened first";
  EXPECT_EQ(line->counters().connected, 1U);
  clock.pass(1h);
  rounds_pass(2);
  EXPECT_GT(second.served, 1);
  EXPECT_EQ(second.forgotten, 2);
  EXPECT_EQ(line->counters().connected, 2U);
}

TEST_F(ModbusLine, GivesItsDescriptorsBack) {
  const auto open_descriptors = [] {
    const std::filesystem::directory_iterator all("/proc/self/fd");
    return std::distance(begin(all), end(all));
  };
  const auto before = open_descriptors();
  for (int run = 0; run < 3; ++run) {
    ASSERT_TRUE(start());
    line.reset();
  }
  peer.vanish();  // with its own
  EXPECT_LE(open_descriptors(), before);
}

TEST_F(ModbusLine, IsWokenBeforeItsPeriodIsOver) {
  config.period = 1h;
  ASSERT_TRUE(start());
  for (int served = 1; served < 4; ++served) {
    line->wake();
    const auto give_up = Clock::now() + 60s;
    while (first.served <= served) ASSERT_LT(Clock::now(), give_up);
  }
}

TEST_F(ModbusLine, NamesTheStationThatWasNotServed) {
  second.on_serve = [](Client&) -> Answer<> { return fails(Kind::Timeout, 0, "it says nothing"); };
  const auto started = start(10ms);
  ASSERT_FALSE(started);
  EXPECT_EQ(started.error().code, MinorCode::CommTimeout);
  EXPECT_THAT(started.error().message, StartsWith("slave 2 at 127.0.0.1 port "));
  EXPECT_THAT(started.error().message, HasSubstr(" was not reached within 0.01 s: it says nothing"));
  const int served = first.served;
  EXPECT_GT(first.made_safe, 0) << "the other one was told to run, perhaps";
  EXPECT_EQ(first.served, served) << "the line's thread has ended";
}

TEST_F(ModbusLine, CountsWhyRoundsFailed) {
  struct Case {
    Kind kind;
    int code;
    std::uint64_t LineCounters::*count;
  };
  const std::vector<Case> cases{{Kind::Timeout, 0, &LineCounters::timeouts},
                                {Kind::WrongAnswer, 0, &LineCounters::wrong_answers},
                                {Kind::Exception, 6, &LineCounters::busy},
                                {Kind::Exception, 2, &LineCounters::exceptions},
                                {Kind::Disconnected, 0, &LineCounters::disconnects}};
  for (const Case& one : cases) {
    ScriptedStation fails_twice(3);
    fails_twice.on_serve = [&](Client&) -> Answer<> {
      if (fails_twice.served <= 2) return fails(one.kind, one.code);
      return {};
    };
    Line fresh(config, {&fails_twice});
    ASSERT_TRUE(fresh.start(60s));
    fresh.stop();
    LineCounters counted = fresh.counters();
    EXPECT_EQ(counted.failures, 2U);
    EXPECT_EQ(counted.*one.count, 2U) << static_cast<int>(one.kind) << " " << one.code;
    for (const Case& other : cases) {
      if (other.count != one.count) {
        EXPECT_EQ(counted.*other.count, 0U);
      }
    }
    EXPECT_GE(fails_twice.forgotten, 2) << "what was written before does not count as done";
  }
}

TEST_F(ModbusLine, SaysInWhatMannerADeviceFailsAndReportsIt) {
  struct Case {
    Failure failure;
    std::string manner;
  };
  const std::vector<Case> cases{{{Kind::Timeout, 0, "a"}, "does not answer"},
                                {{Kind::WrongAnswer, 0, "b"}, "is not understood"},
                                {{Kind::Exception, 5, "c"}, "is busy"},
                                {{Kind::Exception, 3, "d"}, "refuses"},
                                {{Kind::Disconnected, 0, "e"}, "does not answer"}};
  std::atomic<std::size_t> now_fails{cases.size()};
  second.on_serve = [&](Client&) -> Answer<> {
    const std::size_t which = now_fails;
    if (which == cases.size()) return {};
    return tl::unexpected(cases[which].failure);
  };
  ASSERT_TRUE(start());
  EXPECT_EQ(line->trouble(1), std::nullopt);
  EXPECT_EQ(line->trouble(2), std::nullopt) << "there is none";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    now_fails = i;
    rounds_pass(1);
    EXPECT_THAT(line->trouble(1).value_or(""),
                StartsWith(cases[i].manner + ": " + cases[i].failure.message + " (since the start "));
    EXPECT_EQ(line->trouble(0), std::nullopt) << "the other one is well";
    const LineReport report = line->report();
    ASSERT_EQ(report.units.size(), 2U);
    EXPECT_EQ(report.units[0].unit, 1);
    EXPECT_EQ(report.units[0].state, "answers");
    EXPECT_EQ(report.units[1].unit, 2);
    EXPECT_EQ(report.units[1].state, cases[i].manner);
    EXPECT_GE(report.rounds, 1U);
    EXPECT_GE(report.connections, 1U);
  }
}

TEST_F(ModbusLine, ReportsItsUnitsAsOffBeforeItIsStarted) {
  const Line fresh(config, {&first, &second});
  const LineReport report = fresh.report();
  EXPECT_EQ(report.endpoint, to_string(config.endpoint));
  ASSERT_EQ(report.units.size(), 2U);
  EXPECT_EQ(report.units[1].unit, 2);
  EXPECT_EQ(report.units[1].state, "off");
}

// Whoever asks why a drive was silent may ask when it has answered again.
TEST_F(ModbusLine, RemembersATroubleForTenSecondsAfterItPassed) {
  std::atomic<bool> silent{false};
  first.on_serve = [&](Client&) -> Answer<> {
    if (silent) return fails(Kind::Timeout);
    return {};
  };
  ASSERT_TRUE(start());
  silent = true;
  rounds_pass(1);
  silent = false;
  rounds_pass(1);
  clock.pass(10s);
  EXPECT_TRUE(line->trouble(0));
  clock.pass(1ms);
  EXPECT_FALSE(line->trouble(0));
  silent = true;
  rounds_pass(1);
  clock.pass(1h);
  EXPECT_TRUE(line->trouble(0)) << "it lasts";
}

// Red when the doubt that follows from a lost answer takes the place of what lost it.
TEST_F(ModbusLine, TellsTheCauseOfADoubtAndADoubtThatHasNone) {
  std::atomic<int> kind{-1};
  first.on_serve = [&](Client&) -> Answer<> {
    if (kind < 0) return {};
    return fails(static_cast<Kind>(kind.load()), 0, kind == static_cast<int>(Kind::InDoubt) ? "doubt" : "cause");
  };
  const auto trouble_of = [&](Kind next) {
    kind = static_cast<int>(next);
    rounds_pass(1);
    return line->trouble(0).value_or("");
  };
  ASSERT_TRUE(start());
  EXPECT_THAT(trouble_of(Kind::InDoubt), HasSubstr(": doubt")) << "there was nothing before";
  EXPECT_THAT(trouble_of(Kind::WrongAnswer), HasSubstr(": cause"));
  EXPECT_THAT(trouble_of(Kind::InDoubt), HasSubstr(": cause"));
  kind = -1;
  rounds_pass(1);
  EXPECT_THAT(trouble_of(Kind::InDoubt), HasSubstr(": doubt")) << "that cause is over";
}

TEST_F(ModbusLine, MakesItsStationsSafeOnceWhereTheyTakeIt) {
  ASSERT_TRUE(start());
  line->stop();
  EXPECT_EQ(first.made_safe, 1);
  EXPECT_EQ(second.made_safe, 1);
  line->stop();
  EXPECT_EQ(first.made_safe, 1) << "it has ended";
}

TEST_F(ModbusLine, TriesThreeTimesToMakeAStationSafe) {
  first.on_safe = [](int) -> Answer<> { return fails(Kind::Timeout); };
  ASSERT_TRUE(start());
  line->stop();
  EXPECT_EQ(first.made_safe, 3);
  EXPECT_EQ(second.made_safe, 3) << "one that fails does not keep the others from it";
}

TEST_F(ModbusLine, WaitsAPeriodBeforeItTellsABusyStationAgain) {
  config.period = 30ms;
  first.on_safe = [](int told) -> Answer<> {
    if (told <= 3) return fails(Kind::Exception, 6);
    return {};
  };
  ASSERT_TRUE(start());
  const auto begun = Clock::now();
  line->stop();
  EXPECT_EQ(first.made_safe, 4);
  EXPECT_GE(Clock::now() - begun, 2 * 30ms) << "three pauses, of which its own end may cut the first short";
}

TEST_F(ModbusLine, HasPatienceWithABusyStationForThreeSeconds) {
  first.on_safe = [this](int) -> Answer<> {
    clock.pass(1s);
    return fails(Kind::Exception, 6);
  };
  ASSERT_TRUE(start());
  line->stop();
  EXPECT_EQ(first.made_safe, 2 + 3) << "in three seconds, and as often as any other from then on";
}

TEST_F(ModbusLine, EndsThoughNobodyIsThereToBeMadeSafe) {
  ASSERT_TRUE(start());
  peer.vanish();
  first.on_safe = [](int) -> Answer<> { return fails(Kind::Disconnected); };
  line->stop();
  EXPECT_FALSE(line->start(10ms)) << "and cannot start";
}

TEST_F(ModbusLine, StartsAgainWithFreshCounts) {
  first.on_serve = [this](Client&) -> Answer<> {
    if (first.served == 1) return fails(Kind::Timeout);
    return {};
  };
  ASSERT_TRUE(start());
  ASSERT_TRUE(line->start(60s));
  const LineCounters counted = line->counters();
  EXPECT_EQ(counted.timeouts, 0U);
  EXPECT_EQ(counted.failures, 0U);
  EXPECT_EQ(counted.connected, 1U);
  EXPECT_EQ(line->trouble(0), std::nullopt);
}

}  // namespace
}  // namespace rmac::fieldbus::modbus

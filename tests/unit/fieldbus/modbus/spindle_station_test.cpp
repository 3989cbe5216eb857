#include "modbus/spindle_station.hpp"

#include <gmock/gmock.h>

#include "unit/fieldbus/modbus/modbus_wire.hpp"
#include "unit/fieldbus/modbus/spindle_drive.hpp"

namespace rmac::fieldbus::modbus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using Manner = ModbusPeer::Manner;
using Wire = ModbusPeer::Wire;

const auto kIsStopped = Pair(kCommand, kStop);
const auto kRunsForward = Pair(kCommand, kForward);
const auto kRunsBackward = Pair(kCommand, kBackward);
const auto kIsReset = Pair(kReset, 1);
constexpr auto speed = [](int tenths_hz) { return Pair(kSpeedCommand, tenths_hz); };

/// A drive and its station, round by round.
class StationOnAWire : public testing::TestWithParam<Wire> {
 protected:
  StationOnAWire() : StationOnAWire(GetParam()) {}
  explicit StationOnAWire(Wire kind) : wire(kind) {
    wire.bank.on_write = turn;
    config = {.slave = 4, .rpm_per_hz = 60, .maximum_hz = 0, .map = spindle_map()};
  }

  /// One round, which goes well: what it wrote.
  std::vector<std::pair<int, int>> round() {
    if (!station) station = std::make_unique<SpindleStation>(config);
    const auto served = station->serve(*wire.client);
    EXPECT_TRUE(served) << served.error().message;
    return wire.written();
  }
  Answer<> failing_round() { return station->serve(*wire.client); }

  ModbusWire wire;
  SpindleConfig config;
  std::unique_ptr<SpindleStation> station;
};

using ModbusSpindleStation = StationOnAWire;
INSTANTIATE_TEST_SUITE_P(Wires, ModbusSpindleStation, testing::Values(Wire::Tcp, Wire::Rtu),
                         [](const auto& kind) { return kind.param == Wire::Tcp ? "Tcp" : "Rtu"; });
/// Where the wire makes no difference.
struct ModbusStation : StationOnAWire {
  ModbusStation() : StationOnAWire(Wire::Tcp) {}
};

TEST_F(ModbusStation, TellsADriveWhatIsNewAndNothingTwice) {
  EXPECT_THAT(round(), ElementsAre(kIsStopped)) << "whatever it did before";
  EXPECT_THAT(round(), IsEmpty());
  EXPECT_EQ(wire.reads, 1) << "what lies side by side is asked for together, once";
  EXPECT_FALSE(station->command(0)) << "no news";
  EXPECT_TRUE(station->command(1500));
  EXPECT_FALSE(station->command(1500));
  EXPECT_THAT(round(), ElementsAre(speed(250), kRunsForward)) << "its speed first";
  EXPECT_THAT(round(), IsEmpty());
  station->command(3000);
  EXPECT_THAT(round(), ElementsAre(speed(500)));
  station->command(-3000);
  EXPECT_THAT(round(), ElementsAre(kRunsBackward)) << "its speed is the same";
  station->command(-1500);
  EXPECT_THAT(round(), ElementsAre(speed(250)));
  station->command(-1);  // the slowest: it runs that way already
  EXPECT_THAT(round(), ElementsAre(speed(0)));
  station->command(-1500);
  EXPECT_THAT(round(), ElementsAre(speed(250)));
  station->command(1500);
  EXPECT_THAT(round(), ElementsAre(kRunsForward));
  station->command(0);
  EXPECT_THAT(round(), ElementsAre(kIsStopped));
  EXPECT_THAT(round(), IsEmpty());
}

TEST_F(ModbusStation, StopsADriveBeforeAnythingElse) {
  station = std::make_unique<SpindleStation>(config);
  station->command(1500);
  round();
  station->command(0);
  ASSERT_TRUE(station->serve(*wire.client));
  EXPECT_EQ(wire.peer.take_requests().front(), (Bytes{4, 6, 0, kCommand, 0, kStop}));
}

TEST_F(ModbusStation, RunsNoDriveBackwardThatHasNoWayTo) {
  config.map.backward_run.clear();
  round();
  EXPECT_FALSE(station->command(-600)) << "it is as stopped as it was";
  EXPECT_THAT(round(), IsEmpty());
  station->command(600);
  EXPECT_THAT(round(), ElementsAre(speed(100), kRunsForward));
  EXPECT_TRUE(station->command(-600));
  EXPECT_THAT(round(), ElementsAre(kIsStopped));
}

// Red when an answer that was lost starts a drive that someone stopped meanwhile.
TEST_F(ModbusStation, TellsAStopAndASpeedAgainInDoubtButNoRun) {
  round();
  station->forget();
  EXPECT_THAT(round(), ElementsAre(kIsStopped));
  station->command(60);
  EXPECT_THAT(round(), ElementsAre(speed(10), kRunsForward));
  station->forget();
  EXPECT_THAT(round(), ElementsAre(speed(10)));
  station->command(1);  // the slowest that there is: it runs, too
  EXPECT_THAT(round(), ElementsAre(speed(0)));
  station->forget();
  EXPECT_THAT(round(), ElementsAre(speed(0)));
}

TEST_F(ModbusStation, BeginsAnewWhenItIsCleared) {
  station = std::make_unique<SpindleStation>(config);
  station->command(1500);
  round();
  station->request_reset();
  station->clear();
  EXPECT_EQ(station->report().asked, Clock::time_point::min());
  EXPECT_EQ(station->report().busy, Clock::time_point::min());
  EXPECT_THAT(round(), ElementsAre(kIsStopped)) << "and what was to be reset before is not";
  station->command(1500);
  EXPECT_THAT(round(), ElementsAre(speed(250), kRunsForward));
}

TEST_F(ModbusStation, CommandsTheSpeedInItsDrivesScale) {
  config.map.speed_command = {{kHolding, kSpeedCommand}, 10000};
  config.map.speed_command_unit = SpindleMap::Unit::OfMaximum;
  config.map.speed_read_back.reset();
  config.rpm_per_hz = 30;
  config.maximum_hz = 400;
  round();
  station->command(6000);
  EXPECT_THAT(round(), ElementsAre(speed(5000), kRunsForward)) << "200 Hz are half of 400";
}

TEST_F(ModbusStation, TellsHowFastItTurns) {
  round();
  station->command(1500);
  round();
  round();
  EXPECT_EQ(station->report().rpm, 1500);
  EXPECT_EQ(station->report().asked, wire.client->now());
  station->command(-1500);
  round();
  round();
  EXPECT_EQ(station->report().rpm, -1500) << "by the bit that says so";
  EXPECT_FALSE(station->report().dropped);
  EXPECT_FALSE(station->report().tripped);
}

TEST_F(ModbusStation, TakesTheWayFromWhatItWasToldWhereNothingElseTellsIt) {
  config.map.backward.reset();
  round();
  station->command(-1500);
  round();
  round();
  EXPECT_EQ(station->report().rpm, -1500);
}

TEST_F(ModbusStation, TakesTheWayFromASpeedWithASign) {
  config.map.speed.place.is_signed = true;
  round();
  wire.bank.set(kHolding, kActual, 0xFFF6);
  wire.bank.set(kHolding, kStatus, 3);
  round();
  EXPECT_EQ(station->report().rpm, -60) << "-10 tenths of a hertz";
}

TEST_F(ModbusStation, TellsATripAndItsCode) {
  round();
  wire.bank.set(kHolding, kFault, 7);
  round();
  EXPECT_FALSE(station->report().tripped) << "an old code is no trip where the state says that there is none";
  wire.bank.set(kHolding, kStatus, 4);
  round();
  EXPECT_TRUE(station->report().tripped);
  EXPECT_EQ(station->report().error_code, 7);
  wire.bank.set(kHolding, kStatus, 0);
  round();
  EXPECT_FALSE(station->report().tripped);
  EXPECT_EQ(station->report().error_code, 0);
}

TEST_F(ModbusStation, TellsATripWithoutACodeAsOneOfTheManufacturers) {
  config.map.fault_code.reset();
  round();
  wire.bank.set(kHolding, kStatus, 4);
  round();
  EXPECT_TRUE(station->report().tripped);
  EXPECT_EQ(station->report().error_code, 0xFF00);
}

TEST_F(ModbusStation, TakesACodeForATripWhereNothingElseTellsOne) {
  config.map.tripped.reset();
  round();
  EXPECT_FALSE(station->report().tripped);
  wire.bank.set(kHolding, kFault, 1);
  round();
  EXPECT_TRUE(station->report().tripped);
  EXPECT_EQ(station->report().error_code, 1);
}

// A drive may restart when it is reset, and answer nothing meanwhile.
TEST_F(ModbusStation, ResetsADriveOnceForEachTimeThatItIsAskedAndSeldom) {
  round();
  EXPECT_THAT(round(), IsEmpty());
  station->request_reset();
  EXPECT_THAT(round(), ElementsAre(kIsReset));
  EXPECT_THAT(round(), IsEmpty());
  station->request_reset();
  wire.clock.pass(1999ms);
  EXPECT_THAT(round(), IsEmpty());
  wire.clock.pass(1ms);
  EXPECT_THAT(round(), ElementsAre(kIsReset));
  EXPECT_THAT(round(), IsEmpty());
}

TEST_F(ModbusStation, TellsThatSomeoneStoppedItsDriveTwoSecondsAfterItWasToldToRun) {
  round();
  station->command(1500);
  round();
  wire.bank.set(kHolding, kStatus, 0);
  wire.clock.pass(2s);
  round();
  EXPECT_FALSE(station->report().dropped);
  wire.clock.pass(1ns);
  round();
  EXPECT_TRUE(station->report().dropped);
  wire.bank.set(kHolding, kStatus, 1);
  round();
  EXPECT_FALSE(station->report().dropped);
  wire.bank.set(kHolding, kStatus, 0);
  station->command(0);
  round();
  EXPECT_FALSE(station->report().dropped) << "that was us";
}

TEST_F(ModbusStation, KnowsOfNobodyWhoStoppedADriveThatDoesNotTell) {
  config.map.running.reset();
  round();
  station->command(1500);
  round();
  wire.bank.set(kHolding, kStatus, 0);
  wire.clock.pass(1h);
  round();
  EXPECT_FALSE(station->report().dropped);
}

TEST_F(ModbusStation, TellsASpeedAgainThatItsDriveDoesNotShow) {
  round();
  station->command(1500);
  round();
  wire.bank.set(kHolding, kTaken, 251);
  EXPECT_THAT(round(), ElementsAre(speed(250)));
  EXPECT_THAT(round(), IsEmpty());
  config.map.speed_read_back->mask = 0xFF;
  station = std::make_unique<SpindleStation>(config);
  station->command(1500);
  round();
  wire.bank.set(kHolding, kTaken, 250 | 0x100);
  EXPECT_THAT(round(), ElementsAre(speed(250))) << "all of it counts";
}

// Red when values from before a run or a stop hold on because the drive is busy with it.
TEST_F(ModbusStation, SaysThatItsDriveIsBusyWhereWhatItToldIsNewerThanWhatItWasTold) {
  const auto busy_to = [this](std::uint8_t function) {
    wire.peer.respond([this, function](const Bytes& request) {
      if (request[1] != function) return wire.bank.answer(request);
      return Bytes{request[0], static_cast<std::uint8_t>(request[1] | 0x80U), 6};
    });
  };
  round();
  EXPECT_EQ(station->report().busy, Clock::time_point::min());
  wire.clock.pass(1s);
  busy_to(3);
  const auto refused = failing_round();
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().busy());
  EXPECT_EQ(station->report().busy, wire.client->now());
  const Clock::time_point then = wire.client->now();
  busy_to(0);
  station->command(1500);
  wire.peer.respond([this](const Bytes& request) {
    if (request[1] == 6) wire.clock.pass(1ms);  // what was read is older than what is written
    return wire.bank.answer(request);
  });
  round();
  busy_to(3);
  wire.clock.pass(1s);
  ASSERT_FALSE(failing_round());
  EXPECT_EQ(station->report().busy, then) << "it told nothing since it runs";
}

TEST_F(ModbusStation, TellsABusyDriveItsStopInEveryRoundAndReadsIt) {
  round();
  station->command(1500);
  round();
  wire.peer.respond([this](const Bytes& request) {
    if (request[1] == 6) return Bytes{request[0], 0x86, 6};
    return wire.bank.answer(request);
  });
  station->command(0);
  static_cast<void>(wire.written());
  for (int rounds = 0; rounds < 3; ++rounds) {
    wire.clock.pass(50ms);
    const auto refused = failing_round();
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().busy());
    EXPECT_THAT(wire.written(), ElementsAre(kIsStopped, kIsStopped)) << "before it is asked, and behind that";
    EXPECT_EQ(wire.reads, 1);
    EXPECT_EQ(station->report().asked, wire.client->now());
  }
}

TEST_F(ModbusStation, GivesUpARoundWhoseStopIsRefusedForGood) {
  round();
  station->command(1500);
  round();
  wire.peer.respond([](const Bytes& request) {
    return Bytes{request[0], static_cast<std::uint8_t>(request[1] | 0x80U), 4};
  });
  station->command(0);
  const auto refused = failing_round();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exception_code, 4);
  EXPECT_THAT(wire.written(), ElementsAre(kIsStopped));
  EXPECT_EQ(wire.reads, 0);
}

// A drive that gives one register at a time refuses the longer questions that end a doubt: it is left alone until
// nothing late can come from it.
struct ModbusStationRtu : StationOnAWire {
  ModbusStationRtu() : StationOnAWire(Wire::Rtu) {}
};

TEST_F(ModbusStationRtu, LeavesADriveAloneForTwoSecondsThatRefusesLongQuestions) {
  wire.bank.most_per_read = 1;
  config.map.most_per_read = 1;
  station = std::make_unique<SpindleStation>(config);
  ASSERT_FALSE(failing_round());
  EXPECT_THAT(wire.written(), ElementsAre(kIsStopped)) << "a stop goes out all the same";
  EXPECT_EQ(wire.reads, 1);
  wire.clock.pass(1999ms);
  ASSERT_FALSE(failing_round());
  EXPECT_TRUE(wire.peer.take_requests().empty());
  wire.clock.pass(1ms);
  EXPECT_THAT(round(), ElementsAre(kIsStopped)) << "now its answer can be believed";
  EXPECT_EQ(wire.reads, 1 + 4) << "the long question, and each value";
  EXPECT_THAT(round(), IsEmpty());
}

TEST_F(ModbusStationRtu, TellsAStopInDoubtAgainAfterFourSeconds) {
  wire.peer.respond([](const Bytes& request) {  // another slave's, whatever is asked
    return Bytes{static_cast<std::uint8_t>(request[0] + 1), request[1], request[2], request[3], request[4], request[5]};
  });
  station = std::make_unique<SpindleStation>(config);
  const auto stops = [this](std::chrono::milliseconds later) {
    wire.clock.pass(later);
    EXPECT_FALSE(failing_round());
    return wire.written().size();
  };
  EXPECT_EQ(stops(0ms), 1U);
  EXPECT_EQ(stops(3999ms), 0U);
  EXPECT_EQ(stops(1ms), 1U);
  EXPECT_EQ(stops(50ms), 0U);
}

TEST_P(ModbusSpindleStation, MakesItsDriveSafeWhateverWasWanted) {
  station = std::make_unique<SpindleStation>(config);
  station->command(1500);
  round();
  EXPECT_TRUE(station->make_safe(*wire.client));
  EXPECT_THAT(wire.written(), ElementsAre(kIsStopped));
  EXPECT_TRUE(station->command(1500)) << "what was wanted is not any more";
}

TEST_F(ModbusStationRtu, BelievesNoStopInDoubtWhenItMakesItsDriveSafe) {
  station = std::make_unique<SpindleStation>(config);
  EXPECT_TRUE(station->make_safe(*wire.client));
  EXPECT_THAT(wire.written(), ElementsAre(kIsStopped, kIsStopped)) << "again, once its answer is its own";
  EXPECT_EQ(wire.reads, 1);
}

}  // namespace
}  // namespace rmac::fieldbus::modbus

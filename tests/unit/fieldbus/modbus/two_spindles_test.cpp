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

/// Two drives behind one port, of which one may be mute.
class ModbusTwoSpindles : public testing::TestWithParam<std::tuple<Wire, int>> {
 protected:
  ModbusTwoSpindles() : mute(std::get<int>(GetParam())), peer(std::get<Wire>(GetParam())) {
    for (RegisterBank& bank : banks) bank.on_write = turn;
    peer.respond([this](const Bytes& request) {
      return request[0] == mute && silent ? Bytes() : banks[request[0] - 1U].answer(request);
    });
    SpindleLineConfig config;
    config.line.endpoint = peer.endpoint();
    config.line.deadline = 20ms;
    config.line.period = 2ms;
    config.line.first_pause = config.line.longest_pause = 0ms;
    config.line.now = clock.now();
    config.boot_timeout = 60s;
    for (const int slave : {1, 2}) config.axes.push_back({slave, 60, 0, spindle_map()});
    spindle = std::make_unique<SpindleInterface>(std::move(config));
  }
  [[nodiscard]] std::size_t other() const noexcept { return mute == 1 ? 1 : 0; }
  void run_until(const std::function<bool()>& reached) {
    Patience patience(*spindle);
    do {
      for (std::size_t i = 0; i < commands.size(); ++i) {
        commands[i].controlword =
            next_controlword(feedback[i].statusword, DriveWish::Operational, false, commands[i].controlword);
        commands[i].mode = DriveMode::ProfileVelocity;
        commands[i].target_velocity_rpm = 600;
      }
      ASSERT_TRUE(spindle->exchange(commands, feedback));
      ASSERT_FALSE(patience.ends());
      std::this_thread::yield();
    } while (!reached());
  }

  const int mute;
  std::atomic<bool> silent{false};
  std::array<RegisterBank, 2> banks;
  ModbusPeer peer;
  StillClock clock;
  std::unique_ptr<SpindleInterface> spindle;
  std::array<DriveCommand, 2> commands{};
  std::array<DriveFeedback, 2> feedback{};
};

TEST_P(ModbusTwoSpindles, OneMuteLeavesTheOtherAtWork) {
  ASSERT_TRUE(spindle->start());
  silent = true;
  clock.pass(2s);
  run_until([this] { return !feedback[static_cast<std::size_t>(mute) - 1].online && feedback[other()].online; });
}

TEST_P(ModbusTwoSpindles, OneMuteLeavesTheOtherToBeStoppedWithTheAppliance) {
  ASSERT_TRUE(spindle->start());
  run_until([this] { return feedback[0].velocity_rpm == 600 && feedback[1].velocity_rpm == 600; });
  silent = true;
  spindle->stop();
  EXPECT_EQ(banks[other()].get(kHolding, kCommand), kStop);
}

TEST_P(ModbusTwoSpindles, AreReportedEachByItself) {
  ASSERT_TRUE(spindle->start());
  silent = true;
  // On a busy computer an answer of the other one may be late, too: what is told at last counts.
  UnitReport away, well;
  run_until([&] {
    const LineReport line = spindle->line_report();
    away = line.units.at(static_cast<std::size_t>(mute) - 1);
    well = line.units.at(other());
    return away.state == "does not answer" && away.traffic.timeouts > 0 && well.state == "answers";
  });
  EXPECT_EQ(spindle->axis_count(), 2U);
  EXPECT_EQ(away.unit, mute);
  EXPECT_NE(well.unit, mute);
  ASSERT_TRUE(away.traffic.last_trouble);
  EXPECT_THAT(away.traffic.last_trouble->message, HasSubstr("slave " + std::to_string(mute) + ", "));
  EXPECT_GT(well.traffic.answers, 0U);
}

INSTANTIATE_TEST_SUITE_P(Wires, ModbusTwoSpindles,
                         testing::Combine(testing::Values(Wire::Tcp, Wire::Rtu), testing::Values(1, 2)));

}  // namespace
}  // namespace rmac::fieldbus::modbus

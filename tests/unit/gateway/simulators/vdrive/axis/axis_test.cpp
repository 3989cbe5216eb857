#include <cmath>

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

// CiA 402: power states, option codes, modes, limits and faults.
namespace rmac::vdrive::test {
namespace {

using DriveAxis = NodeBench;

// States in the statusword's bits 0 to 3, 5 and 6 (bit 5 is 0 in a quick stop alone).
constexpr int kSwitchOnDisabled = 0x40;
constexpr int kReady = 0x21;
constexpr int kSwitchedOn = 0x23;
constexpr int kEnabled = 0x27;
constexpr int kQuickStop = 0x07;
constexpr int kFault = 0x08;
constexpr double kTurn = 131072;

TEST_F(DriveAxis, GoesThroughThePowerStatesByTheControlword) {
  EXPECT_EQ(state(), kSwitchOnDisabled);
  control(0x0F);
  EXPECT_EQ(state(), kSwitchOnDisabled) << "only shutdown leads out of it";
  control(0x06);
  EXPECT_EQ(state(), kReady);  // 2
  control(0x07);
  EXPECT_EQ(state(), kSwitchedOn);  // 3
  control(0x06);
  EXPECT_EQ(state(), kReady);  // 6
  control(0x0F);
  EXPECT_EQ(state(), kEnabled);  // 3 and 4
  control(0x07);
  EXPECT_EQ(state(), kSwitchedOn);  // 5
  control(0x0F);
  control(0x06);
  EXPECT_EQ(state(), kReady);  // 8
  control(0x00);
  EXPECT_EQ(state(), kSwitchOnDisabled);  // 7
  control(0x06);
  control(0x0F);
  control(0x00);
  EXPECT_EQ(state(), kSwitchOnDisabled);  // 9
}

TEST_F(DriveAxis, LeavesAFaultOnARisingEdgeOnly) {
  enable(3);
  node_.axis().trip(0x7305);
  pass(0.01);
  EXPECT_EQ(state(), kFault);
  EXPECT_EQ(read(0x603F), 0x7305);
  EXPECT_EQ(number(last(0x085), 0, 2), 0x7305U);
  EXPECT_EQ(last(0x085).data[2], 1);
  control(0x0F);
  EXPECT_EQ(state(), kFault);
  control(0x80);
  EXPECT_EQ(state(), kSwitchOnDisabled);
  EXPECT_EQ(number(last(0x085), 0, 2), 0U) << "error reset";
  EXPECT_EQ(read(0x1001), 0);
  node_.axis().trip(0x7305);
  pass(0.01);
  control(0x80);
  EXPECT_EQ(state(), kFault) << "bit 7 did not rise";
}

TEST_F(DriveAxis, StopsQuicklyAsItsOptionCodeSays) {
  for (const int code : {0, 1, 2, 3, 5, 6, 7}) {
    SCOPED_TRACE(code);
    EXPECT_EQ(write(0x605A, 0, code, 2), 0U);
    EXPECT_EQ(write(0x60FF, 0, 1000000, 4), 0U);
    EXPECT_EQ(write(0x6084, 0, 20000000, 4), 0U);  // half of what 2 does
    EXPECT_EQ(write(0x6085, 0, 40000000, 4), 0U);
    enable(3);
    pass(0.4);
    EXPECT_NEAR(static_cast<double>(read(0x606C)), 1e6, 5000);
    EXPECT_EQ(write(0x6040, 0, 0x0B, 2), 0U);
    double stopped_s = 0;
    while (std::abs(read(0x606C)) > 3000 && stopped_s < 1) {
      pass(0.0005);
      stopped_s += 0.0005;
    }
    if (code == 1 || code == 5) {
      EXPECT_NEAR(stopped_s, 0.05, 0.006);
    }
    if (code == 2 || code == 6) {
      EXPECT_NEAR(stopped_s, 0.025, 0.005);
    }
    if (code == 3 || code == 7) {
      EXPECT_LT(stopped_s, 0.018);
    }
    pass(0.02);
    EXPECT_EQ(state(), code >= 5 ? kQuickStop : kSwitchOnDisabled);
    if (code >= 5) {
      control(0x0F);
      EXPECT_EQ(state(), kEnabled);  // 16
    }
    control(0x00);
  }
}

TEST_F(DriveAxis, SlowsDownBeforeItDisablesWhereTheOptionCodesSaySo) {
  EXPECT_EQ(write(0x605B, 0, 1, 2), 0U);
  EXPECT_EQ(write(0x60FF, 0, 1000000, 4), 0U);
  for (const int word : {0x06, 0x07}) {
    enable(3);
    pass(0.3);
    control(static_cast<std::uint16_t>(word));
    EXPECT_EQ(state(), kEnabled) << "it slows down first";
    pass(0.12);
    EXPECT_EQ(state(), word == 0x06 ? kReady : kSwitchedOn);
    EXPECT_EQ(read(0x606C), 0);
    control(0x00);
  }
}

TEST_F(DriveAxis, PositionsByProfilesWithTheHandshakeOfSetpoints) {
  enable(1);
  EXPECT_EQ(write(0x607A, 0, 400000, 4), 0U);
  control(0x1F);
  EXPECT_EQ(status() & 0x1000, 0x1000) << "acknowledged";
  EXPECT_EQ(status() & 0x0400, 0);
  control(0x0F);
  EXPECT_EQ(status() & 0x1000, 0);
  EXPECT_EQ(write(0x607A, 0, -100000, 4), 0U);
  control(0x5F);  // relative, after this one
  EXPECT_EQ(status() & 0x1000, 0x1000);
  control(0x0F);
  EXPECT_EQ(status() & 0x1000, 0x1000) << "no room for another";
  double furthest = 0;
  for (int i = 0; i < 1000; ++i) {
    pass(0.001);
    furthest = std::max(furthest, static_cast<double>(read(0x6064)));
  }
  EXPECT_NEAR(furthest, 400000, 100);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 300000, 100);
  EXPECT_EQ(status() & 0x1400, 0x0400) << "target reached, room for another";
  EXPECT_EQ(write(0x607A, 0, 500000, 4), 0U);
  control(0x1F);
  control(0x0F);
  pass(0.1);
  EXPECT_EQ(write(0x607A, 0, 0, 4), 0U);
  control(0x3F);  // at once
  pass(1.5);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 0, 100);
  EXPECT_EQ(write(0x607A, 0, 500000, 4), 0U);
  control(0x0F);
  control(0x1F);
  pass(0.1);
  control(0x11F);  // halt
  pass(0.3);
  const std::int64_t halted = read(0x6064);
  EXPECT_EQ(status() & 0x0400, 0x0400) << "halted";
  pass(0.1);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), static_cast<double>(halted), 10);
  control(0x1F);
  pass(1.5);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 500000, 100);
}

TEST_F(DriveAxis, KeepsItsProfilesVelocityAndAcceleration) {
  enable(3);
  EXPECT_EQ(write(0x60FF, 0, 2000000, 4), 0U);
  EXPECT_EQ(write(0x6083, 0, 5000000, 4), 0U);
  pass(0.2);
  EXPECT_NEAR(static_cast<double>(read(0x606C)), 1e6, 20000);
  EXPECT_EQ(status() & 0x0400, 0);
  pass(0.3);
  EXPECT_NEAR(static_cast<double>(read(0x606C)), 2e6, 10000);
  EXPECT_EQ(status() & 0x0400, 0x0400);
}

// Red where an offset is not honoured, or where the brake opens with the load's torque twice.
TEST_F(DriveAxis, FollowsNearerWithTheOffsetsOfVelocityAndTorque) {
  EXPECT_EQ(write(0x60C2, 1, 1, 1), 0U);  // 1 ms
  EXPECT_EQ(write(0x2002, 0, 0, 2), 0U);  // what it knows of the velocity is what the master tells
  const fieldbus::AxisPlantParameters plant;
  const double permille_per_count = plant.inertia_kg_m2() * 2 * M_PI / kTurn / plant.rated_torque_nm * 1000;
  std::array<double, 3> largest{};
  enable(8);
  double from = static_cast<double>(read(0x6064));
  for (std::size_t run = 0; run < largest.size(); ++run) {
    for (int i = 1; i <= 400; ++i) {
      const double w = 2 * M_PI / 0.2, t = i * 0.001, amplitude = 65536;
      EXPECT_EQ(write(0x607A, 0, std::lround(from + amplitude * (1 - std::cos(w * t))), 4), 0U);
      const double velocity = run > 0 ? amplitude * w * std::sin(w * (t - 0.0005)) : 0;
      EXPECT_EQ(write(0x60B1, 0, std::lround(velocity), 4), 0U);
      const double acceleration = run > 1 ? amplitude * w * w * std::cos(w * (t - 0.0005)) : 0;
      EXPECT_EQ(write(0x60B2, 0, std::lround(permille_per_count * acceleration), 2), 0U);
      pass(0.001);
      if (i > 100) largest.at(run) = std::max(largest.at(run), std::abs(static_cast<double>(read(0x60F4))));
    }
    EXPECT_EQ(write(0x60B1, 0, 0, 4), 0U);
    EXPECT_EQ(write(0x60B2, 0, 0, 2), 0U);
    pass(0.3);
    from = static_cast<double>(read(0x6064));
  }
  EXPECT_LT(largest[1], largest[0] / 3) << "velocity";
  EXPECT_LT(largest[2], largest[1] / 2) << "torque";
  RecordProperty("alone_counts", std::to_string(largest[0]));
  RecordProperty("velocity_counts", std::to_string(largest[1]));
  RecordProperty("velocity_and_torque_counts", std::to_string(largest[2]));
}

/// Cyclic modes by PDO, as a master does.
TEST_F(DriveAxis, FollowsCyclicPositionsVelocitiesAndTorques) {
  EXPECT_EQ(write(0x60C2, 1, 2, 1), 0U);  // 2 ms
  enable(8);
  for (int i = 1; i <= 200; ++i) {
    EXPECT_EQ(write(0x607A, 0, std::lround(65536 * (1 - std::cos(i * 0.02))), 4), 0U);
    pass(0.002);
  }
  const double wanted = 65536 * (1 - std::cos(200 * 0.02));
  pass(0.2);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), wanted, 50);
  EXPECT_EQ(status() & 0x1000, 0x1000) << "it follows";
  EXPECT_EQ(write(0x6060, 0, 9, 1), 0U);
  EXPECT_EQ(write(0x60FF, 0, -500000, 4), 0U);
  pass(0.1);
  EXPECT_NEAR(static_cast<double>(read(0x606C)), -500000, 5000);
  EXPECT_EQ(read(0x6061), 9);
  EXPECT_EQ(write(0x6060, 0, 10, 1), 0U);
  EXPECT_EQ(write(0x6071, 0, 200, 2), 0U);
  pass(0.01);
  EXPECT_EQ(read(0x6077), 200);
  const double before = static_cast<double>(read(0x606C));
  pass(0.01);
  // 0.2 of the rated torque against friction on the inertia of the table's axis.
  const fieldbus::AxisPlantParameters plant;
  const double free_run = (0.2 * plant.rated_torque_nm) / plant.inertia_kg_m2() * kTurn / (2 * M_PI) * 0.01;
  const double gained = static_cast<double>(read(0x606C)) - before;
  EXPECT_GT(gained, 0.6 * free_run);
  EXPECT_LT(gained, 1.3 * free_run);
}

TEST_F(DriveAxis, FaultsBeyondItsFollowingErrorWindow) {
  EXPECT_EQ(write(0x6065, 0, 1000, 4), 0U);
  enable(8);
  EXPECT_EQ(write(0x607A, 0, 2000000, 4), 0U);
  pass(0.3);
  EXPECT_EQ(state(), kFault);
  EXPECT_EQ(read(0x603F), static_cast<std::int16_t>(0x8611));
}

TEST_F(DriveAxis, ComesToRestInItsLimitSwitches) {
  for (const int direction : {1, -1}) {
    enable(3);
    EXPECT_EQ(write(0x2000, 1, -200000, 4), 0U);
    EXPECT_EQ(write(0x2000, 2, 200000, 4), 0U);
    EXPECT_EQ(write(0x60FF, 0, direction * 655360, 4), 0U);
    pass(1.5);
    EXPECT_NEAR(static_cast<double>(read(0x6064)), direction * 200000, 5000);
    EXPECT_EQ(status() & 0x0800, 0x0800) << "internal limit active";
    EXPECT_EQ(read(0x60FD), direction > 0 ? 2 : 1);
    EXPECT_EQ(write(0x60FF, 0, -direction * 655360, 4), 0U);
    pass(0.3);
    EXPECT_LT(std::abs(read(0x6064)), 150000) << "out of it again";
    EXPECT_EQ(read(0x60FD), 0);
    control(0);
  }
}

TEST_F(DriveAxis, StopsAtItsSoftwareLimits) {
  enable(1);
  EXPECT_EQ(write(0x607D, 1, -50000, 4), 0U);
  EXPECT_EQ(write(0x607D, 2, 50000, 4), 0U);
  EXPECT_EQ(write(0x607A, 0, 400000, 4), 0U);
  control(0x1F);
  pass(1);
  EXPECT_NEAR(static_cast<double>(read(0x6064)), 50000, 100);
  EXPECT_EQ(status() & 0x0800, 0x0800);
}

TEST_F(DriveAxis, StaysInFaultWhileItIsTooHot) {
  enable(3);
  node_.axis().set_overheated(true);
  pass(0.05);
  EXPECT_EQ(state(), kFault);
  EXPECT_EQ(read(0x603F), 0x4310);
  EXPECT_EQ(last(0x085).data[2], 0x09) << "generic and temperature";
  control(0x80);
  pass(0.01);
  EXPECT_EQ(state(), kFault);
  control(0x00);
  node_.axis().set_overheated(false);
  control(0x80);
  EXPECT_EQ(state(), kSwitchOnDisabled);
}

TEST_F(DriveAxis, TellsAJumpOfItsEncoderAndNotOfItsShaft) {
  const std::int64_t before = read(0x6064);
  node_.axis().shift_encoder(12345);
  EXPECT_EQ(read(0x6064), before + 12345);
  EXPECT_EQ(node_.axis().shaft(), 0);
}

/// Homing on a travel with limit switches at both ends, a cam, and an index pulse in every turn.
class DriveHoming : public NodeBench {
 protected:
  static constexpr std::int32_t kNegative = -700000;
  static constexpr std::int32_t kPositive = 900000;
  static constexpr std::int32_t kCamFrom = 100000;
  static constexpr std::int32_t kCamTo = 230000;
  static constexpr std::int32_t kIndex = 30000;
  static constexpr double kTolerance = 60;  // counts: friction, and the step in which the edge is seen

  void SetUp() override {
    write_switches(kCamFrom, kCamTo);
    EXPECT_EQ(write(0x6099, 2, 16384, 4), 0U);
    EXPECT_EQ(write(0x607C, 0, 777, 4), 0U);
  }
  void write_switches(std::int32_t from, std::int32_t to) {
    EXPECT_EQ(write(0x2000, 1, kNegative, 4), 0U);
    EXPECT_EQ(write(0x2000, 2, kPositive, 4), 0U);
    EXPECT_EQ(write(0x2000, 3, from, 4), 0U);
    EXPECT_EQ(write(0x2000, 4, to, 4), 0U);
    EXPECT_EQ(write(0x2000, 5, kIndex, 4), 0U);
  }
  void go_to(std::int32_t position) {
    enable(1);
    EXPECT_EQ(write(0x6081, 0, 4000000, 4), 0U);
    EXPECT_EQ(write(0x607A, 0, position - std::lround(node_.axis().shaft()) + read(0x6064), 4), 0U);
    control(0x1F);
    pass(1);
    control(0x0F);
    EXPECT_NEAR(node_.axis().shaft(), position, 100);
  }
  /// Where the shaft was when it was at home: zero lies beyond it by the home offset.
  double home_found(int method) {
    enable(6);
    EXPECT_EQ(write(0x6098, 0, method, 1), 0U);
    EXPECT_EQ(status() & 0x3400, 0x0400) << "not homed, at rest";
    control(0x1F);
    for (int i = 0; i < 400 && (status() & 0x3000) == 0; ++i) pass(0.05);
    EXPECT_EQ(status() & 0x3400, 0x1400) << "homing attained";
    control(0x0F);
    const double home = node_.axis().shaft() - node_.axis().position() - 777;
    return home;
  }
};

/// The first index pulse at or beyond `from`, seen in `direction`.
double next_index(double from, int direction, double index) {
  const double turns = (from - index) / kTurn;
  return index + kTurn * (direction > 0 ? std::ceil(turns) : std::floor(turns));
}

TEST_F(DriveHoming, FindsHomeByEveryMethodFromEverywhere) {
  struct Row {
    int method;
    double edge;
    int direction;  ///< from the edge to the index
  };
  constexpr double kCamSide = kCamFrom;
  constexpr double kFarSide = kCamTo;
  const std::array rows{Row{1, kNegative, 1}, Row{2, kPositive, -1}, Row{7, kCamSide, -1}, Row{8, kCamSide, 1},
                        Row{9, kFarSide, -1}, Row{10, kFarSide, 1},  Row{11, kFarSide, 1}, Row{12, kFarSide, -1},
                        Row{13, kCamSide, 1}, Row{14, kCamSide, -1}};
  for (const Row& row : rows) {
    for (const std::int32_t start : {-400000, 150000, 600000}) {
      SCOPED_TRACE("method " + std::to_string(row.method) + " from " + std::to_string(start));
      go_to(start);
      EXPECT_NEAR(home_found(row.method), next_index(row.edge, row.direction, kIndex), kTolerance);
      go_to(start);
      EXPECT_NEAR(home_found(row.method + 16), row.edge, kTolerance);
    }
  }
}

TEST_F(DriveHoming, FindsTheEdgeOfASwitchThatStaysClosed) {
  // 3, 4, 19, 20: closed to the positive side; 5, 6, 21, 22: to the negative.
  for (const std::int32_t start : {-400000, 600000}) {
    for (const int method : {3, 4, 19, 20}) {
      SCOPED_TRACE("method " + std::to_string(method) + " from " + std::to_string(start));
      write_switches(kCamFrom, 2000000);
      go_to(start);
      const int direction = method % 16 == 3 ? -1 : 1;
      const double edge = kCamFrom;
      EXPECT_NEAR(home_found(method), method > 16 ? edge : next_index(edge, direction, kIndex), kTolerance);
    }
    for (const int method : {5, 6, 21, 22}) {
      SCOPED_TRACE("method " + std::to_string(method) + " from " + std::to_string(start));
      write_switches(-2000000, kCamTo);
      go_to(start);
      const int direction = method % 16 == 5 ? 1 : -1;
      const double edge = kCamTo;
      EXPECT_NEAR(home_found(method), method > 16 ? edge : next_index(edge, direction, kIndex), kTolerance);
    }
  }
}

TEST_F(DriveHoming, TakesTheIndexOrThePlaceWhereItStands) {
  go_to(50000);
  EXPECT_NEAR(home_found(33), kIndex, kTolerance);
  go_to(50000);
  EXPECT_NEAR(home_found(34), kIndex + kTurn, kTolerance);
  for (const int method : {35, 37}) {
    go_to(50000);
    EXPECT_NEAR(home_found(method), 50000, 100);
    EXPECT_NEAR(static_cast<double>(read(0x6064)), -777, 3) << "the home offset";
  }
}

TEST_F(DriveHoming, FailsWhereThereIsNoSwitch) {
  write_switches(2000000, 2000001);
  enable(6);
  EXPECT_EQ(write(0x6098, 0, 24, 1), 0U);
  control(0x1F);
  pass(8);
  EXPECT_EQ(status() & 0x3400, 0x2400) << "homing error, at rest";
  EXPECT_EQ(write(0x6098, 0, 15, 1), 0x06090030U) << "reserved";
}

}  // namespace
}  // namespace rmac::vdrive::test

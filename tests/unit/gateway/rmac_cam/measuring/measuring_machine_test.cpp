// Measuring by touch on the simulated bus: the probe's contact bounces, the part is where device.json puts it, and the
// controller knows neither.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using sdk::ControlMode;
using sdk::MeasureParameter;
using testing::HasSubstr;

constexpr double kRadius = 1;
/// 5 mm of pitch on 131072 counts.
constexpr double kCount_mm = 5.0 / 131072;

sdk::DeviceObject measuring_mill() {
  sdk::DeviceObject device = TestMachine::mill();
  device.inputs = {{"Probe", 3}};
  device.digital_io_interface = {"SimulatedIOInterface",
                                 {{"probe_input", {3}},
                                  {"probe_radius_mm", {kRadius}},
                                  {"probe_bounce_ms", {3}},
                                  {"part_block_mm", {-20, -15, -40, 20, 15, -20}},
                                  {"sphere_mm", {35, 35, -20, 10}}},
                                 {}};
  return device;
}

class Measuring : public testing::Test {
 protected:
  void SetUp() override { load(measuring_mill()); }
  void load(const sdk::DeviceObject& device) {
    const auto loaded = machine_.load_at_zero(device);
    ASSERT_TRUE(loaded) << loaded.error().message;
    start(sdk::CycleMode::Automatic);
  }
  void start(sdk::CycleMode mode) { ASSERT_TRUE(machine_.controller.cam().cycle().start(mode)); }
  sdk::Measuring& measuring() { return machine_.controller.measuring(); }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  /// Until nothing is queued and nothing moves.
  void rest() {
    ASSERT_TRUE(
        machine_.run_until([&] { return cam().queue().moves_left() == 0 && !machine_.controller.sample().moving; }));
    machine_.controller.dispatch();
  }
  void go(const Vector& point) {
    const auto queued = cam().cmm_moves().to_point(1, point, 150);
    ASSERT_TRUE(queued) << queued.error().message;
    rest();
  }
  /// Measures a point; where the probe touched.
  Vector measure(const Vector& point) {
    const auto queued = measuring().auto_measure(7, point, 100);
    EXPECT_TRUE(queued) << queued.error().message;
    if (!queued) return {};
    rest();
    EXPECT_TRUE(measuring().new_hit());
    const auto hit = measuring().last_hit();
    EXPECT_TRUE(hit) << hit.error().message << machine_.last(Event::Kind::Stopped);
    return hit ? hit->pose.tip : Vector{};
  }
  [[nodiscard]] MinorCode last_code() const {
    MinorCode code = MinorCode::None;
    for (const Event& event : machine_.events) code = event.code != MinorCode::None ? event.code : code;
    return code;
  }
  TestMachine machine_;
};

TEST_F(Measuring, FindsThePartToTheEncodersCount) {
  std::mt19937 random(20261121);  // NOLINT(cert-msc51-cpp): the same sphere every time
  std::uniform_real_distribution<double> unit(-1, 1);
  constexpr int kTimes = kSanitized ? 15 : 60;
  for (int i = 0; i < kTimes; ++i) {
    Vector n{unit(random), unit(random), std::abs(unit(random)) + 0.2};
    const double length = std::hypot(n[0], n[1], n[2]);
    for (double& c : n) c /= length;
    const auto at = [&](double distance) {
      return Vector{35 + distance * n[0], 35 + distance * n[1], -20 + distance * n[2]};
    };
    go({35, 35, 2});  // clear of the sphere, wherever it was before
    go(at(10 + kRadius + 4));
    const Vector hit = measure(at(10 + kRadius));
    const double distance = std::hypot(hit[0] - 35, hit[1] - 35, hit[2] + 20);
    EXPECT_NEAR(distance, 10 + kRadius, 1e-4 + kCount_mm) << "at " << n[0] << ' ' << n[1] << ' ' << n[2];
    go(at(10 + kRadius + 4));
  }
  EXPECT_EQ(last_code(), MinorCode::None) << machine_.last(Event::Kind::Stopped);
  EXPECT_EQ(machine_.count(Event::Kind::Hit, 7), kTimes);
  EXPECT_EQ(machine_.count(Event::Kind::MoveStarted, 7), kTimes);
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 7), kTimes);
}

TEST_F(Measuring, TakesTheCountsThatTheDrivesLatched) {
  sdk::DeviceObject device = measuring_mill();
  for (sdk::Actuator& actuator : device.actuators) actuator.probe_edge = TouchProbeEdge::FirstRising;
  load(device);
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same sphere every time
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20; ++i) {
    Vector n{unit(random), unit(random), std::abs(unit(random)) + 0.2};
    const double length = std::hypot(n[0], n[1], n[2]);
    for (double& c : n) c /= length;
    const auto at = [&](double distance) {
      return Vector{35 + distance * n[0], 35 + distance * n[1], -20 + distance * n[2]};
    };
    go({35, 35, 2});
    go(at(10 + kRadius + 4));
    (void)measure(at(10 + kRadius));
    const auto hit = measuring().last_hit();
    ASSERT_TRUE(hit);
    double squared = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const double counts = hit->joints[j] / kCount_mm;
      EXPECT_NEAR(counts, std::round(counts), 1e-6) << "a whole count, and nothing between two";
      const double from = hit->joints[j] - std::array{35.0, 35.0, -20.0}[j];
      squared += from * from;
    }
    EXPECT_NEAR(std::sqrt(squared), 10 + kRadius, 2 * kCount_mm) << "no count is rounded by more than one";
    go(at(10 + kRadius + 4));
  }
  EXPECT_EQ(last_code(), MinorCode::None) << machine_.last(Event::Kind::Stopped);
  EXPECT_EQ(machine_.count(Event::Kind::Hit, 7), 20);
}

TEST_F(Measuring, StopsAtTheHitAndRetractsAlongTheSearch) {
  ASSERT_TRUE(measuring().set_parameter(MeasureParameter::RetractDistance, 4));
  go({0, 0, -10});
  machine_.samples.clear();
  const Vector hit = measure({0, 0, -19});
  EXPECT_NEAR(hit[2], -20 + kRadius, 1e-3);
  const CycleSample now = machine_.controller.sample();
  EXPECT_NEAR(now.position_set[2], hit[2] + 4, 1e-3);
  double lowest = 0, fastest = 0;
  for (const CycleSample& sample : machine_.samples) {
    lowest = std::min(lowest, sample.position_set[2]);
    if (sample.position_set[2] < -16.5 && sample.velocity_set[2] < 0) {
      fastest = std::max(fastest, -sample.velocity_set[2]);
    }
  }
  EXPECT_GT(lowest, hit[2] - 0.5) << "5 mm/s are stopped within half a millimetre";
  EXPECT_LT(fastest, measuring().parameter(MeasureParameter::ScanSpeed) + 0.1) << "the last 3 mm are the search";
}

TEST_F(Measuring, NeverRetractsBehindWhereItsApproachBegan) {
  ASSERT_TRUE(measuring().set_parameter(MeasureParameter::RetractDistance, 30));
  go({0, 0, -15});
  (void)measure({0, 0, -19});
  EXPECT_NEAR(machine_.controller.sample().position_set[2], -15, 1e-3);
}

TEST_F(Measuring, SaysThatThePartIsNotThereAndStops) {
  go({0, 0, 20});
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, 5}, 100));
  ASSERT_TRUE(machine_.run_until([&] { return last_code() != MinorCode::None; }));
  EXPECT_EQ(last_code(), MinorCode::PartNotFound);
  EXPECT_NEAR(machine_.controller.sample().position_set[2], 0, 1e-3) << "5 mm beyond the point";
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
  EXPECT_EQ(machine_.count(Event::Kind::MoveDone, 7), 0);
  EXPECT_FALSE(measuring().new_hit());
  EXPECT_FALSE(measuring().last_hit());
}

TEST_F(Measuring, AHitThatIsNoSearchStopsTheMachine) {
  ASSERT_TRUE(cam().cmm_moves().to_point(3, {0, 0, -25}, 20));
  ASSERT_TRUE(machine_.run_until([&] { return last_code() != MinorCode::None; }));
  EXPECT_EQ(last_code(), MinorCode::UnexpectedHit);
  EXPECT_EQ(cam().queue().moves_left(), 0);
  EXPECT_GT(machine_.controller.sample().position_set[2], -22);
  const auto refused = measuring().auto_measure(7, {0, 0, -30}, 20);
  ASSERT_FALSE(refused) << "the probe touches";
  EXPECT_EQ(refused.error().code, MinorCode::ProbeNotArmed);
  ASSERT_TRUE(cam().positioning().jog_path({{0, 0, 1}}, 5)) << "off it is free";
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.cycle_now().state == CycleState::Idle; }));
  start(sdk::CycleMode::Automatic);
  go({0, 0, -10});
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Running);
}

TEST_F(Measuring, AHitOnTheApproachIsUnexpected) {
  go({0, 0, -10});
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -30}, 40)) << "the surface lies 10 mm before the point";
  ASSERT_TRUE(machine_.run_until([&] { return last_code() != MinorCode::None; }));
  EXPECT_EQ(last_code(), MinorCode::UnexpectedHit);
  EXPECT_EQ(machine_.controller.cycle_now().state, CycleState::Idle);
}

TEST_F(Measuring, TakesNoMoveBehindAMeasurement) {
  go({0, 0, -10});
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -19}, 10));
  EXPECT_EQ(cam().queue().moves_left(), 1);
  EXPECT_EQ(measuring().control_mode(), ControlMode::AutomaticMeasure);
  const auto refused = cam().cmm_moves().to_point(8, {0, 0, 0}, 10);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::CommandQueueFull);
  rest();
  EXPECT_EQ(measuring().control_mode(), ControlMode::AutomaticMove);
  EXPECT_TRUE(cam().cmm_moves().to_point(8, {0, 0, 0}, 10));
}

TEST_F(Measuring, RefusesWhatItCannotReachWithoutMoving) {
  go({0, 0, -10});
  const auto refused = measuring().auto_measure(7, {0, 0, -48}, 10);
  ASSERT_FALSE(refused) << "the search would end beyond the travel of Z";
  EXPECT_EQ(refused.error().code, MinorCode::TravelLimit);
  EXPECT_EQ(cam().queue().moves_left(), 0);
  EXPECT_NEAR(measure({0, 0, -19})[2], -19, 1e-3) << "what was refused left nothing behind";
}

TEST_F(Measuring, RunsAsOneMoveInManualMode) {
  go({0, 0, -10});
  ASSERT_TRUE(cam().cycle().stop_now());
  rest();
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.cycle_now().state == CycleState::Idle; }));
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -19}, 50));
  start(sdk::CycleMode::Manual);
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.cycle_now().state == CycleState::Idle; }));
  machine_.controller.dispatch();
  EXPECT_TRUE(measuring().new_hit());
  EXPECT_NEAR(machine_.controller.sample().position_set[2], -16, 1e-2);
}

TEST_F(Measuring, GoesOnAfterAHoldInTheSearch) {
  go({0, 0, -10});
  // Virtual time is at most four seconds ahead of who reads its samples: not as far as the surface.
  ASSERT_TRUE(measuring().set_parameter(MeasureParameter::ScanSpeed, 0.2));
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -19}, 50));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.sample().position_set[2] < -17; }));
  ASSERT_TRUE(cam().cycle().hold());
  ASSERT_TRUE(machine_.run_until([&] { return !machine_.controller.sample().moving; }));
  EXPECT_FALSE(measuring().new_hit());
  ASSERT_TRUE(cam().cycle().resume());
  rest();
  EXPECT_TRUE(measuring().new_hit());
}

TEST_F(Measuring, ByHandJogsUntilItTouches) {
  go({0, 0, -15});
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.cycle_now().state == CycleState::Idle; }));
  ASSERT_TRUE(measuring().manual_measure());
  EXPECT_EQ(measuring().control_mode(), ControlMode::Manual);
  ASSERT_TRUE(cam().path().set_feedrate(300));
  ASSERT_TRUE(cam().positioning().jog_path({{0, 0, -1}}, 20));
  rest();
  ASSERT_TRUE(machine_.run_until([&] { return measuring().new_hit(); }));
  const auto hit = measuring().last_hit();
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->pose.tip[2], -20 + kRadius, 1e-4 + kCount_mm);
  EXPECT_EQ(last_code(), MinorCode::None);
  ASSERT_TRUE(cam().positioning().jog_path({{0, 0, 1}}, 3)) << "from the part, while the probe still touches";
  rest();
  EXPECT_EQ(last_code(), MinorCode::None);
}

TEST_F(Measuring, ByHandAMoveEndsAtTheHitToo) {
  go({0, 0, -15});
  ASSERT_TRUE(measuring().manual_measure());
  ASSERT_TRUE(cam().cmm_moves().to_point(3, {0, 0, -25}, 20));
  ASSERT_TRUE(cam().cmm_moves().to_point(4, {5, 0, -25}, 20));
  ASSERT_TRUE(machine_.run_until([&] { return measuring().new_hit(); }));
  EXPECT_NEAR(measuring().last_hit()->pose.tip[2], -20 + kRadius, 1e-4 + kCount_mm);
  ASSERT_TRUE(machine_.run_until([&] { return machine_.controller.last_stop().has_value(); }));
  EXPECT_EQ(last_code(), MinorCode::None);
  EXPECT_THAT(machine_.last(Event::Kind::Stopped), HasSubstr("as ManualMeasure expects"));
  EXPECT_EQ(cam().queue().moves_left(), 0U) << "what was to follow knows nothing of the part";
  ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(cam().cmm_moves().to_point(5, {0, 0, -15}, 20)) << "from the part, while the probe still touches";
  rest();
  EXPECT_NEAR(machine_.controller.sample().position_set[2], -15, 1e-2);
}

TEST_F(Measuring, FramesStayUntilAPointIsMeasured) {
  go({0, 0, -10});
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -19}, 10));
  Frame moved;
  moved.p = {1, 0, 0};
  // At every instant of it, also while the machine stands between the hit and the way back.
  int refused = 0;
  while (cam().queue().moves_left() > 0) {
    if (!cam().frames().set_part(moved)) ++refused;
    machine_.controller.dispatch();
  }
  EXPECT_GT(refused, 0);
  EXPECT_NEAR(measuring().last_hit()->pose.tip[2], -20 + kRadius, 1e-3);
}

TEST_F(Measuring, ARetractThatDoesNotFreeTheProbeIsAnError) {
  ASSERT_TRUE(measuring().set_parameter(MeasureParameter::RetractDistance, 1e-3));
  ASSERT_TRUE(measuring().set_parameter(MeasureParameter::ScanSpeed, 2));
  go({0, 0, -10});
  ASSERT_TRUE(measuring().auto_measure(7, {0, 0, -19}, 50));
  ASSERT_TRUE(machine_.run_until([&] { return last_code() != MinorCode::None; }));
  EXPECT_EQ(last_code(), MinorCode::ProbeNotArmed);
}

TEST_F(Measuring, PartFrameOfWhereItStandsReadsZero) {
  go({12, -7, -10});
  ASSERT_TRUE(measuring().set_calibrated_part_frame());
  ASSERT_TRUE(machine_.run_until([&] { return std::abs(machine_.controller.sample().pose_set.tip[0]) < 1e-6; }));
  const ToolPose pose = machine_.controller.sample().pose_set;
  for (const double c : pose.tip) EXPECT_NEAR(c, 0, 1e-9);
  EXPECT_NEAR(pose.axis[2], 1, 1e-12);
}

TEST_F(Measuring, MovesAtTheSpeedsThatItsMovesBring) {
  machine_.samples.clear();
  ASSERT_TRUE(cam().cmm_moves().to_point(1, {0, 30, 0}, 40));
  rest();
  EXPECT_NEAR(machine_.peak_velocity(1), 40, 1e-3);
  machine_.samples.clear();
  ASSERT_TRUE(cam().cmm_moves().all_joints(2, {30, -10, 0}, 50));
  rest();
  EXPECT_NEAR(std::hypot(machine_.peak_velocity(0), machine_.peak_velocity(1)), 50, 0.2);
  const auto too_fast = cam().cmm_moves().all_joints(3, {-30, -10, 0}, 201);
  ASSERT_FALSE(too_fast);
  EXPECT_EQ(too_fast.error().code, MinorCode::SpeedLimit);
  machine_.samples.clear();
  // A quarter about (20, -10), from (30, -10) to (20, 0).
  ASSERT_TRUE(cam().cmm_moves().in_arc(4, {{20, 0, 0}, {20, -10, 0}, {0, 0, 1}}, 25));
  rest();
  for (const CycleSample& sample : machine_.samples) {
    EXPECT_NEAR(std::hypot(sample.position_set[0] - 20, sample.position_set[1] + 10), 10, 1e-6);
  }
  EXPECT_NEAR(machine_.controller.sample().position_set[1], 0, 1e-6);
}

TEST(MeasuringProbe, IsSwitchedBySpinningIt) {
  TestMachine machine;
  sdk::DeviceObject device = measuring_mill();
  device.inputs["ProbeReady"] = 4;
  device.digital_io_interface.numbers["probe_ready"] = {4};
  device.digital_io_interface.numbers["probe_switch_rpm"] = {300};
  ASSERT_TRUE(machine.load_at_zero(device));
  sdk::Measuring& measuring = machine.controller.measuring();
  EXPECT_FALSE(measuring.probe_active());
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  const auto refused = measuring.auto_measure(7, {0, 0, -19}, 50);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::ProbeNotArmed);
  EXPECT_THAT(refused.error().message, HasSubstr("SpinProbe"));
  ASSERT_TRUE(measuring.spin_probe(500, 1));
  EXPECT_TRUE(machine.run_until([&] { return measuring.probe_active(); }));
  EXPECT_TRUE(machine.run_until([&] { return machine.controller.sample().spindle_rpm[0] == 0; }));
}

TEST(MeasuringProbe, IsMissedWhereThereIsNone) {
  TestMachine machine;
  ASSERT_TRUE(machine.load_at_zero(TestMachine::mill()));
  sdk::Measuring& measuring = machine.controller.measuring();
  EXPECT_FALSE(measuring.probe_active());
  const auto refused = measuring.manual_measure();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::ProbeNotArmed);
  EXPECT_THAT(refused.error().message, HasSubstr("Mill has no probe"));
}

TEST(MeasuringProbe, ThatIsBrushedBeforeItSearchesHasNotFoundThePart) {
  TestMachine machine;
  sdk::DeviceObject device = TestMachine::mill();
  device.inputs = {{"Probe", 3}};
  ASSERT_TRUE(machine.load_at_zero(device));
  sdk::Measuring& measuring = machine.controller.measuring();
  ASSERT_TRUE(measuring.set_parameter(MeasureParameter::PrehitDistance, 20));
  ASSERT_TRUE(measuring.auto_measure(7, {0, 0, -1}, 5));
  for (const std::uint64_t inputs : {std::uint64_t{1} << 3, std::uint64_t{0}}) {
    machine.io->set_inputs(inputs);
    ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().inputs == inputs; }));
  }
  const double let_go_s = machine.controller.sample().t_s;
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().t_s > let_go_s + 0.1; })) << "it settles";
  EXPECT_EQ(measuring.control_mode(), ControlMode::AutomaticMeasure) << "it has still to be measured";
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(machine.run_until_event(Event::Kind::Stopped));
  EXPECT_EQ(std::ranges::find(machine.events, Event::Kind::Stopped, &Event::kind)->code, MinorCode::PartNotFound);
  EXPECT_EQ(machine.count(Event::Kind::MoveDone, 7), 0);
}

TEST(MeasuringProbe, ThatIsDeflectedAlreadyIsNotDrivenIntoThePart) {
  // Found on the approach, and at the begin of a search that needs none.
  for (const double prehit_mm : {3.0, 20.0}) {
    TestMachine machine;
    sdk::DeviceObject device = TestMachine::mill();
    device.inputs = {{"Probe", 3}};
    ASSERT_TRUE(machine.load_at_zero(device));
    sdk::Measuring& measuring = machine.controller.measuring();
    ASSERT_TRUE(measuring.set_parameter(MeasureParameter::PrehitDistance, prehit_mm));
    ASSERT_TRUE(measuring.auto_measure(7, {0, 0, -10}, 5));
    machine.io->set_inputs(1U << 3);
    ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().inputs != 0; }));
    ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine.run_until_event(Event::Kind::Stopped));
    EXPECT_THAT(machine.last(Event::Kind::Stopped), HasSubstr("deflected before it could touch"));
    const auto stop = std::ranges::find(machine.events, Event::Kind::Stopped, &Event::kind);
    EXPECT_EQ(stop->code, MinorCode::ProbeNotArmed);
    EXPECT_GT(machine.controller.sample().position_set[2], -1) << "prehit " << prehit_mm;
    EXPECT_EQ(machine.controller.cam().queue().moves_left(), 0);
    EXPECT_TRUE(machine.controller.cam().positioning().jog_path({{0, 0, 1}}, 5)) << "off it is free";
  }
}

TEST(MeasuringProbe, IsTheClientsInVirtualMode) {
  TestMachine machine;
  machine.controller.set_mechanism_folder("", true);
  ASSERT_TRUE(machine.load(measuring_mill()));
  sdk::Measuring& measuring = machine.controller.measuring();
  // Virtual time is at most four seconds ahead of who reads its samples: not as far as the search goes.
  ASSERT_TRUE(measuring.set_parameter(MeasureParameter::ScanSpeed, 0.5));
  ASSERT_TRUE(machine.controller.cam().cycle().start(sdk::CycleMode::Automatic));
  ASSERT_TRUE(measuring.auto_measure(7, {0, 0, -19}, 20));
  ASSERT_TRUE(machine.run_until([&] { return machine.controller.sample().position_set[2] < -17; }));
  ASSERT_TRUE(measuring.simulate_probe({0, 0, -18.5}, true));
  ASSERT_TRUE(measuring.simulate_probe({0, 0, -18.5}, false));
  ASSERT_TRUE(machine.run_until([&] { return machine.count(Event::Kind::MoveDone, 7) > 0; }));
  EXPECT_NEAR(measuring.last_hit()->pose.tip[2], -18.5, 1e-12);
  EXPECT_EQ(machine.count(Event::Kind::Hit, 0) + machine.count(Event::Kind::Hit, 7), 1);
}

TEST_F(Measuring, LiveDrivesHaveNoSimulatedHits) {
  const auto refused = measuring().simulate_probe({0, 0, 0}, true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, MinorCode::UnsupportedOperation);
}

}  // namespace
}  // namespace rmac::gateway

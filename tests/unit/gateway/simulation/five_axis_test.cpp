#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/simulation/simulation.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "gateway/threads/sanitized.hpp"
#include "places.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Joints = std::array<double, kMaxJoints>;

constexpr double kRad = std::numbers::pi / 180;

Vector about_x(double degrees, const Vector& v) {
  const double c = std::cos(degrees * kRad), s = std::sin(degrees * kRad);
  return {v[0], c * v[1] - s * v[2], s * v[1] + c * v[2]};
}
Vector about_z(double degrees, const Vector& v) {
  const double c = std::cos(degrees * kRad), s = std::sin(degrees * kRad);
  return {c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
}
Vector sum(const Vector& a, const Vector& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

/// A machine, and its geometry written down a second time.
struct Machine {
  const char* name;
  ToolPose (*forward)(const Joints& q, const ToolPose& tool);
  std::size_t turn, tilt;  ///< joints C and A
};

/// The part turns by C about z and tilts by A about the line 60 mm below the origin; the tool stands still but for X,
/// Y, Z.
ToolPose table(const Joints& q, const ToolPose& tool) {
  const Vector tip = sum(tool.tip, {q[0], q[1], q[2] + 60});
  const Vector tilted = sum(about_x(q[3], tip), {0, 0, -60});
  return {about_z(q[4], tilted), about_z(q[4], about_x(q[3], tool.axis))};
}

/// The tool leans by A about a line 200 mm above the interface, and turns with that by C.
ToolPose head(const Joints& q, const ToolPose& tool) {
  const Vector leaning = sum(about_x(q[4], sum(tool.tip, {0, 0, -200})), {0, 0, 200});
  return {sum(about_z(q[3], leaning), {q[0], q[1], q[2]}), about_z(q[3], about_x(q[4], tool.axis))};
}

constexpr Machine kTable{"SuginoXYZAC", table, 4, 3};
constexpr Machine kHead{"TarusXYZCA", head, 3, 4};

void PrintTo(const Machine& machine, std::ostream* out) {
  *out << machine.name;
}

double angle(const Vector& a, const Vector& b) {
  const Vector across{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  return std::atan2(std::hypot(across[0], across[1], across[2]), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/// Tool axis that leans by `tilt` degrees from z, towards `around` degrees from x.
Vector leaning(double tilt, double around) {
  return about_z(around, {std::sin(tilt * kRad), 0, std::cos(tilt * kRad)});
}

/// How far a point is from the line between two others, and which part of the way along it.
std::pair<double, double> from_line(const Vector& point, const Vector& a, const Vector& b) {
  double along = 0, square = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (point[c] - a[c]) * (b[c] - a[c]);
    square += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double part = along / square;
  double off = 0;
  for (std::size_t c = 0; c < 3; ++c) off += std::pow(point[c] - a[c] - part * (b[c] - a[c]), 2);
  return {std::sqrt(off), part};
}

class FiveAxes : public testing::TestWithParam<Machine> {
 protected:
  void load() {
    auto opened = Simulation::open({.device_tree = std::string(RMAC_BINARY_DIR) + "/drivers"}, GetParam().name);
    ASSERT_TRUE(opened) << opened.error().message;
    simulation_ = std::move(*opened);
    simulation_->controller().on_sample([this](const CycleSample& sample) {
      if (sample.moving) trace_.push_back(sample);
    });
    expect(cam().path().set_feedrate(6000).and_then([&] { return cam().cycle().start(sdk::CycleMode::Automatic); }));
  }
  sdk::RmacCam& cam() { return simulation_->controller().cam(); }
  static void expect(const Expected<>& done) { ASSERT_TRUE(done) << done.error().message; }
  /// Puts the tool at a pose by turning joints.
  void go_to(const ToolPose& pose) {
    const auto joints = cam().queue().joints_at(pose);
    ASSERT_TRUE(joints) << joints.error().message;
    ASSERT_NO_FATAL_FAILURE(expect(cam().queue().add(1, JointTargetGeometry{*joints})));
    ASSERT_TRUE(run());
  }
  bool run() {
    for (int i = 0; i < 200'000; ++i) {
      simulation_->cycle();
      const CycleSample now = simulation_->controller().sample();
      if (cam().queue().moves_left() == 0 && !now.moving) return true;
    }
    return false;
  }
  void line(const ToolPose& from, const ToolPose& to) {
    ASSERT_NO_FATAL_FAILURE(expect(cam().queue().add(2, LineGeometry{from, to})));
  }
  /// Where these joints put the tool in the part frame, by the test's own geometry.
  [[nodiscard]] ToolPose where(const Joints& joints) const {
    return apply_to_pose(inverse(part_), GetParam().forward(joints, {tool_.p, z_axis(tool_)}));
  }
  void check_limits() const {
    const auto& limits = simulation_->controller().mechanism()->joints;
    for (std::size_t i = 1; i < trace_.size(); ++i) {
      for (std::size_t j = 0; j < limits.size(); ++j) {
        const JointLimits& joint = limits[j].limits;
        const double speed = trace_[i].velocity_set[j], acceleration = trace_[i].acceleration_set[j];
        const double jerk = (acceleration - trace_[i - 1].acceleration_set[j]) / 1e-3;
        ASSERT_LE(std::abs(speed), joint.max_speed * 1.000001) << joint.name << " in cycle " << i;
        ASSERT_LE(std::abs(acceleration), joint.max_acceleration * 1.000001) << joint.name << " in cycle " << i;
        ASSERT_LE(std::abs(jerk), joint.max_jerk * 1.01) << joint.name << " in cycle " << i;
        const double step = trace_[i].position_set[j] - trace_[i - 1].position_set[j];
        ASSERT_LE(std::abs(step), joint.max_speed * 1.001e-3) << joint.name << " jumps in cycle " << i;
        if (joint.limit_type != JointLimitType::Limited) continue;
        ASSERT_LE(trace_[i].position_set[j], joint.max + 1e-6) << joint.name;
        ASSERT_GE(trace_[i].position_set[j], joint.min - 1e-6) << joint.name;
      }
    }
  }
  /// Every setpoint holds the tip on the line, and the axis in step with it to within `lean` degrees.
  void check_line(const ToolPose& from, const ToolPose& to, double lean) const {
    ASSERT_GT(trace_.size(), 50U);
    const double whole = angle(from.axis, to.axis);
    for (const CycleSample& sample : trace_) {
      const ToolPose pose = where(sample.position_set);
      const auto [off, part] = from_line(pose.tip, from.tip, to.tip);
      ASSERT_LE(off, 1e-6) << "mm off the line, " << part << " along it";
      const double a = whole > 0 ? std::sin((1 - part) * whole) / std::sin(whole) : 1;
      const double b = whole > 0 ? std::sin(part * whole) / std::sin(whole) : 0;
      Vector wanted;
      for (std::size_t c = 0; c < 3; ++c) wanted[c] = a * from.axis[c] + b * to.axis[c];
      ASSERT_LE(angle(wanted, pose.axis), lean * kRad + 1e-8) << part << " along the line";
    }
  }

  /// How far C goes.
  [[nodiscard]] double peak_turn() const {
    const auto [least, most] = std::minmax_element(trace_.begin(), trace_.end(), [&](const auto& a, const auto& b) {
      return a.position_set[GetParam().turn] < b.position_set[GetParam().turn];
    });
    return trace_.empty() ? 0 : most->position_set[GetParam().turn] - least->position_set[GetParam().turn];
  }

  std::unique_ptr<Simulation> simulation_;
  std::vector<CycleSample> trace_;
  Frame part_, tool_;
};

INSTANTIATE_TEST_SUITE_P(Machines, FiveAxes, testing::Values(kTable, kHead),
                         [](const auto& made) { return made.param.name; });

TEST_P(FiveAxes, HoldTheTipOnItsLineWhileTheToolTurnsWhereverPartAndToolAre) {
  std::mt19937 random(20261121);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    ASSERT_NO_FATAL_FAILURE(load());
    const double turned = between(-180, 180) * kRad / 2;
    part_ = {{between(-20, 20), between(-20, 20), between(0, 20)}, {std::cos(turned), 0, 0, std::sin(turned)}};
    const double aslant = between(-5, 5) * kRad / 2;
    tool_ = {{between(-3, 3), between(-3, 3), -between(20, 80)}, {std::cos(aslant), std::sin(aslant), 0, 0}};
    ASSERT_NO_FATAL_FAILURE(
        expect(cam().frames().set_tool_interface(tool_).and_then([&] { return cam().frames().set_part(part_); })));
    // On one side of the pole, and 15 degrees off it at least.
    const double around = between(-180, 180);
    const auto somewhere = [&] {
      return ToolPose{{between(-25, 25), between(-25, 25), between(-20, 20)},
                      leaning(between(25, 50), around + between(-40, 40))};
    };
    const ToolPose from = somewhere(), to = somewhere();
    ASSERT_NO_FATAL_FAILURE(go_to(from));
    trace_.clear();
    ASSERT_NO_FATAL_FAILURE(line(from, to));
    ASSERT_TRUE(run());
    check_line(from, to, 0);
    check_limits();
    if (HasFatalFailure()) return;
    const ToolPose end = where(simulation_->controller().sample().position_set);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(end.tip[c], to.tip[c], 1e-6);
    EXPECT_LE(angle(end.axis, to.axis), 1e-8);
  }
}

TEST_P(FiveAxes, FollowANurbsOfTipAndAxis) {
  ASSERT_NO_FATAL_FAILURE(load());
  Nurbs curve;
  curve.degree = 3;
  curve.dimension = 6;
  curve.knots = {0, 0, 0, 0, 1, 2, 3, 3, 3, 3};
  for (int i = 0; i < 6; ++i) {
    const Vector axis = leaning(30 + 3 * i, 20 * i);
    curve.points.push_back({8.0 * i - 20, 10 * std::sin(1.3 * i), 4 * std::cos(2.1 * i), axis[0], axis[1], axis[2]});
    curve.weights.push_back(1);
  }
  const auto first = curve.points.front();
  const ToolPose from{{first[0], first[1], first[2]}, {first[3], first[4], first[5]}};
  ASSERT_NO_FATAL_FAILURE(go_to(from));
  trace_.clear();
  ASSERT_NO_FATAL_FAILURE(expect(cam().queue().add(3, NurbsGeometry{NurbsSpace::Pose, curve})));
  ASSERT_TRUE(run());
  ASSERT_GT(trace_.size(), 200U);
  for (const CycleSample& sample : trace_) {
    const ToolPose pose = where(sample.position_set);
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(pose.tip[c], sample.pose_set.tip[c], 1e-6);
    ASSERT_LE(angle(pose.axis, sample.pose_set.axis), 1e-8);
  }
  check_limits();
}

TEST_P(FiveAxes, WorkWithTheToolUprightWithoutTurningC) {
  ASSERT_NO_FATAL_FAILURE(load());
  const ToolPose from = simulation_->controller().sample().pose_set;
  ToolPose to = from;
  to.tip[0] += 30;
  to.tip[1] -= 20;
  ASSERT_NO_FATAL_FAILURE(line(from, to));
  ASSERT_TRUE(run());
  check_line(from, to, 0);
  check_limits();
  for (const CycleSample& sample : trace_) {
    ASSERT_EQ(sample.position_set[GetParam().turn], 0);
    ASSERT_EQ(sample.position_set[GetParam().tilt], 0);
  }
}

TEST_P(FiveAxes, RefuseByNameAmountAndPlaceWhatAJointCannotReach) {
  ASSERT_NO_FATAL_FAILURE(load());
  const ToolPose from{{0, 0, 0}, leaning(100, 90)}, to{{20, 0, 0}, leaning(125, 90)};
  ASSERT_NO_FATAL_FAILURE(go_to(from));
  const auto refused = cam().queue().add(2, LineGeometry{from, to});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              testing::ContainsRegex("joint A to -?11[0-9.]+ degrees, [0-9.]+ degrees beyond"));
  EXPECT_THAT(refused.error().message, testing::HasSubstr("mm along the move"));
}

/// Lines whose axis comes close to the one along which C turns.
class PastThePole : public FiveAxes {
 protected:
  static constexpr double kDeviation = 0.2;  // degrees, kPoleDeviation

  void follow(const ToolPose& from, const ToolPose& to) {
    trace_.clear();
    ASSERT_NO_FATAL_FAILURE(line(from, to));
    ASSERT_TRUE(run());
    check_line(from, to, kDeviation);
    check_limits();
    if (HasFatalFailure()) return;
    const ToolPose end = where(simulation_->controller().sample().position_set);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(end.tip[c], to.tip[c], 1e-6);
    EXPECT_LE(angle(end.axis, to.axis), 1e-6);
  }
};
INSTANTIATE_TEST_SUITE_P(Machines, PastThePole, testing::Values(kTable, kHead),
                         [](const auto& made) { return made.param.name; });

TEST_P(PastThePole, AToolLeansAnyWayFromUprightAndBack) {
  for (const double around : {0.0, 30.0, 90.0, -100.0, 170.0}) {
    SCOPED_TRACE("towards " + std::to_string(around));
    ASSERT_NO_FATAL_FAILURE(load());
    const ToolPose upright = simulation_->controller().sample().pose_set;
    const ToolPose leant{{20, 10, 5}, leaning(25, around)}, back{{0, 15, 0}, {0, 0, 1}};
    ASSERT_NO_FATAL_FAILURE(follow(upright, leant));
    ASSERT_NO_FATAL_FAILURE(follow(leant, back));
  }
}

TEST_P(PastThePole, TheTipHoldsItsLineHoweverCloseTheAxisPasses) {
  for (const double off : {0.0, 1e-9, 1e-5, 0.001, 0.05, 0.3, 5.0}) {
    for (const double around : {90.0, 20.0}) {
      SCOPED_TRACE("off by " + std::to_string(off) + " degrees, towards " + std::to_string(around));
      ASSERT_NO_FATAL_FAILURE(load());
      // The circle between the two axes passes the pole by about `off`.
      const double beside = std::asin(std::min(1.0, std::sin(off * kRad) / std::sin(20 * kRad))) / kRad;
      const ToolPose from{{-20, 0, 0}, leaning(20, around + beside)},
          to{{20, 5, 3}, leaning(20, around + 180 - beside)};
      ASSERT_NO_FATAL_FAILURE(go_to(from));
      ASSERT_NO_FATAL_FAILURE(follow(from, to));
    }
  }
}

TEST_P(PastThePole, SeededLinesKeepTipAndLimits) {
  std::mt19937 random(6);
  const auto between = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  const int rounds = kSanitized ? 4 : 15;  // a sanitizer makes minutes of each second
  for (int round = 0; round < rounds; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    ASSERT_NO_FATAL_FAILURE(load());
    tool_ = {{0, 0, -between(20, 80)}, {1, 0, 0, 0}};
    ASSERT_NO_FATAL_FAILURE(expect(cam().frames().set_tool_interface(tool_)));
    const auto somewhere = [&] {
      const Vector tip{between(-25, 25), between(-25, 25), between(-20, 20)};
      const double around = between(-180, 180), by = between(0, 12);  // one after the other: arguments have no order
      return ToolPose{tip, leaning(by, around)};
    };
    ToolPose from = somewhere();
    ASSERT_NO_FATAL_FAILURE(go_to(from));
    for (int i = 0; i < 3; ++i) {
      const ToolPose to = somewhere();
      ASSERT_NO_FATAL_FAILURE(follow(from, to));
      from = to;
    }
  }
}

TEST_P(PastThePole, StraightThroughItGoesOnWithoutAStop) {
  ASSERT_NO_FATAL_FAILURE(load());
  const ToolPose from{{-20, 0, 0}, leaning(15, 60)}, to{{20, 0, 0}, leaning(15, 240)};
  ASSERT_NO_FATAL_FAILURE(expect(cam().path().set_feedrate(600)));
  ASSERT_NO_FATAL_FAILURE(go_to(from));
  ASSERT_NO_FATAL_FAILURE(follow(from, to));
  for (const CycleSample& sample : trace_) {
    if (sample.s_mm < 5 || sample.s_mm > 35) continue;
    ASSERT_GT(sample.feed_set_mm_s, 5) << sample.s_mm << " mm along the line";
  }
}

TEST_P(PastThePole, AHeldMachineRunsBackThroughItAndForwardAgain) {
  ASSERT_NO_FATAL_FAILURE(load());
  const ToolPose from = simulation_->controller().sample().pose_set;
  const ToolPose to{{from.tip[0] + 20, from.tip[1], from.tip[2]}, leaning(20, 50)};
  int stops = 0;
  simulation_->controller().on_event([&](const Event& event) { stops += event.kind == Event::Kind::Stopped ? 1 : 0; });
  const auto stopped = [&](int count) {
    for (int i = 0; i < 100'000 && stops < count; ++i) simulation_->cycle();
    return stops == count;
  };
  trace_.clear();
  ASSERT_NO_FATAL_FAILURE(expect(cam().path().set_feedrate(600)));
  ASSERT_NO_FATAL_FAILURE(line(from, to));
  while (simulation_->controller().sample().s_mm < 10) simulation_->cycle();
  ASSERT_NO_FATAL_FAILURE(expect(cam().cycle().hold()));
  while (simulation_->controller().sample().moving) simulation_->cycle();
  EXPECT_LT(simulation_->controller().sample().s_mm, 15);
  const auto way = cam().cycle().retrace(1000);
  ASSERT_TRUE(way) << way.error().message;
  ASSERT_TRUE(stopped(1));
  EXPECT_NEAR(where(simulation_->controller().sample().position_set).tip[0], from.tip[0], 1e-6);
  ASSERT_NO_FATAL_FAILURE(expect(cam().cycle().resume()));
  ASSERT_TRUE(run());
  check_line(from, to, kDeviation);
  check_limits();
}

TEST_P(PastThePole, WhatWouldLeaveTheAxisMoreThanItMayIsRefusedWithPlaceAndAmount) {
  ASSERT_NO_FATAL_FAILURE(load());
  // The axis comes to the pole within a millimetre, and stays there for many.
  Nurbs curve;
  curve.degree = 2;
  curve.dimension = 6;
  const std::array<double, 9> leans{10, 5, 0, 0, 0, 0, 0, 5, 10};
  const std::array<double, 9> places{-20, -19.5, -19, -18.5, 0, 18.5, 19, 19.5, 20};
  for (std::size_t i = 0; i < leans.size(); ++i) {
    const Vector axis = leaning(leans[i], 40);
    curve.points.push_back({places[i], 0, 0, axis[0], axis[1], axis[2]});
    curve.weights.push_back(1);
  }
  curve.knots = {0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 7, 7};
  const ToolPose from{{-20, 0, 0}, leaning(10, 40)};
  ASSERT_NO_FATAL_FAILURE(go_to(from));
  const auto refused = cam().queue().add(3, NurbsGeometry{NurbsSpace::Pose, curve});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              testing::AllOf(testing::HasSubstr("move 3 passes the pole"), testing::HasSubstr("may by 0.200"),
                             testing::ContainsRegex("tip x -?[0-9.]+ y -?0.0000 z -?0.0000")));
  const ToolPose to{{20, 0, 0}, leaning(10, 40)};
  ASSERT_NO_FATAL_FAILURE(follow(from, to));  // nothing of it was queued
}

TEST_P(PastThePole, ACornerBesideItIsTakenExactlyAndNotRounded) {
  ASSERT_NO_FATAL_FAILURE(load());
  ASSERT_NO_FATAL_FAILURE(expect(cam().path().set_tolerance(0.05)));
  const ToolPose from{{-10, 0, 0}, leaning(8, 30)}, corner{{0, 0, 0}, {0, 0, 1}}, to{{0, 10, 0}, leaning(8, 120)};
  ASSERT_NO_FATAL_FAILURE(go_to(from));
  trace_.clear();
  ASSERT_NO_FATAL_FAILURE(line(from, corner));
  ASSERT_NO_FATAL_FAILURE(line(corner, to));
  ASSERT_TRUE(run());
  check_limits();
  double nearest = 1;
  for (const CycleSample& sample : trace_) {
    const ToolPose pose = where(sample.position_set);
    const double off =
        std::min(from_line(pose.tip, from.tip, corner.tip).first, from_line(pose.tip, corner.tip, to.tip).first);
    ASSERT_LE(off, 1e-6) << "the tip stays on the two lines";
    nearest = std::min(nearest, std::hypot(pose.tip[0], pose.tip[1]));
  }
  EXPECT_LT(nearest, 1e-6) << "through the corner itself";
}

/// Round and round: a C with an end of travel is refused where it would run into it, by name, and a joint target with
/// the tool clear of the part unwinds it. Nothing unwinds it in the middle of a cut.
TEST_P(FiveAxes, ACThatHasWoundUpIsRefusedByNameAndUnwoundByAJointTarget) {
  ASSERT_NO_FATAL_FAILURE(load());
  const auto& joints = simulation_->controller().mechanism()->joints;
  const bool ends = joints[GetParam().turn].limits.limit_type == JointLimitType::Limited;
  const auto around = [](int i) { return ToolPose{{10, 0, 0}, leaning(30, 60.0 * i)}; };
  ASSERT_NO_FATAL_FAILURE(go_to(around(0)));
  std::string refusal;
  int i = 0;
  for (; i < 15 && refusal.empty(); ++i) {
    ToolPose next = around(i + 1);
    next.tip[1] = 1.0 * (i % 2 == 0);
    ToolPose here = around(i);
    here.tip[1] = 1.0 * (i % 2 == 1);
    const auto queued = cam().queue().add(2, LineGeometry{here, next});
    if (!queued) refusal = queued.error().message;
    ASSERT_TRUE(run());
    if (refusal.empty()) continue;
    EXPECT_THAT(refusal, testing::AllOf(testing::ContainsRegex("joint C to -?[0-9.]+ degrees, [0-9.]+ degrees beyond"),
                                        testing::HasSubstr("mm along the move")));
    trace_.clear();
    ASSERT_NO_FATAL_FAILURE(go_to({{10, 0, 50}, next.axis}));
    EXPECT_GT(peak_turn(), 100) << "it unwinds";
    ASSERT_NO_FATAL_FAILURE(go_to(here));
    ASSERT_NO_FATAL_FAILURE(line(here, next));
    ASSERT_TRUE(run());
  }
  EXPECT_EQ(!refusal.empty(), ends) << "the table turns without end";
  check_limits();
}

/// All poses that some joint vector within the travel gives are reached within it, and by the quickest such vector.
TEST_P(FiveAxes, JointTargetsTakeTheQuickestSolutionInsideTheTravel) {
  ASSERT_NO_FATAL_FAILURE(load());
  const auto& joints = simulation_->controller().mechanism()->joints;
  std::mt19937 random(9);
  for (int round = 0; round < (kSanitized ? 15 : 60); ++round) {
    Joints wanted{};
    std::vector<double> start;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const JointLimits& limits = joints[j].limits;
      const bool turns = limits.type == JointType::Rotary;
      const double min = limits.limit_type == JointLimitType::Limited ? (turns ? limits.min : -40) : -500;
      const double max = limits.limit_type == JointLimitType::Limited ? (turns ? limits.max : 40) : 500;
      wanted[j] = std::uniform_real_distribution<>(min, max)(random);
      start.push_back(std::uniform_real_distribution<>(min, max)(random));
    }
    ASSERT_NO_FATAL_FAILURE(expect(cam().queue().add(1, JointTargetGeometry{start})));
    ASSERT_TRUE(run());
    const ToolPose pose = where(wanted);
    const auto found = cam().queue().joints_at(pose);
    ASSERT_TRUE(found) << found.error().message;
    Joints taken{};
    std::copy(found->begin(), found->end(), taken.begin());
    const ToolPose reached = where(taken);
    double longest = 0, known = 0;
    for (std::size_t c = 0; c < 3; ++c) ASSERT_NEAR(reached.tip[c], pose.tip[c], 1e-8);
    ASSERT_LE(angle(reached.axis, pose.axis), 1e-9);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const JointLimits& limits = joints[j].limits;
      if (limits.limit_type == JointLimitType::Limited) {
        ASSERT_GE(taken[j], limits.min - 1e-9) << limits.name;
        ASSERT_LE(taken[j], limits.max + 1e-9) << limits.name;
      }
      longest = std::max(longest, std::abs(taken[j] - start[j]) / limits.max_speed);
      known = std::max(known, std::abs(wanted[j] - start[j]) / limits.max_speed);
    }
    EXPECT_LE(longest, known + 1e-9) << "the joints that the pose was made of are quicker to reach";
  }
}

}  // namespace
}  // namespace rmac::gateway

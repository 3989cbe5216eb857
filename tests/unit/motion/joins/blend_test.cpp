#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "curves/make_curves.hpp"
#include "seeds.hpp"
#include "unit/motion/joins/traces.hpp"

namespace rmac::test {
namespace {

/// What the moves ask for, without joins.
Trace programmed(const Move& move, const ToolPose& from) {
  Trace trace;
  const std::vector<double> joints{from.tip[0], from.tip[1], from.tip[2]};
  const auto curves = make_curves(move, {from, joints});
  for (const auto& curve : *curves) {
    const int steps = static_cast<int>(std::ceil(curve->length() / 0.01));
    for (int i = 0; i <= steps; ++i) {
      CurvePoint point;
      curve->evaluate(curve->length() * i / steps, 0, 1, point);
      trace.push_back({point.d[0][0], point.d[0][1], point.d[0][2]});
    }
  }
  return trace;
}

/// Random programs of lines, arcs and curves that meet in corners, tangents and jumps of curvature, each with a
/// tolerance.
class JoinProgram {
 public:
  explicit JoinProgram(unsigned seed) : random_(seed) {}

  Move next(const ToolPose& from) {
    Move move;
    move.id = ++id_;
    move.feed_mm_s = pick({20, 60, 150});
    move.tolerance_mm = pick({0, 0.001, 0.01, 0.1});
    const Vector& p = from.tip;
    switch (std::uniform_int_distribution<int>(0, 3)(random_)) {
      case 0:
        move.geometry =
            LineGeometry{from, {inside({p[0] + uniform(-9, 9), p[1] + uniform(-9, 9), p[2] + uniform(-3, 3)}), kUp}};
        break;
      case 1:
        // On in the direction of before: a tangent join, with a jump of curvature from an arc.
        move.geometry =
            LineGeometry{from, {inside({p[0] + 3 * ahead_[0], p[1] + 3 * ahead_[1], p[2] + 3 * ahead_[2]}), kUp}};
        break;
      case 2: {
        Arc3Geometry arc;
        arc.start = from;
        arc.via = inside({p[0] + 2 * ahead_[0] + uniform(-1, 1), p[1] + 2 * ahead_[1] + uniform(-1, 1), p[2]});
        arc.end = {inside({p[0] + uniform(-8, 8), p[1] + uniform(-8, 8), p[2] + uniform(-2, 2)}), kUp};
        move.geometry = arc;
        break;
      }
      default: {
        NurbsGeometry curve;
        curve.curve.degree = 3;
        curve.curve.knots = {0, 0, 0, 0, 1, 2, 2, 2, 2};
        curve.curve.points = {{p[0], p[1], p[2]}};
        for (int i = 0; i < 4; ++i) {
          const auto& q = curve.curve.points.back();
          const Vector to = inside({q[0] + uniform(-6, 6), q[1] + uniform(-6, 6), q[2] + uniform(-1, 1)});
          curve.curve.points.push_back({to[0], to[1], to[2]});
        }
        move.geometry = curve;
      }
    }
    return move;
  }

  void went(const Trace& trace) {
    const Vector& a = trace[trace.size() - 2];
    const Vector& b = trace.back();
    const double d = distance(a, b);
    for (std::size_t c = 0; c < 3; ++c) ahead_[c] = (b[c] - a[c]) / d;
  }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

 private:
  static Vector inside(Vector p) {
    for (double& c : p) c = std::clamp(c, -49.0, 49.0);
    return p;
  }
  double pick(std::initializer_list<double> values) {
    return *(values.begin() + std::uniform_int_distribution<std::size_t>(0, values.size() - 1)(random_));
  }

  std::mt19937 random_;
  std::int64_t id_ = 0;
  Vector ahead_{1, 0, 0};
};

struct Programmed {
  Move move;
  Trace trace;
};

class JoinProperty : public ::testing::TestWithParam<unsigned> {
 protected:
  /// Queues moves, `pause` cycles apart at random.
  void queue(PlannerBench& bench, JoinProgram& program, int count, int most_pause) {
    while (static_cast<int>(moves_.size()) < count) {
      const ToolPose from = bench.builder.end_pose();
      const Move move = program.next(from);
      if (!bench.queue(move)) continue;
      moves_.push_back({move, programmed(move, from)});
      program.went(moves_.back().trace);
      const int pause = most_pause > 0 ? static_cast<int>(program.uniform(0, most_pause)) : 0;
      for (int i = 0; i < pause; ++i) bench.cycle();
    }
  }

  /// Every setpoint within the tolerances around it of the program, and every programmed corner of the setpoints' path.
  void expect_within_tolerance(const PlannerBench& bench) const {
    const Trace path = travelled(bench);
    const double chord = 2e-4;  // the traces' own chords
    std::size_t at = 0;
    for (const Setpoint& p : bench.record) {
      while (at < moves_.size() && moves_[at].move.id != p.move_id) ++at;
      if (at == moves_.size()) {
        ASSERT_EQ(p.move_id, 0) << "move ids come in the order of the program";
        at = 0;
        continue;
      }
      const Vector here{p.position[0], p.position[1], p.position[2]};
      double least = 1e9, tolerance = 0;
      for (std::size_t i = at > 0 ? at - 1 : 0; i <= at + 1 && i < moves_.size(); ++i) {
        least = std::min(least, distance_to_trace(here, moves_[i].trace));
        if (i >= at) tolerance = std::max(tolerance, moves_[i].move.tolerance_mm);
      }
      ASSERT_LE(least, tolerance + chord) << "move " << p.move_id << " at " << p.s_mm << " mm, seed " << GetParam();
    }
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      const double tolerance = i + 1 < moves_.size() ? moves_[i + 1].move.tolerance_mm : 0;
      ASSERT_LE(distance_to_trace(moves_[i].trace.back(), path), tolerance + chord) << "end of move " << i + 1;
    }
  }

  static void expect_limits(const PlannerBench& bench) {
    const auto peaks = bench.peaks();
    EXPECT_LE(peaks.velocity, kAtMost) << "seed " << GetParam();
    EXPECT_LE(peaks.acceleration, kAtMost) << "seed " << GetParam();
    EXPECT_LE(peaks.jerk, kAtMost) << "seed " << GetParam() << " in cycle " << peaks.jerk_cycle;
  }

  std::vector<Programmed> moves_;
};

TEST_P(JoinProperty, StaysWithinToleranceAndLimitsAndEndsEveryMove) {
  PlannerBench bench(mill(GetParam() % 2 == 0 ? 10000 : 50000));
  JoinProgram program(GetParam());
  queue(bench, program, 12, 0);
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  expect_within_tolerance(bench);
  expect_limits(bench);
  EXPECT_EQ(bench.moves_done(), moves_.size());
  EXPECT_EQ(bench.planner.moves_left(), 0U);
}

TEST_P(JoinProperty, RestsAtTheExactEndOfWhatASlowClientSent) {
  PlannerBench bench(mill());
  JoinProgram program(GetParam() + 100);
  bench.planner.command(PathCommand::Run);
  for (int batch = 1; batch <= 4; ++batch) {
    queue(bench, program, 3 * batch, 200);
    ASSERT_TRUE(bench.run());
    EXPECT_EQ(bench.moves_done(), moves_.size());
    const Setpoint& end = bench.record.back();
    EXPECT_LT(distance({end.position[0], end.position[1], end.position[2]}, moves_.back().trace.back()), 1e-9);
    EXPECT_EQ(end.move_id, moves_.back().move.id);
  }
  expect_within_tolerance(bench);
  expect_limits(bench);
}

INSTANTIATE_TEST_SUITE_P(Seeds, JoinProperty, seeds(8));

/// Two lines of 20 mm that turn by an angle.
std::unique_ptr<PlannerBench> around_corner(double degrees, double tolerance_mm, double feed_mm_s = 100) {
  auto bench = std::make_unique<PlannerBench>(mill(50000));
  Move move;
  move.feed_mm_s = feed_mm_s;
  move.tolerance_mm = tolerance_mm;
  const double angle = degrees * std::numbers::pi / 180;
  const Vector corner{20, 0, 0}, end{20 + 20 * std::cos(angle), 20 * std::sin(angle), 0};
  move.id = 1;
  move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {corner, kUp}};
  EXPECT_TRUE(bench->queue(move));
  move.id = 2;
  move.geometry = LineGeometry{{corner, kUp}, {end, kUp}};
  EXPECT_TRUE(bench->queue(move));
  bench->planner.command(PathCommand::Run);
  EXPECT_TRUE(bench->run());
  return bench;
}

TEST(Joins, PassCornersWithinToleranceAndFasterTheMoreThereIs) {
  for (const double degrees : {5.0, 30.0, 90.0, 135.0}) {
    double before = seconds(*around_corner(degrees, 0));
    for (const double tolerance : {0.01, 0.1, 1.0}) {
      const auto bench = around_corner(degrees, tolerance);
      EXPECT_LE(seconds(*bench), before + 0.001) << degrees << " degrees, " << tolerance << " mm";
      EXPECT_LE(distance_to_trace({20, 0, 0}, travelled(*bench)), tolerance);
      before = seconds(*bench);
    }
    EXPECT_LT(before, 0.95 * seconds(*around_corner(degrees, 0)));
  }
}

TEST(Joins, RoundNoMoreThanTheFeedNeeds) {
  const double deviation = distance_to_trace({20, 0, 0}, travelled(*around_corner(90, 1, 5)));
  EXPECT_LT(deviation, 0.1);
}

TEST(Joins, EndAMoveInTheMiddleOfItsCorner) {
  const auto bench = around_corner(90, 0.1);
  double s = -1;
  std::int64_t id = 0;
  for (const Setpoint& setpoint : bench->record) {
    if (setpoint.move_id == 0) continue;
    if (setpoint.move_id != id) {
      if (id != 0) {
        EXPECT_NEAR(s, 20, 0.1);
      }
      EXPECT_EQ(setpoint.move_id, id + 1);
      EXPECT_NEAR(setpoint.s_mm, 0, 0.1);
      EXPECT_EQ(setpoint.moves_done, id == 0 ? 0U : 1U);
      id = setpoint.move_id;
    } else {
      EXPECT_GE(setpoint.s_mm, s);
    }
    s = setpoint.s_mm;
  }
  EXPECT_NEAR(s, 20, 1e-9);
}

TEST(Joins, KeepTheTravelThatTheCornersThemselvesKeep) {
  PlannerBench bench(mill(50000));
  Move move;
  move.feed_mm_s = 100;
  move.tolerance_mm = 0.1;
  for (const Vector& to : {Vector{50, 0, 0}, Vector{50, 50, 0}, Vector{0, 50, 0}}) {
    move.geometry = LineGeometry{bench.builder.end_pose(), {to, kUp}};
    ASSERT_TRUE(bench.queue(move));
  }
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  for (const Setpoint& setpoint : bench.record)
    for (std::size_t j = 0; j < 2; ++j) EXPECT_LE(setpoint.position[j], 50 + 1e-6);
}

}  // namespace
}  // namespace rmac::test

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "planner_bench.hpp"

namespace rmac {
namespace {

using test::mill;
using test::PlannerBench;

constexpr Vector kUp{0, 0, 1};
constexpr double kAtMost = 1.0005;

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double distance_to_chord(const Vector& p, const Vector& a, const Vector& b) {
  double along = 0, length = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    length += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double part = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0.0;
  return distance(p, {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])});
}

/// A chain of points so dense that its chords stand for the curve.
using Trace = std::vector<Vector>;

double distance_to_trace(const Vector& p, const Trace& trace) {
  double least = 1e9;
  for (std::size_t i = 0; i + 1 < trace.size(); ++i) {
    // A chord no nearer than its first point less its length needs no closer look.
    if (distance(p, trace[i]) - distance(trace[i], trace[i + 1]) < least)
      least = std::min(least, distance_to_chord(p, trace[i], trace[i + 1]));
  }
  return least;
}

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

Trace travelled(const PlannerBench& bench) {
  Trace trace;
  for (const Setpoint& setpoint : bench.record) {
    const Vector here{setpoint.position[0], setpoint.position[1], setpoint.position[2]};
    if (trace.empty() || distance(trace.back(), here) > 0) trace.push_back(here);
  }
  return trace;
}

double seconds(const PlannerBench& bench) {
  std::size_t moving = 0;
  for (const Setpoint& setpoint : bench.record) moving += setpoint.moving ? 1U : 0U;
  return static_cast<double>(moving) * 1e-3;
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

INSTANTIATE_TEST_SUITE_P(Seeds, JoinProperty, ::testing::Range(1U, 9U));

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

/// A rose of five leaves from the origin, in lines; `rounding_mm` is what the client's coordinates are rounded to.
Trace rose(double line_mm, double rounding_mm = 0) {
  Trace corners;
  double since = line_mm;
  Vector before{};
  for (int i = 0; i <= 400000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 400000, r = 12 + 4 * std::cos(5 * angle);
    Vector here{r * std::cos(angle) - 16, r * std::sin(angle), 0};
    if (i > 0) since += distance(before, here);
    before = here;
    if (since < line_mm) continue;
    since = 0;
    if (rounding_mm > 0)
      for (double& c : here) c = std::round(c / rounding_mm) * rounding_mm;
    corners.push_back(here);
  }
  return corners;
}

/// Queues lines through corners, and checks that the path keeps their tolerance and the limits.
double machined(const Trace& corners, double tolerance_mm, int cycles_between = 0, double jerk_mm_s3 = 50000) {
  PlannerBench bench(mill(jerk_mm_s3));
  if (cycles_between > 0) bench.planner.command(PathCommand::Run);
  Move move;
  move.feed_mm_s = 100;
  move.tolerance_mm = tolerance_mm;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    move.id = static_cast<std::int64_t>(i);
    move.geometry = LineGeometry{{corners[i - 1], kUp}, {corners[i], kUp}};
    EXPECT_TRUE(bench.queue(move));
    for (int k = 0; k < cycles_between; ++k) bench.cycle();
  }
  bench.planner.command(PathCommand::Run);
  EXPECT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), corners.size() - 1);
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  const Trace path = travelled(bench);
  EXPECT_LT(distance(path.back(), corners.back()), 1e-9);
  double off = 0;
  for (const Vector& p : path) off = std::max(off, distance_to_trace(p, corners));
  EXPECT_LE(off, tolerance_mm + 1e-9);
  off = 0;
  for (const Vector& p : corners) off = std::max(off, distance_to_trace(p, path));
  EXPECT_LE(off, tolerance_mm + 2e-4);
  std::int64_t id = 0;
  for (const Setpoint& setpoint : bench.record) {
    EXPECT_GE(setpoint.move_id, id);
    id = setpoint.move_id;
  }
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, kAtMost);
  EXPECT_LE(peaks.acceleration, kAtMost);
  EXPECT_LE(peaks.jerk, kAtMost);
  return seconds(bench);
}

TEST(ShortLines, RunAsFastAsTheCurveTheyCameFromHoweverShort) {
  const double fifths = machined(rose(0.2), 0.01);
  EXPECT_NEAR(machined(rose(0.1), 0.01) / fifths, 1, 0.02);
  EXPECT_NEAR(machined(rose(0.05), 0.01) / fifths, 1, 0.02);
  EXPECT_NEAR(machined(rose(0.1, 0.001), 0.01) / fifths, 1, 0.05);
}

TEST(ShortLines, WhoseChordsMissTheCurveByMoreThanTheToleranceAreNotStoppedAtEachCorner) {
  const double fine = machined(rose(0.1), 0.01);
  EXPECT_LT(machined(rose(0.3), 0.01), 1.15 * fine);
  EXPECT_LT(machined(rose(0.5), 0.01), 1.5 * fine);
  EXPECT_LT(machined(rose(1), 0.01), 3.71) << "on the smoothest spline it takes 3.75 s";
}

/// A closed curve in a plane, of five waves each way, in lines.
Trace waves(unsigned seed, double line_mm) {
  std::mt19937 random(seed);
  std::array<std::array<double, 5>, 2> height{}, phase{};
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t k = 0; k < 5; ++k) {
      height[c][k] = std::uniform_real_distribution<double>(-12, 12)(random) / static_cast<double>(k + 1);
      phase[c][k] = std::uniform_real_distribution<double>(0, 2 * std::numbers::pi)(random);
    }
  }
  Trace corners;
  Vector start{}, before{};
  for (int i = 0; i <= 200000; ++i) {
    Vector here{};
    for (std::size_t c = 0; c < 2; ++c) {
      for (std::size_t k = 0; k < 5; ++k)
        here[c] += height[c][k] * std::sin(static_cast<double>(k + 1) * i * std::numbers::pi / 100000 + phase[c][k]);
    }
    if (i == 0) start = here;
    for (std::size_t c = 0; c < 2; ++c) here[c] -= start[c];
    if (i > 0 && distance(before, here) < line_mm) continue;
    before = here;
    corners.push_back(here);
  }
  return corners;
}

class CoarseLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(CoarseLines, FindALawAlsoWhereJerkIsLow) {
  for (const double line_mm : {0.8, 1.2, 1.8}) {
    const Trace corners = waves(GetParam(), line_mm);
    // A law that is slowed down by the third root of what the jerk is less by keeps every limit.
    EXPECT_LT(machined(corners, 0.04, 0, 10000), 1.01 * std::cbrt(5) * machined(corners, 0.04, 0, 50000)) << line_mm;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CoarseLines, ::testing::Range(1U, 9U));

/// Lines of all lengths and directions in space, now dense, now coarse, with corners among them.
Trace wandering(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  Trace corners{{0, 0, 0}};
  Vector ahead{1, 0, 0}, turn{};
  double line = 1;
  for (int i = 0; i < 300; ++i) {
    if (i % 40 == 0) {
      line = std::exp(uniform(std::log(0.05), std::log(3.0)));
      for (double& c : turn) c = uniform(-0.4, 0.4);
    }
    for (std::size_t c = 0; c < 3; ++c) ahead[c] += turn[c] * std::min(1.0, 2 * line) + uniform(-0.1, 0.1);
    if (uniform(0, 1) < 0.02) ahead = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    const double length = distance(ahead, {0, 0, 0});
    const double step = line * uniform(0.3, 1);
    Vector next = corners.back();
    for (std::size_t c = 0; c < 3; ++c) {
      ahead[c] /= length;
      if (std::abs(next[c] + step * ahead[c]) > 45) ahead[c] = -ahead[c];
      next[c] += step * ahead[c];
    }
    corners.push_back(next);
  }
  return corners;
}

class WanderingLines : public ::testing::TestWithParam<unsigned> {};

TEST_P(WanderingLines, KeepToleranceAndLimits) {
  const double tolerance = std::array{0.002, 0.01, 0.05, 0.3}[GetParam() % 4];
  machined(wandering(GetParam()), tolerance);
}

INSTANTIATE_TEST_SUITE_P(Seeds, WanderingLines, ::testing::Range(1U, 25U));

TEST(ShortLines, OfASlowClientEndExactly) {
  Trace corners = rose(0.2);
  corners.resize(60);
  machined(corners, 0.01, 15);
}

TEST(ShortLines, KeepTheCornersThatWereMeant) {
  Trace corners;
  for (int i = 0; i <= 40; ++i) corners.push_back({i * 0.1, 0, 0});
  for (int i = 1; i <= 40; ++i) corners.push_back({4, i * 0.1, 0});
  machined(corners, 0.01);
}

}  // namespace
}  // namespace rmac

// What CAM systems leave in a program beside what is meant: points that repeat, lines shorter than the tolerance, arcs
// that rounding made tiny. The machine runs as if they were not there, and every move that moves is done.
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

constexpr double kTolerance_mm = 0.01;

/// A program, and what it asks for.
class Program {
 public:
  void line_to(const Vector& end) { add(LineGeometry{{at_, kUp}, {end, kUp}}, end); }
  void arc_to(const Vector& center, int rotation, const Vector& end) {
    add(ArcGeometry{center, {0, 0, 1}, rotation, false, {at_, kUp}, {end, kUp}}, end);
  }
  [[nodiscard]] const Vector& at() const { return at_; }
  [[nodiscard]] const std::vector<Move>& moves() const { return moves_; }

 private:
  void add(Geometry geometry, const Vector& end) {
    Move move;
    move.id = static_cast<std::int64_t>(moves_.size()) + 1;
    move.feed_mm_s = 100;
    move.tolerance_mm = kTolerance_mm;
    move.geometry = std::move(geometry);
    moves_.push_back(std::move(move));
    at_ = end;
  }

  std::vector<Move> moves_;
  Vector at_{};
};

void append_trace(const Move& move, const ToolPose& from, Trace& trace) {
  const auto curves = make_curves(move, {from, std::vector<double>{from.tip[0], from.tip[1], from.tip[2]}});
  ASSERT_TRUE(curves) << "move " << move.id << ": " << curves.error().message;
  for (const auto& curve : *curves) {
    const int steps = curve->straight() ? 1 : static_cast<int>(std::ceil(curve->length() / 0.02));
    for (int i = trace.empty() ? 0 : 1; i <= steps; ++i) {
      CurvePoint point;
      curve->evaluate(curve->length() * i / steps, 0, 1, point);
      trace.push_back({point.d[0][0], point.d[0][1], point.d[0][2]});
    }
  }
}

struct Ran {
  double time_s = 0;
  int rests = 0;
};

/// Runs it, and checks what holds for every program: limits, the tolerance both ways, an exact end, each move told done
/// in its order.
Ran run(const Program& program, int most_pause = 0, unsigned seed = 0) {
  std::mt19937 random(seed);
  PlannerBench bench(mill(20000));
  Trace sent{{0, 0, 0}}, vertices{{0, 0, 0}};
  if (most_pause > 0) bench.planner.command(PathCommand::Run);
  std::size_t moving = 0;
  for (const Move& move : program.moves()) {
    append_trace(move, bench.builder.end_pose(), sent);
    auto segments = bench.builder.build(move);
    if (!segments) {
      ADD_FAILURE() << "move " << move.id << ": " << segments.error().message;
      return {};
    }
    if (!segments->empty()) ++moving;
    bench.planner.add(std::move(*segments));
    vertices.push_back(bench.builder.end_pose().tip);
    const int pause = most_pause > 0 ? std::uniform_int_distribution<int>(0, most_pause)(random) : 0;
    for (int i = 0; i < pause; ++i) bench.cycle();
  }
  bench.planner.command(PathCommand::Run);
  EXPECT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), moving);
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  const Trace path = travelled(bench);
  EXPECT_LT(distance(path.back(), vertices.back()), 1e-9);
  double off = 0;
  for (const Vector& p : path) off = std::max(off, distance_to_trace(p, sent));
  EXPECT_LE(off, kTolerance_mm + 1e-5);
  off = 0;
  for (const Vector& p : vertices) off = std::max(off, distance_to_trace(p, path));
  EXPECT_LE(off, kTolerance_mm + 2e-4);
  expect_limits_and_order(bench);
  int stops = 0;
  bool was_moving = false;
  for (const Setpoint& setpoint : bench.record) {
    if (was_moving && !setpoint.moving) ++stops;
    was_moving = setpoint.moving;
  }
  return {seconds(bench), stops - 1};
}

/// What a program has beside what is meant.
struct Debris {
  const char* name;
  double length_mm;  ///< of its tiny lines
  int most;          ///< of them in one place
  bool returns;      ///< to where it began
};

void PrintTo(const Debris& debris, std::ostream* out) {
  *out << debris.name;
}

class Strewn : public ::testing::TestWithParam<std::tuple<Debris, unsigned>> {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// Leaves some here.
  void strew(Program& program) {
    const auto& debris = std::get<0>(GetParam());
    const int count = std::uniform_int_distribution<int>(1, debris.most)(random_);
    const Vector begin = program.at();
    for (int i = 0; i < count; ++i) {
      Vector next = begin;
      if (debris.length_mm > 0)
        for (std::size_t c = 0; c < 2; ++c) next[c] += uniform(-1, 1) * debris.length_mm / std::sqrt(2);
      program.line_to(next);
    }
    if (debris.returns) program.line_to(begin);
  }

  std::mt19937 random_{std::get<1>(GetParam())};
};

/// Long lines with corners, arcs that go on from each other, and curves in short lines.
class MeantProgram {
 public:
  explicit MeantProgram(unsigned seed) : random_(seed) {}

  /// `between` is called where two moves meet.
  template <class Between>
  Program made(const Between& between) {
    Program program;
    for (int i = 0; i < 6; ++i) {
      const Vector p = program.at();
      switch (std::uniform_int_distribution<int>(0, 2)(random_)) {
        case 0:
          program.line_to(inside({p[0] + uniform(-9, 9), p[1] + uniform(-9, 9), p[2]}));
          break;
        case 1: {  // two halves of a circle, one to each side
          const double r = p[0] > 0 ? uniform(-2, -0.5) : uniform(0.5, 2);
          const Vector middle = {p[0] + 2 * r, p[1], p[2]}, end = {p[0] + 4 * r, p[1], p[2]};
          program.arc_to({p[0] + r, p[1], p[2]}, 1, middle);
          between(program);
          const Vector& now = program.at();
          program.arc_to({now[0] + (end[0] - now[0]) / 2, now[1] + (end[1] - now[1]) / 2, now[2]}, -1, end);
          break;
        }
        default: {
          const double r = uniform(3, 6), begin = uniform(0, 6);
          for (int k = 1; k <= 60; ++k) {
            const double angle = begin + 0.03 * k;
            program.line_to(
                {p[0] + r * (std::cos(angle) - std::cos(begin)), p[1] + r * (std::sin(angle) - std::sin(begin)), p[2]});
            if (k % 17 == 0) between(program);
          }
        }
      }
      between(program);
    }
    return program;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  static Vector inside(Vector p) {
    for (double& c : p) c = std::clamp(c, -40.0, 40.0);
    return p;
  }
  std::mt19937 random_;
};

TEST_P(Strewn, CostsNoTime) {
  const unsigned seed = std::get<1>(GetParam());
  const Ran clean = run(MeantProgram(seed).made([](Program&) {}));
  const Program strewn = MeantProgram(seed).made([this](Program& program) { strew(program); });
  const Ran ran = run(strewn);
  EXPECT_LE(ran.rests, clean.rests);
  EXPECT_LT(ran.time_s, 1.08 * clean.time_s) << "clean " << clean.time_s << " s";
}

TEST_P(Strewn, IsPassedWheneverItComes) {
  run(MeantProgram(std::get<1>(GetParam())).made([this](Program& program) { strew(program); }), 20,
      std::get<1>(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(
    Debris, Strewn,
    ::testing::Combine(::testing::Values(Debris{"RepeatedPoints", 0, 3, false}, Debris{"TinyLines", 0.002, 1, false},
                                         Debris{"ManyTinyLines", 0.003, 12, false},
                                         Debris{"ThereAndBack", 0.003, 2, true}, Debris{"Specks", 2e-5, 4, false}),
                       seeds(6)),
    [](const auto& row) { return std::get<0>(row.param).name + std::to_string(std::get<1>(row.param)); });

/// Arcs that go on from each other without a corner, their coordinates rounded to `to_mm`, and lines among them.
Program tangent_arcs(unsigned seed, double to_mm) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto written = [&](Vector v) {
    if (to_mm > 0)
      for (double& c : v) c = std::round(c / to_mm) * to_mm;
    return v;
  };
  Program program;
  Vector at{};
  double heading = 0;
  for (int i = 0; i < 12; ++i) {
    if (i % 4 == 3) {
      const double length = uniform(2, 6);
      at = {at[0] + length * std::cos(heading), at[1] + length * std::sin(heading), 0};
      program.line_to(written(at));
      continue;
    }
    const int rotation = i % 2 == 0 ? 1 : -1;
    const double r = uniform(1.5, 5), sweep = rotation * uniform(0.6, 1.4);
    const Vector center{at[0] - rotation * r * std::sin(heading), at[1] + rotation * r * std::cos(heading), 0};
    heading += sweep;
    at = {center[0] + rotation * r * std::sin(heading), center[1] - rotation * r * std::cos(heading), 0};
    program.arc_to(written(center), rotation, written(at));
  }
  return program;
}

class RoundedArcs : public ::testing::TestWithParam<unsigned> {};

TEST_P(RoundedArcs, RunAsFastAsExactOnes) {
  EXPECT_LT(run(tangent_arcs(GetParam(), 0.001)).time_s, 1.02 * run(tangent_arcs(GetParam(), 0)).time_s);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoundedArcs, seeds(12));

TEST(TinyLine, ThatIsTheLastIsRunToItsExactEnd) {
  Program program;
  program.line_to({10, 0, 0});
  program.line_to({10, 0.002, 0});
  run(program);
  Program alone;
  alone.line_to({0.001, 0.002, 0});
  run(alone);
}

TEST(TinyLines, GoNowhereTogether) {
  // Each within the tolerance of the one before, and together a circle.
  Program program;
  for (int i = 1; i <= 3000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3000;
    program.line_to({1 - std::cos(angle), std::sin(angle), 0});
  }
  EXPECT_EQ(run(program).rests, 0);
}

}  // namespace
}  // namespace rmac::test

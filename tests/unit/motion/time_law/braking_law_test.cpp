#include "time_law/braking_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "time_law/law_check.hpp"
#include "time_law/window.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

constexpr Vector kUp{0, 0, 1};

/// A path of one move, and the law by which it is travelled as fast as can be.
struct Travelled {
  explicit Travelled(const Move& move, double jerk = 10'000) : model(test::mill(jerk)) {
    PathBuilder builder(model);
    const auto* line = std::get_if<LineGeometry>(&move.geometry);
    const auto* arc = std::get_if<ArcGeometry>(&move.geometry);
    const Vector start = line != nullptr ? line->start.tip : arc->start.tip;
    builder.restart(std::vector<double>{start[0], start[1], start[2]}, {});
    segments = builder.build(move).value();
    law = *plan_window(path(), model.joints, {{0, 0, 0}, segments.front()->length(), feed, nullptr, false, true});
    duration = law.back().t0 + law.back().duration;
  }
  [[nodiscard]] PathView path() const { return {segments, starts}; }
  [[nodiscard]] PathState at(double t) const {
    std::size_t i = 0;
    while (i + 1 < law.size() && law[i + 1].t0 <= t) ++i;
    return law[i].at(t - law[i].t0);
  }
  [[nodiscard]] std::optional<std::vector<LawPiece>> brake(double t, int steps = 1000) const {
    return braking_law(path(), model.joints, {at(t), segments.front()->length(), law}, steps);
  }

  PlannerModel model;
  PathSegments segments;
  std::vector<double> starts{0};
  FeedRule feed;
  std::vector<LawPiece> law;
  double duration = 0;
};

Move line(double feed) {
  Move move;
  move.feed_mm_s = feed;
  move.geometry = LineGeometry{{{-45, 0, 0}, kUp}, {{45, 0, 0}, kUp}};
  return move;
}

Move circle(double radius, double feed) {
  Move move;
  move.feed_mm_s = feed;
  ArcGeometry arc;
  arc.start = arc.end = {{radius, 0, 0}, kUp};
  arc.closed = true;
  move.geometry = arc;
  return move;
}

void expect_brakes(const Travelled& way, double t, const std::vector<LawPiece>& law) {
  const PathState from = way.at(t), begin = law.front().start, end = law.back().at(law.back().duration);
  EXPECT_EQ(begin.s, from.s);
  EXPECT_EQ(begin.v, from.v);
  EXPECT_EQ(begin.a, from.a);
  EXPECT_NEAR(end.v, 0, 1e-9);
  EXPECT_NEAR(end.a, 0, 1e-6);
  for (std::size_t i = 0; i + 1 < law.size(); ++i) {
    const PathState here = law[i].at(law[i].duration), next = law[i + 1].start;
    EXPECT_NEAR(law[i + 1].t0, law[i].t0 + law[i].duration, 1e-12);
    EXPECT_NEAR(here.s, next.s, 1e-9);
    EXPECT_NEAR(here.v, next.v, 1e-6);
    EXPECT_NEAR(here.a, next.a, 1e-6);
  }
}

TEST(BrakingLaw, OnALineIsWithinThreePercentOfTheShortest) {
  for (const double feed : {5.0, 40.0, 150.0, 200.0}) {
    const Travelled way(line(feed));
    const double t = 0.5 * way.duration;
    const auto law = way.brake(t);
    ASSERT_TRUE(law) << feed;
    expect_brakes(way, t, *law);
    EXPECT_LE(check_law(way.path(), way.model.joints, *law, nullptr).worst, 1) << feed;
    const double length = law->back().at(law->back().duration).s - way.at(t).s;
    EXPECT_LE(length, 1.03 * ramp_length(feed, 1000, 10'000)) << feed;
    EXPECT_GE(length, 0.999 * ramp_length(feed, 1000, 10'000)) << feed;
  }
}

TEST(BrakingLaw, FromMostStatesOfACircleKeepsTheLimits) {
  for (const double radius : {0.5, 3.0, 20.0}) {
    for (const double jerk : {2000.0, 10'000.0, 50'000.0}) {
      const Travelled way(circle(radius, 200), jerk);
      int kept = 0;
      constexpr int kInstants = 50;
      for (int i = 0; i < kInstants; ++i) {
        const double t = way.duration * (i + 0.5) / kInstants;
        const auto law = way.brake(t);
        if (!law) continue;
        expect_brakes(way, t, *law);
        if (check_law(way.path(), way.model.joints, *law, nullptr).worst <= 1) ++kept;
      }
      EXPECT_GE(kept, kInstants / 2) << "radius " << radius << " jerk " << jerk;
    }
  }
}

TEST(BrakingLaw, TakesNoMoreStepsThanItIsLeftAndComesToRestBeforeItIsTold) {
  const Travelled way(line(200));
  const double t = 0.5 * way.duration;
  EXPECT_FALSE(way.brake(t, 10));
  int steps = 1000;
  const double needed = ramp_length(200, 1000, 10'000);
  const PathState from = way.at(t);
  EXPECT_FALSE(braking_law(way.path(), way.model.joints, {from, from.s + 0.9 * needed, way.law}, steps));
  EXPECT_GT(steps, 0);
  EXPECT_TRUE(braking_law(way.path(), way.model.joints, {from, from.s + 1.1 * needed, way.law}, steps));
}

TEST(BrakingLaw, ThatIsGentleIsNoSlowerThanItMayBe) {
  const Travelled way(line(200));
  const PathState from = way.at(0.35 * way.duration);
  int steps = 1000;
  const auto law = braking_law(way.path(), way.model.joints, {from, way.path().end(), way.law, 2}, steps);
  ASSERT_TRUE(law);
  // Until the law that it leaves brakes for the end of the line.
  const double brakes = way.path().end() - 1.1 * ramp_length(200, 1000, 10'000);
  int gentle = 0;
  for (const LawPiece& piece : *law) {
    if (piece.start.s > brakes) break;
    EXPECT_GE(piece.start.a, -2 * 200 - 1e-6) << piece.t0;
    ++gentle;
  }
  EXPECT_GT(gentle, 10);
}

}  // namespace
}  // namespace rmac

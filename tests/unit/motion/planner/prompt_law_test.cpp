#include "planner/prompt_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "seeds.hpp"
#include "time_law/law_check.hpp"
#include "time_law/window.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

constexpr double kPeriod_s = 0.001, kFeed = 200;

/// A spline that winds at random, travelled as fast as can be.
struct Winding {
  explicit Winding(unsigned seed) : model(test::mill()) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> step(-8, 8);
    Nurbs nurbs;
    nurbs.degree = 4;
    Vector at{0, 0, 0};
    for (int i = 0; i < 16; ++i) {
      nurbs.points.push_back({at[0], at[1], at[2]});
      at = {at[0] + 2, std::clamp(at[1] + step(random), -40.0, 40.0), std::clamp(at[2] + step(random), -40.0, 40.0)};
    }
    nurbs.knots = {0, 0, 0, 0, 0};
    for (int i = 1; i < 12; ++i) nurbs.knots.push_back(i);
    nurbs.knots.insert(nurbs.knots.end(), 5, 12);
    Move move;
    move.feed_mm_s = kFeed;
    move.geometry = NurbsGeometry{NurbsSpace::Tip, nurbs};
    PathBuilder builder(model);
    builder.restart(std::vector<double>{0, 0, 0}, {});
    segments = builder.build(move).value();
    plan.law = *plan_window(path, model.joints, {{0, 0, 0}, path.end(), {}, nullptr, false, true});
    auto made = std::make_unique<Plan>();
    made->end_time_s = plan.law.back().t0 + plan.law.back().duration;
    plan.plan = std::move(made);
  }
  [[nodiscard]] std::optional<PromptLaw> stop(double t, const FeedRule& feed, int later = 0) const {
    return prompt_stop({path, model.joints, plan, t, kPeriod_s}, path.end(), feed, later);
  }

  [[nodiscard]] double end_s() const { return plan.plan->end_time_s; }

  PlannerModel model;
  PathSegments segments;
  std::vector<double> starts{0};
  PathView path{segments, starts};
  PublishedPlan plan;
};

class PromptLaws : public ::testing::TestWithParam<unsigned> {};

// The law before is at a limit everywhere, and its path winds: where nothing is done sooner, braking soon leads to
// where the joints allow nothing at all.
TEST_P(PromptLaws, BrakeFromMostStatesOfTheFastestLawWithinTheLimits) {
  const Winding way(GetParam());
  int states = 0, found = 0;
  for (double t = 0.01; t < way.end_s() - 0.1; t += 0.0173) {
    ++states;
    const auto stop = way.stop(t, {});
    if (!stop) continue;
    ++found;
    const PathState from = way.plan.state_at(stop->leaves_t), begin = stop->law.front().start;
    const PathState end = stop->law.back().at(stop->law.back().duration);
    EXPECT_GE(stop->leaves_t, t);
    EXPECT_EQ(begin.s, from.s);
    EXPECT_EQ(begin.v, from.v);
    EXPECT_EQ(begin.a, from.a);
    EXPECT_NEAR(end.v, 0, 1e-9);
    EXPECT_LT(end.s, way.path.end());
    EXPECT_LE(check_law(way.path, way.model.joints, stop->law, nullptr).worst, 1) << t;
  }
  EXPECT_GE(found, 0.7 * states);
}

// What is faster than a feed that was lowered has to brake anyway; that it is too fast for it is no reason not to.
TEST_P(PromptLaws, BrakeFromAboveTheFeedAsWell) {
  const Winding way(GetParam());
  for (double t = 0.01; t < way.end_s() - 0.1; t += 0.0173) {
    const auto below = way.stop(t, {}), above = way.stop(t, {0.1});
    if (!below || way.plan.state_at(below->leaves_t).v <= 0.1 * kFeed) continue;
    ASSERT_TRUE(above) << t;
    EXPECT_EQ(above->leaves_t, below->leaves_t);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PromptLaws, test::seeds(12));

}  // namespace
}  // namespace rmac

#include "time_law/law_mend.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "time_law/law_problem.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// One joint on a straight way at the largest speed all along.
LawProblem cruise() {
  constexpr std::size_t kIntervals = 120;
  LawProblem problem;
  problem.joint_count = 1;
  for (std::size_t k = 0; k <= kIntervals; ++k) problem.nodes.push_back(0.5 * static_cast<double>(k));
  for (std::size_t k = 0; k < kIntervals; ++k) {
    problem.derivatives.insert(problem.derivatives.end(), {1, 0, 0, 1, 0, 0});
    problem.speed_cap.push_back(100 * 100);
    problem.rise.push_back(1000);
    problem.fall.push_back(1000);
    problem.tightening.push_back(1);
  }
  problem.max_acceleration = {1000};
  problem.max_jerk = {10'000};
  problem.begin = {0, 99.9, 0};
  problem.end = {60, 99.9, 0};
  return problem;
}

TEST(LawMend, GoesSlowerWhereAJointIsFasterBetweenNodesThanAtThem) {
  LawProblem problem = cruise();
  LawSolution solution = solve_law(problem, {});
  ASSERT_TRUE(solution.converged);
  constexpr std::size_t kFast = 60;
  ASSERT_GT(spline_start(problem, solution.coefficients, kFast).q, 99.85 * 99.85);
  std::vector<double> excess(problem.intervals(), 0.99);
  excess[kFast] = 1.002;
  ASSERT_FALSE(mend_law(problem, excess, solution.coefficients).empty());
  EXPECT_LE(spline_start(problem, solution.coefficients, kFast).q, 99.8 * 99.8);
  EXPECT_GT(spline_start(problem, solution.coefficients, kFast).q, 99 * 99);
  EXPECT_GT(spline_start(problem, solution.coefficients, kFast + 40).q, 99.85 * 99.85) << "there alone";
}

/// A joint's jerk within an interval, as a part of its bound (eq. 3).
double jerk_at(const LawProblem& problem, const LawCut& cut, const std::vector<double>& coefficients) {
  const SplineStart start = spline_start(problem, coefficients, cut.interval);
  const double ds = cut.part * problem.step(cut.interval);
  const double q = start.q + ds * (start.dq + ds / 2 * start.ddq), dq = start.dq + ds * start.ddq;
  const double* const d = cut.derivatives.data();
  return std::abs(d[2] * q + 1.5 * d[1] * dq + 0.5 * d[0] * start.ddq) * std::sqrt(q) / problem.max_jerk[0];
}

TEST(LawMend, KeepsTheBoundsAtACutAsAtANode) {
  // At 100 mm/s, d3 alone is twice the bound of jerk there.
  constexpr double kThird = 0.02;
  LawProblem free = cruise(), cut = cruise();
  const LawCut here{60, 0.3, {1, 0, kThird}};
  cut.cuts.push_back(here);
  const LawSolution without = solve_law(free, {}), with = solve_law(cut, {});
  ASSERT_TRUE(without.converged);
  ASSERT_TRUE(with.converged);
  EXPECT_GT(jerk_at(free, here, without.coefficients), 1.9);
  EXPECT_LE(jerk_at(cut, here, with.coefficients), 1 + 1e-6);
  EXPECT_GT(jerk_at(cut, here, with.coefficients), 0.95) << "and no slower than that asks for";
  EXPECT_GT(spline_start(cut, with.coefficients, 10).q, 0.99 * spline_start(free, without.coefficients, 10).q);
}

TEST(LawMend, CutsWithinAnIntervalAndNotTwiceAtAPlace) {
  test::PlannerBench bench(test::mill());
  bench.builder.restart(std::vector<double>{20, 0, 0}, {});
  Move move;
  move.feed_mm_s = 30;
  ArcGeometry arc;
  arc.start = {{20, 0, 0}, {0, 0, 1}};
  arc.end = {{-20, 0, 0}, {0, 0, 1}};
  move.geometry = arc;
  const auto built = bench.builder.build(move);
  ASSERT_TRUE(built);
  const std::vector<double> starts{0};
  const PathView path(*built, starts);
  LawProblem problem = cruise();
  problem.joint_count = 3;
  EXPECT_FALSE(cut_at(problem, path, 60, 30)) << "a node";
  EXPECT_FALSE(cut_at(problem, path, 60, 30.5)) << "the next";
  EXPECT_FALSE(cut_at(problem, path, 60, 31)) << "another interval's";
  ASSERT_TRUE(cut_at(problem, path, 60, 30.1));
  EXPECT_FALSE(cut_at(problem, path, 60, 30.11)) << "says the same";
  ASSERT_TRUE(cut_at(problem, path, 60, 30.2));
  ASSERT_EQ(problem.cuts.size(), 2U);
  EXPECT_NEAR(problem.cuts[0].part, 0.2, 1e-12);
  ASSERT_EQ(problem.cuts[0].derivatives.size(), 9U);
  const double turn = 30.1 / 20;
  EXPECT_NEAR(problem.cuts[0].derivatives[0], -std::sin(turn), 1e-9) << "of X, the first";
  EXPECT_NEAR(problem.cuts[0].derivatives[1], std::cos(turn), 1e-9) << "of Y";
  EXPECT_NEAR(problem.cuts[0].derivatives[3], -std::cos(turn) / 20, 1e-9) << "the second";
  EXPECT_NEAR(problem.cuts[0].derivatives[7], -std::cos(turn) / 400, 1e-9) << "the third of Y";
}

TEST(LawMend, TakesACutAlongWhereAPartIsSolvedAgain) {
  LawProblem problem = cruise();
  problem.cuts.push_back({70, 0.3, {1, 0, 0.02}});
  LawSolution solution = solve_law(problem, {});
  ASSERT_TRUE(solution.converged);
  std::vector<double> excess(problem.intervals(), 0.99);
  excess[72] = 1.002;
  ASSERT_FALSE(mend_law(problem, excess, solution.coefficients).empty());
  EXPECT_LE(jerk_at(problem, problem.cuts.front(), solution.coefficients), 1 + 1e-6);
}

}  // namespace
}  // namespace rmac

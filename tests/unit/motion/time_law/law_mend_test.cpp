#include "time_law/law_mend.hpp"

#include <gtest/gtest.h>

#include "time_law/law_problem.hpp"

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

}  // namespace
}  // namespace rmac

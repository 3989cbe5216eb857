#include "rmac/motion/state_to_state.hpp"

#include <chrono>
#include <random>
#include <string>

#include "rows.hpp"
#include "unit/motion/state_to_state/state_to_state_cases.hpp"

namespace rmac::bench {
namespace {

using Clock = std::chrono::steady_clock;

double us_since(Clock::time_point began) {
  return std::chrono::duration<double, std::micro>(Clock::now() - began).count();
}

}  // namespace

/// Random states to random states: time of one call, and how many answers are wrong in any way.
void state_to_state_rows(Figures& figures, const Extent& extent) {
  const int cases = extent.cases(1'000'000, 50'000);
  std::mt19937_64 random(11);
  int wrong = 0;
  std::vector<double> us;
  us.reserve(static_cast<std::size_t>(cases));
  for (int i = 0; i < cases; ++i) {
    const StateToStateCase c = random_case(random);
    const auto began = Clock::now();
    const JerkProfile profile = fastest_profile(c.from, c.to, c.bounds);
    us.push_back(us_since(began));
    wrong += fault_of(c, profile).empty() ? 0 : 1;
  }
  const std::string note = std::to_string(cases) + " random cases";
  figures.at_most("state_to_state_1_joint_p50", quantile(us, 0.5), 1, "us", note);
  figures.at_most("state_to_state_1_joint_wrong", wrong, 0, "cases", note);

  constexpr std::size_t kJoints = 7;
  std::vector<StateToStateCase> joints(kJoints);
  std::vector<JointState> from(kJoints), to(kJoints);
  std::vector<MotionBounds> bounds(kJoints);
  std::vector<JerkProfile> profiles(kJoints);
  us.clear();
  wrong = 0;
  for (int i = 0; i < cases; ++i) {
    for (std::size_t k = 0; k < kJoints; ++k) {
      joints[k] = random_case(random);
      from[k] = joints[k].from, to[k] = joints[k].to, bounds[k] = joints[k].bounds;
    }
    const auto began = Clock::now();
    const double duration = synchronise(from, to, bounds, profiles);
    us.push_back(us_since(began));
    bool right = true;
    for (std::size_t k = 0; k < kJoints; ++k) {
      right = right && fault_of(joints[k], profiles[k]).empty() &&
              std::abs(profiles[k].duration() - duration) <= 1e-9 * duration;
    }
    wrong += right ? 0 : 1;
  }
  figures.at_most("state_to_state_7_joints_p50", quantile(us, 0.5), 10, "us", note);
  figures.at_most("state_to_state_7_joints_wrong", wrong, 0, "cases", note);
}

}  // namespace rmac::bench

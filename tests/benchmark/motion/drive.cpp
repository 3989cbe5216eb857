#include "drive.hpp"

#include <algorithm>
#include <ctime>

#include "rmac/motion/plan.hpp"

namespace rmac::bench {
namespace {

double now_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The least that lies between two readings.
double cost_of_reading_s() {
  double least = 1;
  for (int i = 0; i < 10'000; ++i) {
    const double before = now_s();
    least = std::min(least, now_s() - before);
  }
  return least;
}

}  // namespace

CpuTime::CpuTime() : began_s_(now_s()) {}

double CpuTime::since_s() const {
  const double taken = now_s() - began_s_;
  static const double cost_s = cost_of_reading_s();
  return std::max(taken - cost_s, 0.0);
}

Drive::Drive(const PlannerModel& model, const std::vector<double>& start_joints)
    : builder(model),
      planner(model, to_tap_),
      follower_(to_follower_, model.joints, model.period_s),
      period_s_(model.period_s) {
  builder.restart(start_joints, Frames{});
  follower_.hold_at(start_joints);
  std::copy(start_joints.begin(), start_joints.end(), setpoint_.position.begin());
}

Expected<> Drive::queue(const Move& move) {
  auto segments = builder.build(move);
  if (!segments) return tl::unexpected(segments.error());
  planner.add(std::move(*segments));
  return {};
}

ServoProgress Drive::progress() const {
  return {cycle_, follower_.accepted_plan(), follower_.last_refused(), follower_.departure()};
}

void Drive::pass_plans() {
  const Plan* plan = nullptr;
  while (to_tap_.published.pop(plan)) {
    passed_.push_back(std::make_shared<const Plan>(*plan));
    ++plans_;
    (void)to_follower_.published.push(plan);
  }
}

void Drive::travelled(std::int64_t until_cycle) {
  if (!on_travelled || active_ == nullptr) return;
  const double from = static_cast<double>(active_since_ - active_->start_cycle) * period_s_;
  const double to = std::min(static_cast<double>(until_cycle - active_->start_cycle) * period_s_, active_->end_time_s);
  if (to > from) on_travelled(*active_, from, to);
}

void Drive::plan_once() {
  const ServoProgress known = progress();
  const CpuTime time;
  planner.step(known);
  const double taken_s = time.since_s();
  planning_s_ += taken_s;
  longest_step_s_ = std::max(longest_step_s_, taken_s);
  pass_plans();
}

double Drive::plan() {
  const double before_s = planning_s_;
  const std::uint64_t plans = plans_;
  double answer_s = 0;
  while (!planner.idle(progress())) {
    const bool answered = plans_ != plans || to_tap_.stopping.load() != 0;
    plan_once();
    if (!answered) answer_s = planning_s_ - before_s;
  }
  return answer_s;
}

bool Drive::stops() const {
  const std::uint64_t first = to_tap_.stopping.load();
  return first != 0 && active_ != nullptr && active_->id >= first;
}

const Setpoint& Drive::cycle() {
  plan();
  ++cycle_;
  follower_.sample(cycle_, setpoint_);
  // As behind a servo loop, the planner hears at once what became of its plan.
  plan_once();
  // Plans that the follower is through with go back to the planner, which frees them.
  const Plan* plan_back = nullptr;
  while (to_follower_.retired.pop(plan_back)) (void)to_tap_.retired.push(plan_back);
  // The follower's rule for what it takes over, seen from its answers.
  while (!passed_.empty() && passed_.front()->id <= std::max(follower_.accepted_plan(), follower_.last_refused())) {
    const auto plan = passed_.front();
    const bool replaced = passed_.size() > 1 && passed_[1]->id <= follower_.accepted_plan();
    if (plan->id == follower_.last_refused() || (cycle_ < plan->start_cycle && replaced)) {
      passed_.pop_front();
      continue;
    }
    if (cycle_ < plan->start_cycle) break;
    travelled(cycle_);
    active_ = plan;
    active_since_ = cycle_;
    passed_.pop_front();
  }
  if (on_setpoint) on_setpoint(setpoint_);
  return setpoint_;
}

void Drive::finish() {
  travelled(cycle_ + 1);
  active_since_ = cycle_ + 1;
}

bool Drive::resting() {
  return !setpoint_.moving && planner.idle(progress()) && planner.at_rest(progress());
}

bool Drive::run(std::int64_t most) {
  for (std::int64_t i = 0; i < most; ++i) {
    cycle();
    if (resting()) return true;
  }
  return false;
}

}  // namespace rmac::bench

#include "judge.hpp"

#include <algorithm>

namespace rmac::bench {

Judge::Judge(const PlannerModel& model, const std::vector<double>& start_joints)
    : drive(model, start_joints),
      check_(model.joints, model.max_feed_mm_s),
      period_s_(model.period_s),
      joint_count_(model.joints.size()) {
  drive.on_travelled = [this](const Plan& plan, double from, double to) { check_.travelled(plan, from, to); };
  drive.on_setpoint = [this](const Setpoint& setpoint) {
    check_.setpoint(setpoint);
    if (on_joints && setpoint.moving) on_joints(std::span(setpoint.position).first(joint_count_));
    if (moving_ && !setpoint.moving) ++stops_;
    moving_ = setpoint.moving;
    cycles_ += moving_ ? 1 : 0;
  };
}

tl::expected<Machined, std::string> Judge::run() {
  drive.planner.command(PathCommand::Run);
  if (!drive.run(kMostCycles)) return tl::unexpected(std::string("did not come to its end within 3000 s"));
  drive.finish();
  return Machined{.time_s = static_cast<double>(cycles_) * period_s_,
                  .planning_s = drive.planning_s(),
                  .longest_step_s = drive.longest_step_s(),
                  .limits = check_.worst(),
                  .deviation_mm = 0,
                  .rests = std::max(stops_ - 1, 0)};
}

}  // namespace rmac::bench

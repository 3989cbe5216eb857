#include "gateway/verifier/planned_moves.hpp"

#include <fmt/format.h>

#include "gateway/dynamics/axis_models.hpp"
#include "gateway/verification/checks/planned_moves_check.hpp"
#include "gateway/verifier/machine_rig.hpp"
#include "gateway/verifier/samples.hpp"
#include "gateway/verifier/watched_ports.hpp"

namespace rmac::verifier {
namespace {

/// Moves of which the last were refused, in words.
constexpr const char* kNoneRun = "of {} moves to places that joints within their travel give, the planner can run none";

PlannedMovesCase case_of(const MachineRig& rig, const Task& task, Watch& watch) {
  const gateway::Mechanism& mechanism = rig.mechanism();
  PlannedMovesCase given;
  given.model = mechanism.planner_model;
  given.model.kinematics = std::make_shared<WatchedKinematics>(given.model.kinematics, watch);
  given.tools = sample_tools(*mechanism.planner_model.kinematics);
  given.seed = task.seed;
  given.misdeed = [&watch] { return watch.misdeed(); };
  for (const JointLimits& limits : given.model.joints) given.ranges.push_back(range_of(limits));
  const auto hold = mechanism.loop->hold_position().first(given.model.joints.size());
  given.start.assign(hold.begin(), hold.end());
  return given;
}

}  // namespace

void check_planned_moves(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell) {
  sdk::DeviceObject device = task.device;
  const bool virtual_mode = !gateway::put_on_models(device).empty();
  auto rig = MachineRig::assemble(task, virtual_mode ? task.device : device, virtual_mode, watch);
  Checked checked = rig ? (*rig)->power_up() : Checked(tl::unexpected(rig.error()));
  PlannedMoves moves;
  if (checked) {
    PlannedMovesCase given = case_of(**rig, task, watch);
    given.follow = [&](const Setpoint& setpoint, const Frames& frames) {
      (*rig)->command().setpoint = setpoint;
      (*rig)->command().frames = frames;
      const Checked fine = (*rig)->cycle();
      watch.step("planning");
      return fine;
    };
    watch.step("planning");
    const auto done = check_planned_moves(given);
    if (!done) {
      checked = tl::unexpected(done.error());
    } else if (moves = *done; moves.run == 0) {
      checked = found("planned moves", fmt::format(kNoneRun, moves.refused), -1, {});
    }
  }
  if (checked) {
    report.passed.push_back(fmt::format("{} planned moves are run to their ends{}, each joint within its limits",
                                        moves.run, virtual_mode ? "" : " on the axis models"));
  } else {
    report.refusal = checked.error();
  }
  tell();
}

}  // namespace rmac::verifier

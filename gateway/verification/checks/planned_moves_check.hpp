#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"
#include "rmac/motion/planner_model.hpp"
#include "rmac/motion/pose.hpp"
#include "rmac/motion/servo/setpoint.hpp"

namespace rmac::verifier {

struct PlannedMovesCase {
  PlannerModel model;
  std::vector<JointRange> ranges;  ///< of each joint: where moves lead
  std::vector<double> start;       ///< where the joints stand
  std::vector<Frame> tools = {Frame{}};
  int programs = 10;
  std::uint64_t seed = 1;
  Misdeed misdeed{};
  /// Asked of every setpoint, in the order of the cycles: what follows it.
  std::function<Checked(const Setpoint& setpoint, const Frames& frames)> follow{};
};

struct PlannedMoves {
  int run = 0;
  int refused = 0;  ///< for their geometry, before they moved anything: out of travel, or of reach
};

/// What the planner makes of a mechanism: seeded programs of joint targets, lines and NURBS within its travel, with
/// exact corners and rounded ones, as a client would send them. Each comes to its end; at each cycle every joint keeps
/// its travel and its limits, and the tool is on its line. The planner's own time is bounded: a geometry that has it
/// search on and on is found.
[[nodiscard]] tl::expected<PlannedMoves, CounterExample> check_planned_moves(const PlannedMovesCase& given);

}  // namespace rmac::verifier

#pragma once

#include "gateway/verifier/worker.hpp"

namespace rmac::verifier {

/// Has the planner plan moves through the mechanism's kinematics, and its servo loops run them on the axis models of
/// its buses; without such a model, in virtual mode.
void check_planned_moves(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell);

}  // namespace rmac::verifier

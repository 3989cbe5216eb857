#pragma once

#include <functional>

#include "gateway/verifier/worker.hpp"

namespace rmac::verifier {

/// All of a mechanism's modules together on the axis models of its buses: the drives come up, each joint goes a little
/// way and back within its limits, follows within its bound, and stands still after it; each spindle comes to its full
/// speed and to rest. Not checked where a bus is neither simulated nor has a model.
void check_servo_loops(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell);

}  // namespace rmac::verifier

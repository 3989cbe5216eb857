#pragma once

#include <functional>

#include "gateway/verifier/worker.hpp"

namespace rmac::verifier {

/// All of a mechanism's modules together on the axis models of its simulated bus: the drives come up, and each joint
/// goes a little way and back within its limits, follows within its bound, and stands still after it. Not checked where
/// a bus is not a simulated one: what its axes are made of is not known before `rmac tune`.
void check_servo_loops(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell);

}  // namespace rmac::verifier

#pragma once

#include "gateway/verifier/confinement/confinement.hpp"
#include "gateway/verifier/worker.hpp"

namespace rmac::verifier {

/// Runs a job in a process of its own, which is killed when it uses more than it may or does not come back from a call.
/// A crash and a hang are refusals like others, with the call in which it happened and what the call was given.
[[nodiscard]] ModuleReport supervise(const Job& job, const Task& task, const Bounds& bounds = {});

}  // namespace rmac::verifier

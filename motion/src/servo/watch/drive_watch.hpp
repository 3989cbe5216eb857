#pragma once

#include <cstddef>

#include "rmac/motion/ports/digital_control_interface.hpp"
#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// The drive tells a fault of its own. Real-time safe, as all that follows.
[[nodiscard]] bool is_faulted(const DriveFeedback& words) noexcept;
/// It answers, and gives torque.
[[nodiscard]] bool operates(const DriveFeedback& words) noexcept;

/// What is wrong with a drive of a machine under power: `part` and `index` say whose it is. `in_use`: the loop counts
/// on its answers and its torque.
void watch_drive(const DriveFeedback& words, bool in_use, ServoFault::Part part, std::size_t index,
                 FaultSink& faults) noexcept;
/// A drive that does not operate though it has had `timeout_s` for it.
void watch_enabled(const DriveFeedback& words, double timeout_s, ServoFault::Part part, std::size_t index,
                   FaultSink& faults) noexcept;

}  // namespace rmac

#pragma once

#include <cstdint>
#include <span>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"

namespace rmac {

/// Watches emergency stops and limit switches among the machine's inputs. Real-time safe.
class InputWatch {
 public:
  /// `parts` must outlive it.
  explicit InputWatch(const ServoLoopParts& parts) noexcept : parts_(parts) {}

  /// One cycle's inputs. `homing`: joints whose drives look for home, which may be in a limit switch.
  void step(std::uint64_t inputs, IndexSet homing, FaultSink& faults) noexcept;
  /// Whoever was told of a switch and reset the machine may move off it, and no further. `live`: joints under control.
  void hold_back(IndexSet live, std::span<const double> velocity_set, FaultSink& faults) const noexcept;

  [[nodiscard]] std::uint64_t inputs() const noexcept { return inputs_; }
  [[nodiscard]] bool emergency_stop() const noexcept { return (inputs_ & parts_.emergency_stop_inputs) != 0; }

 private:
  const ServoLoopParts& parts_;
  std::uint64_t inputs_ = 0;  ///< of the last cycle
};

}  // namespace rmac

#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/drives/shafts.hpp"
#include "servo/joints/transmission.hpp"
#include "servo/joints/wiring.hpp"
#include "servo/probe/probe_latch.hpp"
#include "servo/probe/probe_signal.hpp"

namespace rmac {

/// The touch probe of the machine: its contact among the inputs, and the drives that latch their positions at a hit.
/// Real-time safe but for its making.
class Probe {
 public:
  /// Both must outlive it.
  Probe(const ServoLoopParts& parts, const Wiring& wiring);

  /// One cycle: the machine's inputs, and what the drives told.
  void read(std::uint64_t inputs) noexcept;
  /// What the drive is told of its touch probe (60B8h).
  [[nodiscard]] std::uint16_t function(std::size_t actuator) const noexcept;
  /// With what the drives have latched, as positions of joints.
  [[nodiscard]] ProbeReport report(const Shafts& shafts, const Transmission& transmission) const noexcept;

 private:
  const ServoLoopParts& parts_;
  const Wiring& wiring_;
  ProbeSignal signal_;
  std::vector<std::optional<ProbeLatch>> latches_;  ///< one an actuator
};

}  // namespace rmac

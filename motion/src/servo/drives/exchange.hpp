#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"

namespace rmac {

/// Answers in from all buses of the mechanism and its I/O, and words out. Real-time safe but for its making.
class Exchange {
 public:
  /// `parts` must outlive it.
  explicit Exchange(const ServoLoopParts& parts);

  /// Answers of all drives, then the exchange with the I/O; the machine's inputs, those that drives tell among them.
  [[nodiscard]] std::uint64_t receive(std::uint64_t outputs, FaultSink& faults) noexcept;
  /// What was made of them.
  void send(FaultSink& faults) noexcept;
  /// Another loop's words stand: those for drives that this loop has go on, the others ask for nothing.
  void take_over() noexcept;
  /// The bus that a fault of a bus names by `index`; nullptr where there is none.
  [[nodiscard]] const ServoBus* bus(std::size_t index) const noexcept {
    return index < buses_.size() ? buses_[index].get() : nullptr;
  }
  /// Time that both took in this cycle.
  [[nodiscard]] std::int64_t took_ns() const noexcept { return took_ns_; }

 private:
  [[nodiscard]] bool owns(const ServoBus* bus, std::uint32_t axis) const noexcept;

  const ServoLoopParts& parts_;
  /// Each once, in the order in which actuators, spindles and sensors name them.
  std::vector<std::shared_ptr<ServoBus>> buses_;
  bool fresh_ = true;
  std::int64_t took_ns_ = 0;
};

}  // namespace rmac

#pragma once

#include "rmac/motion/servo/servo_fault.hpp"

namespace rmac {

/// Takes what is found wrong in a cycle, in the order in which it is found. The first cause counts.
class FaultSink {
 public:
  virtual void raise(const ServoFault& found) noexcept = 0;

 protected:
  ~FaultSink() = default;
};

}  // namespace rmac

#pragma once

#include "rmac/motion/error.hpp"

namespace rmac::sdk {

/// Joints under force control. Gateway thread only.
class JointForces {
 public:
  virtual ~JointForces() = default;

  /// Contact force that a joint under force control keeps, N or N·m, positive towards larger positions; 0: it holds its
  /// position. The joint goes for contact by itself. A stop of the cycle lets go of it.
  virtual Expected<> set(int joint, double force) = 0;
};

}  // namespace rmac::sdk

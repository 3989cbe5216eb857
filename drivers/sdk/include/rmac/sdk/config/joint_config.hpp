#pragma once

#include <string_view>

#include "rmac/motion/error.hpp"
#include "rmac/motion/limits.hpp"

namespace rmac::sdk {

/// What a draft says of one joint's travel and bounds: mm and s, or degrees and s. Held joints count behind those that
/// are moved. Gateway thread only.
class JointConfig {
 public:
  virtual ~JointConfig() = default;

  virtual Expected<> set_name(int joint, std::string_view name) = 0;
  virtual Expected<> set_type(int joint, JointType type) = 0;
  virtual Expected<> set_limit_type(int joint, JointLimitType type) = 0;
  virtual Expected<> set_maximum_limit(int joint, double value) = 0;
  virtual Expected<> set_minimum_limit(int joint, double value) = 0;
  virtual Expected<> set_maximum_speed(int joint, double value) = 0;
  virtual Expected<> set_maximum_acceleration(int joint, double value) = 0;
  virtual Expected<> set_maximum_jerk(int joint, double value) = 0;
};

}  // namespace rmac::sdk

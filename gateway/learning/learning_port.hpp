#pragma once

#include <nlohmann/json_fwd.hpp>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// What was learned of a program that is repeated, as the machine makes it good. Gateway thread.
class LearningPort {
 public:
  virtual ~LearningPort() = default;

  /// An object as docs/servo.md has it; null: nothing is made good any more. At rest, with an empty queue. Refused
  /// where it was learned with another machine or configuration, and where it goes beyond what may be learned.
  virtual Expected<> set_learned(const nlohmann::json& learned) = 0;
  /// What there is to know of the machine for who learns, and how much is in force.
  [[nodiscard]] virtual Expected<nlohmann::json> learned() const = 0;
  /// Nothing is made good from the next cycle on; also in motion, without a step.
  virtual void forget() = 0;
};

}  // namespace rmac::gateway

#pragma once

#include <cstdint>

#include "rmac/motion/planner.hpp"

namespace rmac {

/// How long planning takes, in servo cycles: so far ahead of the servo loop a plan must begin to be there in time.
/// Learns from the cycles that go by while a plan is made, and from plans that came too late.
class PlanningTime {
 public:
  /// A plan is begun in this cycle.
  void began(std::int64_t cycle) noexcept { began_ = cycle; }
  /// What the servo loop tells afterwards. A refused plan came too late: the next one is left more time.
  void heard(const ServoProgress& progress) noexcept;
  /// Cycles from now after which a plan begun now will have reached the servo loop.
  [[nodiscard]] std::int64_t lead() const noexcept;

 private:
  double cycles_ = 0;          ///< that went by while a plan was made, lately
  std::int64_t began_ = -1;    ///< cycle in which the last plan was begun; -1 once that was heard of
  std::uint64_t refused_ = 0;  ///< the last plan that was refused
};

}  // namespace rmac

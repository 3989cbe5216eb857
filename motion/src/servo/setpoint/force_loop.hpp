#pragma once

#include <string>

#include "rmac/motion/error.hpp"
#include "rmac/motion/force_control.hpp"

namespace rmac {

/// The loop around a joint's position loop that keeps its contact force: force error to velocity of the position's
/// setpoint (docs/servo.md, "Force"). Real-time safe.
class ForceLoop {
 public:
  ForceLoop(const ForceControl& control, double period_s) noexcept : control_(control), period_s_(period_s) {}

  /// One cycle: the velocity that the joint's setpoint is to have. `wanted` and `measured`: what the joint pushes with;
  /// wanted 0: hold the position.
  [[nodiscard]] double step(double wanted, double measured) noexcept;
  [[nodiscard]] ContactState state() const noexcept { return state_; }
  /// Way without contact, from the start or from where it was lost.
  [[nodiscard]] double searched() const noexcept { return searched_; }
  /// Begins anew, at rest.
  void restart() noexcept;

 private:
  [[nodiscard]] double target(double wanted, double measured) noexcept;

  ForceControl control_;
  double period_s_;
  ContactState state_ = ContactState::Holding;
  double velocity_ = 0;
  double integral_ = 0;  ///< velocity
  double searched_ = 0;
};

/// What makes no sense in `control`, named; `who` is the joint.
[[nodiscard]] Expected<> check_force_control(const ForceControl& control, const std::string& who);

}  // namespace rmac

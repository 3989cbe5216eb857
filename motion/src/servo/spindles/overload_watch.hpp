#pragma once

namespace rmac {

/// Tells a spindle that is overloaded from one that is changing its speed. Real-time safe.
class OverloadWatch {
 public:
  OverloadWatch(double tolerance_rpm, double timeout_s, double period_s) noexcept
      : tolerance_rpm_(tolerance_rpm), timeout_s_(timeout_s), period_s_(period_s) {}

  /// One cycle. True from when `torque_nm` has been at `bound_nm` for a tenth of a second, at the speed that is wanted
  /// or after the time that it may take to come there. A bound of 0 is none.
  [[nodiscard]] bool step(double wanted_rpm, double rpm, double torque_nm, double bound_nm) noexcept;

 private:
  double tolerance_rpm_;
  double timeout_s_;
  double period_s_;
  double wanted_rpm_ = 0;  ///< in the cycle before
  double since_change_s_ = 0;
  double over_s_ = 0;
  bool arrived_ = false;
};

}  // namespace rmac

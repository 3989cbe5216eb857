#pragma once

#include "clients/legacy/program/writer.hpp"

namespace rmac::legacy {

/// Spindle and coolant: what of them a program asks for, and what was written of it. Nothing is written before write().
class MachineSwitches {
 public:
  explicit MachineSwitches(Writer& writer) : writer_(writer) {}

  void set_speed(double rpm) noexcept { rpm_ = rpm; }
  /// 1: clockwise, -1: the other way, 0: not at all.
  void turn(int direction) noexcept { direction_ = direction; }
  [[nodiscard]] bool spindle_turns() const noexcept { return direction_ != 0 && rpm_ != 0; }
  [[nodiscard]] int direction() const noexcept { return direction_; }
  [[nodiscard]] bool mist() const noexcept { return mist_; }
  [[nodiscard]] bool flood() const noexcept { return flood_; }
  [[nodiscard]] double rpm() const noexcept { return rpm_; }
  /// Stops the spindle where a program does not say so, and lets it turn again.
  void hold_spindle();
  void release_spindle();
  void set_mist(bool on) noexcept { mist_ = on; }
  void set_flood(bool on) noexcept { flood_ = on; }
  /// The appliance stopped spindle and coolant for a change of tool. The coolant that was on comes on again.
  void tool_was_changed() noexcept;
  /// Writes what changed. Several calls are one request.
  void write();
  /// The end of a program: all off.
  void off();

 private:
  Writer& writer_;
  double rpm_ = 0, turning_rpm_ = 0;
  int direction_ = 0, held_ = 0;
  bool mist_ = false, flood_ = false, mist_on_ = false, flood_on_ = false;  ///< wanted, and written
};

}  // namespace rmac::legacy

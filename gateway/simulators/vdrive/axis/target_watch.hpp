#pragma once

namespace rmac::vdrive {

/// How well a drive does what it is to do: whether it is at its target, and whether it follows (bits 10 and 13 of the
/// statusword, CiA 402-2).
class TargetWatch {
 public:
  /// As after power on.
  void reset() noexcept { at_target_ = following_error_ = false; }
  /// There is another target.
  void leave_target() noexcept { at_target_ = false; }
  /// `within` tells whether it is where it should be, which counts when it has lasted `needed_s`.
  void reach(bool within, double needed_s, double dt) noexcept {
    in_window_s_ = within ? in_window_s_ + dt : 0;
    at_target_ = within && in_window_s_ >= needed_s;
  }
  /// `beyond` tells whether it is too far from what it follows. True when that has lasted longer than it may.
  [[nodiscard]] bool follow(bool beyond, double allowed_s, double dt) noexcept {
    following_error_ = beyond;
    error_s_ = beyond ? error_s_ + dt : 0;
    return beyond && error_s_ > allowed_s;
  }

  [[nodiscard]] bool at_target() const noexcept { return at_target_; }
  [[nodiscard]] bool following_error() const noexcept { return following_error_; }

 private:
  double in_window_s_ = 0;
  double error_s_ = 0;
  bool at_target_ = false;
  bool following_error_ = false;
};

}  // namespace rmac::vdrive

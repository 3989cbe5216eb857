#pragma once

namespace rmac {

/// What a joint is pushed with beyond its law's output while it touches, so that its force is the wanted one: the error
/// integrated twice, behind a low-pass. The sum of all that pushes acts on the part whatever its stiffness is, so that
/// one bandwidth does for all of them; it stays below where the part and the joint swing (docs/servo.md, "Force").
/// N or N·m and s. Real-time safe.
class ContactEffort {
 public:
  explicit ContactEffort(double period_s) noexcept;

  /// Contact begins: nothing is added yet.
  void begin() noexcept { *this = ContactEffort(period_s_); }
  struct Limits {
    double bandwidth_rad_s = 0;             ///< no more than this
    double reset_time_s = 0;                ///< of the outer integral, no less than this
    double largest_error = 0;               ///< that counts for the outer integral
    bool no_more = false, no_less = false;  ///< ways that the effort may not go now
  };
  /// One cycle, by the force's error.
  [[nodiscard]] double step(double error, const Limits& limits) noexcept;

 private:
  double period_s_;
  double part_a_cycle_;  ///< of the low-pass's stages
  double smoothed_ = 0, smooth_ = 0;
  double rate_ = 0;  ///< of the effort, that a part needs which rises or falls
  double effort_ = 0;
};

}  // namespace rmac

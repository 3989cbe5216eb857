#pragma once

#include <cstdint>
#include <optional>

#include "servo/joints/range.hpp"

namespace rmac {

/// What no brake and no wall takes from a joint within a cycle: mm or degrees in a cycle.
[[nodiscard]] inline double dead_stop(double max_acceleration, double period_s) noexcept {
  constexpr double kTimes = 10;
  return kTimes * max_acceleration * period_s * period_s;
}

/// The last digit of a joint's encoder, which is never quite still where it resolves well. Where it went to and fro
/// until now, or the joint went at a speed that nothing takes away within a cycle, and it tells the same from then on,
/// it froze, or its shaft is held fast. Real-time safe.
class EncoderDigits {
 public:
  /// `fast`: the way in a cycle, mm or degrees, of such a speed; 0: there is none.
  EncoderDigits(double fast, double period_s) noexcept;

  /// One reading, and the effort under which it was taken.
  void note(double position, double effort) noexcept;
  /// The joint is under control from now on: what its counter did before is no motion of it.
  void begin(double position, double effort) noexcept;
  /// There is none in this cycle, and none that the next one could be compared with.
  void lose() noexcept { last_.reset(); }

  /// From the last reading to this one; 0 where there was none.
  [[nodiscard]] double step_to(double position) const noexcept { return last_ ? position - *last_ : 0; }
  /// It tells the same for some milliseconds, as it did not before.
  [[nodiscard]] bool froze() const noexcept;
  [[nodiscard]] std::int64_t same() const noexcept { return same_; }  ///< readings on end
  /// By which the effort changed while they lasted.
  [[nodiscard]] double effort_change() const noexcept { return effort_.width(); }
  /// By which it did so while others lasted that ended: a digit is so coarse.
  [[nodiscard]] double usual_change() const noexcept { return usual_; }
  /// It goes to and fro by several digits under control: it resolves so finely that it is never still for long,
  /// whatever friction does, though it may rest for some milliseconds.
  [[nodiscard]] bool noisy() const noexcept;
  /// The least step that there was; 0: there was none.
  [[nodiscard]] double digit() const noexcept { return digit_; }

 private:
  void note_step(double step) noexcept;

  double fast_;
  std::int64_t rests_cycles_, noticed_cycles_;  ///< readings on end that are a rest, and that are noticed
  std::optional<double> last_{};
  double last_step_ = 0;       ///< that was none of 0
  int turns_ = 0;              ///< in which steps turned round, without a rest
  int noisy_turns_ = 0;        ///< by two digits and more, before and after
  int fast_cycles_ = 0;        ///< on end
  bool stopped_dead_ = false;  ///< from a fast one
  std::int64_t same_ = 0;
  Range effort_{};
  double usual_ = 0, digit_ = 0;
};

}  // namespace rmac

#pragma once

#include <cstdint>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/response_seen.hpp"

namespace rmac {

/// Finds a joint whose position stays while it is to move: one that is blocked, or whose encoder froze.
///
/// An encoder that resolves well is never quite still: its last digit goes to and fro. Where it did so until now, or
/// went on at speed, and then tells the same to the last digit, however much the effort changes meanwhile, it froze; a
/// joint that is blocked gives way a little. So it is found before an integral part has moved the joint far. Real-time
/// safe.
class StandingWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  StandingWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint), index_(static_cast<std::uint32_t>(index)), period_s_(period_s) {}

  void step(const ResponseSeen& seen, FaultSink& faults) noexcept;
  /// The joint is not under control, and its encoder tells so; where nothing is told, `rest()` keeps what was found.
  void rest(double position) noexcept;
  void rest() noexcept;
  /// The encoder tells the same to the last digit for some milliseconds, as it did not before.
  [[nodiscard]] bool froze() const noexcept;
  void raise_frozen(FaultSink& faults) const noexcept;

 private:
  /// Least and largest of a value.
  struct Range {
    double least = 0, most = 0;
    void begin(double value) noexcept { least = most = value; }
    void add(double value) noexcept {
      if (value < least) least = value;
      if (value > most) most = value;
    }
    [[nodiscard]] double width() const noexcept { return most - least; }
  };

  void note_digits(double position, double effort) noexcept;
  void watch_digits(const ResponseSeen& seen, FaultSink& faults) const noexcept;
  void watch_way(const ResponseSeen& seen, FaultSink& faults) noexcept;
  void watch_limit(const ResponseSeen& seen, FaultSink& faults) noexcept;
  void begin_way(const ResponseSeen& seen) noexcept;
  [[nodiscard]] std::int64_t cycles(double seconds) const noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;
  bool begun_ = false;

  // The encoder's last digit.
  int turns_ = 0;              ///< in which its steps turned round, without a rest
  bool stopped_dead_ = false;  ///< from a speed that nothing takes away within a cycle
  double last_step_ = 0;       ///< that was none of 0
  double digits_ = 0;          ///< position in the cycle before
  std::int64_t same_ = 0;      ///< cycles on end
  double set_still_ = 0;       ///< where it was to be when they began
  Range effort_{};             ///< of them

  // The way that the joint was to go while it stands.
  Range position_{}, set_{};
  double set_before_ = 0, set_at_ = 0;
  double way_ = 0;
  std::int64_t stands_ = 0;  ///< cycles

  // All its effort, and what comes of it.
  std::int64_t at_limit_ = 0;  ///< cycles
  Range pushed_{};             ///< positions of them
};

}  // namespace rmac

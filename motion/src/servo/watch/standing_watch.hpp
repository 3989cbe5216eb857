#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/response_seen.hpp"

namespace rmac {

/// Finds a joint whose position stays while it is to move: one that is blocked, or whose encoder froze.
///
/// An encoder that resolves well is never quite still: its last digit goes to and fro. Where it did so until now, or
/// went on at speed, and then tells the same to the last digit, while the effort changes by more than it did in any
/// digit before, it froze; a joint that is blocked gives way a little. So it is found before an integral part has moved
/// the joint far. A loop that is too soft to move its joint at once does not push, and that is no standing. Real-time
/// safe.
class StandingWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  StandingWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint), index_(static_cast<std::uint32_t>(index)), period_s_(period_s) {}

  void step(const ResponseSeen& seen, FaultSink& faults) noexcept;
  /// The joint is not under control; `position`: where its encoder has it meanwhile. Where that is not told, what was
  /// found of its digits is kept.
  void rest(std::optional<double> position = std::nullopt) noexcept;
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
    void add(const Range& other) noexcept {
      add(other.least);
      add(other.most);
    }
    [[nodiscard]] double width() const noexcept { return most - least; }
  };
  /// A part of the way that the joint was to go.
  struct Stretch {
    Range position{}, set{};
    Range free{};     ///< where a joint would be that nothing holds
    double from = 0;  ///< where it was to be at its beginning
    double way = 0;   ///< that it was to go, there and back
    std::int64_t cycles = 0;
    std::int64_t pushed = 0;  ///< of them, in which it was by more than friction takes
  };

  void note_digits(double position, double effort) noexcept;
  void note_step(double step) noexcept;
  void watch_digits(const ResponseSeen& seen, FaultSink& faults) const noexcept;
  void watch_way(const ResponseSeen& seen, double went, FaultSink& faults) noexcept;
  void watch_limit(const ResponseSeen& seen, FaultSink& faults) noexcept;
  void begin_limit(const ResponseSeen& seen) noexcept;
  void begin_rest(const ResponseSeen& seen) noexcept;
  void begin_stretch(const ResponseSeen& seen) noexcept;
  void push(const ResponseSeen& seen, double went) noexcept;
  /// The latest stretches in which it was to go so far, for so long at least; all of them where they are less.
  [[nodiscard]] Stretch lately(double way, std::int64_t least_cycles) const noexcept;
  [[nodiscard]] static bool stands(const Stretch& stretch) noexcept;
  void raise_standing(const Stretch& stretch, const ResponseSeen& seen, FaultSink& faults) const noexcept;
  [[nodiscard]] std::int64_t cycles(double seconds) const noexcept;
  /// What keeps it from going is nothing that it makes good.
  [[nodiscard]] bool slips() const noexcept { return joint_->method == ControlMethod::Velocity; }

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;
  bool begun_ = false;

  // The encoder's last digit.
  int turns_ = 0;                   ///< in which its steps turned round, without a rest
  bool stopped_dead_ = false;       ///< from a speed that nothing takes away within a cycle
  int fast_ = 0;                    ///< cycles on end at such a speed
  double last_step_ = 0;            ///< that was none of 0
  double digit_ = 0;                ///< the least of them; 0: there was none
  std::optional<double> digits_{};  ///< position in the cycle before, where it was told
  std::int64_t same_ = 0;           ///< cycles on end
  double set_still_ = 0;            ///< where it was to be when they began
  Range effort_{};                  ///< of them
  double usual_ = 0;  ///< by which the effort changed while others lasted that ended: a digit is so coarse

  // The way that the joint was to go lately.
  static constexpr std::size_t kMostStretches = 24;
  std::array<Stretch, kMostStretches> stretches_{};
  std::size_t latest_ = 0, stretched_ = 0;
  double set_before_ = 0;
  int set_rests_ = 0;         ///< cycles on end
  double effort_lately_ = 0;  ///< mean of them: it holds the weight of the joint
  std::int64_t efforts_ = 0;
  double went_speed_ = 0;                ///< lately
  double free_speed_ = 0, free_at_ = 0;  ///< that its effort gives it at least where nothing holds it

  // All its effort, and what comes of it.
  std::int64_t at_limit_ = 0;  ///< cycles
  double set_at_limit_ = 0;    ///< where it was to be when they began
  Range pushed_{};             ///< positions of them
};

}  // namespace rmac

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/encoder_digits.hpp"
#include "servo/joints/range.hpp"
#include "servo/watch/response_seen.hpp"

namespace rmac {

/// Finds a joint whose position stays while it is to move: one that is blocked, or whose encoder froze.
///
/// What is blocked gives way a little; an encoder that froze (`EncoderDigits`) does not, while the effort changes by
/// more than it did in any digit before. So it is found before an integral part has moved the joint far. A loop that is
/// too soft to move its joint at once does not push, and that is no standing. Real-time safe.
class StandingWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  StandingWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept;

  void step(const ResponseSeen& seen, FaultSink& faults) noexcept;
  /// The joint is not under control; `position`: where its encoder has it meanwhile. Where that is not told, what was
  /// found of its digits is kept.
  void rest(std::optional<double> position = std::nullopt) noexcept;
  /// The encoder tells the same to the last digit for some milliseconds, as it did not before.
  [[nodiscard]] bool froze() const noexcept { return digits_.froze(); }
  void raise_frozen(FaultSink& faults) const noexcept;

 private:
  /// A part of the way that the joint was to go.
  struct Stretch {
    Range position{}, set{};
    Range free{};     ///< where a joint would be that nothing holds
    double from = 0;  ///< where it was to be at its beginning
    double way = 0;   ///< that it was to go, there and back
    std::int64_t cycles = 0;
    std::int64_t pushed = 0;  ///< of them, in which it was by more than friction takes
  };

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
  /// What keeps it from going is nothing that it makes good.
  [[nodiscard]] bool slips() const noexcept { return joint_->method == ControlMethod::Velocity; }

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;
  struct {
    std::int64_t stands, stretch, limit;
  } least_cycles_;  ///< that it takes
  bool begun_ = false;

  EncoderDigits digits_;
  double set_still_ = 0;  ///< where it was to be when they began to stay

  // The way that the joint was to go lately.
  static constexpr std::size_t kMostStretches = 48;
  std::array<Stretch, kMostStretches> stretches_{};
  std::size_t latest_ = 0, stretched_ = 0;
  double set_before_ = 0;
  int set_rests_ = 0;         ///< cycles on end
  double effort_lately_ = 0;  ///< mean of them: it holds the weight of the joint
  std::int64_t efforts_ = 0;
  double went_speed_ = 0;                ///< lately
  double free_speed_ = 0, free_at_ = 0;  ///< that its effort gives it at least where nothing holds it

  // All its effort, and what comes of it.
  struct {
    std::int64_t cycles = 0;
    double set = 0;    ///< where it was to be when they began
    Range position{};  ///< of them
  } at_limit_;
};

}  // namespace rmac

#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/error_history.hpp"
#include "servo/watch/response_seen.hpp"
#include "servo/watch/standing_watch.hpp"

namespace rmac {

/// Finds a joint that does not answer: it goes faster and faster against its effort and away from its setpoint, the
/// faster the longer that lasts, as with a motor or an encoder of the wrong sign, where what pushes it grows with the
/// way, and what only pushed a sound one is held better and better; or it stands still while it is to move
/// (`StandingWatch`). Real-time safe.
class ResponseWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  ResponseWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint),
        index_(static_cast<std::uint32_t>(index)),
        period_s_(period_s),
        fades_(std::exp(-period_s / kForgetsS)),
        standing_(joint, index, period_s),
        lately_(period_s, kSampleS),
        longer_(period_s, kLongSampleS) {}

  void step(const ResponseSeen& seen, FaultSink& faults) noexcept;
  [[nodiscard]] bool encoder_froze() const noexcept { return standing_.froze(); }
  /// Behind `step`, for a joint that left its bound of following error: by the cause that its last way shows, or as
  /// `FollowingError` where it shows none.
  void name_error(double error, FaultSink& faults) const noexcept;
  /// The joint is not under control; `position`: where its encoder has it meanwhile, where it tells that.
  void rest(std::optional<double> position = std::nullopt) noexcept;

 private:
  static constexpr double kForgetsS = 0.02;
  static constexpr double kSampleS = 0.001, kLongSampleS = 0.01;
  [[nodiscard]] bool rebounds(double way) noexcept;
  void forget_direction(double error) noexcept;
  void watch_direction(const ResponseSeen& seen, double way, FaultSink& faults) noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;
  double fades_;  ///< share of a way that is left of it in the next cycle

  bool begun_ = false;
  double last_position_ = 0, last_way_ = 0;  ///< in the last cycle in which its drives answered
  int cycles_ = 0;                           ///< since
  int against_ = 0;                          ///< cycles on end
  double gone_ = 0;                          ///< way of them
  double first_gain_ = 0, last_gain_ = 0;    ///< of its way, in the first half of them and after it
  double error_before_ = 0;
  StandingWatch standing_;
  ErrorHistory lately_, longer_;
  double back_ = 0, forth_ = 0;  ///< fastest ways either way, lately
};

}  // namespace rmac

#pragma once

#include <algorithm>

#include "rmac/fieldbus/can/can_port.hpp"

namespace rmac::fieldbus::canopen {

/// Counts the frames of one synchronous TPDO against the SYNCs: a node sends one a SYNC, two nodes of the same id send
/// two. No evidence are frames that come late, in the window of another SYNC, and frames that come twice as they are,
/// which gateways make, and CAN itself where the last bit of a frame is disturbed. Real-time safe.
class SyncAnswers {
 public:
  void sync() noexcept {
    due_ = std::min(due_ + 1, kMostDue);
    if (surplus_ > 0 && ++since_surplus_ >= kForgetAfter) restart_surplus();
  }
  /// A frame has come. True when there were more, and different ones, than SYNCs explain.
  [[nodiscard]] bool take(const CanFrame& frame) noexcept {
    const bool repeated = any_ && frame == last_;
    last_ = frame;
    any_ = true;
    if (due_ > 0) {
      --due_;
      if (repeated) repeats_ = std::min(repeats_ + 1, kMostDue);  // may be a copy that used up another's place
      return false;
    }
    if (repeated) return false;
    if (repeats_ > 0) {
      --repeats_;
      return false;
    }
    since_surplus_ = 0;
    return ++surplus_ >= kEvidence;
  }
  void restart() noexcept { *this = {}; }

 private:
  static constexpr int kMostDue = 8;       ///< SYNCs whose answers may still be on their way
  static constexpr int kEvidence = 3;      ///< surplus frames
  static constexpr int kForgetAfter = 32;  ///< SYNCs without one

  void restart_surplus() noexcept { surplus_ = since_surplus_ = 0; }

  CanFrame last_{};
  bool any_ = false;
  int due_ = 2;  ///< a node may have begun before it was watched
  int repeats_ = 0;
  int surplus_ = 0;
  int since_surplus_ = 0;  ///< SYNCs
};

}  // namespace rmac::fieldbus::canopen

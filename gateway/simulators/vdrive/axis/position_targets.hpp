#pragma once

#include <cstdint>
#include <optional>

namespace rmac::vdrive {

/// The targets of profile position and the handshake by which new ones come (CiA 402-2, 10.2): taken on the rise of bit
/// 4 of the controlword, acknowledged until it falls and there is room for another. In counts.
class PositionTargets {
 public:
  /// As after power on.
  void reset() noexcept;
  /// The mode changed: what waits is dropped.
  void drop_next() noexcept;
  /// The target is here; one that waits still does.
  void stay(double position) noexcept { target_ = position; }

  /// What a controlword finds.
  struct Seen {
    bool active = false;     ///< the drive operates in profile position
    bool at_target = false;  ///< the last target was reached
    bool at_rest = false;    ///< the demand is
    double written = 0;      ///< the target that the master wrote
  };
  /// True when it made another target the one to go to.
  bool control(std::uint16_t word, const Seen& seen) noexcept;
  /// The target is reached: goes on to the one that waits. True when there was one.
  bool arrive() noexcept;

  [[nodiscard]] double target() const noexcept { return target_; }
  [[nodiscard]] bool has_next() const noexcept { return next_.has_value(); }
  [[nodiscard]] bool acknowledges() const noexcept { return acknowledges_; }

 private:
  double target_ = 0;
  std::optional<double> next_;
  bool acknowledges_ = false;
  bool asked_before_ = false;  ///< bit 4
};

}  // namespace rmac::vdrive

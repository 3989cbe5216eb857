#pragma once

#include <cstdint>

#include "rmac/motion/servo/servo_spindle.hpp"
#include "servo/spindles/overload_watch.hpp"
#include "servo/spindles/turn_reader.hpp"

namespace rmac {

/// What the servo loop keeps of one spindle between cycles. Real-time safe but for its making.
class SpindleLoop {
 public:
  SpindleLoop(const ServoSpindle& spindle, double period_s) noexcept;

  /// Takes what the drive measured.
  void read(const DriveFeedback& words) noexcept;
  /// One cycle of a drive under control: towards `wanted_rpm`, from what `words` told it before. False when the law
  /// gives no number.
  [[nodiscard]] bool follow(double wanted_rpm, const DriveCommand& words) noexcept;
  /// The drive is not under control.
  void let_go() noexcept;
  /// Speed and torque for the drive.
  void command(DriveCommand& words) const noexcept;
  /// Its measured torque has been at `bound_nm` for a tenth of a second, and not because it is changing its speed.
  [[nodiscard]] bool overloaded(double wanted_rpm, double bound_nm) noexcept {
    return overload_.step(wanted_rpm, rpm_, measured_nm_, bound_nm);
  }
  /// It turns faster than it may by a fifth, for three cycles on end.
  [[nodiscard]] bool too_fast() noexcept;

  [[nodiscard]] double rpm() const noexcept { return rpm_; }
  [[nodiscard]] double torque_nm() const noexcept { return measured_nm_; }
  /// How far the angle is behind under position control, in degrees; 0 otherwise.
  [[nodiscard]] double following_error() const noexcept;
  [[nodiscard]] std::int64_t counts() const noexcept { return turns_.counts(); }
  /// Its place is known by its encoder, and not only its speed.
  [[nodiscard]] bool has_encoder() const noexcept { return part_.mode == DriveMode::CyclicSyncTorque; }

 private:
  [[nodiscard]] double angle_deg() const noexcept;
  [[nodiscard]] ServoInput input() const noexcept;

  ServoSpindle part_;
  double period_s_;
  bool tells_torque_;
  TurnReader turns_;
  double rpm_ = 0, measured_nm_ = 0;

  bool live_ = false;  ///< the speed follows what is wanted
  double rpm_set_ = 0, rpm_per_s_set_ = 0, angle_set_deg_ = 0;
  double torque_nm_ = 0;

  OverloadWatch overload_;
  int fast_cycles_ = 0;
};

}  // namespace rmac

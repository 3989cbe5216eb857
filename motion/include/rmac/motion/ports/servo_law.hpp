#pragma once

#include <cmath>
#include <span>

namespace rmac {

/// What a servo law sees in one cycle of one joint. mm or degrees; efforts in N or N·m at the joint. The law of a
/// spindle's speed sees that, in rpm, as position, and its rate of change as velocity.
struct ServoInput {
  double position_setpoint = 0;
  double velocity_setpoint = 0;
  double acceleration_setpoint = 0;
  /// Measured. Where the drives tell what was a cycle before, moved on by what the setpoint did since: the difference
  /// to the setpoint is what it was when they measured.
  double position = 0;
  double velocity = 0;  ///< the same
  /// What the joint is pushed with, or the spindle turned. Measured where `effort_measured` says so: by the drives,
  /// from their motors' current (6077h), through the actuator map, friction of the transmission included; drives that
  /// tell what was a cycle before do so of this too. Elsewhere the effort that was commanded in the cycle before. A
  /// joint's force sensor has no part in it: the loop of its contact force is around this law.
  double effort = 0;
  bool effort_measured = false;
  double period_s = 0.001;
};

/// What an update of a position or velocity law may rest on; false for NaN and infinity anywhere in it.
[[nodiscard]] inline bool is_finite(const ServoInput& input) noexcept {
  return std::isfinite(input.position_setpoint) && std::isfinite(input.velocity_setpoint) &&
         std::isfinite(input.acceleration_setpoint) && std::isfinite(input.position) && std::isfinite(input.velocity);
}

/// One gain of a law: its name and unit as `device.json` and `SetMechanismJointServoControlGains` order them.
struct GainInfo {
  const char* name;
  const char* unit;
};

/// Port: the control law of one joint, in joint space; its output is the joint effort in N or N·m.
class ServoLaw {
 public:
  virtual ~ServoLaw() = default;

  /// The meaning of the gain array, in order. Off the cycle.
  [[nodiscard]] virtual std::span<const GainInfo> gains() const noexcept = 0;
  /// Takes new gains, without a jump of the next output; false, and nothing changes, when their number or a value is
  /// impossible. Off the cycle.
  [[nodiscard]] virtual bool set_gains(std::span<const double> values) noexcept = 0;
  /// Largest effort the law may put out. Off the cycle.
  virtual void set_effort_limit(double effort) noexcept = 0;
  /// Effort that holds the joint where it stands, as far as the law knows it beforehand: a hanging load. The drive is
  /// given it with the command that enables it, so that the load does not sag when the brake opens. Real-time safe.
  [[nodiscard]] virtual double resting_effort() const noexcept { return 0; }
  /// Engages without a jump: the next output continues from `effort`. Real-time safe.
  virtual void engage(const ServoInput& input, double effort) noexcept = 0;
  /// One cycle. Always within the effort limit; NaN or infinity in gives NaN out, which the servo loop turns into a
  /// fault, and leaves the law's state as it was. Real-time safe.
  [[nodiscard]] virtual double update(const ServoInput& input) noexcept = 0;
};

}  // namespace rmac

#pragma once

#include <cstdint>

#include "gateway/simulators/vdrive/axis/power_states.hpp"
#include "rmac/fieldbus/simulated_plant.hpp"

namespace rmac::vdrive {

/// Motor, screw and table, and the encoder that looks at them. Angles are counts of the encoder from where the shaft
/// stood at power on; positions are what the encoder tells, as homing and faults have shifted it.
class Shaft {
 public:
  explicit Shaft(const fieldbus::AxisPlantParameters& mechanics) : mechanics_(mechanics), plant_(mechanics) {}

  /// Under this torque, or held by its brake.
  void advance(double torque_nm, bool braked, double dt) noexcept { plant_.advance(torque_nm, braked, dt); }

  [[nodiscard]] double angle() const noexcept;
  [[nodiscard]] double velocity() const noexcept;  ///< in counts/s
  [[nodiscard]] double motor_nm() const noexcept { return plant_.motor_nm(); }
  [[nodiscard]] double position() const noexcept { return position_at(angle()); }
  [[nodiscard]] double position_at(double angle) const noexcept;
  /// Which turn of the index pulse that comes at `index` an angle lies in.
  [[nodiscard]] double turn_of(double angle, double index) const noexcept;

  /// Positions are so many counts more from now on: by homing, or by a fault.
  void shift_zero(double counts) noexcept { offset_ += counts; }
  void shift_encoder(std::int32_t counts) noexcept { shift_ += counts; }
  /// Both are forgotten, as after power on.
  void forget_shifts() noexcept { offset_ = shift_ = 0; }

  /// So slow that a drive calls it standing.
  [[nodiscard]] bool stands() const noexcept;
  [[nodiscard]] double counts_per_radian() const noexcept;
  /// The torque, in N·m, that speeds it up by one count/s².
  [[nodiscard]] double nm_per_count() const noexcept;
  /// The torque that would bring it to rest within `dt`.
  [[nodiscard]] double nm_to_rest(double dt) const noexcept;
  /// How fast it slows down, in counts/s²; `slow_down` and `quick_stop` are the ramps that are asked for.
  [[nodiscard]] double deceleration(Braking by, double slow_down, double quick_stop) const noexcept;
  [[nodiscard]] const fieldbus::AxisPlantParameters& mechanics() const noexcept { return mechanics_; }

 private:
  fieldbus::AxisPlantParameters mechanics_;
  fieldbus::AxisPlant plant_;
  double offset_ = 0;
  double shift_ = 0;
};

}  // namespace rmac::vdrive

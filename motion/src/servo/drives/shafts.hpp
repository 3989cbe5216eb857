#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/drives/shaft_reader.hpp"

namespace rmac {

/// The shafts of all motors, in the order of the actuator map. Real-time safe but for its making.
class Shafts {
 public:
  /// `actuators` must outlive it.
  Shafts(std::span<const ServoActuator> actuators, double period_s);

  /// One cycle: takes what the drives told.
  void read() noexcept;
  [[nodiscard]] ShaftReader& operator[](std::size_t actuator) noexcept { return readers_[actuator]; }
  [[nodiscard]] const ShaftReader& operator[](std::size_t actuator) const noexcept { return readers_[actuator]; }
  void refuse(std::size_t actuator) noexcept {
    readers_[actuator].refuse();
    show(actuator);
  }
  void put_at(std::size_t actuator, const DriveFeedback& words) noexcept {
    readers_[actuator].put_at(words);
    show(actuator);
  }
  /// As the last `read` found them, but for what was refused or put elsewhere since.
  [[nodiscard]] std::span<const double> rad() const noexcept { return {rad_.data(), readers_.size()}; }
  [[nodiscard]] std::span<const double> rad_s() const noexcept { return {rad_s_.data(), readers_.size()}; }
  /// Where the loads are, as angles of the shafts; none where a drive does not tell (`tells_load`).
  [[nodiscard]] std::optional<std::array<double, kMaxJoints>> loads_rad() const noexcept;

 private:
  void show(std::size_t actuator) noexcept {
    rad_[actuator] = readers_[actuator].rad();
    rad_s_[actuator] = readers_[actuator].rad_s();
  }

  std::span<const ServoActuator> actuators_;
  std::vector<ShaftReader> readers_;
  std::array<double, kMaxJoints> rad_{}, rad_s_{};
  bool loads_told_;
};

}  // namespace rmac

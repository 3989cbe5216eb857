#pragma once

#include <atomic>
#include <optional>
#include <variant>
#include <vector>

#include "rmac/fieldbus/simulated_drive.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus {

using SimulatedAxis = std::variant<AxisPlantParameters, SpindlePlantParameters>;

/// A part under the tool: one axis meets it on its way to smaller positions. Its surface may rise and wave along
/// another axis. Every drive of the bus has a force sensor beside it; the first axis's feels the part. mm and N as with
/// a screw of `pitch_mm` on both axes.
struct SimulatedContact {
  std::size_t axis = 2;
  double surface_mm = 0;  ///< where the other axis stands at 0
  double stiffness_n_mm = 1000;
  double damping_n_s_mm = 1;
  std::size_t along = 0;  ///< the other axis
  double slope = 0;       ///< mm a mm of the other axis
  double wave_mm = 0;     ///< amplitude
  double wave_length_mm = 100;
  double pitch_mm = 5;
  double counts_per_newton = 100;  ///< of the sensor; positive where the joint pushes towards larger positions
};

/// A bus of simulated drives with a SYNC: a drive acts a cycle after it measured what is answered so. What is received
/// was measured as the cycle began, and what is sent acts from the begin of the next one on; or the other way round,
/// `set_answer_delay`.
///
/// Tests inject faults from any thread; they act in the next cycle.
class SimulatedInterface : public DigitalControlInterface {
 public:
  SimulatedInterface(const std::vector<SimulatedAxis>& axes, double period_s);

  [[nodiscard]] std::size_t axis_count() const noexcept override { return drives_.size(); }
  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override;
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override;
  [[nodiscard]] std::uint32_t input_bits(std::size_t axis) const noexcept override {
    constexpr std::uint32_t kLimitSwitches = 3;
    return is_spindle(axis) ? 0 : kLimitSwitches;
  }
  [[nodiscard]] DriveMode mode(std::size_t axis) const noexcept override { return modes_[axis]; }
  [[nodiscard]] bool tells_torque(std::size_t /*axis*/) const noexcept override { return true; }
  [[nodiscard]] bool tells_load(std::size_t axis) const noexcept override { return !is_spindle(axis); }
  [[nodiscard]] bool takes_torque_offset(std::size_t axis) const noexcept override { return !is_spindle(axis); }
  [[nodiscard]] int answer_delay(std::size_t /*axis*/) const noexcept override {
    return static_cast<int>(before_.size());
  }
  [[nodiscard]] bool latches(std::size_t axis, TouchProbeEdge /*edge*/) const noexcept override {
    return !is_spindle(axis);
  }

  /// The drive stops answering, and brakes by itself as a drive does that misses its master's heartbeat; and comes
  /// back.
  void set_online(std::size_t axis, bool online) noexcept;
  /// The drive trips with an error code (603Fh).
  void trip(std::size_t axis, std::uint16_t error_code) noexcept;
  void shift_encoder(std::size_t axis, std::int32_t counts) noexcept;
  /// The encoder's reading stays where it is; and goes on.
  void freeze_encoder(std::size_t axis, bool frozen) noexcept;
  /// The drive gives this torque whatever is asked for, until it is no longer operational.
  void run_away(std::size_t axis, double torque_nm) noexcept;
  /// Torque on a shaft from outside, until it is 0 again. A spindle's load holds it back, whichever way it turns.
  void push(std::size_t axis, double torque_nm) noexcept;
  /// The force sensor's value is not valid; and is again.
  void set_sensor_lost(bool lost) noexcept { sensor_lost_ = lost; }
  /// Puts a part under the tool. Before the first cycle.
  void set_contact(const SimulatedContact& contact) noexcept { contact_ = contact; }
  /// Answers are those of so many cycles before, and what is sent acts at once: one as on a bus whose drives answer a
  /// SYNC while nobody reads on, more where drives take their time. 0, as it is unless set, is above. Before a servo
  /// loop is made with it.
  void set_answer_delay(int cycles);
  /// The bus itself fails, as on bus-off; and works again.
  void set_bus_failed(bool failed) noexcept { bus_failed_ = failed; }

  /// Between cycles: an edge at the touch probe of a drive that is no spindle, while its load stood at `angle_rad`.
  void touch(std::size_t axis, TouchProbeEdge edge, double angle_rad) noexcept {
    std::get_if<SimulatedServoDrive>(&drives_[axis])->touch(edge, angle_rad);
  }
  /// Between cycles: where a shaft really is. For an axis that is no spindle; and one that is.
  [[nodiscard]] AxisPlant& plant(std::size_t axis);
  [[nodiscard]] const SpindlePlant& spindle(std::size_t axis) const;
  [[nodiscard]] bool is_spindle(std::size_t axis) const noexcept {
    return std::holds_alternative<SimulatedSpindleDrive>(drives_[axis]);
  }

 private:
  using Drive = std::variant<SimulatedServoDrive, SimulatedSpindleDrive>;
  struct Injected {
    std::atomic<bool> offline{false};
    std::atomic<std::int32_t> error_code{0};  ///< 0: none
    std::atomic<std::int32_t> encoder_shift{0};
    std::atomic<bool> frozen{false};
    std::atomic<double> runaway_nm{0};  ///< 0: none
    std::atomic<double> push_nm{0};
  };
  void act_on_injected(std::size_t axis) noexcept;
  void move_surface() noexcept;
  void read_sensor(std::size_t axis, DriveFeedback& words) noexcept;

  std::vector<Drive> drives_;
  std::vector<DriveMode> modes_;
  std::vector<Injected> injected_;
  std::vector<char> heard_;  ///< the axis, in this cycle
  std::atomic<bool> bus_failed_{false};
  bool bus_fails_now_ = false;  ///< in this cycle
  std::atomic<bool> sensor_lost_{false};
  std::optional<SimulatedContact> contact_;
  std::vector<DriveCommand> sent_;                  ///< in the cycle before
  std::vector<std::vector<DriveFeedback>> before_;  ///< what late answers will tell, the next ones first
  double period_s_;
};

/// The bus of the example machines: three table axes (the third carries the spindle head), a spindle, and four axes
/// more.
[[nodiscard]] std::vector<SimulatedAxis> default_simulated_axes();

}  // namespace rmac::fieldbus

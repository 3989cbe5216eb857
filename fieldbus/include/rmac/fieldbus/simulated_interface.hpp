#pragma once

#include <atomic>
#include <variant>
#include <vector>

#include "rmac/fieldbus/simulated_drive.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus {

using SimulatedAxis = std::variant<AxisPlantParameters, SpindlePlantParameters>;

/// A bus of simulated drives. Feedback is what the drives measured when the exchange began, and commands act from then
/// until the next exchange: as with a SYNC on a real bus, a drive acts on a measurement one cycle after it was taken.
///
/// Tests inject faults from any thread; they act in the next exchange.
class SimulatedInterface : public DigitalControlInterface {
 public:
  SimulatedInterface(const std::vector<SimulatedAxis>& axes, double period_s);

  [[nodiscard]] std::size_t axis_count() const noexcept override { return drives_.size(); }
  [[nodiscard]] Expected<> start() override;
  void stop() noexcept override;
  [[nodiscard]] bool exchange(std::span<const DriveCommand> commands,
                              std::span<DriveFeedback> feedback) noexcept override;

  /// The drive stops answering, and brakes by itself as a drive does that misses its master's heartbeat; and comes
  /// back.
  void set_online(std::size_t axis, bool online) noexcept;
  /// The drive trips with an error code (603Fh).
  void trip(std::size_t axis, std::uint16_t error_code) noexcept;
  void shift_encoder(std::size_t axis, std::int32_t counts) noexcept;
  /// The bus itself fails, as on bus-off; and works again.
  void set_bus_failed(bool failed) noexcept { bus_failed_ = failed; }

  /// For tests, between exchanges: where a shaft really is.
  [[nodiscard]] AxisPlant& plant(std::size_t axis);
  [[nodiscard]] const SpindlePlant& spindle(std::size_t axis) const;

 private:
  using Drive = std::variant<SimulatedServoDrive, SimulatedSpindleDrive>;
  struct Injected {
    std::atomic<bool> offline{false};
    std::atomic<std::int32_t> error_code{0};  ///< 0: none
    std::atomic<std::int32_t> encoder_shift{0};
  };
  void act_on_injected(std::size_t axis) noexcept;

  std::vector<Drive> drives_;
  std::vector<Injected> injected_;
  std::atomic<bool> bus_failed_{false};
  double period_s_;
};

/// The bus of the example machines: three table axes (the third carries the spindle head), a spindle, and four axes
/// more.
[[nodiscard]] std::vector<SimulatedAxis> default_simulated_axes();

}  // namespace rmac::fieldbus
